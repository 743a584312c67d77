//! Populations estimated from likelihoods whose answers other programs know
//! (`bench/population_reference.R`).

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use windfall_identify::population::fit::fit_population;
use windfall_identify::population::model::{
    Approximation, Covariate, Expansion, Likelihood, PopulationData, PopulationOptions, Structure,
};

fn rows(text: &str) -> Vec<Vec<f64>> {
    let numbers = |line: &str| line.split(',').map(|cell| cell.parse().unwrap()).collect();
    text.lines().skip(1).map(numbers).collect()
}

fn reference(text: &str, name: &str) -> Vec<f64> {
    let named = text.lines().filter_map(|line| line.split_once(' '));
    let own = named.filter(|(key, _)| *key == name);
    own.map(|(_, value)| value.parse().unwrap()).collect()
}

fn names(list: &[&str]) -> Vec<String> {
    list.iter().map(|name| (*name).to_owned()).collect()
}

fn column(rows: &[Vec<f64>], index: usize) -> Vec<f64> {
    rows.iter().map(|row| row[index]).collect()
}

fn fruit(rows: &[Vec<f64>]) -> Vec<usize> {
    rows.iter().map(|row| row[0] as usize).collect()
}

fn near(found: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        let error = (found - expected).abs() / expected.abs().max(1e-300);
        assert!(error < tolerance, "{found} is not {expected} ({error:e})");
    }
}

/// A normal observation of two parameters.
fn normal(row: &[f64], at: &[f64]) -> Expansion {
    let (z, [v11, v12, v22]) = (&row[2..4], [row[4], row[5], row[6]]);
    let determinant = v11 * v22 - v12 * v12;
    let h = [
        [v22 / determinant, -v12 / determinant],
        [-v12 / determinant, v11 / determinant],
    ];
    let r = [z[0] - at[0], z[1] - at[1]];
    let gradient = h.map(|row| row[0] * r[0] + row[1] * r[1]);
    Expansion {
        value: -0.5 * (gradient[0] * r[0] + gradient[1] * r[1]),
        gradient: gradient.to_vec(),
        curvature: h.map(|row| row.to_vec()).to_vec(),
    }
}

/// Full likelihood against nlme::lme of the whitened rows, restricted one
/// against dense matrices in R: fixed effects, their standard errors, both
/// covariance matrices, the likelihood, a profile interval.
#[test]
fn reference_linear_mixed_model() {
    let rows = rows(include_str!("population/linear.csv"));
    let data = PopulationData {
        parameters: names(&["k", "c"]),
        fruit: fruit(&rows),
        covariates: vec![Covariate {
            name: "x".to_owned(),
            centre: 0.0,
            values: column(&rows, 1),
        }],
    };
    let starts: Vec<Vec<f64>> = rows.iter().map(|row| row[2..4].to_vec()).collect();
    let expand = |points: &[Vec<f64>]| -> Vec<Option<Expansion>> {
        let own = rows.iter().zip(points);
        own.map(|(row, at)| Some(normal(row, at))).collect()
    };
    let expected = include_str!("population/linear.txt");
    for (likelihood, name) in [(Likelihood::Restricted, "REML"), (Likelihood::Full, "ML")] {
        let options = PopulationOptions {
            likelihood,
            ..PopulationOptions::default()
        };
        let fit = fit_population(&data, &starts, &expand, &options).unwrap();
        println!("{:?} {:?} {:?}", fit.effects, fit.between, fit.within);
        let known = |what: &str| reference(expected, &format!("{name}.{what}"));
        let effects: Vec<f64> = fit.effects.iter().map(|e| e.value).collect();
        near(&effects, &known("effect"), 1e-5);
        let triangle = |m: &[Vec<f64>]| [m[0][0], m[0][1], m[1][1]];
        near(&triangle(&fit.between.covariance), &known("between"), 1e-3);
        near(&triangle(&fit.within.covariance), &known("within"), 1e-3);
        near(&[fit.log_likelihood], &known("loglik"), 1e-6);
        if likelihood == Likelihood::Restricted {
            let errors: Vec<f64> = fit.effects.iter().map(|e| e.se).collect();
            near(&errors, &known("se"), 1e-4);
            let (low, high) = fit.between.sds[0].interval.unwrap();
            near(&[low, high], &known("profile"), 1e-3);
        }
        assert!(fit.converged && fit.not_quadratic.abs() < 1e-9);
    }
}

