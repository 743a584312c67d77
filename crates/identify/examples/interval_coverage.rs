//! How often intervals hold the truth, from simulated raw recordings:
//!
//! ```text
//! cargo run --release -p windfall-identify --example interval_coverage -- CAMPAIGNS THREADS [METHODS] [--seed S]
//! ```
//!
//! Each campaign is one impact on its own fruit, recorded as an instrument writes
//! it (encoder phases, volts with coloured noise, a clock that knows nothing of
//! the impact), cut out with a threshold of 1 N, and fitted with velocity, onset
//! and zero of the displacement free. Prints a Markdown table for each
//! instrument, and the ranks of the truth among draws of the posterior. "left out"
//! counts impacts that have no contact, no fit, or one that does not determine k.

#![allow(clippy::print_stdout, clippy::unwrap_used)]

#[path = "shared/pendulum.rs"]
mod pendulum;

use pendulum::{Bench, arguments, bench, on_threads, recorded, rig};
use windfall_contact::expression::parse_law;
use windfall_contact::laws::kind::LawKind;
use windfall_distribution::tail::chi_squared_upper;
use windfall_identify::fit::interval::{IntervalDetail, IntervalMethod, IntervalOptions};
use windfall_identify::fit::problem::{FitOptions, Known, LawProblem, NoiseModel, Prior};
use windfall_identify::fit::result::{Fit, fit_impact};
use windfall_signal::impact::Impact;
use windfall_signal::noise::gaussian::{noise_source, normal, uniform};

/// Median law: the rubber half-ball of the 2003 pendulum study.
const MEDIAN: [f64; 2] = [394_931.0, 681.0];
/// Spread between fruit of ln k and ln c.
const SPREAD: [f64; 2] = [0.2, 0.3];
/// Impact velocities; m/s.
const VELOCITIES: (f64, f64) = (0.2, 0.5);
/// Draws of the posterior that are ranked: every fourth of a thousand.
const RANKED: usize = 250;
/// Bins of the histogram of ranks.
const BINS: usize = 20;

fn benches() -> [Bench; 3] {
    [
        bench(
            "360,000 counts a revolution, force noise 1 N, white",
            360_000.0,
            1.0,
            0.0,
        ),
        bench(
            "360,000 counts a revolution, force noise 1 N, persistence 0.8",
            360_000.0,
            1.0,
            0.8,
        ),
        bench(
            "20,000 counts a revolution, force noise 0.3 N, persistence 0.9",
            20_000.0,
            0.3,
            0.9,
        ),
    ]
}

/// One recorded impact with the law that made it.
struct Made {
    impact: Impact,
    truth: [f64; 2],
}

fn made(bench: &Bench, seed: u64) -> Option<Made> {
    let mut source = noise_source(seed, 1000);
    let truth = [0, 1].map(|i| MEDIAN[i] * (SPREAD[i] * normal(&mut source)).exp());
    let velocity = VELOCITIES.0 + (VELOCITIES.1 - VELOCITIES.0) * uniform(&mut source);
    let law = LawKind::KuwabaraKono.with_parameters(&truth).ok()?;
    Some(Made {
        impact: recorded(bench, &law, velocity, seed)?,
        truth,
    })
}

fn fit(made: &Made, method: IntervalMethod, noise: NoiseModel, seed: u64) -> Option<Fit> {
    let mut problem = LawProblem::from_expression(&parse_law("kuwabara-kono").unwrap());
    if method == IntervalMethod::Posterior {
        // Normal, with the moments of the log-normal distribution that the truth is drawn from.
        let known = [0, 1].map(|i| {
            let square = SPREAD[i] * SPREAD[i];
            let mean = MEDIAN[i] * (0.5 * square).exp();
            Known {
                name: ["k", "c"][i].to_owned(),
                prior: Some(Prior {
                    mean,
                    sd: mean * square.exp_m1().sqrt(),
                }),
                range: (f64::NEG_INFINITY, f64::INFINITY),
            }
        });
        problem.known = known.to_vec();
    }
    let options = FitOptions {
        noise,
        intervals: IntervalOptions {
            method,
            seed,
            draws: 250,
            ..IntervalOptions::default()
        },
        ..FitOptions::default()
    };
    let fit = fit_impact(&made.impact, &rig(), &problem, &options).ok()?;
    // What `windfall fit` leaves out of every mean: no convergence, and "undetermined".
    let k = &fit.parameters[0];
    (fit.converged && DEVIATIONS * k.sd <= k.value).then_some(fit)
}

/// Deviations by which k of a fit that counts differs from zero.
const DEVIATIONS: f64 = 3.0;

/// Free motion beside the contact, in contact durations, of the comparison with less of it.
const SHORT_FLIGHT: f64 = 0.2;

/// What one campaign says about k and c.
#[derive(Clone, Copy)]
struct Told {
    error: [f64; 2],
    sd: [f64; 2],
    covered: [bool; 2],
    above: [bool; 2],
    rank: [usize; 2],
}

