//! The draws of a posterior: how probable each value of a parameter is, and which
//! values go together.

use crate::figures::parameters::own_ellipse;
use std::f64::consts::TAU;
use windfall_campaign::result::outcome::ImpactOutcome;
use windfall_draw::xy::{Figure, Panel, Series, Style};
use windfall_files::found::EstimateOutcome;
use windfall_files::name::Name;

/// Points of a density.
const POINTS: usize = 161;

/// Parameters of a law that are shown.
const MOST_SHOWN: usize = 4;

/// Densities of the parameters with their intervals, and the draws of each pair with the
/// ellipse of their standard deviations; `None` where the intervals were not drawn.
pub fn figure_of_posterior(title: &str, outcome: &ImpactOutcome) -> Option<Figure> {
    let drawn = &outcome.intervals.drawn.0;
    let paired: Vec<&(Name, Vec<f64>)> = drawn
        .iter()
        .filter(|(name, _)| outcome.parameters.get(name).is_some())
        .take(MOST_SHOWN)
        .collect();
    let mut panels: Vec<Panel> = paired
        .iter()
        .filter_map(|(name, draws)| marginal(name, outcome.parameters.get(name)?, draws))
        .collect();
    for (place, x) in paired.iter().enumerate() {
        for y in &paired[place + 1..] {
            panels.push(pair(outcome, x, y));
        }
    }
    (!panels.is_empty())
        .then(|| Figure::new(format!("{title}: posterior, {}", outcome.law), panels))
}

fn unit_of(estimate: Option<&EstimateOutcome>) -> &str {
    estimate.map_or("1", |estimate| &estimate.unit)
}

fn marginal(name: &str, estimate: &EstimateOutcome, draws: &[f64]) -> Option<Panel> {
    let line = density(draws)?;
    // Of the area under the curve, what the interval holds.
    let within = match (estimate.low, estimate.high) {
        (Some(low), Some(high)) => {
            let inner = line.iter().filter(|(x, _)| (low..=high).contains(x));
            let mut area = vec![(low, 0.0)];
            area.extend(inner);
            area.push((high, 0.0));
            area
        }
        _ => Vec::new(),
    };
    let mut all = vec![
        Series::new("95 % interval", Style::Band, within).coloured(0),
        Series::new("posterior", Style::Line, line.clone()).coloured(0),
        Series::new("best fit", Style::Upright, vec![(estimate.value, 0.0)]).coloured(1),
    ];
    if let Some(sd) = estimate.sd {
        let normal = line.iter().map(|(x, _)| {
            let z = (x - estimate.value) / sd;
            (*x, (-0.5 * z * z).exp() / (sd * TAU.sqrt()))
        });
        let label = "normal of the same standard deviation";
        all.push(Series::new(label, Style::Dashed, normal.collect()).coloured(6));
    }
    let unit = estimate.unit.as_str();
    let per_unit = match unit {
        "1" => String::new(),
        unit => format!("1/({unit})"),
    };
    Some(Panel::new(
        (name, unit),
        ("probability density", &per_unit),
        all,
    ))
}

/// Density of draws: Gaussian kernels; `None` where they do not differ.
///
/// # Source
/// B. W. Silverman (1986), Density Estimation for Statistics and Data Analysis, eq. 3.31:
/// h = 0.9 min(s, R/1.34) n^(−1/5).
fn density(draws: &[f64]) -> Option<Vec<(f64, f64)>> {
    let mut sorted: Vec<f64> = draws.iter().copied().filter(|d| d.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    let n = sorted.len() as f64;
    let (first, last) = (*sorted.first()?, *sorted.last()?);
    let mean = sorted.iter().sum::<f64>() / n;
    let sd = (sorted.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / (n - 1.0)).sqrt();
    let quartile = |part: f64| sorted[((n - 1.0) * part).round() as usize];
    let range = (quartile(0.75) - quartile(0.25)) / 1.34;
    let width = 0.9 * sd.min(range) * n.powf(-0.2);
    if !(width > 0.0 && width.is_finite()) {
        return None;
    }
    let (low, high) = (first - 3.0 * width, last + 3.0 * width);
    let at = |x: f64| {
        let kernels = sorted
            .iter()
            .map(|d| (-0.5 * ((x - d) / width).powi(2)).exp());
        kernels.sum::<f64>() / (n * width * TAU.sqrt())
    };
    let x = |i: usize| low + (high - low) * i as f64 / (POINTS - 1) as f64;
    Some((0..POINTS).map(|i| (x(i), at(x(i)))).collect())
}

fn pair(outcome: &ImpactOutcome, x: &(Name, Vec<f64>), y: &(Name, Vec<f64>)) -> Panel {
    let points = x.1.iter().copied().zip(y.1.iter().copied()).collect();
    let mut all = vec![Series::new("draws", Style::Dots, points).coloured(0)];
    if let Some(ellipse) = own_ellipse(outcome, &x.0, &y.0) {
        let label = "95 % ellipse of the standard deviations";
        all.push(Series::new(label, Style::Dashed, ellipse).coloured(6));
    }
    let [of_x, of_y] = [&x.0, &y.0].map(|name| outcome.parameters.get(name));
    let best = of_x.zip(of_y).map(|(x, y)| (x.value, y.value));
    all.push(Series::new("best fit", Style::Dots, best.into_iter().collect()).coloured(1));
    Panel::new((&x.0, unit_of(of_x)), (&y.0, unit_of(of_y)), all)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of normal scores the density is the normal one, a little wider by the kernel
    /// (variance 1 + h²), and its area is 1.
    #[test]
    fn closed_form_density_of_normal_scores() {
        use windfall_distribution::tail::normal_quantile;
        let draws: Vec<f64> = (0..500)
            .map(|i| normal_quantile((f64::from(i) + 0.5) / 500.0))
            .collect();
        let line = density(&draws).unwrap();
        let step = line[1].0 - line[0].0;
        let area = line.iter().map(|p| p.1).sum::<f64>() * step;
        assert!((area - 1.0).abs() < 2e-3, "{area}");
        let variance = 1.0 + (0.9 * 500.0_f64.powf(-0.2)).powi(2);
        for (x, found) in line {
            let normal = (-0.5 * x * x / variance).exp() / (TAU * variance).sqrt();
            assert!((found - normal).abs() < 6e-3, "{x}: {found} {normal}");
        }
        assert!(density(&[1.0, 1.0, 1.0]).is_none() && density(&[]).is_none());
    }
}
