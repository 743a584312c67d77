//! Which terms of a response surface matter: Pareto and half-normal plot of their t.

use crate::surface::outcome::SurfaceModel;
use windfall_distribution::tail::{normal_quantile, t_upper_quantile};
use windfall_draw::axis::axis;
use windfall_draw::files::{Painting, Picture, file_name};
use windfall_draw::frame::{Frame, Rectangle};
use windfall_draw::svg::{Anchor, Drawing, Ink};
use windfall_draw::text_width::text_width;
use windfall_draw::width::Width;
use windfall_files::error::Error;
use windfall_files::table::write::csv_text;
use windfall_files::text::column_title::column_title;

/// Size of the panels and the room around them; px.
const WIDTH: f64 = 300.0;
const LEFT: f64 = 128.0;
const BETWEEN: f64 = 78.0;
const RIGHT: f64 = 24.0;
const TOP: f64 = 66.0;
const BELOW: f64 = 52.0;
const LEAST_HEIGHT: f64 = 230.0;

/// Height of a bar with the room to the next; px.
const BAR: f64 = 21.0;

/// A name longer than this is cut; characters.
const LONGEST: usize = 17;

/// A term with its t.
#[derive(Clone, Debug, PartialEq)]
pub struct TermEffect {
    /// The term, as it was written, and with the names of the factors.
    pub term: String,
    /// With the names of the factors.
    pub name: String,
    /// Coefficient in coded units over its standard error; 1.
    pub t: f64,
}

/// Effects of a model with what they are held against.
#[derive(Clone, Debug, PartialEq)]
pub struct Effects {
    /// Terms, the largest first; none that is aliased.
    pub terms: Vec<TermEffect>,
    /// Beyond this |t| a term named beforehand differs from zero; 1.
    pub critical: f64,
    /// Beyond this the largest of all terms does (Bonferroni); 1.
    pub critical_of_all: f64,
}

/// Effects of a fitted model; `None` where nothing is left to estimate the noise, and with random
/// groups, where terms have degrees of freedom of their own and so no common limit.
///
/// * `confidence`: level of the limits, such as 0.95
///
/// # Source
/// C. Daniel (1959), Technometrics 1:311 (half-normal plots); R. V. Lenth (1989)
/// for why unreplicated two-level designs need other limits than these of t.
pub fn effects_of(model: &SurfaceModel, confidence: f64) -> Option<Effects> {
    let terms = model.terms.iter().skip(1).filter_map(|term| {
        let t = term.coded / term.se;
        t.is_finite().then(|| TermEffect {
            term: term.term.clone(),
            name: term.name.clone(),
            t,
        })
    });
    let mut terms: Vec<TermEffect> = terms.collect();
    if terms.is_empty() || model.random.is_some() || model.residual.df < 1.0 {
        return None;
    }
    terms.sort_by(|a, b| b.t.abs().total_cmp(&a.t.abs()));
    let tail = 0.5 * (1.0 - confidence);
    Some(Effects {
        critical: t_upper_quantile(tail, model.residual.df),
        critical_of_all: t_upper_quantile(tail / terms.len() as f64, model.residual.df),
        terms,
    })
}

/// Expected |t| of the terms if none matters, largest first.
pub fn half_normal_scores(count: usize) -> Vec<f64> {
    let m = count as f64;
    (0..count)
        .rev()
        .map(|i| normal_quantile(0.5 + 0.5 * (i as f64 + 0.5) / m))
        .collect()
}

