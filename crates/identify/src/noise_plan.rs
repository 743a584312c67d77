//! The noise of each channel as the fit weighs it: from the recording at first,
//! then from what a first fit leaves.

use crate::finding::Finding;
use crate::noise_edges::{EdgeSamples, edge_samples};
use crate::problem::{FitOptions, NoiseModel, Weighting};
use crate::residual::Rows;
use crate::samples::{QUANTITIES, Quantity, SampleGroup};
use crate::uncertainty::{inflation, standardised};
use windfall_signal::impact::{Impact, Series};
use windfall_signal::noise_colour::persistence;

/// A channel's noise is not believed to be smaller than this part of what the
/// recording showed, nor its correlation read off residuals that are smaller:
/// those of a simulation without noise are not random; 1.
const LEAST_VARIANCE_RATIO: f64 = 0.25;

/// Samples of an impact in groups, with what their noise is known to be.
#[derive(Clone, Debug)]
pub(crate) struct NoisePlan {
    /// Samples that share their times.
    pub groups: Vec<SampleGroup>,
    /// The displacement's edges, where these took the place of its samples.
    pub edges: Option<EdgeSamples>,
}

/// A quantity of an impact, if it was measured.
pub(crate) fn series(impact: &Impact, quantity: Quantity) -> Option<&Series> {
    let found = match quantity {
        Quantity::Displacement => &impact.displacement,
        Quantity::Rate => &impact.rate,
        Quantity::Force => &impact.force,
        Quantity::Acceleration => &impact.acceleration,
    };
    found.as_ref().filter(|s| !s.times.is_empty())
}

/// Groups the series that share their times, each with its weight and noise.
/// Times count from the threshold's onset.
pub(crate) fn noise_plan(
    impact: &Impact,
    options: &FitOptions,
    findings: &mut Vec<Finding>,
) -> NoisePlan {
    let modelled =
        options.weighting == Weighting::InverseVariance && options.noise == NoiseModel::Automatic;
    let mut used: Vec<(Quantity, &Series)> = Quantity::ALL
        .into_iter()
        .filter(|q| options.quantities.holds(*q))
        .filter_map(|q| Some((q, series(impact, q)?)))
        .collect();
    let moved = used.iter().any(|(q, _)| *q == Quantity::Displacement);
    let repeated = |(q, s): &(Quantity, &Series)| *q == Quantity::Rate && s.derived;
    if modelled && moved && used.iter().any(repeated) {
        used.retain(|entry| !repeated(entry));
        findings.push(Finding::ComputedRate);
    }
    let mut plan = NoisePlan {
        groups: Vec::new(),
        edges: None,
    };
    if modelled
        && let Some((_, displacement)) = used.iter().find(|(q, _)| *q == Quantity::Displacement)
        && let Some(edges) = edge_samples(displacement)
    {
        used.retain(|(q, _)| *q != Quantity::Displacement);
        findings.push(Finding::CountedDisplacement {
            edges: edges.times.len(),
            quantum: edges.quantum,
        });
        let variances = edges.variances(&edges.speeds, 0.0);
        plan.groups
            .push(edge_group(&edges, &variances, impact.onset));
        plan.edges = Some(edges);
    }
    plan.groups
        .extend(grouped(impact, &used, options, modelled));
    plan
}

fn edge_group(edges: &EdgeSamples, variances: &[f64], onset: f64) -> SampleGroup {
    let times: Vec<f64> = edges.times.iter().map(|t| t - onset).collect();
    let mut values = [None; QUANTITIES];
    // A common scale, so that the quantity's weight is that of a typical edge.
    let typical = variances.iter().sum::<f64>() / variances.len() as f64;
    values[Quantity::Displacement as usize] = Some((edges.values.as_slice(), 1.0 / typical));
    let relative: Vec<f64> = variances.iter().map(|v| typical / v).collect();
    SampleGroup::new(&times, values).with_relative_weights(Quantity::Displacement, &relative)
}

