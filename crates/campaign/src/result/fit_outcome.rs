//! A fit as it is saved and shown.

use crate::result::interval_outcome::interval_outcome;
use crate::result::outcome::ImpactOutcome;
use crate::settings::model::ImpactEntry;
use windfall_contact::restitution::nominal_restitution;
use windfall_files::found::{EstimateOutcome, FindingOutcome};
use windfall_files::named::Named;
use windfall_identify::fit::problem::LawProblem;
use windfall_identify::fit::result::{Estimate, Fit};
use windfall_identify::rig::kind::Rig;
use windfall_identify::rig::simulate::ImpactSummary;
use windfall_signal::Finding;
use windfall_signal::impact::{Impact, Measured};

/// Saves what one law on one impact gave.
#[must_use]
pub fn impact_outcome(
    entry: &ImpactEntry,
    impact: &Impact,
    signal_findings: &[Finding],
    fit: &Fit,
    problem: &LawProblem,
    rig: &Rig,
) -> ImpactOutcome {
    let fitted = fitted_values(&fit.simulated, fit.velocity, rig.effective_mass());
    let (derived, derived_from) = derived_values(&impact.measured, &fitted);
    let nominal = nominal_restitution(&fit.law);
    let mut fitted = fitted;
    fitted
        .0
        .extend(nominal.map(|value| ("nominal_restitution".to_owned(), Some(value))));
    ImpactOutcome {
        id: entry.id.clone(),
        specimen: entry.specimen.clone(),
        group: None,
        file: entry.file.clone(),
        law: fit.law.kind().name().to_owned(),
        quantities: fit
            .quantities
            .iter()
            .map(|q| q.quantity.name().to_owned())
            .collect(),
        parameters: parameters(fit, problem),
        nuisances: named(&fit.nuisances),
        correlations: correlations(fit),
        cost: fit.cost,
        samples: fit.samples,
        evaluations: fit.evaluations,
        converged: fit.converged,
        residual_norm: fit.residual_norm,
        residuals: residuals(fit),
        regression: named(&fit.regression),
        derived,
        derived_sd: derived_uncertainties(&impact.measured),
        derived_from,
        fitted,
        directions: directions(fit),
        intervals: interval_outcome(fit),
        findings: findings(signal_findings, fit),
    }
}

/// JSON has no infinity: a deviation that is not available is null.
fn estimate(estimate: &Estimate) -> EstimateOutcome {
    let finite = |value: f64| value.is_finite().then_some(value);
    EstimateOutcome {
        value: estimate.value,
        sd: finite(estimate.sd),
        low: finite(estimate.low),
        high: finite(estimate.high),
        unit: estimate.unit.clone(),
        held: false,
    }
}

fn named(estimates: &[Estimate]) -> Named<EstimateOutcome> {
    Named(
        estimates
            .iter()
            .map(|e| (e.name.clone(), estimate(e)))
            .collect(),
    )
}

/// All parameters in the order of the law, estimated or held.
fn parameters(fit: &Fit, problem: &LawProblem) -> Named<EstimateOutcome> {
    let values = fit.law.parameters();
    let descriptions = fit.law.kind().describe().parameters;
    let outcome = descriptions.iter().enumerate().map(|(index, description)| {
        let estimated = fit.parameters.iter().find(|e| e.name == description.name);
        let outcome = match estimated.filter(|_| problem.free[index]) {
            Some(found) => estimate(found),
            None => EstimateOutcome {
                value: values[index],
                sd: None,
                low: None,
                high: None,
                unit: fit.law.unit_of(index),
                held: true,
            },
        };
        (description.name.to_owned(), outcome)
    });
    Named(outcome.collect())
}

/// Each direction by the names of the estimates.
fn directions(fit: &Fit) -> Vec<Named<f64>> {
    let names = || {
        fit.parameters
            .iter()
            .chain(&fit.nuisances)
            .map(|e| e.name.clone())
    };
    let of = |change: &[f64]| Named(names().zip(change.iter().copied()).collect());
    fit.directions.iter().map(|d| of(&d.change)).collect()
}

/// "k, c" → correlation, of all pairs of estimates.
fn correlations(fit: &Fit) -> Named<f64> {
    let names: Vec<&str> = fit
        .parameters
        .iter()
        .chain(&fit.nuisances)
        .map(|e| e.name.as_str())
        .collect();
    let mut pairs = Vec::new();
    for (i, row) in fit.correlations.iter().enumerate() {
        for (j, value) in row.iter().enumerate().skip(i + 1) {
            if value.is_finite() {
                pairs.push((format!("{}, {}", names[i], names[j]), *value));
            }
        }
    }
    Named(pairs)
}

