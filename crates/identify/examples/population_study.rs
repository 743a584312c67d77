//! How well a population is estimated from raw recordings: replicates of a
//! campaign with known truth, nonlinear mixed effects beside the two-stage way.
//!
//! `population_study [fine|coarse] [REPLICATES] [THREADS] [REACH]` prints a
//! Markdown table. REACH: standard errors around a fit in which it counts as a
//! normal observation (2).
//!
//! `fine`: encoder of 360,000 counts per revolution, force noise of 1 N.
//! `coarse`: encoder of 20,000 counts, force noise of 4 N, half of the impacts.

#![allow(clippy::print_stdout, clippy::print_stderr, clippy::unwrap_used)]

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha12Rng;
use std::sync::atomic::{AtomicUsize, Ordering};
use windfall_contact::expression::parse_law;
use windfall_contact::law::EndRule;
use windfall_contact::law_kind::{Law, LawKind};
use windfall_identify::population::{
    Covariate, FixedEffect, PopulationData, PopulationFit, PopulationOptions, Spread,
};
use windfall_identify::population_fit::fit_population;
use windfall_identify::population_likelihood::{ImpactLikelihood, NORMAL_REACH, impact_likelihood};
use windfall_identify::population_two_stage::{TwoStage, two_stage};
use windfall_identify::problem::{FitOptions, LawProblem};
use windfall_identify::rig::{Pendulum, Rig};
use windfall_identify::simulate::trajectory;
use windfall_signal::extract::extract_impact;
use windfall_signal::impact::Impact;
use windfall_signal::instrument::{
    Instrument, Trajectory, calibrated, pendulum_instrument, record,
};
use windfall_signal::kinematics::Encoder;
use windfall_signal::options::ExtractOptions;
use windfall_signal::trigger::{Threshold, TriggerOptions};

const FRUIT: usize = 40;
const VELOCITIES: [f64; 6] = [0.15, 0.20, 0.27, 0.36, 0.48, 0.60];
/// Medians of k and c at the reference velocity.
const MEDIANS: [f64; 2] = [394_931.0, 681.0];
const REFERENCE_VELOCITY: f64 = 0.3;
/// Change of ln k and ln c per unit of ln v.
const EFFECTS: [f64; 2] = [-0.10, -0.25];
const BETWEEN: [f64; 2] = [0.15, 0.20];
const CORRELATION: f64 = 0.4;
const WITHIN: f64 = 0.05;

/// What the recordings are made with.
#[derive(Clone, Copy)]
struct Case {
    counts: f64,
    force_noise: f64,
    /// Share of the impacts that are kept.
    kept: f64,
}

fn case(name: &str) -> Case {
    match name {
        "coarse" => Case {
            counts: 20_000.0,
            force_noise: 4.0,
            kept: 0.5,
        },
        _ => Case {
            counts: 360_000.0,
            force_noise: 1.0,
            kept: 0.7,
        },
    }
}

fn rig() -> Rig {
    Rig::Pendulum(Pendulum {
        inertia: 0.014_35,
        arm: 0.505,
        mass: 0.08,
        centre_of_mass: 0.35,
        gravity: 9.806_65,
    })
}

fn instrument(case: Case) -> (Instrument, Encoder) {
    let encoder = Encoder::Rotary {
        counts_per_revolution: case.counts,
    };
    let mut out = pendulum_instrument();
    if let Some(sensor) = out.encoder.as_mut() {
        sensor.encoder = encoder;
    }
    if let Some(sensor) = out.force.as_mut() {
        sensor.noise = case.force_noise;
    }
    (out, encoder)
}

/// Standard normal (Box and Muller 1958).
fn normal(source: &mut ChaCha12Rng) -> f64 {
    let (u, v): (f64, f64) = (source.random(), source.random());
    (-2.0 * (1.0 - u).ln()).sqrt() * (std::f64::consts::TAU * v).cos()
}

/// One impact from its raw signals; `None` where none is found in them.
fn impact(law: &Law, velocity: f64, case: Case, source: &mut ChaCha12Rng) -> Option<Impact> {
    let start = -3e-3 - 5e-6 * source.random::<f64>();
    let times: Vec<f64> = (0..2800).map(|i| start + 5e-6 * f64::from(i)).collect();
    let motion = trajectory(law, &rig(), velocity, &times, EndRule::ForceZero).ok()?;
    let motion = Trajectory {
        times: motion.times,
        displacement: motion.displacement,
        rate: motion.rate,
        force: motion.force,
        acceleration: motion.acceleration,
    };
    let (instrument, encoder) = instrument(case);
    let raw = record(&motion, &instrument, source.random()).ok()?;
    let recording = calibrated("simulated", &raw, &instrument);
    let options = ExtractOptions {
        trigger: TriggerOptions {
            threshold: match case.force_noise > 1.0 {
                true => Threshold::default(),
                false => Threshold::Fixed(1.0),
            },
            ..TriggerOptions::default()
        },
        encoder: Some(encoder),
        arm: Some(0.505),
        effective_mass: Some(rig().effective_mass()),
        ..ExtractOptions::default()
    };
    Some(extract_impact(&recording, &options).ok()?.0)
}

