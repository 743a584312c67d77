//! Prediction of the impacts of one velocity from those of the others.

use crate::fit::problem::{FitOptions, LawProblem};
use crate::fit::result::Fit;
use crate::rig::kind::Rig;
use crate::rig::simulate::trajectory;
use windfall_contact::parameter::IMPACT_VELOCITY;
use windfall_signal::impact::Impact;

/// An impact with the fit of a law to it.
#[derive(Clone, Copy)]
pub(crate) struct Example<'a> {
    pub impact: &'a Impact,
    pub fit: &'a Fit,
    pub level: usize,
}

/// Root mean square over the impacts of predicted less measured values, relative to the
/// peak and without the sensor's noise, and its standard error; `None` with fewer than
/// two predictions.
///
/// For each velocity level, the law's parameters are the median of those fitted
/// at the other levels (of the logarithm where they are scales); velocity and
/// onset are those of the impact itself.
pub(crate) fn prediction_error(
    examples: &[Example],
    problem: &LawProblem,
    rig: &Rig,
    options: &FitOptions,
) -> Option<(f64, f64)> {
    let errors: Vec<f64> = examples
        .iter()
        .filter_map(|example| {
            let others = examples.iter().filter(|e| e.level != example.level);
            let known: Vec<&Fit> = others.map(|e| e.fit).collect();
            predicted(example, &known, problem, rig, options)
        })
        .collect();
    let n = errors.len() as f64;
    if errors.len() < 2 {
        return None;
    }
    let mean = errors.iter().map(|e| e * e).sum::<f64>() / n;
    let spread = errors.iter().map(|e| (e * e - mean).powi(2)).sum::<f64>() / (n - 1.0);
    let root = mean.sqrt();
    Some((
        root,
        0.5 * (spread / n).sqrt() / root.max(f64::MIN_POSITIVE),
    ))
}

/// Relative root mean square error of one impact.
fn predicted(
    example: &Example,
    known: &[&Fit],
    problem: &LawProblem,
    rig: &Rig,
    options: &FitOptions,
) -> Option<f64> {
    let kind = problem.kind;
    let described = kind.describe().parameters;
    let mut values = example.fit.law.parameters();
    for position in problem.free_positions() {
        let mut fitted: Vec<f64> = known
            .iter()
            .map(|fit| fit.law.parameters()[position])
            .collect();
        values[position] = median(&mut fitted)?;
    }
    if let Some(tied) = described.iter().position(|p| p.name == IMPACT_VELOCITY)
        && problem.values[tied].is_none()
    {
        values[tied] = example.fit.velocity;
    }
    let law = kind.with_parameters(&values).ok()?;
    let impact = example.impact;
    let series = impact.force.as_ref().or(impact.displacement.as_ref())?;
    let force = impact.force.is_some();
    let inside: Vec<usize> = (0..series.times.len())
        .filter(|&i| series.times[i] >= impact.onset && series.times[i] <= impact.end)
        .collect();
    let times: Vec<f64> = inside
        .iter()
        .map(|&i| series.times[i] - example.fit.onset)
        .collect();
    let motion = trajectory(&law, rig, example.fit.velocity, &times, options.end).ok()?;
    let model = if force {
        &motion.force
    } else {
        &motion.displacement
    };
    let offset = if force { 0.0 } else { example.fit.offset };
    let (mut square, mut peak) = (0.0, 0.0_f64);
    for (model, &i) in model.iter().zip(&inside) {
        square += (model + offset - series.values[i]).powi(2);
        peak = peak.max(*model);
    }
    let noise = series.noise * series.noise;
    let rms = (square / inside.len().max(1) as f64 - noise)
        .max(0.0)
        .sqrt();
    (peak > 0.0 && rms.is_finite()).then(|| rms / peak)
}

/// Median; the logarithm of a median is the median of the logarithms.
fn median(values: &mut [f64]) -> Option<f64> {
    values.sort_unstable_by(f64::total_cmp);
    let n = values.len();
    (n > 0).then(|| 0.5 * (values[(n - 1) / 2] + values[n / 2]))
}