fn residuals(fit: &Fit) -> Named<crate::result::outcome::ResidualOutcome> {
    let of =
        |q: &windfall_identify::fit::result::QuantityFit| crate::result::outcome::ResidualOutcome {
            samples: q.samples,
            weight: q.weight,
            noise: q.noise,
            persistence: q.persistence,
            rms: q.rms_residual,
            runs_z: q.runs.map(|runs| runs.z).filter(|z| z.is_finite()),
        };
    Named(
        fit.quantities
            .iter()
            .map(|q| (q.quantity.name().to_owned(), of(q)))
            .collect(),
    )
}

/// The derived quantities in the motion under the fitted law.
fn fitted_values(summary: &ImpactSummary, velocity: f64, mass: f64) -> Named<Option<f64>> {
    let energy = |speed: f64| 0.5 * mass * speed * speed;
    let values = [
        ("impact_velocity", velocity),
        ("rebound_velocity", summary.separation_velocity),
        ("restitution", summary.restitution),
        ("contact_duration", summary.contact_duration),
        ("peak_force", summary.peak_force),
        ("max_displacement", summary.max_displacement),
        ("impact_energy", energy(velocity)),
        ("elastic_energy", energy(summary.separation_velocity)),
        ("absorbed_energy", summary.absorbed_energy),
        ("impulse", summary.impulse),
    ];
    Named(
        values
            .into_iter()
            .map(|(name, value)| (name.to_owned(), value.is_finite().then_some(value)))
            .collect(),
    )
}

/// Read off the signals where they show it, else from the fitted law.
fn derived_values(
    measured: &Measured,
    fitted: &Named<Option<f64>>,
) -> (Named<Option<f64>>, Named<String>) {
    let of_signal = |name: &str| match name {
        "impact_velocity" => measured.impact_velocity,
        "rebound_velocity" => measured.rebound_velocity,
        "restitution" => measured.restitution,
        "contact_duration" => measured.contact_duration,
        "peak_force" => measured.peak_force,
        "max_displacement" => measured.max_displacement,
        "impact_energy" => measured.impact_energy,
        "elastic_energy" => measured.elastic_energy,
        "absorbed_energy" => measured.absorbed_energy,
        "impulse" => measured.impulse,
        _ => None,
    };
    let (mut values, mut sources) = (Vec::new(), Vec::new());
    for (name, fitted) in &fitted.0 {
        let measured = of_signal(name).filter(|value| value.is_finite());
        let source = if measured.is_some() { "signal" } else { "fit" };
        values.push((name.clone(), measured.or(*fitted)));
        sources.push((name.clone(), source.to_owned()));
    }
    // What only channels tell, where they do.
    for (name, value) in [
        ("loading_energy", measured.loading_energy),
        ("hysteresis_energy", measured.hysteresis_energy),
        (
            "acceleration_impulse_ratio",
            measured.acceleration_impulse_ratio,
        ),
        ("acceleration_peak_ratio", measured.acceleration_peak_ratio),
        (
            "integrated_displacement_error",
            measured.integrated_displacement_error,
        ),
        (
            "integrated_displacement_rms",
            measured.integrated_displacement_rms,
        ),
        (
            "integrated_displacement_drift",
            measured.integrated_displacement_drift,
        ),
    ] {
        if let Some(value) = value.filter(|value| value.is_finite()) {
            values.push((name.to_owned(), Some(value)));
            sources.push((name.to_owned(), "signal".to_owned()));
        }
    }
    (Named(values), Named(sources))
}

fn derived_uncertainties(measured: &Measured) -> Named<f64> {
    let values = [
        ("impact_velocity", measured.impact_velocity_sd),
        ("rebound_velocity", measured.rebound_velocity_sd),
        ("impulse", measured.impulse_sd),
        (
            "acceleration_impulse_ratio",
            measured.acceleration_impulse_ratio_sd,
        ),
        (
            "acceleration_peak_ratio",
            measured.acceleration_peak_ratio_sd,
        ),
    ];
    let known = values
        .into_iter()
        .filter_map(|(name, sd)| Some((name.to_owned(), sd?)));
    Named(known.filter(|(_, sd)| sd.is_finite()).collect())
}

fn findings(signal: &[Finding], fit: &Fit) -> Vec<FindingOutcome> {
    let signal = signal.iter().map(|f| FindingOutcome {
        code: f.code().to_owned(),
        message: f.to_string(),
    });
    let fit = fit.findings.iter().map(|f| FindingOutcome {
        code: f.code().to_owned(),
        message: f.to_string(),
    });
    signal.chain(fit).collect()
}
