//! What shapes of a PDF are filled with: transparency and gradients.

use pdf_writer::types::FunctionShadingType;
use pdf_writer::{Finish, Name, Pdf, Ref};
use resvg::tiny_skia::Transform;
use resvg::usvg::{Color, Stop};

/// A gradient as it lies on the page.
pub struct Gradient {
    /// Ends of a linear one; centres and radii of a radial one.
    pub places: Places,
    /// Colours along it.
    pub stops: Vec<Stop>,
    /// From its own units to the page.
    pub transform: Transform,
}

/// Where a gradient begins and ends.
pub enum Places {
    /// x and y of both ends.
    Linear([f32; 4]),
    /// x, y and radius of the inner and the outer circle.
    Radial([f32; 6]),
}

/// Parts of a colour; 0 to 1.
pub fn parts_of(colour: Color) -> [f32; 3] {
    [colour.red, colour.green, colour.blue].map(|own| f32::from(own) / 255.0)
}

/// Name of an entry of the page's resources.
pub fn name_of(kind: char, place: usize) -> String {
    format!("{kind}{place}")
}

/// Writes a gradient as a pattern.
pub fn write_gradient(
    pdf: &mut Pdf,
    gradient: &Gradient,
    pattern: Ref,
    next: &mut dyn FnMut() -> Ref,
) {
    let colours = write_colours(pdf, &gradient.stops, next);
    let mut written = pdf.shading_pattern(pattern);
    let m = gradient.transform;
    written.matrix([m.sx, m.ky, m.kx, m.sy, m.tx, m.ty]);
    let mut shading = written.function_shading();
    match gradient.places {
        Places::Linear(ends) => {
            shading
                .shading_type(FunctionShadingType::Axial)
                .coords(ends);
        }
        Places::Radial(circles) => {
            shading
                .shading_type(FunctionShadingType::Radial)
                .coords(circles);
        }
    }
    shading.color_space().device_rgb();
    shading.function(colours).extend([true, true]);
    shading.finish();
}

/// Colours between stops: a function for each stretch, and one that joins them.
fn write_colours(pdf: &mut Pdf, stops: &[Stop], next: &mut dyn FnMut() -> Ref) -> Ref {
    let mut stretches = Vec::new();
    for pair in stops.windows(2) {
        let stretch = next();
        pdf.exponential_function(stretch)
            .domain([0.0, 1.0])
            .c0(parts_of(pair[0].color()))
            .c1(parts_of(pair[1].color()))
            .n(1.0);
        stretches.push(stretch);
    }
    let all = next();
    let inner = stops.iter().skip(1).take(stretches.len().saturating_sub(1));
    pdf.stitching_function(all)
        .domain([0.0, 1.0])
        .bounds(inner.map(|own| own.offset().get()))
        .encode(stretches.iter().flat_map(|_| [0.0, 1.0]))
        .functions(stretches);
    all
}

/// Writes opacities of what is filled and of lines.
pub fn write_opacity(pdf: &mut Pdf, state: Ref, (fill, stroke): (f32, f32)) {
    pdf.ext_graphics(state)
        .non_stroking_alpha(fill)
        .stroking_alpha(stroke);
}

/// [`name_of`] as it stands in the file.
pub fn as_name(text: &str) -> Name<'_> {
    Name(text.as_bytes())
}
