//! How the likelihood falls on either side of each estimate.

use windfall_campaign::result::interval_outcome::ProfileOutcome;
use windfall_campaign::result::outcome::ImpactOutcome;
use windfall_draw::xy::{Figure, Panel, Series, Style};
use windfall_files::found::EstimateOutcome;
use windfall_files::name::Name;

/// Points of the parabola.
const POINTS: usize = 81;

/// −2 ln of the profile likelihood of each parameter over its value, with the ends of
/// the 95 % interval and the parabola that estimate and standard deviation stand for;
/// `None` where the intervals were not made by profiles.
pub fn figure_of_profiles(title: &str, outcome: &ImpactOutcome) -> Option<Figure> {
    let profiles = outcome.intervals.profiles.0.iter();
    let panel = |(name, profile): &(Name, ProfileOutcome)| {
        let parameter = outcome.parameters.get(name);
        let estimate = parameter.or_else(|| outcome.nuisances.get(name))?;
        let rises = profile.rises.iter().copied();
        let mut points: Vec<_> = profile.values.iter().copied().zip(rises).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        (!points.is_empty()).then(|| panel(name, estimate, points))
    };
    let panels: Vec<Panel> = profiles.filter_map(panel).collect();
    (!panels.is_empty()).then(|| Figure {
        title: format!("{title}: profile likelihood, {}", outcome.law),
        panels,
    })
}

fn panel(name: &str, estimate: &EstimateOutcome, points: Vec<(f64, f64)>) -> Panel {
    let ends = [estimate.low, estimate.high].into_iter().flatten();
    let ends = ends.map(|end| (end, 0.0)).collect();
    let mut series = vec![Series::new("95 % interval", Style::Upright, ends).coloured(1)];
    if let (Some(sd), Some(first), Some(last)) = (estimate.sd, points.first(), points.last()) {
        let highest = points.iter().map(|p| p.1).fold(0.0, f64::max);
        let parabola = (0..POINTS).map(|i| {
            let x = first.0 + (last.0 - first.0) * i as f64 / (POINTS - 1) as f64;
            (x, ((x - estimate.value) / sd).powi(2))
        });
        let within = parabola
            .filter(|(_, rise)| *rise <= 1.2 * highest)
            .collect();
        let label = "parabola of the standard deviation";
        series.push(Series::new(label, Style::Dashed, within).coloured(6));
    }
    let line = between(&points, estimate.value);
    series.push(Series::new("profile", Style::Line, line).coloured(0));
    series.push(Series::new("", Style::Dots, points).coloured(0));
    let rise = ("−2 ln of the likelihood, above its least", "");
    Panel::new((name, &estimate.unit), rise, series)
}

/// The profile between the points at which it was found: straight in the root of the
/// rise, negative below the estimate, which curves far less than the rise does.
///
/// # Source
/// D. M. Bates, D. G. Watts, Nonlinear Regression Analysis (1988), section 6.1.
fn between(points: &[(f64, f64)], estimate: f64) -> Vec<(f64, f64)> {
    let root = |(x, rise): (f64, f64)| match x < estimate {
        true => -rise.max(0.0).sqrt(),
        false => rise.max(0.0).sqrt(),
    };
    let mut line = Vec::new();
    for pair in points.windows(2) {
        let (from, to) = (pair[0], pair[1]);
        let (low, high) = (root(from), root(to));
        line.extend((0..POINTS).map(|i| {
            let part = i as f64 / (POINTS - 1) as f64;
            let root = low + part * (high - low);
            (from.0 + part * (to.0 - from.0), root * root)
        }));
    }
    line
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three points of a parabola give the parabola.
    #[test]
    fn closed_form_parabola_between_three_points() {
        let parabola = |x: f64| ((x - 3.0) / 0.5_f64).powi(2);
        let points = [2.0, 3.0, 4.5].map(|x| (x, parabola(x)));
        let line = between(&points, 3.0);
        assert_eq!(line.len(), 2 * POINTS);
        for (x, rise) in line {
            assert!((rise - parabola(x)).abs() < 1e-12, "{x} {rise}");
        }
    }
}
