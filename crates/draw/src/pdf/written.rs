//! SVG written as PDF.

use super::font::{FontRefs, Glyphs};
use super::packed::packed;
use super::paint::{Gradient, Places, as_name, name_of, parts_of, write_gradient, write_opacity};
use crate::png::OPTIONS;
use pdf_writer::types::{ColorSpaceOperand, LineCapStyle, LineJoinStyle};
use pdf_writer::{Content, Filter, Finish, Pdf, Rect, Ref, Str};
use resvg::tiny_skia::{PathSegment, Transform};
use resvg::usvg::layout::PositionedGlyph;
use resvg::usvg::{
    FillRule, Group, LineCap, LineJoin, Node, Paint, PaintOrder, Path, Stroke, Text, Tree,
};
use windfall_files::error::Error;

/// Points per px.
const POINT: f32 = 0.75;

/// Name of the font among the page's resources.
const FONT: &str = "F0";

/// A page while it is drawn.
struct Page {
    content: Content,
    glyphs: Glyphs,
    gradients: Vec<Gradient>,
    /// Opacities of what is filled and of lines, as used.
    opacities: Vec<(f32, f32)>,
}

/// See [`pdf_of_svg`](crate::pdf::pdf_of_svg).
pub fn written(svg: &str) -> Result<Vec<u8>, Error> {
    let failed = |detail: String| Error::FigureUndrawable { detail };
    let tree = Tree::from_str(svg, &OPTIONS).map_err(|error| failed(error.to_string()))?;
    let size = (POINT * tree.size().width(), POINT * tree.size().height());
    // Upwards, in points.
    let onto_page = Transform::from_row(POINT, 0.0, 0.0, -POINT, 0.0, size.1);
    let mut page = Page {
        content: Content::new(),
        glyphs: Glyphs::default(),
        gradients: Vec::new(),
        opacities: Vec::new(),
    };
    page.group(tree.root(), onto_page);
    page.finish(size).map_err(failed)
}

impl Page {
    fn group(&mut self, group: &Group, onto_page: Transform) {
        for node in group.children() {
            match node {
                Node::Group(own) => self.group(own, onto_page),
                Node::Path(own) => {
                    let onto_page = onto_page.pre_concat(own.abs_transform());
                    self.path(own, onto_page);
                }
                Node::Text(own) => self.text(own, onto_page),
                // Figures have none.
                Node::Image(_) => {}
            }
        }
    }

    /// Opacities from here to the end of the saved state.
    fn opacity(&mut self, fill: f32, stroke: f32) {
        if (fill, stroke) == (1.0, 1.0) {
            return;
        }
        let found = self.opacities.iter().position(|own| *own == (fill, stroke));
        let place = found.unwrap_or_else(|| {
            self.opacities.push((fill, stroke));
            self.opacities.len() - 1
        });
        let name = name_of('G', place);
        self.content.set_parameters(as_name(&name));
    }

    /// What comes is filled with this paint; lines are drawn with it where `line` says so.
    fn paint(&mut self, paint: &Paint, onto_page: Transform, line: bool) {
        let (places, own) = match paint {
            Paint::Color(colour) => {
                let [r, g, b] = parts_of(*colour);
                match line {
                    true => self.content.set_stroke_rgb(r, g, b),
                    false => self.content.set_fill_rgb(r, g, b),
                };
                return;
            }
            Paint::LinearGradient(own) => {
                let ends = [own.x1(), own.y1(), own.x2(), own.y2()];
                (Places::Linear(ends), &***own)
            }
            Paint::RadialGradient(own) => {
                let (inner, outer) = (own.fr().get(), own.r().get());
                let circles = [own.fx(), own.fy(), inner, own.cx(), own.cy(), outer];
                (Places::Radial(circles), &***own)
            }
            // Figures have none.
            Paint::Pattern(_) => return,
        };
        self.gradients.push(Gradient {
            places,
            stops: own.stops().to_vec(),
            transform: onto_page.pre_concat(own.transform()),
        });
        let name = name_of('P', self.gradients.len() - 1);
        self.content
            .set_fill_color_space(ColorSpaceOperand::Pattern)
            .set_fill_pattern([], as_name(&name));
    }

