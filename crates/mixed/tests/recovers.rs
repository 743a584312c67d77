//! What the right model changes for the apple study's design, by simulation: the
//! numbers of `docs/guide/src/mixed_models.md`.

#![allow(clippy::unwrap_used)]

use nalgebra::{DMatrix, DVector};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{RngCore, SeedableRng};
use statrs::distribution::{ContinuousCDF, Normal, StudentsT};
use windfall_mixed::coefficient::Coefficient;
use windfall_mixed::fit::{MixedMethod, MixedOptions, fit_mixed};
use windfall_mixed::fit_levels::fit_mixed_levels;
use windfall_mixed::inference::{coefficient_tests, variance_uncertainty};
use windfall_mixed::kenward_roger::{kenward_roger, kenward_roger_tests};
use windfall_mixed::profile::profile_variances;
use windfall_mixed::residual_levels::ResidualLevels;
use windfall_mixed::term::random_intercept;

const STUDIES: usize = 1000;
const PROFILED: usize = 400;
/// Intercept, velocity, radius, acoustic stiffness: k in kN/m^1.5, near the study's
/// Golden Delicious; stiffness has no effect.
const TRUE: [f64; 4] = [700.0, -330.0, 285.0, 0.0];
const BETWEEN: f64 = 40.0;
const WITHIN: f64 = 20.0;

fn normal(random: &mut ChaCha8Rng) -> f64 {
    let uniform = ((random.next_u64() >> 11) as f64 + 0.5) / (1u64 << 53) as f64;
    Normal::standard().inverse_cdf(uniform)
}

/// 20 fruit at 0.1, 0.2, 0.27 and 0.34 m/s, 10 at 0.5 and 10 at 0.7.
fn design() -> Vec<(usize, f64)> {
    let repeated = (0..20).flat_map(|fruit| [0.1, 0.2, 0.27, 0.34].map(|v| (fruit, v)));
    let fast = (20..40).map(|fruit| (fruit, if fruit < 30 { 0.5 } else { 0.7 }));
    repeated.chain(fast).collect()
}

struct Study {
    y: Vec<f64>,
    x: DMatrix<f64>,
    fruit: Vec<usize>,
}

fn study(random: &mut ChaCha8Rng) -> Study {
    let design = design();
    let radius: Vec<f64> = (0..40).map(|_| 0.05 + 0.01 * normal(random)).collect();
    let stiffness: Vec<f64> = (0..40).map(|_| 25.0 + 3.0 * normal(random)).collect();
    let own: Vec<f64> = (0..40).map(|_| BETWEEN * normal(random)).collect();
    let x = DMatrix::from_fn(design.len(), 4, |row, column| {
        let (fruit, velocity) = design[row];
        [1.0, velocity, radius[fruit], stiffness[fruit]][column]
    });
    let expected = &x * DVector::from_column_slice(&TRUE);
    let rows = design.iter().zip(expected.iter());
    let y = rows.map(|((fruit, _), mean)| mean + own[*fruit] + WITHIN * normal(random));
    Study {
        y: y.collect(),
        fruit: design.iter().map(|(fruit, _)| *fruit).collect(),
        x,
    }
}

/// Estimate, lower and upper end of each coefficient.
type Intervals = Vec<[f64; 3]>;

/// Ordinary least squares, as if all impacts were on different fruit.
fn ordinary(study: &Study) -> Intervals {
    let y = DVector::from_column_slice(&study.y);
    let inverse = study.x.tr_mul(&study.x).try_inverse().unwrap();
    let beta = &inverse * study.x.tr_mul(&y);
    let df = (study.y.len() - 4) as f64;
    let variance = (&y - &study.x * &beta).norm_squared() / df;
    let t = StudentsT::new(0.0, 1.0, df).unwrap().inverse_cdf(0.975);
    let ends = |k: usize| {
        let half = t * (variance * inverse[(k, k)]).sqrt();
        [beta[k], beta[k] - half, beta[k] + half]
    };
    (0..4).map(ends).collect()
}

fn intervals(tests: &[Coefficient]) -> Intervals {
    tests
        .iter()
        .map(|test| [test.estimate, test.low, test.high])
        .collect()
}

