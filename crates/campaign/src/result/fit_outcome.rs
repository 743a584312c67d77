//! A fit as it is saved and shown.

use crate::result::interval_outcome::interval_outcome;
use crate::result::outcome::{ImpactOutcome, ResidualOutcome};
use crate::result::quantity::{FittedMotion, QUANTITIES, Quantity};
use crate::settings::model::ImpactEntry;
use windfall_files::found::{EstimateOutcome, FindingOutcome};
use windfall_files::name::Name;
use windfall_files::named::Named;
use windfall_identify::fit::problem::LawProblem;
use windfall_identify::fit::result::{CommonShift, Estimate, Fit, QuantityFit};
use windfall_identify::rig::bench::BenchSd;
use windfall_identify::rig::kind::Rig;
use windfall_signal::Finding;
use windfall_signal::impact::{Impact, Measured};

/// Saves what one law on one impact gave.
pub fn impact_outcome(
    entry: &ImpactEntry,
    impact: &Impact,
    signal_findings: &[Finding],
    fit: &Fit,
    problem: &LawProblem,
    (rig, bench): (&Rig, &BenchSd),
) -> ImpactOutcome {
    let mut fitted = fitted_values(&FittedMotion {
        summary: &fit.simulated,
        velocity: fit.velocity,
        mass: rig.effective_mass(),
    });
    let (derived, mut derived_sd, derived_from) = derived_values(&impact.measured, &fitted);
    let of_mass = bench.relative_energy(rig);
    for energy in ["impact_energy", "elastic_energy", "absorbed_energy"] {
        let value = derived.get(energy).copied().flatten();
        let mut own = derived_sd.0.iter_mut().filter(|(name, _)| name == energy);
        if let (Some(value), Some((_, sd))) = (value, own.next()) {
            *sd = sd.hypot(value * of_mass);
        }
    }
    let nominal = fit.law.nominal_restitution();
    fitted
        .0
        .extend(nominal.map(|value| ("nominal_restitution".into(), Some(value))));
    ImpactOutcome {
        id: entry.id.clone(),
        specimen: entry.specimen.clone(),
        group: None,
        file: entry.file.clone(),
        law: fit.law.kind().name().into(),
        quantities: fit
            .quantities
            .iter()
            .map(|q| q.quantity.name().into())
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
        derived_sd,
        derived_from,
        fitted,
        directions: directions(fit),
        common: common(fit),
        intervals: interval_outcome(fit),
        findings: findings(signal_findings, fit),
        left_out: Vec::new(),
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
        unit: estimate.unit.as_str().into(),
        held: false,
    }
}

fn named(estimates: &[Estimate]) -> Named<EstimateOutcome> {
    let named = estimates.iter().map(|e| (e.name.clone(), estimate(e)));
    named.collect()
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
                unit: fit.law.unit_of(index).into(),
                held: true,
            },
        };
        (description.name, outcome)
    });
    outcome.collect()
}

/// Parameters, then nuisances: the order of directions, correlations and intervals.
pub(crate) fn estimates(fit: &Fit) -> impl Iterator<Item = &Estimate> {
    fit.parameters.iter().chain(&fit.nuisances)
}

/// Each direction by the names of the estimates.
fn directions(fit: &Fit) -> Vec<Named<f64>> {
    let names = || estimates(fit).map(|e| e.name.clone());
    let of = |change: &[f64]| names().zip(change.iter().copied()).collect();
    fit.directions.iter().map(|d| of(&d.change)).collect()
}

/// What the bench moves, by its quantities and the names of the estimates.
fn common(fit: &Fit) -> Named<Named<f64>> {
    let names = || estimates(fit).map(|e| e.name.clone());
    let of = |own: &CommonShift| names().zip(own.shifts.iter().copied()).collect();
    let all = fit.common.iter();
    all.map(|own| (own.cause.name(), of(own))).collect()
}

/// "k, c" → correlation, of all pairs of estimates.
fn correlations(fit: &Fit) -> Named<f64> {
    let names: Vec<&str> = estimates(fit).map(|e| e.name.as_str()).collect();
    let mut pairs = Vec::new();
    for (i, row) in fit.correlations.iter().enumerate() {
        for (j, value) in row.iter().enumerate().skip(i + 1) {
            if value.is_finite() {
                pairs.push((Name::from(format!("{}, {}", names[i], names[j])), *value));
            }
        }
    }
    pairs.into_iter().collect()
}

fn residuals(fit: &Fit) -> Named<ResidualOutcome> {
    let of = |q: &QuantityFit| ResidualOutcome {
        samples: q.samples,
        weight: q.weight,
        noise: q.noise,
        persistence: q.persistence,
        rms: q.rms_residual,
        by_phase: q.by_phase,
        runs_z: q.runs.map(|runs| runs.z).filter(|z| z.is_finite()),
    };
    let quantities = fit.quantities.iter();
    quantities.map(|q| (q.quantity.name(), of(q))).collect()
}

/// The derived quantities in the motion under the fitted law.
fn fitted_values(motion: &FittedMotion) -> Named<Option<f64>> {
    let value = |quantity: &Quantity| {
        let value = quantity.fitted(motion)?;
        Some((quantity.name, value.is_finite().then_some(value)))
    };
    QUANTITIES.iter().filter_map(value).collect()
}

/// Values of the derived quantities, their uncertainties, and where they come from: the
/// signals where they show them, else the fitted law.
type Derived = (Named<Option<f64>>, Named<f64>, Named<Name>);

fn derived_values(measured: &Measured, fitted: &Named<Option<f64>>) -> Derived {
    let (mut values, mut sds, mut sources) = (Vec::new(), Vec::new(), Vec::new());
    for quantity in &QUANTITIES {
        let name = || Name::from(quantity.name);
        let (value, sd) = quantity.measured(measured);
        sds.extend(sd.map(|sd| (name(), sd)));
        let (value, source) = match (value, fitted.get(quantity.name)) {
            (Some(value), _) => (Some(value), "signal"),
            (None, Some(fitted)) => (*fitted, "fit"),
            (None, None) => continue,
        };
        values.push((name(), value));
        sources.push((name(), source.into()));
    }
    let (values, sds, sources) = (values.into_iter(), sds.into_iter(), sources.into_iter());
    (values.collect(), sds.collect(), sources.collect())
}

/// A finding on the signals.
pub fn told(finding: &Finding) -> FindingOutcome {
    FindingOutcome::new(finding.code(), finding.to_string()).of_channel(finding.channel())
}

fn findings(signal: &[Finding], fit: &Fit) -> Vec<FindingOutcome> {
    let fit = fit
        .findings
        .iter()
        .map(|own| FindingOutcome::new(own.code(), own.to_string()).of_channel(own.quantity()));
    signal.iter().map(told).chain(fit).collect()
}
