//! The noise of each channel as the fit weighs it: from the recording at first,
//! then from what a first fit leaves.

use crate::finding::Finding;
use crate::fit::edge_errors::edge_inflation;
use crate::fit::problem::{FitOptions, NoiseModel, Weighting};
use crate::fit::residual::Rows;
use crate::fit::response::Shift;
use crate::fit::solve::LARGEST_FREE;
use crate::fit::uncertainty::{inflation, standardised};
use crate::noise::blocks::{block_length, mean_noise, means, samples_between};
use crate::noise::edges::{EdgeSamples, edge_samples};
use crate::samples::{QUANTITIES, Quantity, SampleGroup};
use windfall_signal::impact::{Impact, Series};
use windfall_signal::noise::colour::persistence;

/// Least variance of a channel's residuals over that of its recorded noise; below it
/// they are not random, as in a simulation without noise; 1.
const LEAST_VARIANCE_RATIO: f64 = 0.25;

/// Fewer edges do not determine their own variance.
const ENOUGH_EDGES: usize = 50;

/// Samples of an impact in groups, with what their noise is known to be.
#[derive(Clone, Debug)]
pub(crate) struct NoisePlan {
    /// Samples that share their times.
    pub groups: Vec<SampleGroup>,
    /// The displacement's edges, where these took the place of its samples.
    pub edges: Option<EdgeSamples>,
    /// Noise of a fitted value (a sample, a mean of a block, an edge) by the
    /// recording alone; SI.
    pub noise: [f64; QUANTITIES],
    /// Correlation of the noise of successive samples as they were recorded; 1.
    pub persistence: [f64; QUANTITIES],
    /// Noise of a sample that the user gave, in place of what the recording shows; SI.
    pub given: [Option<f64>; QUANTITIES],
    /// What the instruments add, where it has been taken off.
    pub shift: Option<Shift>,
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
        noise: [f64::NAN; QUANTITIES],
        persistence: [0.0; QUANTITIES],
        given: options.noise_sd,
        shift: None,
    };
    for (quantity, series) in used.iter().filter(|_| modelled) {
        plan.persistence[*quantity as usize] = series.persistence.unwrap_or(0.0);
    }
    if modelled
        && let Some((_, displacement)) = used.iter().find(|(q, _)| *q == Quantity::Displacement)
        && options.noise_sd[Quantity::Displacement as usize].is_none()
        && let Some(edges) = edge_samples(displacement)
    {
        used.retain(|(q, _)| *q != Quantity::Displacement);
        findings.push(Finding::CountedDisplacement {
            edges: edges.times.len(),
            quantum: edges.quantum,
        });
        let variances = edges.variances(&edges.velocities, 0.0);
        plan.noise[Quantity::Displacement as usize] = edges.typical_deviation();
        plan.groups.push(edge_group(
            &edges,
            &edges.velocities,
            &variances,
            impact.onset,
        ));
        plan.edges = Some(edges);
    }
    let rest = grouped(impact, &used, options, modelled, &mut plan.noise);
    plan.groups.extend(rest);
    plan
}

/// The edges with their errors, at these velocities and of these variances.
fn edge_group(
    edges: &EdgeSamples,
    velocities: &[f64],
    variances: &[f64],
    onset: f64,
) -> SampleGroup {
    let times: Vec<f64> = edges.times.iter().map(|t| t - onset).collect();
    let mut values = [None; QUANTITIES];
    // A common scale, so that the quantity's weight is that of a typical edge.
    let typical = variances.iter().sum::<f64>() / variances.len() as f64;
    values[Quantity::Displacement as usize] = Some((edges.values.as_slice(), 1.0 / typical));
    let relative: Vec<f64> = variances.iter().map(|v| typical / v).collect();
    SampleGroup::new(&times, values)
        .with_relative_weights(Quantity::Displacement, &relative)
        .with_edges(edges.errors(velocities, variances))
}