    fn path(&mut self, path: &Path, onto_page: Transform) {
        if !path.is_visible() {
            return;
        }
        let m = onto_page;
        self.content.save_state();
        let fill = path.fill().map_or(1.0, |own| own.opacity().get());
        let stroke = path.stroke().map_or(1.0, |own| own.opacity().get());
        self.opacity(fill, stroke);
        if let Some(own) = path.fill() {
            self.paint(own.paint(), onto_page, false);
        }
        if let Some(own) = path.stroke() {
            self.paint(own.paint(), onto_page, true);
        }
        self.content.transform([m.sx, m.ky, m.kx, m.sy, m.tx, m.ty]);
        if let Some(own) = path.stroke() {
            self.line(own);
        }
        self.outline(path);
        match (path.fill(), path.stroke()) {
            (None, None) => self.content.end_path(),
            (None, Some(_)) => self.content.stroke(),
            (Some(own), None) => match own.rule() {
                FillRule::NonZero => self.content.fill_nonzero(),
                FillRule::EvenOdd => self.content.fill_even_odd(),
            },
            (Some(own), Some(_)) => match own.rule() {
                FillRule::NonZero => self.content.fill_nonzero_and_stroke(),
                FillRule::EvenOdd => self.content.fill_even_odd_and_stroke(),
            },
        };
        self.content.restore_state();
    }

    fn line(&mut self, stroke: &Stroke) {
        let cap = match stroke.linecap() {
            LineCap::Butt => LineCapStyle::ButtCap,
            LineCap::Round => LineCapStyle::RoundCap,
            LineCap::Square => LineCapStyle::ProjectingSquareCap,
        };
        let join = match stroke.linejoin() {
            LineJoin::Round => LineJoinStyle::RoundJoin,
            LineJoin::Bevel => LineJoinStyle::BevelJoin,
            LineJoin::Miter | LineJoin::MiterClip => LineJoinStyle::MiterJoin,
        };
        self.content
            .set_line_width(stroke.width().get())
            .set_line_cap(cap)
            .set_line_join(join);
        if let Some(dashes) = stroke.dasharray() {
            let dashes = dashes.iter().copied();
            self.content.set_dash_pattern(dashes, stroke.dashoffset());
        }
    }

    fn outline(&mut self, path: &Path) {
        let mut last = (0.0, 0.0);
        for segment in path.data().segments() {
            match segment {
                PathSegment::MoveTo(to) => {
                    self.content.move_to(to.x, to.y);
                    last = (to.x, to.y);
                }
                PathSegment::LineTo(to) => {
                    self.content.line_to(to.x, to.y);
                    last = (to.x, to.y);
                }
                // A curve of degree two as one of degree three.
                PathSegment::QuadTo(by, to) => {
                    let between = |end: f32, by: f32| end + 2.0 / 3.0 * (by - end);
                    self.content.cubic_to(
                        between(last.0, by.x),
                        between(last.1, by.y),
                        between(to.x, by.x),
                        between(to.y, by.y),
                        to.x,
                        to.y,
                    );
                    last = (to.x, to.y);
                }
                PathSegment::CubicTo(a, b, to) => {
                    self.content.cubic_to(a.x, a.y, b.x, b.y, to.x, to.y);
                    last = (to.x, to.y);
                }
                PathSegment::Close => {
                    self.content.close_path();
                }
            }
        }
    }