/// Share of studies whose interval holds the truth, and mean half width.
#[derive(Clone, Copy, Default)]
struct Tally {
    held: f64,
    half: f64,
}

fn count(tally: &mut [Tally; 4], intervals: &Intervals) {
    for (k, [_, low, high]) in intervals.iter().enumerate() {
        let held = (*low..=*high).contains(&TRUE[k]);
        tally[k].held += f64::from(u8::from(held)) / STUDIES as f64;
        tally[k].half += (high - low) / 2.0 / STUDIES as f64;
    }
}

#[test]
fn recovers_the_stated_coverage_in_the_apple_studys_design() {
    let mut random = ChaCha8Rng::seed_from_u64(2013);
    let mut tallies = [[Tally::default(); 4]; 3];
    let names = ["intercept", "velocity", "radius", "stiffness"].map(str::to_owned);
    let fruit: Vec<String> = (0..40).map(|fruit| fruit.to_string()).collect();
    for _ in 0..STUDIES {
        let study = study(&mut random);
        let term = random_intercept("fruit", &study.fruit, &fruit);
        let fit = fit_mixed(
            &study.y,
            &study.x,
            &names,
            &[term],
            &MixedOptions::default(),
        )
        .unwrap();
        let satterthwaite = coefficient_tests(&fit, &variance_uncertainty(&fit).unwrap(), 0.95);
        let adjusted = kenward_roger(&fit).unwrap();
        count(&mut tallies[0], &ordinary(&study));
        count(&mut tallies[1], &intervals(&satterthwaite));
        count(
            &mut tallies[2],
            &intervals(&kenward_roger_tests(&fit, &adjusted, 0.95)),
        );
    }
    let methods = ["ordinary", "Satterthwaite", "Kenward-Roger"];
    for (method, tally) in methods.iter().zip(&tallies) {
        for (name, tally) in names.iter().zip(tally) {
            println!(
                "{method}, {name}: {:.1} %, ± {:.1}",
                100.0 * tally.held,
                tally.half
            );
        }
    }
    // 95 % of 1000 studies, three standard errors: 2.1 %
    for tally in tallies[1..].iter().flatten() {
        assert!((tally.held - 0.95).abs() < 0.021, "{}", tally.held);
    }
    assert!(tallies[0][2].held < 0.8 && tallies[0][3].held < 0.8);
    assert!(tallies[0][1].half > 1.15 * tallies[1][1].half && tallies[0][1].held < 0.93);
}

#[test]
fn recovers_profile_intervals_of_standard_deviations_near_their_rate() {
    let mut random = ChaCha8Rng::seed_from_u64(7);
    let names = ["intercept", "velocity", "radius", "stiffness"].map(str::to_owned);
    let fruit: Vec<String> = (0..40).map(|fruit| fruit.to_string()).collect();
    let likelihoods = [MixedMethod::MaximumLikelihood, MixedMethod::Reml];
    let mut held = [[0.0; 2]; 2];
    for _ in 0..PROFILED {
        let study = study(&mut random);
        let term = random_intercept("fruit", &study.fruit, &fruit);
        let fit = fit_mixed(
            &study.y,
            &study.x,
            &names,
            &[term],
            &MixedOptions::default(),
        )
        .unwrap();
        for (held, likelihood) in held.iter_mut().zip(likelihoods) {
            let profiles = profile_variances(&fit, likelihood, 0.95).unwrap();
            for (k, truth) in [BETWEEN, WITHIN].into_iter().enumerate() {
                let interval = &profiles.intervals[k];
                let inside = (interval.low..=interval.high).contains(&truth);
                held[k] += f64::from(u8::from(inside)) / PROFILED as f64;
            }
        }
    }
    println!("plain, restricted: sd of fruit and residual sd {held:.3?}");
    // three standard errors of 400 studies are 3.3 %; the plain likelihood takes no
    // account of estimated coefficients and stays below its rate
    assert!(
        held[1].iter().all(|share| (share - 0.95).abs() < 0.033),
        "{held:?}"
    );
    assert!(held[0][0] < held[1][0], "{held:?}");
}