/// Groups of the series that share their times; a series of persistent noise in
/// blocks of its own.
fn grouped(
    impact: &Impact,
    used: &[(Quantity, &Series)],
    options: &FitOptions,
    modelled: bool,
    noise: &mut [f64; QUANTITIES],
) -> Vec<SampleGroup> {
    let mut groups = Vec::new();
    let mut done = [false; QUANTITIES];
    for &(quantity, series) in used.iter().filter(|_| modelled) {
        let persistence = series.persistence.unwrap_or(0.0);
        let length = length_of_blocks(impact, series, persistence);
        if length > 1 {
            let (ratio, rest) = mean_noise(persistence, length);
            noise[quantity as usize] = noise_of(series, quantity, &options.noise_sd) * ratio.sqrt();
            let given = options.noise_sd[quantity as usize].is_some();
            let group = block_group(impact, quantity, series, length, rest, noise);
            groups.push(group.with_given_noise(quantity, given));
            done[quantity as usize] = true;
        }
    }
    for (i, &(quantity, first)) in used.iter().enumerate() {
        if done[quantity as usize] {
            continue;
        }
        let mut values: [Option<(&[f64], f64)>; QUANTITIES] = [None; QUANTITIES];
        let mut held = Vec::new();
        for &(quantity, other) in &used[i..] {
            if !done[quantity as usize] && other.times == first.times {
                done[quantity as usize] = true;
                let own = noise_of(other, quantity, &options.noise_sd);
                noise[quantity as usize] = own;
                let weight = weight_of(impact, (other, own), options.weighting);
                values[quantity as usize] = Some((&other.values, weight));
                held.push((quantity, other));
            }
        }
        let times: Vec<f64> = first.times.iter().map(|t| t - impact.onset).collect();
        let mut group = SampleGroup::new(&times, values);
        for (quantity, series) in held {
            let given = options.noise_sd[quantity as usize].is_some();
            group = group.with_given_noise(quantity, given);
            if !modelled {
                continue;
            }
            group = group
                .with_persistence(quantity, series.persistence.unwrap_or(0.0))
                .with_zero_sd(quantity, series.zero_sd);
        }
        groups.push(group);
    }
    groups
}

fn length_of_blocks(impact: &Impact, series: &Series, persistence: f64) -> usize {
    let inside = samples_between(series, impact.onset, impact.end);
    block_length(persistence, inside)
}

/// One series in blocks, with the noise of their means.
fn block_group(
    impact: &Impact,
    quantity: Quantity,
    series: &Series,
    length: usize,
    persistence: f64,
    noise: &[f64; QUANTITIES],
) -> SampleGroup {
    let times: Vec<f64> = means(&series.times, length)
        .iter()
        .map(|t| t - impact.onset)
        .collect();
    let samples = means(&series.values, length);
    let mut values = [None; QUANTITIES];
    let weight = noise[quantity as usize].powi(-2);
    values[quantity as usize] = Some((samples.as_slice(), weight));
    SampleGroup::new(&times, values)
        .with_persistence(quantity, persistence)
        .with_zero_sd(quantity, series.zero_sd)
        .of_means()
}

/// Noise of a sample: as the user gave it, or as the recording shows it.
fn noise_of(series: &Series, quantity: Quantity, given: &[Option<f64>; QUANTITIES]) -> f64 {
    given[quantity as usize].unwrap_or(series.noise)
}

fn weight_of(impact: &Impact, (series, noise): (&Series, f64), weighting: Weighting) -> f64 {
    match weighting {
        Weighting::InverseVariance => 1.0 / (noise * noise),
        Weighting::InverseMean => {
            let inside = series.times.iter().zip(&series.values);
            let inside = inside.filter(|(t, _)| **t >= impact.onset && **t <= impact.end);
            let (sum, count) = inside.fold((0.0, 0), |(sum, n), (_, v)| (sum + v.abs(), n + 1));
            f64::from(count) / f64::max(sum, f64::MIN_POSITIVE)
        }
    }
}

/// A quantity found to have persistent noise.
struct Coloured {
    /// Its blocks, their noise by the recording, their residuals.
    group: (SampleGroup, f64, Vec<f64>),
    /// Correlation of the noise of successive samples.
    persistence: f64,
}

