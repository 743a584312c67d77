//! Canonical and ridge analysis, desirability, cross-validation and selection against
//! what they are by definition.

#![allow(clippy::unwrap_used)]

use windfall_mixed::weights::Weights;
use windfall_statistics::model::anova::lack_of_fit;
use windfall_statistics::model::contrast::Contrast;
use windfall_statistics::model::formula::formula;
use windfall_statistics::model::linear_model::fit_linear;
use windfall_statistics::model::model_rows::{ModelRows, model_rows};
use windfall_statistics::model::reduced::reduce;
use windfall_statistics::model::selection::{Criterion, Direction, SelectionOptions, select};
use windfall_statistics::residuals::cross_validation::{Parts, cross_validate};
use windfall_statistics::surface::analysis::{Surface, fit_surface};
use windfall_statistics::surface::canonical::{Shape, canonical, ridge};
use windfall_statistics::surface::coding::FactorCoding;
use windfall_statistics::surface::desirability::{Goal, Wanted, desirability, overall};
use windfall_statistics::surface::terms::surface_terms;
use windfall_statistics::table::{Cells, Column, Table};

/// A quadratic in two factors, sampled on a grid of five levels each with nothing
/// but rounding, so that the fit is the polynomial itself.
fn quadratic(value: fn(f64, f64) -> f64) -> Surface {
    let levels = [-1.0, -0.5, 0.0, 0.5, 1.0];
    let points = levels.iter().flat_map(|a| levels.iter().map(|b| (*a, *b)));
    let points: Vec<(f64, f64)> = points.collect();
    let coded = vec![
        points.iter().map(|p| p.0).collect(),
        points.iter().map(|p| p.1).collect(),
    ];
    let y: Vec<f64> = points.iter().map(|p| value(p.0, p.1)).collect();
    let factors = ["a", "b"].map(|name| FactorCoding {
        name: name.to_owned(),
        centre: 5.0,
        half: 2.0,
    });
    let names = ["a", "b"].map(str::to_owned);
    let terms = surface_terms("quadratic", &names).unwrap();
    fit_surface(&factors, &terms, &coded, &y, 0.95).unwrap()
}

/// 7 - (a - 0.3)² - 3 (b + 0.2)²: top at (0.3, -0.2), curvatures -3 and -1.
#[test]
fn closed_form_stationary_points() {
    let top = quadratic(|a, b| 7.0 - (a - 0.3).powi(2) - 3.0 * (b + 0.2).powi(2));
    let found = canonical(&top).unwrap();
    assert_eq!(found.shape, Shape::Maximum);
    for (value, expected) in found.stationary.iter().zip([0.3, -0.2]) {
        assert!((value - expected).abs() < 1e-12);
    }
    for (value, expected) in found.eigenvalues.iter().zip([-3.0, -1.0]) {
        assert!((value - expected).abs() < 1e-12);
    }
    assert!((found.value - 7.0).abs() < 1e-12);
    assert!((found.directions[0][1] - 1.0).abs() < 1e-9);
    let shape = |surface: &Surface| canonical(surface).unwrap().shape;
    assert_eq!(
        shape(&quadratic(|a, b| a * a + 2.0 * b * b)),
        Shape::Minimum
    );
    assert_eq!(shape(&quadratic(|a, b| a * b)), Shape::Saddle);
    assert_eq!(
        shape(&quadratic(|a, b| 2.0 * a - (a + b).powi(2))),
        Shape::Ridge
    );
    assert!(canonical(&quadratic(|a, b| a + b)).is_none());
}

/// On each circle no other point is higher (lower), by trying 100,000 of them.
#[test]
fn reference_ridges_by_trying_all_points() {
    let surfaces: [fn(f64, f64) -> f64; 4] = [
        |a, b| 7.0 - (a - 0.3).powi(2) - 3.0 * (b + 0.2).powi(2) + a * b,
        |a, b| a * b + 0.3 * a,
        // No slope along the steepest curvature: two points are equally good.
        |a, b| 2.0 * a * a - b * b + 0.5 * b,
        |a, b| a * a + b * b,
    ];
    for value in surfaces {
        let surface = quadratic(value);
        for maximum in [true, false] {
            let sign = if maximum { 1.0 } else { -1.0 };
            for point in ridge(&surface, &[0.0, 0.3, 1.0, 2.0], maximum) {
                let radius = point.point.iter().map(|v| v * v).sum::<f64>().sqrt();
                assert!(
                    (radius - point.radius).abs() < 1e-6,
                    "{radius} {}",
                    point.radius
                );
                let best = (0..100_000)
                    .map(|step| {
                        let angle = f64::from(step) * std::f64::consts::TAU / 1e5;
                        sign * value(point.radius * angle.cos(), point.radius * angle.sin())
                    })
                    .fold(f64::NEG_INFINITY, f64::max);
                assert!(
                    (sign * point.value - best).abs() < 1e-6,
                    "{} {best}",
                    point.value
                );
            }
        }
    }
}

