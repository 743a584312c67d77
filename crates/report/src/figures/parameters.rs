//! A fitted campaign as figures: parameters against each other, and what the law
//! predicts against what the signals show.

use std::f64::consts::TAU;
use windfall_campaign::result::outcome::ImpactOutcome;
use windfall_campaign::result::quantity::{Quantity, quantities_named};
use windfall_distribution::tail::{chi_squared_upper_quantile, f_upper_quantile};
use windfall_draw::files::NamedFigure;
use windfall_draw::xy::{Figure, Panel, Series, Style};
use windfall_files::named::grouped;

/// Probability that an ellipse leaves outside.
const OUTSIDE: f64 = 0.05;

/// Corners of an ellipse.
const CORNERS: usize = 96;

/// More impacts than this are shown without the ellipse of each.
const MOST_ELLIPSES: usize = 200;

/// Quantities predicted by the fitted law and measured on their own.
const PREDICTED: [&str; 4] = [
    "peak_force",
    "restitution",
    "absorbed_energy",
    "rebound_velocity",
];

/// Groups in order of first appearance; one of "impacts" where there are none.
pub fn groups_of_impacts<'a>(
    impacts: &[&'a ImpactOutcome],
) -> Vec<(String, Vec<&'a ImpactOutcome>)> {
    let name = |impact: &ImpactOutcome| impact.group.clone().unwrap_or("impacts".to_owned());
    grouped(impacts.iter().map(|impact| (name(impact), *impact)))
}

/// Names of the parameters that were estimated, with their units; "SI" where the unit
/// differs from impact to impact, as it does with an estimated exponent.
pub fn estimated_parameters(impacts: &[&ImpactOutcome]) -> Vec<(String, String)> {
    let first = impacts.first().map_or(&[][..], |i| &i.parameters.0);
    let estimated = first.iter().filter(|(_, estimate)| !estimate.held);
    let unit = |name: &str, unit: &str| {
        let mut others = impacts.iter().filter_map(|i| i.parameters.get(name));
        match unit {
            "1" => String::new(),
            unit if others.all(|other| other.unit == unit) => unit.to_owned(),
            _ => "SI".to_owned(),
        }
    };
    estimated
        .map(|(name, estimate)| (name.to_string(), unit(name, &estimate.unit)))
        .collect()
}

/// Each pair of estimated parameters against each other, impact by impact, with the
/// ellipse of each impact's uncertainty and the one in which a further fruit of a
/// group lies; `None` where fewer than two parameters were estimated.
///
/// # Source
/// R. A. Johnson, D. W. Wichern, Applied Multivariate Statistical Analysis (6th
/// ed., 2007), section 5.4 and exercise 5.9: a further observation of p = 2 normal
/// values from n lies where (x − x̄)ᵀ S⁻¹ (x − x̄) ≤ (n + 1)(n − 1) 2 / (n (n − 2)) F(2, n − 2).
pub fn figure_of_pairs(law: &str, impacts: &[&ImpactOutcome]) -> Option<NamedFigure> {
    let names = estimated_parameters(impacts);
    let mut panels = Vec::new();
    for (i, x) in names.iter().enumerate() {
        for y in &names[i + 1..] {
            panels.push(pair_panel(impacts, x, y));
        }
    }
    if panels.is_empty() {
        return None;
    }
    Some(NamedFigure {
        name: format!("{law}-parameters"),
        caption: "Parameters of the law, one point per impact. Thin lines: 95 % ellipse of the \
                  estimates of one impact. Broken lines: ellipse in which a further fruit of the \
                  group lies with a probability of 95 %, if parameters are normal within a group."
            .to_owned(),
        figure: Figure::new(format!("{law}: parameters of each impact"), panels),
    })
}

fn pair_panel(
    impacts: &[&ImpactOutcome],
    (x, x_unit): &(String, String),
    (y, y_unit): &(String, String),
) -> Panel {
    let mut series = Vec::new();
    for (index, (group, members)) in groups_of_impacts(impacts).into_iter().enumerate() {
        let drawn = |label: &str, style, points| Series::new(label, style, points).coloured(index);
        let points: Vec<(f64, f64)> = members
            .iter()
            .filter_map(|i| Some((i.parameters.get(x)?.value, i.parameters.get(y)?.value)))
            .collect();
        if members.len() <= MOST_ELLIPSES {
            let ellipses = members
                .iter()
                .filter_map(|impact| own_ellipse(impact, x, y));
            series.extend(ellipses.map(|ellipse| drawn("", Style::Line, ellipse)));
        }
        let further = ellipse_of_further(&points);
        series.extend(further.map(|ellipse| drawn("", Style::Dashed, ellipse)));
        series.push(drawn(&group, Style::Dots, points));
    }
    Panel::new((x, x_unit), (y, y_unit), series)
}

/// The 95 % ellipse of the estimates of one impact.
pub(crate) fn own_ellipse(impact: &ImpactOutcome, x: &str, y: &str) -> Option<Vec<(f64, f64)>> {
    let (of_x, of_y) = (impact.parameters.get(x)?, impact.parameters.get(y)?);
    let correlation = impact.correlations.get(&format!("{x}, {y}"))?;
    let (sd_x, sd_y) = (of_x.sd?, of_y.sd?);
    let covariance = [sd_x * sd_x, correlation * sd_x * sd_y, sd_y * sd_y];
    let reach = chi_squared_upper_quantile(OUTSIDE, 2.0);
    ellipse((of_x.value, of_y.value), covariance, reach)
}