/// One campaign: likelihoods with fruit and measured velocities.
fn campaign(case: Case, seed: u64) -> (Vec<ImpactLikelihood>, PopulationData, usize) {
    let mut source = ChaCha12Rng::seed_from_u64(seed);
    let problem = LawProblem::from_expression(&parse_law("kuwabara-kono").unwrap());
    let (mut likelihoods, mut fruits, mut velocities) = (Vec::new(), Vec::new(), Vec::new());
    let mut lost = 0;
    for _ in 0..FRUIT {
        let (a, b) = (normal(&mut source), normal(&mut source));
        let other = CORRELATION * a + (1.0 - CORRELATION * CORRELATION).sqrt() * b;
        let own = [BETWEEN[0] * a, BETWEEN[1] * other];
        let fruit = fruits.last().map_or(0, |last| last + 1);
        for velocity in VELOCITIES {
            let kept = source.random::<f64>() < case.kept;
            let deviation = [normal(&mut source), normal(&mut source)];
            if !kept {
                continue;
            }
            let along = (velocity / REFERENCE_VELOCITY).ln();
            let values: Vec<f64> = (0..2)
                .map(|p| {
                    let shift = EFFECTS[p] * along + own[p] + WITHIN * deviation[p];
                    MEDIANS[p] * shift.exp()
                })
                .collect();
            let law = LawKind::KuwabaraKono.with_parameters(&values).unwrap();
            let found = impact(&law, velocity, case, &mut source).and_then(|impact| {
                let likelihood =
                    impact_likelihood(&impact, &rig(), &problem, &FitOptions::default());
                let measured = impact.measured.impact_velocity.filter(|v| *v > 0.0)?;
                Some((likelihood.ok()?, measured))
            });
            match found {
                Some((likelihood, measured)) => {
                    likelihoods.push(likelihood);
                    fruits.push(fruit);
                    velocities.push(measured.ln());
                }
                None => lost += 1,
            }
        }
    }
    let centre = velocities.iter().sum::<f64>() / velocities.len() as f64;
    let data = PopulationData {
        parameters: vec!["k".to_owned(), "c".to_owned()],
        fruit: fruits,
        covariates: vec![Covariate {
            name: "log(impact_velocity)".to_owned(),
            centre,
            values: velocities,
        }],
    };
    (likelihoods, data, lost)
}

/// One number of one replicate: truth, estimate, interval.
#[derive(Clone, Copy)]
struct Told {
    truth: f64,
    value: f64,
    interval: Option<(f64, f64)>,
}

fn told(truth: f64, spread: &Spread) -> Told {
    Told {
        truth,
        value: spread.value,
        interval: spread.interval,
    }
}

fn told_effect(truth: f64, effect: &FixedEffect) -> Told {
    Told {
        truth,
        value: effect.value,
        interval: Some((effect.low, effect.high)),
    }
}

const NAMES: [&str; 11] = [
    "median ln k",
    "median ln c",
    "effect of ln v on ln k",
    "effect of ln v on ln c",
    "between-fruit SD of ln k",
    "between-fruit SD of ln c",
    "between-fruit correlation",
    "within-fruit SD of ln k",
    "within-fruit SD of ln c",
    "within-fruit correlation",
    "mean fit SD of ln c",
];

/// Rows of the table in one replicate: mixed effects and two-stage.
fn rows(
    fit: &PopulationFit,
    stages: &TwoStage,
    centre: f64,
    noise: f64,
) -> Vec<(Option<Told>, Option<Told>)> {
    let median = |p: usize| MEDIANS[p].ln() + EFFECTS[p] * (centre - REFERENCE_VELOCITY.ln());
    let mut out = Vec::new();
    for p in 0..2 {
        let own = told_effect(median(p), &fit.effects[2 * p]);
        out.push((Some(own), Some(told(median(p), &stages.means[p]))));
    }
    for p in 0..2 {
        let own = told_effect(EFFECTS[p], &fit.effects[2 * p + 1]);
        out.push((
            Some(own),
            Some(told_effect(EFFECTS[p], &stages.effects[2 * p + 1])),
        ));
    }
    for p in 0..2 {
        let own = told(BETWEEN[p], &fit.between.sds[p]);
        out.push((Some(own), Some(told(BETWEEN[p], &stages.sds[p]))));
    }
    let correlation = Told {
        truth: CORRELATION,
        value: stages.correlations[0],
        interval: None,
    };
    let own = told(CORRELATION, &fit.between.correlations[0]);
    out.push((Some(own), Some(correlation)));
    for p in 0..2 {
        out.push((Some(told(WITHIN, &fit.within.sds[p])), None));
    }
    out.push((Some(told(0.0, &fit.within.correlations[0])), None));
    let noise = Told {
        truth: 0.0,
        value: noise,
        interval: None,
    };
    out.push((Some(noise), None));
    out
}

struct Replicate {
    rows: Vec<(Option<Told>, Option<Told>)>,
    impacts: usize,
    lost: usize,
    converged: bool,
    shifts: [f64; 2],
    iterations: usize,
}