/// Pareto and half-normal plot of a response; `None` as in [`effects_of`].
pub fn effects_painting(
    model: &SurfaceModel,
    confidence: f64,
    paper: Option<Width>,
) -> Result<Option<Painting>, Error> {
    let Some(effects) = effects_of(model, confidence) else {
        return Ok(None);
    };
    let scores = half_normal_scores(effects.terms.len());
    let header = [
        "term",
        "name",
        "t",
        "half_normal_score",
        "critical_t",
        "bonferroni_t",
    ];
    let rows = effects.terms.iter().zip(&scores).map(|(term, score)| {
        vec![
            term.term.clone(),
            term.name.clone(),
            term.t.to_string(),
            score.to_string(),
            effects.critical.to_string(),
            effects.critical_of_all.to_string(),
        ]
    });
    Ok(Some(Painting {
        name: file_name(&format!("effects-{}", model.response)),
        caption: "Terms of the model by their coefficient in coded units over its standard error. \
                  Broken lines: limit for one term named beforehand, and (Bonferroni) for the \
                  largest of all."
            .to_owned(),
        csv: csv_text(&header.map(str::to_owned), rows)?,
        picture: Picture::Drawn(drawing_of((model, &effects), &scores, confidence, paper)),
    }))
}

fn drawing_of(
    (model, effects): (&SurfaceModel, &Effects),
    scores: &[f64],
    level: f64,
    paper: Option<Width>,
) -> Drawing {
    let height = (effects.terms.len() as f64 * BAR + 8.0).max(LEAST_HEIGHT);
    // Below each other where they do not fit side by side.
    let aside = paper.is_none_or(|own| own.columns(2) == 2);
    let sides = LEFT + RIGHT + if aside { BETWEEN } else { 0.0 };
    let panels = if aside { 2.0 } else { 1.0 };
    let panel = paper.map_or(WIDTH, |own| (own.px() - sides) / panels);
    let second = if aside { 0.0 } else { height + BELOW + 14.0 };
    let width = sides + panels * panel;
    let mut drawing = Drawing::at_width(paper, width, TOP + second + height + BELOW);
    let title = format!("Effects on {}", column_title(&model.response).0);
    drawing.title(24.0, 26.0, &title);
    let (mut x, mut y) = (24.0, 39.0);
    for (lowers, label) in [(false, "raises"), (true, "lowers")] {
        draw_mark(&mut drawing, (x + 4.0, y), lowers);
        drawing.text((x + 14.0, y + 3.8), Anchor::Start, 11.0, label);
        x += 66.0;
    }
    let percent = 100.0 * level;
    let limits = format!("{percent} % limits: one term, and all together (Bonferroni)");
    if x + 24.0 + text_width(&limits, drawing.letters(11.0)) > width {
        (x, y) = (24.0, y + 15.0);
    }
    drawing.dashed(&[(x, y), (x + 18.0, y)], Ink::Text, 1.2);
    drawing.text((x + 24.0, y + 3.8), Anchor::Start, 11.0, &limits);
    let within = Rectangle {
        left: LEFT,
        top: TOP,
        width: panel,
        height,
    };
    draw_pareto(&mut drawing, effects, within);
    let left = if aside {
        LEFT + panel + BETWEEN
    } else {
        BETWEEN
    };
    let within = Rectangle {
        left,
        top: TOP + second,
        width: width - RIGHT - left,
        height,
    };
    draw_half_normal(&mut drawing, effects, scores, within);
    drawing
}

/// A mark of a term: a spot where it raises, a square where it lowers.
fn draw_mark(drawing: &mut Drawing, at: (f64, f64), lowers: bool) {
    match lowers {
        false => drawing.spot(at, 4.5, Ink::Series(0)),
        true => drawing.mark(at, 4.2, 1, Ink::Series(1)),
    }
}

fn ink_of(term: &TermEffect) -> Ink {
    Ink::Series(usize::from(term.t < 0.0))
}

fn largest(effects: &Effects) -> f64 {
    let sizes = effects.terms.iter().map(|term| term.t.abs());
    sizes.fold(effects.critical_of_all, f64::max)
}

fn draw_limits(drawing: &mut Drawing, effects: &Effects, frame: &Frame) {
    for limit in [effects.critical, effects.critical_of_all] {
        let (x, _) = frame.place((limit, 0.0));
        let ends = [(x, frame.within.top), (x, frame.within.bottom())];
        drawing.dashed(&ends, Ink::Text, 1.2);
    }
}

