//! The posterior of a population against integrals over a grid.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use windfall_identify::error::Error;
use windfall_identify::population::fit::fit_population;
use windfall_identify::population::model::{
    Covariate, Expansion, PopulationData, PopulationFit, PopulationOptions, Structure,
};
use windfall_identify::population::posterior::{
    PopulationPosterior, PosteriorRange, population_posterior,
};
use windfall_identify::sampler::Drawing;
use windfall_signal::noise::gaussian::{noise_source, normal};

const DRAWING: Drawing = Drawing {
    chains: 4,
    draws: 1500,
    seed: 1,
};

/// Observations `z` of each impact's parameters with variance `noise`.
fn expansions(z: &[Vec<f64>], noise: f64, points: &[Vec<f64>]) -> Vec<Option<Expansion>> {
    let one = |(z, at): (&Vec<f64>, &Vec<f64>)| {
        let gradient: Vec<f64> = z.iter().zip(at).map(|(z, at)| (z - at) / noise).collect();
        let size = z.len();
        let curvature = |i: usize| {
            let mut row = vec![0.0; size];
            row[i] = 1.0 / noise;
            row
        };
        Some(Expansion {
            value: -0.5 * noise * gradient.iter().map(|g| g * g).sum::<f64>(),
            curvature: (0..size).map(curvature).collect(),
            gradient,
        })
    };
    z.iter().zip(points).map(one).collect()
}

fn both(data: &PopulationData, z: &[Vec<f64>], noise: f64) -> (PopulationFit, PopulationPosterior) {
    let expand = |points: &[Vec<f64>]| expansions(z, noise, points);
    let options = PopulationOptions::default();
    let fit = fit_population(data, z, &expand, &options).unwrap();
    let posterior =
        population_posterior(data, &fit, &expand, &options, &DRAWING, &|_, _| {}).unwrap();
    for range in posterior.ranges() {
        assert!(range.mixing.r_hat < 1.02, "{range:?}");
        assert!(range.mixing.tail_draws > 300.0, "{range:?}");
    }
    (fit, posterior)
}

/// Quantiles of values with weights.
fn quantiles(mut weighted: Vec<(f64, f64)>) -> [f64; 3] {
    weighted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let total: f64 = weighted.iter().map(|w| w.1).sum();
    [0.5, 0.025, 0.975].map(|level| {
        let mut sum = 0.0;
        let at = weighted.iter().find(|w| {
            sum += w.1;
            sum >= level * total
        });
        at.unwrap().0
    })
}

/// Within a tenth of the interval's half width.
fn near(what: &str, found: &PosteriorRange, [median, low, high]: [f64; 3]) {
    let tolerance = 0.1 * (high - low) / 2.0;
    println!("{what}: {found:?}, expected {median} ({low} to {high})");
    assert!((found.median - median).abs() < tolerance, "{what}");
    assert!((found.low - low).abs() < 1.5 * tolerance, "{what}");
    assert!((found.high - high).abs() < 1.5 * tolerance, "{what}");
}

/// Levels that vary by more than the noise, and by less or not at all.
#[test]
fn converges_to_the_integral_of_two_levels() {
    for spread in [[0.15, 0.05], [0.15, 0.0], [0.01, 0.01]] {
        println!("{spread:?}");
        two_levels(spread);
    }
}

/// One parameter, as many impacts of each fruit: the likelihood of both standard
/// deviations is that of two sums of squares.
fn two_levels(spread: [f64; 2]) {
    let (fruits, each, noise) = (10, 4, 0.02_f64.powi(2));
    let mut source = noise_source(3, 0);
    let (mut z, mut fruit) = (Vec::new(), Vec::new());
    for i in 0..fruits {
        let own = 12.0 + spread[0] * normal(&mut source);
        for _ in 0..each {
            let within = (spread[1].powi(2) + noise).sqrt();
            z.push(vec![own + within * normal(&mut source)]);
            fruit.push(i);
        }
    }
    let data = PopulationData {
        parameters: vec!["k".to_owned()],
        fruit,
        covariates: Vec::new(),
    };
    let (fit, posterior) = both(&data, &z, noise);
    let means: Vec<f64> = z
        .chunks(each)
        .map(|own| own.iter().map(|z| z[0]).sum::<f64>() / each as f64)
        .collect();
    let grand = means.iter().sum::<f64>() / fruits as f64;
    let between: f64 = means.iter().map(|m| (m - grand).powi(2)).sum::<f64>() * each as f64;
    let within: f64 = z
        .chunks(each)
        .zip(&means)
        .flat_map(|(own, mean)| own.iter().map(move |z| (z[0] - mean).powi(2)))
        .sum();
    let (mut sd_between, mut sd_within) = (Vec::new(), Vec::new());
    for i in 0..800 {
        for j in 0..300 {
            let b = spread[0] * 6e-3 * (f64::from(i) + 0.5);
            let w = 4e-4 * (f64::from(j) + 0.5);
            let inner = w * w + noise;
            let outer = inner + each as f64 * b * b;
            let log = -0.5 * ((fruits - 1) as f64 * outer.ln() + between / outer)
                - 0.5 * ((fruits * (each - 1)) as f64 * inner.ln() + within / inner);
            sd_between.push((b, log));
            sd_within.push((w, log));
        }
    }
    let largest = sd_between.iter().map(|p| p.1).fold(f64::MIN, f64::max);
    let weigh = |all: Vec<(f64, f64)>| {
        let weighted = all.into_iter().map(|(v, log)| (v, (log - largest).exp()));
        quantiles(weighted.collect())
    };
    near("between", &posterior.between.sds[0], weigh(sd_between));
    near("within", &posterior.within.sds[0], weigh(sd_within));
    // The estimate lies where the posterior does.
    let effect = &posterior.effects[0];
    assert!((effect.median - fit.effects[0].value).abs() < 0.1 * fit.effects[0].se);
    assert!(posterior.divergences < 30);
}