fn told(made: &Made, fit: &Fit) -> Told {
    let of = |i: usize| &fit.parameters[i];
    let rank = |i: usize| match &fit.intervals {
        IntervalDetail::Posterior(found) => {
            let step = found.draws[i].len() / RANKED;
            let thinned = found.draws[i].iter().step_by(step).take(RANKED);
            thinned.filter(|d| **d < made.truth[i]).count()
        }
        _ => 0,
    };
    Told {
        error: [0, 1].map(|i| (of(i).value / made.truth[i]).ln()),
        sd: [0, 1].map(|i| of(i).sd / of(i).value),
        covered: [0, 1].map(|i| of(i).low <= made.truth[i] && made.truth[i] <= of(i).high),
        above: [0, 1].map(|i| made.truth[i] > of(i).high),
        rank: [0, 1].map(rank),
    }
}

fn campaigns(
    bench: &Bench,
    (begin, count): (u64, u64),
    threads: u64,
    method: IntervalMethod,
    noise: NoiseModel,
) -> Vec<Option<Told>> {
    on_threads(count, threads, |seed| {
        let made = made(bench, begin + seed + 1)?;
        let fit = fit(&made, method, noise, seed)?;
        Some(told(&made, &fit))
    })
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, n) = values.fold((0.0, 0), |(s, n), v| (s + v, n + 1));
    sum / f64::from(n)
}

fn row(name: &str, all: &[Option<Told>]) {
    let good: Vec<Told> = all.iter().flatten().copied().collect();
    let n = good.len() as f64;
    print!("| {name} |");
    for i in [0, 1] {
        let bias = mean(good.iter().map(|t| t.error[i]));
        let spread = mean(good.iter().map(|t| (t.error[i] - bias).powi(2))).sqrt();
        let covered = mean(good.iter().map(|t| f64::from(u8::from(t.covered[i]))));
        let above = mean(good.iter().map(|t| f64::from(u8::from(t.above[i]))));
        print!(
            " {:+.3} % ({:+.1} se) | {:.3} % | {:.3} % | {:.1} % | {:.1}/{:.1} % |",
            100.0 * bias,
            bias / (spread / n.sqrt()),
            100.0 * spread,
            100.0 * mean(good.iter().map(|t| t.sd[i])),
            100.0 * covered,
            100.0 * (1.0 - covered - above),
            100.0 * above,
        );
    }
    println!(" {} |", all.len() - good.len());
}

fn ranks(all: &[Option<Told>]) {
    for (i, name) in ["k", "c"].iter().enumerate() {
        let mut bins = [0usize; BINS];
        let good: Vec<&Told> = all.iter().flatten().collect();
        for told in &good {
            bins[(told.rank[i] * BINS / (RANKED + 1)).min(BINS - 1)] += 1;
        }
        let expected = good.len() as f64 / BINS as f64;
        let square: f64 = bins
            .iter()
            .map(|b| (*b as f64 - expected).powi(2) / expected)
            .sum();
        let p = chi_squared_upper(square, (BINS - 1) as f64);
        println!(
            "ranks of {name}: {bins:?}, chi-square {square:.1} on {}, p = {p:.3}",
            BINS - 1
        );
    }
}

fn main() {
    let (arguments, begin) = arguments();
    let mut arguments = arguments.into_iter();
    let count: u64 = arguments.next().map_or(200, |a| a.parse().unwrap());
    let threads: u64 = arguments.next().map_or(1, |a| a.parse().unwrap());
    let only = arguments.next();
    let methods = [
        (
            "asymptotic",
            IntervalMethod::Asymptotic,
            NoiseModel::Automatic,
        ),
        ("profile", IntervalMethod::Profile, NoiseModel::Automatic),
        (
            "bootstrap",
            IntervalMethod::Bootstrap,
            NoiseModel::Automatic,
        ),
        (
            "posterior",
            IntervalMethod::Posterior,
            NoiseModel::Automatic,
        ),
        (
            "asymptotic, white noise assumed",
            IntervalMethod::Asymptotic,
            NoiseModel::White,
        ),
    ];
    for bench in benches() {
        println!("\n{count} campaigns: {}\n", bench.name);
        println!(
            "| intervals | k: bias | spread | reported | coverage | missed below/above | c: bias | spread | reported | coverage | missed below/above | left out |"
        );
        println!("|---|---|---|---|---|---|---|---|---|---|---|---|");
        let mut posterior = Vec::new();
        for (name, method, noise) in methods {
            if only
                .as_ref()
                .is_some_and(|only| !only.split(',').any(|o| name.starts_with(o)))
            {
                continue;
            }
            let all = campaigns(&bench, (begin, count), threads, method, noise);
            row(name, &all);
            if method == IntervalMethod::Asymptotic && noise == NoiseModel::Automatic {
                let short = bench.clone().with_flight(SHORT_FLIGHT);
                let all = campaigns(&short, (begin, count), threads, method, noise);
                row("asymptotic, a fifth of the contact on either side", &all);
            }
            if method == IntervalMethod::Posterior {
                posterior = all;
            }
        }
        println!();
        if !posterior.is_empty() {
            ranks(&posterior);
        }
    }
}
