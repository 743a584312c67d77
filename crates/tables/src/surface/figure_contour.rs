//! Response surfaces as contours over every pair of factors.

use crate::surface::figure_pairs::{
    PairPlaces, SurfacePairs, csv_of_pairs, factor_title, others_of, places_of, reference_words,
    surface_pairs,
};
use crate::surface::fitted::{FittedSurfaces, SurfaceGrid};
use crate::surface::outcome::SurfaceOutcome;
use windfall_draw::axis::axis;
use windfall_draw::contour_lines::{Field, area_above, contours};
use windfall_draw::files::{Painting, Picture, file_name};
use windfall_draw::frame::{Frame, Rectangle};
use windfall_draw::svg::{Anchor, Drawing, Ink};
use windfall_draw::text_width::text_width;
use windfall_draw::width::Width;
use windfall_files::error::Error;

/// Points of a grid along each factor.
const POINTS: usize = 81;

/// Size of a panel and the room around it; px.
const WIDTH: f64 = 272.0;
const HEIGHT: f64 = 236.0;
const LEFT: f64 = 74.0;
const RIGHT: f64 = 18.0;
const ABOVE: f64 = 26.0;
const BELOW: f64 = 52.0;

/// Title and legend; px.
const TOP: f64 = 56.0;

/// The bar of colours with the room before it and its labels; px.
const BAR: f64 = 14.0;
const BESIDE_BAR: f64 = 76.0;

/// Panels side by side.
const COLUMNS: usize = 2;

/// Least distance between labels, and least length of a labelled line; px.
const LABEL_ROOM: f64 = 30.0;
const LEAST_LABELLED: f64 = 46.0;

/// Colour of the optimum and its family.
const BEST: Ink = Ink::Series(1);

/// Contours of each response, and of the desirability if there are goals, over every pair
/// of factors, with the runs, the optimum and settings as good.
pub fn contour_paintings(
    fitted: &FittedSurfaces,
    outcome: &SurfaceOutcome,
    paper: Option<Width>,
) -> Result<Vec<Painting>, Error> {
    let all = surface_pairs(fitted, POINTS);
    let painting = |own: &SurfacePairs| {
        Ok(Painting {
            name: file_name(&format!("contour-{}", own.name)),
            caption: format!(
                "{} over pairs of factors, the others at {}. Along the line of settings that are \
                 as desirable the other factors change too.",
                own.title,
                reference_words(fitted)
            ),
            picture: Picture::Drawn(drawing_of((fitted, outcome), own, paper)),
            csv: csv_of_pairs(fitted, outcome, own)?,
        })
    };
    all.iter().map(painting).collect()
}

fn drawing_of(
    (fitted, outcome): (&FittedSurfaces, &SurfaceOutcome),
    own: &SurfacePairs,
    paper: Option<Width>,
) -> Drawing {
    let count = own.grids.len();
    let columns = paper.map_or(count.min(COLUMNS), |own| own.columns(count).min(COLUMNS));
    let rows = count.div_ceil(columns.max(1));
    let beside = BAR + BESIDE_BAR;
    let panel = paper.map_or(WIDTH, |own| {
        (own.px() - beside) / columns as f64 - LEFT - RIGHT
    });
    let (step_x, step_y) = (LEFT + panel + RIGHT, ABOVE + HEIGHT + BELOW);
    let width = columns as f64 * step_x + beside;
    let mut drawing = Drawing::at_width(paper, width, TOP + rows as f64 * step_y);
    let title = format!("Contours of {}", own.title);
    drawing.title(LEFT, 26.0, &title);
    let mut any = PairPlaces::default();
    for (index, grid) in own.grids.iter().enumerate() {
        let within = Rectangle {
            left: LEFT + (index % columns) as f64 * step_x,
            top: TOP + ABOVE + (index / columns) as f64 * step_y,
            width: panel,
            height: HEIGHT,
        };
        let places = places_of(fitted, outcome, grid.factors);
        draw_panel(&mut drawing, fitted, (own, grid), within, &places);
        any = places;
    }
    draw_legend(&mut drawing, &any, width);
    let bar = Rectangle {
        left: columns as f64 * step_x + 8.0,
        top: TOP + ABOVE,
        width: BAR,
        height: HEIGHT,
    };
    own.heights
        .draw_bar(&mut drawing, bar, &own.title, &own.unit);
    drawing
}

