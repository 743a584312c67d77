//! Noise models and intervals of a fit.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use crate::rubber;

use nalgebra::{DMatrix, DVector};
use rubber::{C, K, impact, impact_of, rig};
use windfall_contact::expression::parse_law;
use windfall_contact::law::EndRule;
use windfall_contact::laws::kuwabara_kono::KuwabaraKono;
use windfall_identify::fit::interval::{IntervalDetail, IntervalMethod, IntervalOptions};
use windfall_identify::fit::model::{Columns, Model, Sampling};
use windfall_identify::fit::problem::{FitOptions, LawProblem, NoiseModel, Quantities, Treatment};
use windfall_identify::fit::residual::{Rows, evaluate};
use windfall_identify::fit::result::{Fit, fit_impact};
use windfall_identify::rig::impact_event::{ImpactEvent, Seeds};
use windfall_identify::rig::motion::Motion;
use windfall_identify::samples::{Quantity, SampleGroup};
use windfall_numerics::ode::step::Tolerance;
use windfall_numerics::real::Lanes;
use windfall_signal::impact::Impact;
use windfall_signal::instrument::pendulum_instrument;
use windfall_signal::noise::gaussian::{noise_source, normal};

fn fit(impact: &Impact, law: &str, options: &FitOptions) -> Fit {
    let problem = LawProblem::from_expression(&parse_law(law).unwrap());
    fit_impact(impact, &rig(), &problem, options).unwrap()
}

fn with(method: IntervalMethod) -> FitOptions {
    FitOptions {
        intervals: IntervalOptions {
            method,
            replicates: 400,
            draws: 500,
            ..IntervalOptions::default()
        },
        ..FitOptions::default()
    }
}

/// The impact with force noise of persistence 0.8.
fn coloured(seed: u64) -> Impact {
    let mut instrument = pendulum_instrument();
    if let Some(force) = &mut instrument.force {
        force.persistence = 0.8;
    }
    impact_of(&instrument, seed)
}

/// Cost, gradient and normal matrix of persistent noise with an unknown zero,
/// streamed, against rᵀ Σ⁻¹ r of the whole covariance matrix; with flight before
/// contact long enough for several pieces.
#[test]
fn closed_form_generalised_least_squares() {
    let (n, persistence, noise, zero_sd) = (237, 0.83, 0.7, 0.4);
    let mut source = noise_source(5, 0);
    let times: Vec<f64> = (0..n).map(|i| -3e-2 + 2e-4 * f64::from(i)).collect();
    let samples: Vec<f64> = times.iter().map(|_| 5.0 + normal(&mut source)).collect();
    let mut values = [None; 4];
    values[Quantity::Force as usize] = Some((samples.as_slice(), 1.0 / (noise * noise)));
    let group = SampleGroup::new(&times, values)
        .with_persistence(Quantity::Force, persistence)
        .with_zero_sd(Quantity::Force, zero_sd);
    let mut seeds = Seeds::<2, 4>::NONE;
    seeds.parameters = [Lanes::unit(1, K), Lanes::unit(2, C)];
    seeds.velocity = Lanes::unit(3, 0.388);
    let model = Model::<_, 2, 4, 4> {
        event: ImpactEvent {
            law: KuwabaraKono { k: K, c: C },
            motion: Motion::from(&rig()),
            velocity: 0.388,
            end: EndRule::ForceZero,
            seeds,
            tolerance: Tolerance {
                relative: 1e-9,
                absolute: [1e-13, 1e-11],
            },
        },
        onset: 1e-5,
        offset: 0.0,
        columns: Columns {
            lanes: [1, 2, 3, 0],
            onset: [0.0, 0.0, 0.0, 1e-3],
            offset: [0.0; 4],
        },
        sampling: Sampling::Instantaneous,
    };
    let mut rows = Rows::default();
    let found = evaluate(&model, &[group], Some(&mut rows)).unwrap();
    let residuals = &rows.residuals[0][Quantity::Force as usize];
    let jacobian = &rows.jacobian[0][Quantity::Force as usize];
    assert_eq!(residuals.len(), n as usize);
    let size = residuals.len();
    let covariance = DMatrix::from_fn(size, size, |i, j| {
        let lag = i32::try_from(i.abs_diff(j)).unwrap();
        noise * noise * f64::powi(persistence, lag) + zero_sd * zero_sd
    });
    let inverse = covariance.try_inverse().unwrap();
    let r = DVector::from_row_slice(residuals);
    let j = DMatrix::from_row_slice(size, 4, jacobian);
    let weighted = &inverse * &r;
    let cost = r.dot(&weighted);
    assert!(
        (found.cost / cost - 1.0).abs() < 1e-9,
        "{} {cost}",
        found.cost
    );
    let gradient = j.transpose() * weighted;
    let normal = j.transpose() * &inverse * &j;
    for a in 0..4 {
        let scale = normal[(a, a)].sqrt() * cost.sqrt();
        assert!(
            (found.gradient[a] - gradient[a]).abs() < 1e-9 * scale,
            "{a}"
        );
        for b in 0..4 {
            let scale = (normal[(a, a)] * normal[(b, b)]).sqrt();
            let error = found.normal[a][b] - normal[(a, b)];
            assert!(error.abs() < 1e-9 * scale, "{a} {b} {error:e}");
        }
    }
}

