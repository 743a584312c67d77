//! How well a population is estimated from raw recordings: replicates of a
//! campaign with known truth, nonlinear mixed effects beside the two-stage way or
//! beside the posterior.
//!
//! `population_study [fine|coarse] [REPLICATES] [THREADS] [REACH] [--seed S]` prints a
//! Markdown table. REACH: standard errors around a fit in which it counts as a
//! normal observation (2).
//!
//! `population_study posterior [REPLICATES] [THREADS] [--seed S]` draws the posterior of each
//! replicate and compares.
//!
//! `fine`: encoder of 360,000 counts per revolution, force noise of 1 N.
//! `coarse`: encoder of 20,000 counts, force noise of 4 N, half of the impacts.

#![allow(clippy::print_stdout, clippy::print_stderr, clippy::unwrap_used)]

#[path = "shared/pendulum.rs"]
mod pendulum;

use pendulum::{Bench, arguments, bench, on_threads, recorded, rig};
use windfall_contact::expression::parse_law;
use windfall_contact::laws::kind::LawKind;
use windfall_identify::fit::interval::mixes;
use windfall_identify::fit::problem::{FitOptions, LawProblem};
use windfall_identify::population::fit::fit_population;
use windfall_identify::population::likelihood::{
    DRAWN_REACH, ImpactLikelihood, NORMAL_REACH, impact_likelihood,
};
use windfall_identify::population::model::{
    Covariate, FixedEffect, PopulationData, PopulationFit, PopulationOptions, Spread,
};
use windfall_identify::population::posterior::{PosteriorRange, population_posterior};
use windfall_identify::population::two_stage::{TwoStage, two_stage};
use windfall_identify::sampler::Drawing;
use windfall_signal::noise::gaussian::{NoiseSource, noise_source, normal, uniform};

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

/// What the recordings are made with, and the share of the impacts that are kept.
fn case(name: &str) -> (Bench, f64) {
    match name {
        "coarse" => (
            bench("coarse", 20_000.0, 4.0, 0.0).with_found_threshold(),
            0.5,
        ),
        _ => (bench("fine", 360_000.0, 1.0, 0.0), 0.7),
    }
}

