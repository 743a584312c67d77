//! Times one Kuwabara-Kono fit of a pendulum impact, for the comparison with
//! other programs: `fit_speed DATA.csv REFERENCE.txt STARTS.csv SEEDS.bin`.
//!
//! SEEDS.bin holds the times and a hundred recordings of displacement, rate and
//! force, as doubles. Prints one JSON line each for two and four free parameters, with the keys
//! that the other programs print.

#![allow(clippy::print_stdout, clippy::print_stderr)]

use rustix::time::{ClockId, clock_gettime};
use std::time::Instant;
use windfall_contact::law::EndRule;
use windfall_contact::laws::kuwabara_kono::KuwabaraKono;
use windfall_identify::fit::batch::{BatchProblem, Room, minimise_batch};
use windfall_identify::fit::estimator::{
    Coordinate, Estimator, FORESIGHT, FreeParameter, Setting, Target, Values,
};
use windfall_identify::fit::model::Sampling;
use windfall_identify::rig::kind::{Pendulum, Rig};
use windfall_identify::rig::motion::Motion;
use windfall_identify::samples::SampleGroup;
use windfall_numerics::least_squares::{Minimum, Options};
use windfall_numerics::ode::step::Tolerance;

const ARM: f64 = 0.505;
const FITS: usize = 2001;
/// Impacts of the batch, and how often it is timed.
const BATCH: usize = 1000;
const BATCH_ROUNDS: usize = 5;
/// Gain per residual that may be lost to a kink.
const ROUGHNESS: f64 = 0.01;

fn numbers(path: &str) -> Vec<Vec<f64>> {
    let text = std::fs::read_to_string(path).expect("readable file");
    text.lines()
        .filter_map(|line| {
            line.split([',', ' '])
                .map(|cell| cell.trim().parse().ok())
                .collect()
        })
        .collect()
}

/// Processor time of this process; s.
fn processor_seconds() -> f64 {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

fn group(times: &[f64], x: &[f64], v: &[f64], force: &[f64]) -> SampleGroup {
    let weight = |q: &[f64]| q.len() as f64 / q.iter().map(|a| a.abs()).sum::<f64>();
    SampleGroup::new(
        times,
        [
            Some((x, weight(x))),
            Some((v, weight(v))),
            Some((force, weight(force))),
            None,
        ],
    )
}

/// The recordings of other noise seeds.
fn seeds(path: &str, samples: usize) -> Vec<SampleGroup> {
    let bytes = std::fs::read(path).expect("readable file");
    let number = |chunk: &[u8]| f64::from_le_bytes(chunk.try_into().expect("eight bytes"));
    let numbers: Vec<f64> = bytes.chunks_exact(8).map(number).collect();
    let (times, recordings) = numbers.split_at(samples);
    let recording = |r: &[f64]| {
        let (x, rest) = r.split_at(samples);
        let (v, force) = rest.split_at(samples);
        group(times, x, v, force)
    };
    let recordings = recordings.chunks_exact(3 * samples);
    recordings.map(recording).collect()
}

fn parameter(target: Target, coordinate: Coordinate, lower: f64, upper: f64) -> FreeParameter {
    FreeParameter {
        prior: None,
        target,
        coordinate,
        lower,
        upper,
    }
}

/// Kuwabara-Kono fits whose motions have `W` columns.
type Fit<'a, const W: usize, const P: usize> = BatchProblem<'a, KuwabaraKono, 2, W, P>;

/// k, c, velocity and onset.
fn free() -> [FreeParameter; 4] {
    [
        parameter(Target::Law(0), Coordinate::Logarithm, 1e-3, 1e12),
        parameter(Target::Law(1), Coordinate::Logarithm, 1e-6, 1e9),
        parameter(Target::InitialVelocity, Coordinate::Logarithm, 0.01, 5.0),
        parameter(Target::Onset, Coordinate::Linear(1e-3), -1e-3, 1e-3),
    ]
}

/// The fit from (k, c) with the first `P` of the free parameters.
fn problem<'a, const W: usize, const P: usize>(
    group: &'a SampleGroup,
    free: &'a [FreeParameter],
    [k, c]: [f64; 2],
) -> Fit<'a, W, P> {
    let rig = Rig::Pendulum(Pendulum {
        inertia: 0.2 * ARM * ARM,
        arm: ARM,
        mass: 0.3,
        centre_of_mass: ARM,
        gravity: 9.81,
    });
    let motion = Motion::from(&rig);
    let setting = Setting {
        motion,
        end: EndRule::ForceZero,
        tolerance: Tolerance {
            relative: 1e-8,
            absolute: [1e-12 * ARM, 1e-10 * ARM],
        },
        tied_velocity: None,
        sampling: Sampling::Instantaneous,
    };
    let four = P == 4;
    let base = Values {
        law: [k, c],
        velocity: if four { 0.34 } else { 0.35 },
        inverse_mass: motion.inverse_mass,
        onset: if four { 0.02e-3 } else { 0.0 },
        offset: 0.0,
    };
    BatchProblem {
        estimator: Estimator::new(
            KuwabaraKono { k, c },
            setting,
            std::slice::from_ref(group),
            &free[..P],
            base,
        ),
        from: None,
        options: Options {
            largest_step: [2.0; P],
            // As fits of campaigns stop at the kinks that samples leave at separation.
            roughness: ROUGHNESS / (3 * group.times().len()) as f64,
            foresight: FORESIGHT,
            ..Options::default()
        },
    }
}