/// Persistent noise is found in the recording, and told for what it is.
#[test]
fn recovers_the_noise_of_the_force() {
    let mut found = Vec::new();
    for seed in 0..20 {
        let fit = fit(&coloured(seed), "kuwabara-kono", &FitOptions::default());
        let force = fit
            .quantities
            .iter()
            .find(|q| q.quantity == Quantity::Force);
        found.push(force.unwrap().persistence);
    }
    let mean = found.iter().sum::<f64>() / found.len() as f64;
    // One baseline of 600 samples tells it to √((1 − φ²)/n) = 0.024.
    assert!((mean - 0.8).abs() < 4.0 * 0.024 / 20f64.sqrt(), "{mean}");
}

/// Intervals from force alone, its noise persistent: those that take it for white
/// are too narrow.
#[test]
fn recovers_at_the_stated_rate_in_coloured_noise() {
    let covered = |noise: NoiseModel| {
        let options = FitOptions {
            quantities: Quantities::of(&[Quantity::Displacement, Quantity::Force]),
            noise,
            ..FitOptions::default()
        };
        let mut inside = [0, 0];
        for seed in 0..60 {
            let fit = fit(&coloured(100 + seed), "kuwabara-kono", &options);
            for (count, (estimate, truth)) in
                inside.iter_mut().zip(fit.parameters.iter().zip([K, C]))
            {
                *count += usize::from(estimate.low <= truth && truth <= estimate.high);
            }
        }
        inside
    };
    let modelled = covered(NoiseModel::Automatic);
    // 57 expected; fewer than 52 happen once in 70 times for each.
    assert!(modelled.iter().all(|n| *n >= 52), "{modelled:?}");
}

/// With as many samples as here the four ways nearly agree, where the noise of the displacement
/// is known.
#[test]
fn converges_all_intervals_to_the_same() {
    let impact = coloured(7);
    let known = |options: FitOptions| FitOptions {
        noise_sd: [Some(2.5e-6), None, None, None],
        ..options
    };
    let reference = fit(&impact, "kuwabara-kono", &known(FitOptions::default()));
    for method in [
        IntervalMethod::Profile,
        IntervalMethod::Bootstrap,
        IntervalMethod::Posterior,
    ] {
        let found = fit(&impact, "kuwabara-kono", &known(with(method)));
        for (one, other) in found.parameters.iter().zip(&reference.parameters) {
            let (width, expected) = (one.high - one.low, other.high - other.low);
            println!("{} {}: {:.3}", method.name(), one.name, width / expected);
            // Quantiles of 400 replicates scatter by 6 %.
            assert!(
                (width / expected - 1.0).abs() < 0.2,
                "{method:?} {one:?} {other:?}"
            );
            assert!(one.low < one.value && one.value < one.high);
        }
    }
}