fn replicate(case: Case, seed: u64, reach: f64) -> Replicate {
    let (likelihoods, data, lost) = campaign(case, seed);
    let starts: Vec<Vec<f64>> = likelihoods.iter().map(ImpactLikelihood::estimate).collect();
    let expand = |points: &[Vec<f64>]| {
        let own = likelihoods.iter().zip(points);
        own.map(|(likelihood, at)| likelihood.expand_beyond(reach, at))
            .collect()
    };
    let fit = fit_population(&data, &starts, &expand, &PopulationOptions::default()).unwrap();
    let stages = two_stage(&data, &starts, 0.95).unwrap();
    let noise: f64 = likelihoods
        .iter()
        .map(|l| l.covariance()[1][1].sqrt())
        .sum();
    let noise = noise / likelihoods.len() as f64;
    Replicate {
        rows: rows(&fit, &stages, data.covariates[0].centre, noise),
        impacts: starts.len(),
        lost,
        converged: fit.converged,
        shifts: [fit.shift_from_fits, fit.shift_from_first_order],
        iterations: fit.iterations,
    }
}

/// Mean, bias in percent (of the truth, or absolute where it is zero) with its
/// Monte-Carlo error, coverage.
fn summary(told: &[Told]) -> [String; 3] {
    let n = told.len() as f64;
    let mean = |f: &dyn Fn(&Told) -> f64| told.iter().map(f).sum::<f64>() / n;
    let truth = mean(&|t| t.truth);
    let bias = mean(&|t| t.value - t.truth);
    let square = mean(&|t| (t.value - t.truth - bias).powi(2));
    let error = (square / (n - 1.0)).sqrt();
    // Medians are logarithms: their bias is relative by itself.
    let unit = match truth.abs() {
        size if size > 1.0 || size == 0.0 => 1.0,
        size => size,
    };
    let covered: Vec<bool> = told
        .iter()
        .filter_map(|t| {
            t.interval
                .map(|(low, high)| low <= t.truth && t.truth <= high)
        })
        .collect();
    let coverage = match covered.len() {
        0 => "".to_owned(),
        n => format!(
            "{:.1}",
            100.0 * covered.iter().filter(|c| **c).count() as f64 / n as f64
        ),
    };
    [
        format!("{:.4}", mean(&|t| t.value)),
        format!("{:+.1} ± {:.1}", 100.0 * bias / unit, 100.0 * error / unit),
        coverage,
    ]
}

fn table(replicates: &[Replicate]) {
    println!(
        "| quantity | truth | mixed effects: mean | bias, % | coverage, % | two-stage: mean | bias, % | coverage, % |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for (i, name) in NAMES.iter().enumerate() {
        let own: Vec<Told> = replicates.iter().filter_map(|r| r.rows[i].0).collect();
        let other: Vec<Told> = replicates.iter().filter_map(|r| r.rows[i].1).collect();
        let truth = own.iter().map(|t| t.truth).sum::<f64>() / own.len() as f64;
        let [a, b, c] = summary(&own);
        let [d, e, f] = match other.is_empty() {
            true => [const { String::new() }; 3],
            false => summary(&other),
        };
        println!("| {name} | {truth:.4} | {a} | {b} | {c} | {d} | {e} | {f} |");
    }
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let argument = |i: usize| arguments.get(i).map(String::as_str);
    let case = case(argument(0).unwrap_or("fine"));
    let count: usize = argument(1).map_or(200, |text| text.parse().unwrap());
    let threads: usize = argument(2).map_or(2, |text| text.parse().unwrap());
    let reach: f64 = argument(3).map_or(NORMAL_REACH, |text| text.parse().unwrap());
    let begin = std::time::Instant::now();
    let next = AtomicUsize::new(0);
    let mut replicates: Vec<(usize, Replicate)> = std::thread::scope(|scope| {
        let worker = || {
            let mut own = Vec::new();
            loop {
                let i = next.fetch_add(1, Ordering::Relaxed);
                if i >= count {
                    return own;
                }
                own.push((i, replicate(case, 1000 + i as u64, reach)));
            }
        };
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(worker)).collect();
        let results = workers
            .into_iter()
            .flat_map(|worker| worker.join().unwrap());
        results.collect()
    });
    replicates.sort_by_key(|(i, _)| *i);
    let replicates: Vec<Replicate> = replicates.into_iter().map(|(_, r)| r).collect();
    table(&replicates);
    let n = replicates.len() as f64;
    let mean = |f: &dyn Fn(&Replicate) -> f64| replicates.iter().map(f).sum::<f64>() / n;
    println!();
    println!(
        "{count} replicates, {:.0} impacts each ({:.1} could not be used), {} converged, {:.1} iterations; \
         mean largest shift of an estimate by the iterations {:.3}, by the second order {:.4} standard errors; {:.0} s",
        mean(&|r| r.impacts as f64),
        mean(&|r| r.lost as f64),
        replicates.iter().filter(|r| r.converged).count(),
        mean(&|r| r.iterations as f64),
        mean(&|r| r.shifts[0]),
        mean(&|r| r.shifts[1]),
        begin.elapsed().as_secs_f64(),
    );
}