fn draw_panel(
    drawing: &mut Drawing,
    fitted: &FittedSurfaces,
    (own, grid): (&SurfacePairs, &SurfaceGrid),
    within: Rectangle,
    places: &PairPlaces,
) {
    let ends = |values: &[f64]| {
        let (first, last) = (values.first(), values.last());
        (first.copied().unwrap_or(0.0), last.copied().unwrap_or(1.0))
    };
    let ((left, right), (low, high)) = (ends(&grid.x), ends(&grid.y));
    let frame = Frame {
        within,
        across: axis(left, right, 5),
        up: axis(low, high, 5),
    };
    let field = Field {
        x: &grid.x,
        y: &grid.y,
        values: &grid.values,
    };
    let placed = |points: &[(f64, f64)]| -> Vec<(f64, f64)> {
        points.iter().map(|point| frame.place(*point)).collect()
    };

    // What is above each level, over what is above the one below.
    let corners = [(left, low), (right, low), (right, high), (left, high)];
    drawing.area(&[placed(&corners)], own.heights.ink(0));
    let levels = &own.heights.axis.ticks;
    for (index, level) in levels.iter().enumerate() {
        let loops = area_above(&field, *level);
        if !loops.is_empty() {
            let loops: Vec<_> = loops.iter().map(|line| placed(line)).collect();
            drawing.area(&loops, own.heights.ink(index + 1));
        }
    }
    let mut taken: Vec<(f64, f64)> = placed(&places.runs);
    taken.extend(placed(&places.family));
    taken.extend(places.optimum.map(|point| frame.place(point)));
    let mut labels: Vec<((f64, f64), &str, Ink)> = Vec::new();
    for (index, (level, label)) in levels.iter().zip(&own.heights.axis.labels).enumerate() {
        for line in contours(&field, *level) {
            let points = placed(&line.points);
            drawing.polyline(&points, Ink::Text, 0.6);
            let near: Vec<(f64, f64)> = labels.iter().map(|(at, ..)| *at).collect();
            if let Some(at) = label_place(&points, &within, &near, &taken) {
                labels.push((at, label, own.heights.ink(index + 1)));
            }
        }
    }
    for ((x, y), label, ink) in labels {
        drawing.text_over((x, y + 3.4), (Anchor::Middle, 9.5), label, ink);
    }

    for run in placed(&places.runs) {
        drawing.spot(run, 3.0, Ink::Text);
    }
    if places.family.len() > 1 {
        drawing.polyline(&placed(&places.family), BEST, 2.2);
    }
    for best in placed(&places.optimum.into_iter().collect::<Vec<_>>()) {
        drawing.spot(best, 5.5, BEST);
    }
    let (x, y) = (
        factor_title(fitted, grid.factors.0),
        factor_title(fitted, grid.factors.1),
    );
    frame.draw_axes(drawing, (&x.0, &x.1), (&y.0, &y.1), LEFT - 22.0);
    let others = others_of(fitted, grid);
    drawing.text(
        (within.left, within.top - 8.0),
        Anchor::Start,
        10.5,
        &others,
    );
}

/// Place of a line's label: near its middle, away from border, labels and marks.
fn label_place(
    points: &[(f64, f64)],
    within: &Rectangle,
    labels: &[(f64, f64)],
    taken: &[(f64, f64)],
) -> Option<(f64, f64)> {
    let lengths = points.windows(2).map(|p| distance(p[0], p[1]));
    if lengths.sum::<f64>() < LEAST_LABELLED {
        return None;
    }
    let free = |at: (f64, f64), others: &[(f64, f64)], room: f64| {
        others.iter().all(|other| distance(*other, at) > room)
    };
    let parts = [0.5, 0.42, 0.58, 0.34, 0.66, 0.26, 0.74, 0.18, 0.82];
    parts
        .iter()
        .map(|part| points[((points.len() - 1) as f64 * part) as usize])
        .find(|at| {
            within.holds(*at, 16.0) && free(*at, labels, LABEL_ROOM) && free(*at, taken, 16.0)
        })
}

fn distance(a: (f64, f64), b: (f64, f64)) -> f64 {
    (a.0 - b.0).hypot(a.1 - b.1)
}

/// What is marked on the panels, in two lines where it is wider than the figure; px.
fn draw_legend(drawing: &mut Drawing, places: &PairPlaces, width: f64) {
    let mut entries = vec!["runs"];
    entries.extend(places.optimum.map(|_| "most desirable"));
    entries.extend((places.family.len() > 1).then_some("as desirable (the others change too)"));
    let (mut x, mut y) = (LEFT + 4.0, 38.0);
    for label in entries {
        let room = 26.0 + text_width(label, drawing.letters(11.0));
        if x + room > width {
            (x, y) = (LEFT + 4.0, y + 15.0);
        }
        match label {
            "runs" => drawing.spot((x + 4.0, y), 3.0, Ink::Text),
            "most desirable" => drawing.spot((x + 4.0, y), 5.5, BEST),
            _ => drawing.polyline(&[(x - 4.0, y), (x + 10.0, y)], BEST, 2.2),
        }
        drawing.text((x + 14.0, y + 3.8), Anchor::Start, 11.0, label);
        x += room + 6.0;
    }
}