impl NoisePlan {
    /// The same samples with the noise that a fit's residuals show: the variance
    /// of each channel, the correlation where the recording did not show it, and
    /// the widening by the correlation left.
    ///
    /// * `rows`: residuals of the fit
    /// * `velocities`: the fitted model's velocity at each edge; m/s
    /// * `parameters`: number of free parameters
    pub(crate) fn recalibrated(
        &self,
        impact: &Impact,
        rows: &Rows,
        velocities: &[f64],
        parameters: usize,
    ) -> Self {
        let mut plan = self.clone();
        plan.groups.clear();
        let freedom = rows.freedom_lost(parameters);
        for (g, (group, residuals)) in self.groups.iter().zip(&rows.residuals).enumerate() {
            let mut group = group.clone();
            for quantity in Quantity::ALL {
                let residuals = &residuals[quantity as usize];
                if residuals.is_empty() {
                    continue;
                }
                if quantity == Quantity::Displacement
                    && let Some(edges) = &self.edges
                {
                    let jitter = edges.jitter(residuals, velocities, parameters);
                    let variances = edges.variances(velocities, jitter);
                    group = edge_group(edges, velocities, &variances, impact.onset);
                    let mut scale = 1.0;
                    if residuals.len() >= ENOUGH_EDGES {
                        let before = group.weights[quantity as usize];
                        group = rescaled(group, quantity, residuals, freedom);
                        scale = before / group.weights[quantity as usize];
                    }
                    let shared = edges.variances_of_lines(velocities, jitter);
                    let shared: Vec<f64> = shared.iter().map(|v| v * scale).collect();
                    group = edge_group(edges, velocities, &shared, impact.onset);
                    let own = (&residuals[..], &rows.jacobian[g][quantity as usize][..]);
                    let inflation = edge_inflation::<LARGEST_FREE>(&group, own, parameters);
                    group.weights[quantity as usize] /= inflation.max(LEAST_VARIANCE_RATIO);
                } else if let Some(blocks) = self.coloured(impact, quantity, &group, residuals) {
                    let (own, noise, residuals) = blocks.group;
                    plan.noise[quantity as usize] = noise;
                    plan.persistence[quantity as usize] = blocks.persistence;
                    plan.groups
                        .push(rescaled(own, quantity, &residuals, freedom));
                    group = group.without(quantity);
                } else {
                    group = rescaled(group, quantity, residuals, freedom);
                }
            }
            if Quantity::ALL.iter().any(|q| group.holds(*q)) {
                plan.groups.push(group);
            }
        }
        plan
    }

    /// Blocks of a quantity whose persistence only the residuals show, with the noise
    /// of a block by the recording and the residuals of the blocks.
    fn coloured(
        &self,
        impact: &Impact,
        quantity: Quantity,
        group: &SampleGroup,
        residuals: &[f64],
    ) -> Option<Coloured> {
        let series = series(impact, quantity)?;
        if series.persistence.is_some() || series.derived {
            return None;
        }
        let square = residuals.iter().map(|r| r * r).sum::<f64>() / residuals.len() as f64;
        if square * group.weights[quantity as usize] < LEAST_VARIANCE_RATIO {
            return None;
        }
        let persistence = persistence(residuals)?;
        let length = length_of_blocks(impact, series, persistence);
        if length == 1 {
            return None;
        }
        let (ratio, rest) = mean_noise(persistence, length);
        let mut noise = self.noise;
        noise[quantity as usize] = noise_of(series, quantity, &self.given) * ratio.sqrt();
        let mut group = block_group(impact, quantity, series, length, rest, &noise)
            .with_given_noise(quantity, self.given[quantity as usize].is_some());
        if let Some(shift) = &self.shift {
            group.shift(|quantity, time| -shift.at(quantity, time));
        }
        Some(Coloured {
            group: (group, noise[quantity as usize], means(residuals, length)),
            persistence,
        })
    }
}

/// A group with the variance that the residuals show for `quantity`, what is left
/// of their correlation included.
fn rescaled(
    mut group: SampleGroup,
    quantity: Quantity,
    residuals: &[f64],
    freedom: f64,
) -> SampleGroup {
    if group.given[quantity as usize] {
        return group;
    }
    let z = standardised(&group, quantity, residuals);
    let variance = freedom * z.iter().map(|z| z * z).sum::<f64>() / z.len() as f64;
    let ratio = (variance * inflation(&z)).max(LEAST_VARIANCE_RATIO);
    group.weights[quantity as usize] /= ratio;
    group
}