/// The ellipse in which a further point like these lies with 95 %.
fn ellipse_of_further(points: &[(f64, f64)]) -> Option<Vec<(f64, f64)>> {
    let n = points.len() as f64;
    if points.len() < 4 {
        return None;
    }
    let mean_x = points.iter().map(|p| p.0).sum::<f64>() / n;
    let mean_y = points.iter().map(|p| p.1).sum::<f64>() / n;
    let mut covariance = [0.0; 3];
    for (x, y) in points {
        let (x, y) = (x - mean_x, y - mean_y);
        for (sum, square) in covariance.iter_mut().zip([x * x, x * y, y * y]) {
            *sum += square / (n - 1.0);
        }
    }
    let reach = 2.0 * (n + 1.0) * (n - 1.0) / (n * (n - 2.0));
    let reach = reach * f_upper_quantile(OUTSIDE, 2.0, n - 2.0);
    ellipse((mean_x, mean_y), covariance, reach)
}

/// The ellipse (p − centre)ᵀ C⁻¹ (p − centre) = `reach`, where C is positive definite.
fn ellipse((x, y): (f64, f64), [xx, xy, yy]: [f64; 3], reach: f64) -> Option<Vec<(f64, f64)>> {
    // Cholesky factor of C.
    let first = xx.sqrt();
    let below = xy / first;
    let second = (yy - below * below).sqrt();
    let radius = reach.sqrt();
    let corner = |index: usize| {
        let (sine, cosine) = (TAU * index as f64 / CORNERS as f64).sin_cos();
        let (a, b) = (radius * cosine, radius * sine);
        (x + first * a, y + below * a + second * b)
    };
    let usable = first > 0.0 && second > 0.0 && radius.is_finite();
    usable.then(|| (0..=CORNERS).map(corner).collect())
}

/// What the fitted law predicts against what the signals show on their own, if anything.
pub fn figure_of_predictions(law: &str, impacts: &[&ImpactOutcome]) -> Option<NamedFigure> {
    let panels: Vec<Panel> = quantities_named(&PREDICTED)
        .into_iter()
        .filter_map(|quantity| prediction_panel(impacts, quantity))
        .collect();
    if panels.is_empty() {
        return None;
    }
    Some(NamedFigure {
        name: format!("{law}-predicted-measured"),
        caption: "What the fitted law gives for each impact, against the same read off the \
                  signals without a law. On the broken line both agree."
            .to_owned(),
        figure: Figure::new(format!("{law}: fitted and measured"), panels),
    })
}

fn prediction_panel(impacts: &[&ImpactOutcome], quantity: &Quantity) -> Option<Panel> {
    let (name, factor) = (quantity.name, quantity.factor);
    let heading = quantity.label.to_lowercase();
    let pair = |impact: &&ImpactOutcome| {
        let seen = impact.derived_from.get(name)? == "signal";
        let (measured, fitted) = (impact.derived(name)?, impact.fitted(name)?);
        seen.then_some((factor * measured, factor * fitted))
    };
    let mut series = Vec::new();
    for (index, (group, members)) in groups_of_impacts(impacts).into_iter().enumerate() {
        let points = members.iter().filter_map(pair).collect();
        series.push(Series::new(group, Style::Dots, points).coloured(index));
    }
    let points = || series.iter().flat_map(|s| &s.points);
    let values = || points().flat_map(|(a, b)| [*a, *b]);
    let low = values().fold(f64::INFINITY, f64::min);
    let high = values().fold(f64::NEG_INFINITY, f64::max);
    if low >= high || low.is_nan() {
        return None;
    }
    let equal = vec![(low, low), (high, high)];
    series.insert(0, Series::new("", Style::Dashed, equal).coloured(6));
    let (x, y) = (format!("measured {heading}"), format!("fitted {heading}"));
    let unit = quantity.shown_unit;
    Some(Panel::new((&x, unit), (&y, unit), series).with_equal_axes())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a covariance, the ellipse touches mean ± √(reach · variance) and nothing
    /// beyond, and each corner is at the same Mahalanobis distance.
    #[test]
    fn closed_form_ellipse() {
        let (centre, [xx, xy, yy], reach) = ((3.0, -2.0), [4.0, 1.5, 1.0], 5.991);
        let points = ellipse(centre, [xx, xy, yy], reach).unwrap();
        let determinant = xx * yy - xy * xy;
        for (x, y) in &points {
            let (x, y) = (x - 3.0, y + 2.0);
            let distance = (yy * x * x - 2.0 * xy * x * y + xx * y * y) / determinant;
            assert!((distance - reach).abs() < 1e-10, "{distance}");
        }
        let right = points.iter().map(|p| p.0).fold(f64::MIN, f64::max);
        assert!((right - (3.0 + (reach * xx).sqrt())).abs() < 1e-12);
        assert!(ellipse(centre, [1.0, 1.0, 1.0], reach).is_none());
    }

    /// n = 10: 2 · 11 · 9 / (10 · 8) · F(0.95; 2, 8) = 2.475 · 4.45897, table of the F
    /// distribution.
    #[test]
    fn reference_reach_of_a_further_point() {
        let points: Vec<(f64, f64)> = (0..10)
            .map(|i| (f64::from(i), f64::from((i * 7) % 10)))
            .collect();
        let line = ellipse_of_further(&points).unwrap();
        let right = line.iter().map(|p| p.0).fold(f64::MIN, f64::max);
        let variance = 82.5 / 9.0;
        let reach: f64 = (right - 4.5) * (right - 4.5) / variance;
        assert!((reach - 2.475 * 4.458_970).abs() < 1e-4, "{reach}");
        assert!(ellipse_of_further(&points[..3]).is_none());
    }
}