/// Fit from (k, c) with the first `P` of k, c, velocity and onset free.
fn fit<const P: usize>(group: &SampleGroup, k: f64, c: f64) -> (Values<2>, usize) {
    let free = free();
    let mut one = problem::<4, P>(group, &free, [k, c]);
    let minimum = one.estimator.minimise(&one.options);
    (
        one.estimator.values(&minimum.parameters),
        minimum.evaluations,
    )
}

/// Rate of fits of [`BATCH`] recordings side by side, by processor time: the median
/// of some rounds; and how many end elsewhere than single fits do.
fn measure_batch<const W: usize, const P: usize>(seeds: &[SampleGroup]) -> (f64, usize) {
    let free = free();
    let mut minima = vec![Minimum::NONE; BATCH];
    let mut room = Room::of(&seeds[..1]);
    let mut spent = [0.0; BATCH_ROUNDS];
    for spent in &mut spent {
        let begin = processor_seconds();
        let recordings = seeds.iter().cycle().take(BATCH);
        let problems: Vec<Fit<W, P>> = recordings
            .map(|group| problem(group, &free, [2e5, 300.0]))
            .collect();
        minimise_batch(std::hint::black_box(&problems), &mut minima, &mut room);
        std::hint::black_box(&minima);
        *spent = processor_seconds() - begin;
    }
    spent.sort_by(f64::total_cmp);
    let elsewhere = |(group, found): (&SampleGroup, &Minimum<P>)| {
        let mut alone = problem::<4, P>(group, &free, [2e5, 300.0]);
        alone.estimator.minimise(&alone.options).parameters != found.parameters
    };
    let different = seeds.iter().cycle().zip(&minima).take(seeds.len());
    let different = different.filter(|pair| elsewhere(*pair)).count();
    (BATCH as f64 / spent[BATCH_ROUNDS / 2], different)
}

/// Processor seconds (median) and wall seconds (least) over many fits of one
/// recording, and the rate of fits of other seeds one after the other.
fn measure<const W: usize, const P: usize>(
    variant: &str,
    group: &SampleGroup,
    reference: &[f64],
    starts: &[Vec<f64>],
    seeds: &[SampleGroup],
) {
    let once = |group| std::hint::black_box(fit::<P>(std::hint::black_box(group), 2e5, 300.0));
    let mut shortest = f64::INFINITY;
    let mut seconds: Vec<f64> = (0..FITS)
        .map(|_| {
            let (begin, spent) = (Instant::now(), processor_seconds());
            once(group);
            let spent = processor_seconds() - spent;
            shortest = shortest.min(begin.elapsed().as_secs_f64());
            spent
        })
        .collect();
    seconds.sort_by(f64::total_cmp);
    let begin = processor_seconds();
    for group in seeds {
        std::hint::black_box(once(group));
    }
    let rate = seeds.len() as f64 / (processor_seconds() - begin);
    let (batch_rate, different) = measure_batch::<W, P>(seeds);
    let (values, evaluations) = fit::<P>(group, 2e5, 300.0);
    let deviation = |values: &Values<2>| {
        let k = (values.law[0] / reference[0] - 1.0).abs();
        let c = (values.law[1] / reference[1] - 1.0).abs();
        k.max(c)
    };
    let from_starts: Vec<f64> = starts
        .iter()
        .map(|s| deviation(&fit::<P>(group, s[0], s[1]).0))
        .collect();
    let good = from_starts.iter().filter(|d| **d < 1e-3).count();
    let worst = from_starts.iter().fold(0.0, |a: f64, b| a.max(*b));
    println!(
        "{{\"tool\":\"windfall\",\"variant\":\"{variant}\",\"seconds_per_fit\":{:e},\"wall_min\":{:e},\"nfev\":{evaluations},\"k\":{:.10},\"c\":{:.10},\"v0\":{:.10},\"t0\":{:e},\"deviation\":{:e},\"worst_deviation_from_starts\":{worst:e},\"robust\":\"{good}/{}\",\"n\":{},\"batch100_fits_per_s\":{rate:.1},\"batch1000_fits_per_s\":{batch_rate:.1},\"batch1000_different\":{different}}}",
        seconds[FITS / 2],
        shortest,
        values.law[0],
        values.law[1],
        values.velocity,
        values.onset,
        deviation(&values),
        starts.len(),
        group.times().len(),
    );
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [data, reference, starts, batch] = arguments.as_slice() else {
        eprintln!("usage: fit_speed DATA.csv REFERENCE.txt STARTS.csv SEEDS.bin");
        std::process::exit(2);
    };
    let rows = numbers(data);
    let column = |i: usize| rows.iter().map(|row| row[i]).collect::<Vec<f64>>();
    let (x, v, force) = (column(1), column(2), column(3));
    let group = group(&column(0), &x, &v, &force);
    let seeds = seeds(batch, x.len());
    let reference = &numbers(reference)[0];
    let starts = numbers(starts);
    measure::<3, 2>("2p", &group, &reference[..2], &starts, &seeds);
    measure::<4, 4>("4p", &group, &reference[2..], &starts, &seeds);
}