fn draw_pareto(drawing: &mut Drawing, effects: &Effects, within: Rectangle) {
    let frame = Frame {
        within,
        across: axis(0.0, 1.06 * largest(effects), 6),
        up: axis(0.0, 1.0, 1),
    };
    for tick in &frame.across.ticks {
        let (x, _) = frame.place((*tick, 0.0));
        drawing.rule((x, within.top), (x, within.bottom()), Ink::Grid);
    }
    let step = within.height / effects.terms.len() as f64;
    for (index, term) in effects.terms.iter().enumerate() {
        let middle = within.top + (index as f64 + 0.5) * step;
        let half = (0.36 * step).min(9.0);
        let (right, _) = frame.place((term.t.abs(), 0.0));
        let corners = [
            (within.left, middle - half),
            (right, middle - half),
            (right, middle + half),
            (within.left, middle + half),
        ];
        // Paler within a line where it lowers: told apart in grey print, too.
        match term.t < 0.0 {
            false => drawing.area(&[corners.to_vec()], ink_of(term)),
            true => {
                drawing.veil(&corners, ink_of(term), 0.35);
                let around = [&corners[..], &corners[..1]].concat();
                drawing.polyline(&around, ink_of(term), 1.0);
            }
        }
        let at = (within.left - 7.0, middle + 3.8);
        drawing.text(at, Anchor::End, 11.0, &short(&term.name));
    }
    draw_limits(drawing, effects, &frame);
    let bare = Frame {
        up: windfall_draw::axis::Axis {
            ticks: Vec::new(),
            labels: Vec::new(),
            ..frame.up.clone()
        },
        ..frame
    };
    bare.draw_axes(drawing, ("|t| of the term", ""), ("", ""), 0.0);
}

fn short(name: &str) -> String {
    match name.chars().count() > LONGEST {
        true => name.chars().take(LONGEST - 1).chain(['…']).collect(),
        false => name.to_owned(),
    }
}

fn draw_half_normal(drawing: &mut Drawing, effects: &Effects, scores: &[f64], within: Rectangle) {
    let highest = scores.first().copied().unwrap_or(1.0);
    let frame = Frame {
        within,
        across: axis(0.0, 1.06 * largest(effects), 6),
        up: axis(0.0, 1.12 * highest, 5),
    };
    frame.draw_grid(drawing);
    // Where the terms lie if none matters.
    let end = frame.across.high.min(frame.up.high);
    let line = [frame.place((0.0, 0.0)), frame.place((end, end))];
    drawing.polyline(&line, Ink::Frame, 1.2);
    draw_limits(drawing, effects, &frame);
    for (term, score) in effects.terms.iter().zip(scores) {
        let (x, y) = frame.place((term.t.abs(), *score));
        draw_mark(drawing, (x, y), term.t < 0.0);
        if term.t.abs() > effects.critical {
            let text = short(&term.name);
            let (at, anchor) = match x > within.left + 0.5 * within.width {
                true => ((x - 8.0, y + 3.6), Anchor::End),
                false => ((x + 8.0, y + 3.6), Anchor::Start),
            };
            drawing.text_over(at, (anchor, 10.5), &text, Ink::Background);
        }
    }
    let titles = (("|t| of the term", ""), ("half-normal score", ""));
    frame.draw_axes(drawing, titles.0, titles.1, 46.0);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of one term the median of the half-normal distribution, 0.6745; of three
    /// Φ⁻¹(7/12), Φ⁻¹(3/4), Φ⁻¹(11/12) from tables, the largest first.
    #[test]
    fn reference_half_normal_scores() {
        assert!((half_normal_scores(1)[0] - 0.674_490).abs() < 1e-5);
        let expected = [1.382_994, 0.674_490, 0.210_428];
        for (found, expected) in half_normal_scores(3).iter().zip(expected) {
            assert!((found - expected).abs() < 1e-5, "{found}");
        }
    }

    #[test]
    fn closed_form_long_names_are_cut() {
        assert_eq!(short("k:e"), "k:e");
        assert_eq!(short("a_rather_long_factor^2").chars().count(), LONGEST);
    }
}