fn grouped(
    impact: &Impact,
    used: &[(Quantity, &Series)],
    options: &FitOptions,
    modelled: bool,
) -> Vec<SampleGroup> {
    let mut groups = Vec::new();
    let mut done = [false; QUANTITIES];
    for (i, &(_, first)) in used.iter().enumerate() {
        if done[i] {
            continue;
        }
        let mut values: [Option<(&[f64], f64)>; QUANTITIES] = [None; QUANTITIES];
        let mut held = Vec::new();
        for (j, &(quantity, other)) in used.iter().enumerate().skip(i) {
            if !done[j] && other.times == first.times {
                done[j] = true;
                let weight = weight_of(impact, other, options.weighting);
                values[quantity as usize] = Some((&other.values, weight));
                held.push((quantity, other));
            }
        }
        let times: Vec<f64> = first.times.iter().map(|t| t - impact.onset).collect();
        let mut group = SampleGroup::new(&times, values);
        for (quantity, series) in held.into_iter().filter(|_| modelled) {
            group = group
                .with_persistence(quantity, series.persistence.unwrap_or(0.0))
                .with_zero_sd(quantity, series.zero_sd);
        }
        groups.push(group);
    }
    groups
}

fn weight_of(impact: &Impact, series: &Series, weighting: Weighting) -> f64 {
    match weighting {
        Weighting::InverseVariance => 1.0 / (series.noise * series.noise),
        Weighting::InverseMean => {
            let inside = series.times.iter().zip(&series.values);
            let inside = inside.filter(|(t, _)| **t >= impact.onset && **t <= impact.end);
            let (sum, count) = inside.fold((0.0, 0), |(sum, n), (_, v)| (sum + v.abs(), n + 1));
            f64::from(count) / f64::max(sum, f64::MIN_POSITIVE)
        }
    }
}

impl NoisePlan {
    /// The same samples with the noise that a fit's residuals show: the variance
    /// of each channel, the correlation where the recording did not tell it, and
    /// the widening by what correlation is left.
    ///
    /// * `rows`: residuals of the fit
    /// * `speeds`: the fitted model's speed at each edge; m/s
    /// * `parameters`: number of free parameters
    pub(crate) fn recalibrated(
        &self,
        impact: &Impact,
        rows: &Rows,
        speeds: &[f64],
        parameters: usize,
    ) -> Self {
        let mut plan = self.clone();
        let total: usize = rows.residuals.iter().flatten().map(Vec::len).sum();
        // Degrees of freedom that the parameters used up, shared by all channels.
        let freedom = total as f64 / total.saturating_sub(parameters).max(1) as f64;
        for (g, group) in plan.groups.iter_mut().enumerate() {
            for quantity in Quantity::ALL {
                let q = quantity as usize;
                let residuals = &rows.residuals[g][q];
                if residuals.is_empty() {
                    continue;
                }
                if quantity == Quantity::Displacement
                    && let Some(edges) = &self.edges
                {
                    let jitter = edges.jitter(residuals, speeds, parameters);
                    let variances = edges.variances(speeds, jitter);
                    *group = edge_group(edges, &variances, impact.onset);
                }
                let unknown = series(impact, quantity)
                    .is_some_and(|s| s.persistence.is_none() && !s.derived)
                    && !(quantity == Quantity::Displacement && self.edges.is_some());
                let square = residuals.iter().map(|r| r * r).sum::<f64>() / residuals.len() as f64;
                let random = square * group.weights[q] > LEAST_VARIANCE_RATIO;
                if unknown && random {
                    group.persistence[q] = persistence(residuals).unwrap_or(0.0);
                }
                let z = standardised(group, quantity, residuals);
                let variance = freedom * z.iter().map(|z| z * z).sum::<f64>() / z.len() as f64;
                let ratio = (variance * inflation(&z)).max(LEAST_VARIANCE_RATIO);
                group.weights[q] /= ratio;
            }
        }
        plan
    }
}
