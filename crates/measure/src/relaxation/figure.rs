//! A hold as a figure: force over time, with the models.

use crate::relaxation::evaluate::Relaxed;
use windfall_compression::relaxation::maxwell::maxwell_force;
use windfall_compression::relaxation::peleg::peleg_force;
use windfall_draw::xy::{Figure, Panel, Series, Style};

/// Points of a line.
const POINTS: usize = 300;

/// The whole recording with the hold and what was fitted to it, and the residuals below.
pub fn figure_of_relaxation(title: &str, found: &Relaxed) -> Figure {
    let begin = found.times[found.hold.start];
    let samples = |range: std::ops::Range<usize>| -> Vec<(f64, f64)> {
        let step = (range.len() / 2000).max(1);
        let point = |i: usize| (found.times[i] - begin, found.force[i]);
        range.step_by(step).map(point).collect()
    };
    let (start, end) = (found.hold.start, found.hold.end);
    let duration = found.times[end] - begin;
    // The force falls fastest at first: as many points there as later.
    let times: Vec<f64> = (0..=POINTS)
        .map(|i| duration * (i as f64 / POINTS as f64).powi(3))
        .collect();
    let line = |force: &dyn Fn(f64) -> f64| times.iter().map(|t| (*t, force(*t))).collect();
    let maxwell = |t: f64| maxwell_force(&found.maxwell, t);
    let peleg = |t: f64| peleg_force(&found.peleg, t);
    let elements = found.maxwell.elements.len();
    let named = format!("Maxwell, {elements} elements");
    let above = vec![
        Series::new("not used", Style::Dots, samples(0..start)),
        Series::new("held", Style::Dots, samples(start..end + 1)),
        Series::new(named.clone(), Style::Line, line(&maxwell)),
        Series::new("Peleg", Style::Line, line(&peleg)),
    ];
    let residual = |model: &dyn Fn(f64) -> f64| -> Vec<(f64, f64)> {
        let all = found.held.times.iter().zip(&found.held.force);
        all.map(|(t, force)| (*t, force - model(*t))).collect()
    };
    let below = vec![
        Series::new(named, Style::Dots, residual(&maxwell)),
        Series::new("Peleg", Style::Dots, residual(&peleg)),
    ];
    let axis = ("time since the hold began", "s");
    let panels = vec![
        Panel::new(axis, ("force", "N"), above),
        Panel::new(axis, ("residual", "N"), below),
    ];
    Figure::new(title, panels)
}