/// Two varieties of eight fruit, four impacts on each; impacts of the second scatter four times
/// as much. With one residual variance, intervals of the first variety's line hold the truth too
/// often, and those of the second too seldom.
#[test]
fn recovers_lines_and_variances_of_varieties_that_scatter_differently() {
    const SCATTER: [f64; 2] = [8.0, 32.0];
    let mut random = ChaCha8Rng::seed_from_u64(11);
    let variety: Vec<usize> = (0..64).map(|row| row / 32).collect();
    let fruit: Vec<usize> = (0..64).map(|row| row / 4).collect();
    let group_names: Vec<String> = (0..16).map(|own| own.to_string()).collect();
    let names = ["first", "slope", "second", "its slope"].map(str::to_owned);
    let truth = [700.0, -330.0, 650.0, -300.0];
    let levels = ResidualLevels {
        column: "variety".to_owned(),
        names: vec!["first".to_owned(), "second".to_owned()],
        level: variety.clone(),
    };
    let (mut one, mut adjusted, mut satterthwaite) = ([0.0; 4], [0.0; 4], [0.0; 4]);
    let mut sds = [0.0; 3];
    for study in 0..PROFILED {
        let velocity: Vec<f64> = (0..64)
            .map(|row| 0.1 + 0.2 * (row % 4) as f64 + 0.02 * normal(&mut random))
            .collect();
        let x = DMatrix::from_fn(64, 4, |row, column| {
            let own = f64::from(u8::from(variety[row] == column / 2));
            own * if column % 2 == 0 { 1.0 } else { velocity[row] }
        });
        let between: Vec<f64> = (0..16).map(|_| 20.0 * normal(&mut random)).collect();
        let expected = &x * DVector::from_column_slice(&truth);
        let y = (0..64).map(|row| {
            expected[row] + between[fruit[row]] + SCATTER[variety[row]] * normal(&mut random)
        });
        let y: Vec<f64> = y.collect();
        let terms = [random_intercept("fruit", &fruit, &group_names)];
        let options = MixedOptions::default();
        let tally = |held: &mut [f64; 4], tests: &[Coefficient]| {
            for (place, own) in tests.iter().enumerate() {
                let inside = (own.low..=own.high).contains(&truth[place]);
                held[place] += f64::from(u8::from(inside)) / PROFILED as f64;
            }
        };
        let fit = fit_mixed(&y, &x, &names, &terms, &options).unwrap();
        let tests = kenward_roger_tests(&fit, &kenward_roger(&fit).unwrap(), 0.95);
        tally(&mut one, &tests);
        let fit = fit_mixed_levels((&y, &levels), &x, &names, &terms, &options).unwrap();
        assert!(!fit.findings.iter().any(|own| own.code() != "singular"));
        let tests = kenward_roger_tests(&fit, &kenward_roger(&fit).unwrap(), 0.95);
        tally(&mut adjusted, &tests);
        let tests = coefficient_tests(&fit, &variance_uncertainty(&fit).unwrap(), 0.95);
        tally(&mut satterthwaite, &tests);
        if study % 2 > 0 {
            continue;
        }
        let profiles = profile_variances(&fit, MixedMethod::Reml, 0.95).unwrap();
        for (place, truth) in [20.0, SCATTER[0], SCATTER[1]].into_iter().enumerate() {
            let own = &profiles.intervals[place];
            let inside = (own.low..=own.high).contains(&truth);
            sds[place] += 2.0 * f64::from(u8::from(inside)) / PROFILED as f64;
        }
    }
    println!("one variance {one:.3?}, by level {adjusted:.3?} {satterthwaite:.3?}, sds {sds:.3?}");
    // three standard errors of 400 studies are 3.3 %, of 200 4.7 %
    let near = |held: &[f64], by: f64| held.iter().all(|own| (own - 0.95).abs() < by);
    assert!(near(&adjusted, 0.033) && near(&satterthwaite, 0.033) && near(&sds, 0.047));
    assert!(one[1] > 0.98 && one[3] < 0.91, "{one:?}");
}