/// Derringer & Suich 1980, eqs. 1-4.
#[test]
fn closed_form_desirability() {
    let goal = |wanted, weight: f64| Goal {
        wanted,
        low: 10.0,
        high: 20.0,
        weight_low: weight,
        weight_high: weight,
        importance: 1.0,
    };
    let target = goal(Wanted::Target(12.0), 2.0);
    for (value, expected) in [
        (9.0, 0.0),
        (11.0, 0.25),
        (12.0, 1.0),
        (16.0, 0.25),
        (20.0, 0.0),
    ] {
        assert!((desirability(&target, value) - expected).abs() < 1e-15);
    }
    let large = goal(Wanted::Maximum, 0.5);
    let small = goal(Wanted::Minimum, 1.0);
    assert_eq!(desirability(&large, 12.5), 0.5);
    assert_eq!(
        (desirability(&large, 25.0), desirability(&small, 25.0)),
        (1.0, 0.0)
    );
    assert_eq!(desirability(&small, 12.5), 0.75);
    let mut important = small;
    important.importance = 3.0;
    // (0.5 · 0.75³)^(1/4)
    let both = overall(&[large, important], &[12.5, 12.5]);
    assert!((both - (0.5 * 0.75_f64.powi(3)).powf(0.25)).abs() < 1e-15);
    assert_eq!(overall(&[large, target], &[12.5, 9.0]), 0.0);
}

fn rows() -> ModelRows {
    let wave = |i: usize, speed: f64| (i as f64 * speed).sin();
    let column = |name: &str, values: Vec<f64>| Column {
        name: name.to_owned(),
        cells: Cells::Numbers(values.into()),
    };
    let count = 40;
    let a: Vec<f64> = (0..count).map(|i| wave(i, 0.7)).collect();
    let b: Vec<f64> = (0..count).map(|i| wave(i, 1.9)).collect();
    let c: Vec<f64> = (0..count).map(|i| wave(i, 2.6)).collect();
    let y = (0..count)
        .map(|i| 2.0 * a[i] + a[i] * b[i] + 0.2 * wave(i, 5.3))
        .collect();
    let table = Table {
        columns: vec![
            column("y", y),
            column("a", a),
            column("b", b),
            column("c", c),
        ],
    };
    let formula = formula("y ~ (a + b + c)^2", &[]).unwrap();
    model_rows(&formula, &table, Contrast::Treatment, &[]).unwrap()
}

/// Three runs at one setting of which one is written -0: variance of 1, 2, 3 about 2.
#[test]
fn closed_form_pure_error_of_repeated_settings() {
    let settings = nalgebra::DMatrix::from_row_slice(5, 1, &[0.0, -0.0, 0.0, 1.0, 2.0]);
    let found = lack_of_fit(
        &settings,
        &[0],
        (&[1.0, 2.0, 3.0, 9.0, 5.0], &Weights::default()),
        (30.0, 3),
    );
    let found = found.unwrap().unwrap();
    assert_eq!((found.pure_error.ss, found.pure_error.df), (2.0, 2.0));
    assert_eq!(
        (found.lack.ss, found.lack.df, found.lack.f),
        (28.0, 1.0, 28.0)
    );
}

/// With as many parts as rows, cross-validation is PRESS.
#[test]
fn closed_form_leaving_out_one_by_one() {
    let rows = rows();
    let terms: Vec<usize> = (0..rows.frame.terms.len()).collect();
    let wanted: Vec<usize> = (0..rows.x.ncols()).collect();
    let fit = fit_linear(&rows.frame, &rows.x, &rows.y, &wanted, 0.95).unwrap();
    let press = fit.quality(&rows.y).press;
    let found = {
        let parts = Parts {
            folds: 40,
            seed: 3,
            units: None,
            weights: None,
        };
        cross_validate(&rows.frame, &rows.x, &rows.y, &terms, None, parts)
            .unwrap()
            .unwrap()
    };
    assert!((found.rms.powi(2) * 40.0 / press - 1.0).abs() < 1e-10);
}

/// The way to the best criterion ends where no single change improves it, and with
/// hierarchy a product keeps its factors.
#[test]
fn converges_selection_in_every_direction() {
    let rows = rows();
    let reduced = reduce(&rows.x, &rows.y);
    let named = |terms: &[usize]| -> Vec<&str> {
        terms
            .iter()
            .map(|t| rows.frame.terms[*t].name.as_str())
            .collect()
    };
    for direction in [Direction::Backward, Direction::Forward, Direction::Stepwise] {
        for criterion in [
            Criterion::Aicc,
            Criterion::Bic,
            Criterion::Probability {
                enter: 0.01,
                remove: 0.02,
            },
        ] {
            let options = |hierarchy| SelectionOptions {
                direction,
                criterion,
                hierarchy,
            };
            let free = select(&rows.frame, &reduced, &options(false));
            let names = named(&free.terms);
            assert!(
                names.contains(&"a") && names.contains(&"a:b"),
                "{direction:?} {names:?}"
            );
            let kept = select(&rows.frame, &reduced, &options(true));
            let names = named(&kept.terms);
            assert!(names.contains(&"a"));
            // Forward the product cannot enter before b, which alone explains nothing.
            assert_eq!(names.contains(&"a:b"), direction == Direction::Backward);
            assert!(!names.contains(&"a:b") || names.contains(&"b"), "{names:?}");
        }
    }
    let options = SelectionOptions {
        direction: Direction::Backward,
        criterion: Criterion::Bic,
        hierarchy: false,
    };
    let found = select(&rows.frame, &reduced, &options);
    let steps: Vec<f64> = found.steps.iter().map(|s| s.criterion.unwrap()).collect();
    assert!(!steps.is_empty() && steps.windows(2).all(|pair| pair[1] < pair[0]));
}