/// One campaign: likelihoods with fruit and measured velocities.
fn campaign(
    (bench, kept): &(Bench, f64),
    seed: u64,
) -> (Vec<ImpactLikelihood>, PopulationData, usize) {
    let mut source: NoiseSource = noise_source(seed, 0);
    let problem = LawProblem::from_expression(&parse_law("kuwabara-kono").unwrap());
    let (mut likelihoods, mut fruits, mut velocities) = (Vec::new(), Vec::new(), Vec::new());
    let mut lost = 0;
    for specimen in 0..FRUIT {
        let (a, b) = (normal(&mut source), normal(&mut source));
        let other = CORRELATION * a + (1.0 - CORRELATION * CORRELATION).sqrt() * b;
        let own = [BETWEEN[0] * a, BETWEEN[1] * other];
        let fruit = fruits.last().map_or(0, |last| last + 1);
        for (at, velocity) in VELOCITIES.into_iter().enumerate() {
            let missing = uniform(&mut source) >= *kept;
            let deviation = [normal(&mut source), normal(&mut source)];
            if missing {
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
            let number = (specimen * VELOCITIES.len() + at) as u64;
            let impact = recorded(bench, &law, velocity, 1_000 * seed + number);
            let found = impact.and_then(|impact| {
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

fn replicate(case: &(Bench, f64), seed: u64, reach: f64) -> Replicate {
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

/// A number as the estimate and as the posterior tell it.
struct Pair {
    value: f64,
    interval: (f64, f64),
    posterior: PosteriorRange,
}

/// Posterior of one replicate, its numbers in the order of [`NAMES`]; divergences,
/// and whether all chains agree.
fn posterior(case: &(Bench, f64), seed: u64) -> (Vec<Pair>, usize, bool) {
    let (likelihoods, data, _) = campaign(case, seed);
    let starts: Vec<Vec<f64>> = likelihoods.iter().map(ImpactLikelihood::estimate).collect();
    let expand_beyond = |reach: f64, points: &[Vec<f64>]| {
        let own = likelihoods.iter().zip(points);
        own.map(|(likelihood, at)| likelihood.expand_beyond(reach, at))
            .collect()
    };
    let expand = |points: &[Vec<f64>]| expand_beyond(NORMAL_REACH, points);
    let options = PopulationOptions::default();
    let fit = fit_population(&data, &starts, &expand, &options).unwrap();
    let expand = |points: &[Vec<f64>]| expand_beyond(DRAWN_REACH, points);
    let drawing = Drawing {
        chains: 4,
        draws: 500,
        seed,
    };
    let found = population_posterior(&data, &fit, &expand, &options, &drawing, &|_, _| {}).unwrap();
    let mut pairs = Vec::new();
    for at in [0, 2, 1, 3] {
        let effect = &fit.effects[at];
        pairs.push(Pair {
            value: effect.value,
            interval: (effect.low, effect.high),
            posterior: found.effects[at],
        });
    }
    for (level, drawn) in [(&fit.between, &found.between), (&fit.within, &found.within)] {
        let spreads = level.sds.iter().chain(&level.correlations);
        for (spread, posterior) in spreads.zip(drawn.sds.iter().chain(&drawn.correlations)) {
            pairs.push(Pair {
                value: spread.value,
                interval: spread.interval.unwrap(),
                posterior: *posterior,
            });
        }
    }
    let mixed = found.ranges().all(|range| mixes(&range.mixing));
    (pairs, found.divergences, mixed)
}

/// Where the posterior is and how wide, against the estimate's interval.
fn compare_posteriors(case: &(Bench, f64), first: u64, count: u64, threads: u64) {
    let begin = std::time::Instant::now();
    let replicates = on_threads(count, threads, |i| posterior(case, first + 1000 + i));
    println!(
        "| quantity | posterior median less estimate, standard errors | largest | width of the posterior's interval over that of the estimate | smallest | largest |"
    );
    println!("|---|---|---|---|---|---|");
    for (i, name) in NAMES[..10].iter().enumerate() {
        let pairs = replicates.iter().map(|(pairs, ..)| &pairs[i]);
        let width = |p: &Pair| p.interval.1 - p.interval.0;
        let shifts: Vec<f64> = pairs
            .clone()
            .map(|p| (p.posterior.median - p.value) / (width(p) / (2.0 * 1.96)))
            .collect();
        let widths: Vec<f64> = pairs
            .map(|p| (p.posterior.high - p.posterior.low) / width(p))
            .collect();
        let mean = |all: &[f64]| all.iter().sum::<f64>() / all.len() as f64;
        let far = shifts
            .iter()
            .copied()
            .fold(0.0, |a: f64, s| match s.abs() > a.abs() {
                true => s,
                false => a,
            });
        println!(
            "| {name} | {:+.2} | {far:+.2} | {:.2} | {:.2} | {:.2} |",
            mean(&shifts),
            mean(&widths),
            widths.iter().copied().fold(f64::INFINITY, f64::min),
            widths.iter().copied().fold(0.0, f64::max),
        );
    }
    println!(
        "\n{count} replicates, 4 chains of 500 draws; {} divergences, {} of them with all R-hat below 1.01 and 400 independent draws; {:.0} s",
        replicates.iter().map(|r| r.1).sum::<usize>(),
        replicates.iter().filter(|r| r.2).count(),
        begin.elapsed().as_secs_f64(),
    );
}

fn main() {
    let (arguments, first) = arguments();
    let argument = |i: usize| arguments.get(i).map(String::as_str);
    let case = case(argument(0).unwrap_or("fine"));
    let count: u64 = argument(1).map_or(200, |text| text.parse().unwrap());
    let threads: u64 = argument(2).map_or(2, |text| text.parse().unwrap());
    if argument(0) == Some("posterior") {
        return compare_posteriors(&case, first, count, threads);
    }
    let reach: f64 = argument(3).map_or(NORMAL_REACH, |text| text.parse().unwrap());
    let begin = std::time::Instant::now();
    let replicates = on_threads(count, threads, |i| {
        replicate(&case, first + 1000 + i, reach)
    });
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