    /// The rim of letters, below them: outlines, so that the text is found once.
    fn rim(&mut self, group: &Group, onto_page: Transform) {
        for node in group.children() {
            match node {
                Node::Group(own) => self.rim(own, onto_page),
                Node::Path(own) if own.paint_order() == PaintOrder::StrokeAndFill => {
                    if let Some(stroke) = own.stroke() {
                        let m = onto_page.pre_concat(own.abs_transform());
                        self.content.save_state();
                        self.paint(stroke.paint(), m, true);
                        self.content.transform([m.sx, m.ky, m.kx, m.sy, m.tx, m.ty]);
                        self.line(stroke);
                        self.outline(own);
                        self.content.stroke();
                        self.content.restore_state();
                    }
                }
                _ => {}
            }
        }
    }

    fn text(&mut self, text: &Text, page: Transform) {
        self.rim(text.flattened(), page);
        let onto_page = page.pre_concat(text.abs_transform());
        for span in text.layouted() {
            let (Some(fill), true) = (&span.fill, span.visible) else {
                continue;
            };
            self.content.save_state();
            self.paint(fill.paint(), onto_page, false);
            self.letters(&span.positioned_glyphs, onto_page);
            self.content.restore_state();
        }
    }

    fn letters(&mut self, glyphs: &[PositionedGlyph], onto_page: Transform) {
        self.content.begin_text();
        for glyph in glyphs {
            let Ok(id) = u16::try_from(glyph.id.0) else {
                continue;
            };
            let number = self.glyphs.number(id, &glyph.text);
            let size = glyph.font_size();
            // The page in points: the size of the letters is that of the font.
            let own = glyph.outline_transform();
            let (sx, kx) = (own.sx.hypot(own.ky), own.sy.hypot(own.kx));
            let m = onto_page
                .pre_concat(own)
                .pre_scale(1.0 / (sx * POINT), 1.0 / (kx * POINT));
            self.content
                .set_font(as_name(FONT), POINT * size)
                .set_text_matrix([m.sx, m.ky, m.kx, m.sy, m.tx, m.ty])
                .show(Str(&number.to_be_bytes()));
        }
        self.content.end_text();
    }

    fn finish(self, (width, height): (f32, f32)) -> Result<Vec<u8>, String> {
        let mut last = 0;
        let mut next = || {
            last += 1;
            Ref::new(last)
        };
        let [catalog, pages, page, content] = [(); 4].map(|()| next());
        let refs = FontRefs {
            font: next(),
            descendant: next(),
            descriptor: next(),
            file: next(),
            letters: next(),
        };
        let patterns: Vec<Ref> = self.gradients.iter().map(|_| next()).collect();
        let states: Vec<Ref> = self.opacities.iter().map(|_| next()).collect();

        let mut pdf = Pdf::new();
        pdf.catalog(catalog).pages(pages);
        pdf.pages(pages).kids([page]).count(1);
        let mut written = pdf.page(page);
        written
            .media_box(Rect::new(0.0, 0.0, width, height))
            .parent(pages)
            .contents(content);
        let mut resources = written.resources();
        resources.fonts().pair(as_name(FONT), refs.font);
        let mut named = resources.patterns();
        for (place, own) in patterns.iter().enumerate() {
            named.pair(as_name(&name_of('P', place)), *own);
        }
        named.finish();
        let mut named = resources.ext_g_states();
        for (place, own) in states.iter().enumerate() {
            named.pair(as_name(&name_of('G', place)), *own);
        }
        named.finish();
        resources.finish();
        written.finish();

        let drawn = packed(&self.content.finish());
        pdf.stream(content, &drawn).filter(Filter::FlateDecode);
        for (gradient, pattern) in self.gradients.iter().zip(&patterns) {
            write_gradient(&mut pdf, gradient, *pattern, &mut next);
        }
        for (opacity, state) in self.opacities.iter().zip(&states) {
            write_opacity(&mut pdf, *state, *opacity);
        }
        self.glyphs.write(&mut pdf, &refs)?;
        pdf.document_info(next())
            .producer(pdf_writer::TextStr("windfall"));
        Ok(pdf.finish())
    }
}