/// Counts of a Poisson distribution: likelihoods far from normal, without a
/// maximum where the count is zero. Against lme4::glmer: its Laplace
/// approximation, and its quadrature as the truth that both approach.
#[test]
fn reference_laplace_of_counts() {
    let rows = rows(include_str!("population/poisson.csv"));
    let data = PopulationData {
        parameters: names(&["rate"]),
        fruit: fruit(&rows),
        covariates: vec![Covariate {
            name: "x".to_owned(),
            centre: 0.0,
            values: column(&rows, 1),
        }],
    };
    let starts: Vec<Vec<f64>> = rows.iter().map(|row| vec![(row[2] + 0.5).ln()]).collect();
    let expand = |points: &[Vec<f64>]| -> Vec<Option<Expansion>> {
        let own = rows.iter().zip(points);
        own.map(|(row, at)| {
            let mean = at[0].exp();
            Some(Expansion {
                value: row[2] * at[0] - mean,
                gradient: vec![row[2] - mean],
                curvature: vec![vec![mean]],
            })
        })
        .collect()
    };
    let options = PopulationOptions {
        likelihood: Likelihood::Full,
        within: Structure::Zero,
        ..PopulationOptions::default()
    };
    let fit = fit_population(&data, &starts, &expand, &options).unwrap();
    println!("{:?} {:?}", fit.effects, fit.between);
    let expected = include_str!("population/poisson.txt");
    let effects: Vec<f64> = fit.effects.iter().map(|e| e.value).collect();
    near(&effects, &reference(expected, "points1.effect"), 1e-3);
    near(
        &[fit.between.sds[0].value],
        &reference(expected, "points1.sd"),
        1e-3,
    );
}

/// Logistic growth of trees, nonlinear in three parameters: every tree is one
/// likelihood. Against nlme::nlme.
#[test]
fn reference_growth_of_trees() {
    let rows = rows(include_str!("population/growth.csv"));
    let trees: Vec<Vec<&Vec<f64>>> = (0..5)
        .map(|tree| {
            rows.iter()
                .filter(|row| row[0] == f64::from(tree))
                .collect()
        })
        .collect();
    let data = PopulationData {
        parameters: names(&["asymptote", "midpoint", "scale"]),
        fruit: (0..5).collect(),
        covariates: Vec::new(),
    };
    let expand = |points: &[Vec<f64>]| -> Vec<Option<Expansion>> {
        trees
            .iter()
            .zip(points)
            .map(|(tree, at)| Some(growth(tree, at)))
            .collect()
    };
    let options = PopulationOptions {
        likelihood: Likelihood::Full,
        between: Structure::Diagonal,
        approximation: Approximation::FirstOrder,
        ..PopulationOptions::default()
    };
    let start = vec![190.0_f64.ln(), 720.0_f64.ln(), 350.0_f64.ln()];
    let fit = fit_population(&data, &vec![start; 5], &expand, &options).unwrap();
    println!("{:?} {:?} {:?}", fit.effects, fit.between, fit.findings);
    let expected = include_str!("population/growth.txt");
    for (effect, known) in fit.effects.iter().zip(reference(expected, "effect")) {
        assert!(
            (effect.value - known).abs() < 1e-3 * effect.se,
            "{effect:?} {known}"
        );
    }
    let known = reference(expected, "sd");
    let found = fit
        .between
        .sds
        .iter()
        .map(|sd| sd.value)
        .collect::<Vec<_>>();
    near(&[found[0], found[2]], &[known[0], known[2]], 1e-3);
    assert!(found[1] < 1e-3 && known[1] < 1e-3);
}

/// Circumference exp(a) / (1 + exp((exp(m) − age)/exp(s))), standard deviation
/// 8 mm.
fn growth(tree: &[&Vec<f64>], at: &[f64]) -> Expansion {
    let mut out = Expansion {
        value: 0.0,
        gradient: vec![0.0; 3],
        curvature: vec![vec![0.0; 3]; 3],
    };
    for row in tree {
        let (top, middle, scale) = (at[0].exp(), at[1].exp(), at[2].exp());
        let exponent = (middle - row[1]) / scale;
        let share = 1.0 / (1.0 + exponent.exp());
        let by_exponent = -top * share * (1.0 - share);
        let jacobian = [
            top * share,
            by_exponent * middle / scale,
            -by_exponent * exponent,
        ];
        let residual = row[2] - top * share;
        out.value -= residual * residual / 128.0;
        for i in 0..3 {
            out.gradient[i] += residual * jacobian[i] / 64.0;
            for j in 0..3 {
                out.curvature[i][j] += jacobian[i] * jacobian[j] / 64.0;
            }
        }
    }
    out
}