/// From the edges of a count the four ways agree on average; in single impacts the phases
/// of the edges, which only estimate ± deviation knows, add up or cancel.
#[test]
fn converges_all_intervals_of_edges_on_average() {
    const IMPACTS: u64 = 12;
    for method in [
        IntervalMethod::Profile,
        IntervalMethod::Bootstrap,
        IntervalMethod::Posterior,
    ] {
        let mut ratios = [0.0; 2];
        for seed in 0..IMPACTS {
            let impact = coloured(7 + seed);
            let reference = fit(&impact, "kuwabara-kono", &FitOptions::default());
            let found = fit(&impact, "kuwabara-kono", &with(method));
            let pairs = found.parameters.iter().zip(&reference.parameters);
            for (ratio, (one, other)) in ratios.iter_mut().zip(pairs) {
                let own = (one.high - one.low) / (other.high - other.low);
                assert!((0.3..3.0).contains(&own), "{method:?} {one:?} {other:?}");
                assert!(one.low < one.value && one.value < one.high);
                *ratio += own / IMPACTS as f64;
            }
        }
        println!("{}: {ratios:.3?}", method.name());
        // Quantiles of 400 replicates scatter by 6 %.
        assert!(ratios.iter().all(|r| (r - 1.0).abs() < 0.2), "{ratios:?}");
    }
}

/// The posterior's chains agree, and are the same for the same seed.
#[test]
fn repeats_a_posterior_that_mixes() {
    let impact = coloured(8);
    let found = fit(&impact, "kuwabara-kono", &with(IntervalMethod::Posterior));
    let again = fit(&impact, "kuwabara-kono", &with(IntervalMethod::Posterior));
    assert_eq!(found.intervals, again.intervals);
    let IntervalDetail::Posterior(posterior) = &found.intervals else {
        panic!("no posterior");
    };
    assert_eq!(posterior.divergences, 0);
    assert_eq!(posterior.draws[0].len(), 2000);
    for mixing in &posterior.mixing {
        assert!(
            mixing.r_hat < 1.01 && mixing.bulk_draws > 400.0,
            "{mixing:?}"
        );
    }
    let codes: Vec<_> = found.findings.iter().map(|f| f.code()).collect();
    assert!(!codes.contains(&"not-mixed") && !codes.contains(&"divergences"));
}

#[test]
fn repeats_a_bootstrap() {
    let impact = coloured(9);
    let one = fit(&impact, "kuwabara-kono", &with(IntervalMethod::Bootstrap));
    let other = fit(&impact, "kuwabara-kono", &with(IntervalMethod::Bootstrap));
    assert_eq!(one.intervals, other.intervals);
    let IntervalDetail::Bootstrap(bootstrap) = &one.intervals else {
        panic!("no bootstrap");
    };
    assert_eq!((bootstrap.replicates, bootstrap.failed), (400, 0));
}

/// With velocity free and force alone, the data hardly tell exponents apart: no
/// silent number, whatever the method.
#[test]
fn rejects_intervals_of_what_the_data_cannot_tell() {
    let mut problem = LawProblem::from_expression(&parse_law("power-law").unwrap());
    problem.free = vec![true; 4];
    let options = |method| FitOptions {
        quantities: Quantities::of(&[Quantity::Force]),
        initial_velocity: Treatment::Free,
        ..with(method)
    };
    for method in [IntervalMethod::Profile, IntervalMethod::Posterior] {
        let found = fit_impact(&impact(3), &rig(), &problem, &options(method)).unwrap();
        let codes: Vec<_> = found.findings.iter().map(|f| f.code()).collect();
        println!("{} {codes:?}", method.name());
        let warned = [
            "open-interval",
            "not-mixed",
            "divergences",
            "intervals-asymptotic",
            "correlated",
            "at-bound",
            "singular",
        ];
        assert!(codes.iter().any(|code| warned.contains(code)), "{codes:?}");
        for estimate in found.parameters.iter().chain(&found.nuisances) {
            assert!(
                !estimate.low.is_nan() && !estimate.high.is_nan(),
                "{estimate:?}"
            );
        }
    }
}