/// Two parameters, one impact of each fruit: standard deviations and correlation
/// by an integral over all three, under uniform priors.
#[test]
fn converges_to_the_integral_of_a_covariance_matrix() {
    let (fruits, noise) = (25, 0.05_f64.powi(2));
    let mut source = noise_source(7, 0);
    let z: Vec<Vec<f64>> = (0..fruits)
        .map(|_| {
            let (a, b) = (normal(&mut source), normal(&mut source));
            let error = [normal(&mut source), normal(&mut source)].map(|e| 0.05 * e);
            let second = 0.5 * a + 0.75_f64.sqrt() * b;
            vec![12.0 + 0.15 * a + error[0], 6.0 + 0.2 * second + error[1]]
        })
        .collect();
    let data = PopulationData {
        parameters: vec!["k".to_owned(), "c".to_owned()],
        fruit: (0..fruits).collect(),
        covariates: Vec::new(),
    };
    let (_, posterior) = both(&data, &z, noise);
    assert!(posterior.within.sds.is_empty());
    let mean = |a: usize| z.iter().map(|z| z[a]).sum::<f64>() / fruits as f64;
    let centre = [mean(0), mean(1)];
    let product = |a: usize, b: usize| {
        let own = z.iter().map(|z| (z[a] - centre[a]) * (z[b] - centre[b]));
        own.sum::<f64>()
    };
    let scatter = [product(0, 0), product(0, 1), product(1, 1)];
    let mut points = Vec::new();
    for i in 0..100 {
        for j in 0..100 {
            for k in 0..100 {
                let sd = [4e-3, 5e-3]
                    .iter()
                    .zip([i, j])
                    .map(|(step, at)| step * (f64::from(at) + 0.5));
                let sd: Vec<f64> = sd.collect();
                let correlation = -0.99 + 0.02 * f64::from(k);
                let (v1, v2) = (sd[0] * sd[0] + noise, sd[1] * sd[1] + noise);
                let v12 = correlation * sd[0] * sd[1];
                let determinant = v1 * v2 - v12 * v12;
                let trace =
                    (scatter[0] * v2 - 2.0 * scatter[1] * v12 + scatter[2] * v1) / determinant;
                let log = -0.5 * ((fruits - 1) as f64 * determinant.ln() + trace);
                points.push(([sd[0], sd[1], correlation], log));
            }
        }
    }
    let largest = points.iter().map(|p| p.1).fold(f64::MIN, f64::max);
    let expected = |at: usize| {
        let weighted = points.iter().map(|(v, log)| (v[at], (log - largest).exp()));
        quantiles(weighted.collect())
    };
    near("first", &posterior.between.sds[0], expected(0));
    near("second", &posterior.between.sds[1], expected(1));
    near(
        "correlation",
        &posterior.between.correlations[0],
        expected(2),
    );
}

/// The same seed draws the same; a covariate's effect is where least squares put
/// it; fruit that are told not to vary have no posterior.
#[test]
fn repeats_effects_and_rejects_none() {
    let mut source = noise_source(11, 0);
    let (mut z, mut fruit, mut x) = (Vec::new(), Vec::new(), Vec::new());
    for i in 0..12 {
        let own = 0.1 * normal(&mut source);
        for j in 0..3 {
            let along = f64::from(j) - 1.0;
            z.push(vec![5.0 + own - 0.3 * along + 0.04 * normal(&mut source)]);
            fruit.push(i);
            x.push(along);
        }
    }
    let data = PopulationData {
        parameters: vec!["k".to_owned()],
        fruit,
        covariates: vec![Covariate {
            name: "x".to_owned(),
            centre: 0.0,
            values: x.clone(),
        }],
    };
    let (fit, posterior) = both(&data, &z, 1e-4);
    let slope = z.iter().zip(&x).map(|(z, x)| z[0] * x).sum::<f64>() / 24.0;
    let effect = &posterior.effects[1];
    assert!((effect.median - slope).abs() < 0.1 * fit.effects[1].se);
    let width = (effect.high - effect.low) / (fit.effects[1].high - fit.effects[1].low);
    assert!((0.9..1.15).contains(&width), "{width}");
    assert_eq!(both(&data, &z, 1e-4).1, posterior);
    let expand = |points: &[Vec<f64>]| expansions(&z, 1e-4, points);
    let options = PopulationOptions {
        between: Structure::Zero,
        ..PopulationOptions::default()
    };
    let refused = population_posterior(&data, &fit, &expand, &options, &DRAWING, &|_, _| {});
    assert!(matches!(refused, Err(Error::NoPopulation)));
}
