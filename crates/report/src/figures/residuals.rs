//! What a fitted law leaves of the signals: residuals over time, and how those of
//! successive samples go together.

use windfall_campaign::impacts::figure_impact::{FittedImpact, WINDOW, motion_at};
use windfall_campaign::result::outcome::ImpactOutcome;
use windfall_contact::law::EndRule;
use windfall_contact::laws::kind::LawKind;
use windfall_draw::xy::{Figure, Panel, Series, Style};
use windfall_identify::rig::kind::Rig;
use windfall_identify::rig::simulate::Trajectory;
use windfall_signal::impact::{Impact, Series as Samples};

/// Largest lag of the autocorrelation.
const LAGS: usize = 40;

/// Fewer residuals than this tell no autocorrelation.
const FEWEST: usize = 20;

/// Normal deviate of a 95 % interval.
const NORMAL_95: f64 = 1.96;

/// Residuals of each quantity of the cost function, and their autocorrelation; `None`
/// where the motion of the law cannot be followed.
///
/// * `used`: rig, end of contact, and the user's own laws
pub fn figure_of_residuals(
    title: &str,
    impact: &Impact,
    outcome: &ImpactOutcome,
    used: (&Rig, EndRule, &[LawKind]),
) -> Option<Figure> {
    let fitted = FittedImpact::of(impact, outcome, used)?;
    let mut panels = Vec::new();
    for (name, residual) in &outcome.residuals.0 {
        let samples = match name.as_str() {
            "force" => impact.force.as_ref(),
            "displacement" => impact.displacement.as_ref(),
            "rate" => impact.rate.as_ref(),
            "acceleration" => impact.acceleration.as_ref(),
            _ => None,
        };
        let Some(samples) = samples else { continue };
        let shown = Shown::of(name);
        let left = residuals(&fitted, &shown, samples)?;
        let scale = shown.scale;
        match samples.quantum {
            // Rounding repeats itself from sample to sample; the fit does not take it
            // for noise of samples, but takes the instants at which the count changes.
            Some(quantum) if quantum > residual.noise => {
                let label = "half a step of the encoder".to_owned();
                let reach = 0.5 * scale * quantum;
                panels.push(over_time(impact, &shown, &left, (reach, label)));
            }
            _ => {
                let label = format!("{NORMAL_95} standard deviations of the noise");
                let reach = NORMAL_95 * scale * residual.noise;
                panels.push(over_time(impact, &shown, &left, (reach, label)));
                panels.extend(autocorrelations(shown.name, &left));
            }
        }
    }
    (!panels.is_empty())
        .then(|| Figure::new(format!("{title}: residuals of {}", outcome.law), panels))
}

/// How a quantity is shown.
struct Shown {
    name: &'static str,
    unit: &'static str,
    /// Shown unit per SI unit.
    scale: f64,
    of: fn(&Trajectory) -> &Vec<f64>,
}

impl Shown {
    fn of(quantity: &str) -> Self {
        let (name, unit, scale, of): (_, _, _, fn(&Trajectory) -> &Vec<f64>) = match quantity {
            "force" => ("force", "N", 1.0, |m| &m.force),
            "displacement" => ("displacement", "µm", 1e6, |m| &m.displacement),
            "rate" => ("displacement rate", "m/s", 1.0, |m| &m.rate),
            _ => ("acceleration", "m/s²", 1.0, |m| &m.acceleration),
        };
        Self {
            name,
            unit,
            scale,
            of,
        }
    }
}

/// Measured less fitted, at the time of each sample.
fn residuals(fitted: &FittedImpact, shown: &Shown, samples: &Samples) -> Option<Vec<(f64, f64)>> {
    let motion = motion_at(fitted, &samples.times)?;
    let pairs = samples.values.iter().zip((shown.of)(&motion));
    let left = pairs.map(|(measured, model)| shown.scale * (measured - model));
    Some(samples.times.iter().copied().zip(left).collect())
}

fn over_time(
    impact: &Impact,
    shown: &Shown,
    left: &[(f64, f64)],
    (reach, label): (f64, String),
) -> Panel {
    let ms = |t: f64| 1e3 * (t - impact.onset);
    let points: Vec<(f64, f64)> = left.iter().map(|(t, r)| (ms(*t), *r)).collect();
    let window = vec![(0.0, 0.0), (ms(impact.end), 0.0)];
    let begin = points.first().map_or(0.0, |p| p.0);
    let levels = vec![(begin, reach), (begin, -reach)];
    let series = vec![
        Series::new("contact (force threshold)", Style::Shade, window).coloured(WINDOW),
        Series::new("samples", Style::Dots, points).coloured(0),
        Series::new(label, Style::Level, levels).coloured(1),
    ];
    let residual = format!("{}, measured less fitted", shown.name);
    let time = ("time since the force threshold", "ms");
    Panel::new(time, (&residual, shown.unit), series)
}

fn autocorrelations(name: &str, left: &[(f64, f64)]) -> Option<Panel> {
    if left.len() < FEWEST {
        return None;
    }
    let values: Vec<f64> = left.iter().map(|(_, r)| *r).collect();
    let found = autocorrelation(&values, LAGS.min(values.len() / 4));
    let bars = found.iter().enumerate().flat_map(|(lag, r)| {
        let lag = lag as f64;
        [(lag, 0.0), (lag, *r)]
    });
    let reach = NORMAL_95 / (values.len() as f64).sqrt();
    let levels = vec![(0.0, reach), (0.0, -reach)];
    let own = "autocorrelation of the residuals";
    let white = "95 % of those of independent residuals";
    let series = vec![
        Series::new(own, Style::Bars, bars.collect()).coloured(0),
        Series::new(white, Style::Level, levels).coloured(1),
    ];
    let correlation = format!("{name}: autocorrelation");
    Some(Panel::new(
        ("lag in samples", ""),
        (&correlation, ""),
        series,
    ))
}

/// Autocorrelation at lags 0 to `most`, about the mean.
///
/// # Source
/// G. E. P. Box, G. M. Jenkins, Time Series Analysis (1976), equation 2.1.13.
fn autocorrelation(values: &[f64], most: usize) -> Vec<f64> {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let centred: Vec<f64> = values.iter().map(|value| value - mean).collect();
    let at = |lag: usize| -> f64 {
        let later = centred.iter().skip(lag);
        centred.iter().zip(later).map(|(a, b)| a * b).sum()
    };
    let square = at(0);
    (0..=most)
        .map(|lag| if square > 0.0 { at(lag) / square } else { 0.0 })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of ±1 in turns: r(lag) = (−1)^lag (n − lag)/n.
    #[test]
    fn closed_form_autocorrelation_of_turns() {
        let values: Vec<f64> = (0..20)
            .map(|i| if i % 2 == 0 { 1.0 } else { -1.0 })
            .collect();
        let found = autocorrelation(&values, 3);
        for (lag, r) in found.iter().enumerate() {
            let sign = if lag % 2 == 0 { 1.0 } else { -1.0 };
            assert!((r - sign * (20.0 - lag as f64) / 20.0).abs() < 1e-14);
        }
        assert_eq!(autocorrelation(&[2.0; 5], 1), [0.0, 0.0]);
    }
}
