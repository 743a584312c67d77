//! Optimal designs against known optima.

#![allow(clippy::unwrap_used)]

use windfall_design::error::DesignError;
use windfall_design::exchange::Criterion;
use windfall_design::kind::{Design, Factor, Point, evenly};
use windfall_design::model::{DesignModel, extreme_points, model_row, region_points};
use windfall_design::optimal::{Candidates, OptimalOptions, optimal};
use windfall_design::quality::{DesignQuality, design_quality};

fn factors(count: usize) -> Vec<Factor> {
    let name = |i: usize| Factor::between(&format!("x{i}"), "", 0.0, 1.0).unwrap();
    (0..count).map(name).collect()
}

/// A design on `levels` even levels of each factor.
fn make(
    factors: &[Factor],
    model: DesignModel,
    levels: usize,
    options: &OptimalOptions,
) -> Result<Design, DesignError> {
    let levels: Vec<Vec<f64>> = factors
        .iter()
        .map(|f| {
            if f.categories.is_empty() {
                evenly(levels)
            } else {
                f.ends()
            }
        })
        .collect();
    let row = |x: &[f64]| model_row(factors, model, x);
    optimal(
        factors.to_vec(),
        &row,
        Candidates::Levels(&levels),
        &[],
        options,
    )
}

fn quality(design: &Design, model: DesignModel) -> DesignQuality {
    let row = |x: &[f64]| model_row(&design.factors, model, x);
    let rows: Vec<Vec<f64>> = design.runs.iter().map(|run| row(&run.coded)).collect();
    let region = region_points(&design.factors).into_iter();
    let region: Vec<_> = region
        .map(|(weight, point)| (weight, row(&point)))
        .collect();
    design_quality(&rows, &region).unwrap()
}

fn runs(runs: usize) -> OptimalOptions {
    OptimalOptions {
        runs,
        ..OptimalOptions::default()
    }
}

/// The D-optimal quadratic in one factor has −1, 0, 1 equally often (Smith 1918;
/// Atkinson, Donev and Tobias 2007, section 11.2).
#[test]
fn reference_quadratic_in_one_factor() {
    let design = make(&factors(1), DesignModel::Quadratic, 201, &runs(9)).unwrap();
    let levels: Vec<f64> = design.runs.iter().map(|run| run.coded[0]).collect();
    assert_eq!(levels, [-1.0, -1.0, -1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0]);
}

/// Box and Draper (1971), Technometrics 13, 731-742: six runs for the quadratic
/// in two factors, (−1, −1), (1, −1), (−1, 1), (−δ, −δ), (1, 3δ), (3δ, 1) with
/// δ = (4 − √13)/3 = 0.1315; |X'X|/6⁶ = 5.74e-3.
#[test]
fn reference_six_runs_of_two_factors() {
    let options = OptimalOptions {
        starts: Some(15),
        ..runs(6)
    };
    let design = make(&factors(2), DesignModel::Quadratic, 801, &options).unwrap();
    let found = quality(&design, DesignModel::Quadratic)
        .d_efficiency
        .powi(6);
    let delta = (4.0 - 13_f64.sqrt()) / 3.0;
    let published = [
        [-1.0, -1.0],
        [1.0, -1.0],
        [-1.0, 1.0],
        [-delta, -delta],
        [1.0, 3.0 * delta],
        [3.0 * delta, 1.0],
    ];
    let model = |x: &[f64; 2]| model_row(&factors(2), DesignModel::Quadratic, x);
    let rows: Vec<Vec<f64>> = published.iter().map(model).collect();
    let best = design_quality(&rows, &[]).unwrap().d_efficiency.powi(6);
    assert!((best - 5.74e-3).abs() < 5e-6, "{best}");
    assert!((found / best - 1.0).abs() < 1e-5, "{found} {best}");
}

/// The D-optimal measure for the quadratic in two factors puts 0.1458 on each
/// corner, 0.0802 on each middle of an edge and 0.0962 on the centre (Atkinson,
/// Donev and Tobias 2007, table 12.1), |M| = 0.01143; no exact design is above.
/// The best of 104 runs has 0.0114099137, by enumeration of all numbers from 14
/// to 16 at corners and 7 to 10 at edges (NumPy).
#[test]
fn reference_quadratic_in_two_factors() {
    let design = make(&factors(2), DesignModel::Quadratic, 3, &runs(104)).unwrap();
    let determinant = quality(&design, DesignModel::Quadratic)
        .d_efficiency
        .powi(6);
    let on = |zeros: usize| {
        let with = design.runs.iter();
        with.filter(|run| run.coded.iter().filter(|x| **x == 0.0).count() == zeros)
            .count()
    };
    // 104 runs: 60.7, 33.4 and 10.0.
    let counts = [on(0), on(1), on(2)];
    assert!(determinant < 0.011_430);
    assert!(
        (determinant / 0.011_409_913_696_8 - 1.0).abs() < 1e-9,
        "{determinant}"
    );
    for (found, expected) in counts.iter().zip([60.7, 33.4, 10.0]) {
        assert!((*found as f64 - expected).abs() < 1.5, "{counts:?}");
    }
}

/// For main effects and interactions of three factors the factorial is best of
/// eight runs: D-efficiency 1, all leverages p/n.
#[test]
fn closed_form_factorial_is_optimal() {
    for criterion in [Criterion::D, Criterion::I] {
        let options = OptimalOptions {
            criterion,
            ..runs(8)
        };
        let design = make(&factors(3), DesignModel::Interactions, 2, &options).unwrap();
        let found = quality(&design, DesignModel::Interactions);
        assert!((found.d_efficiency - 1.0).abs() < 1e-12);
        assert!((found.max_leverage - 7.0 / 8.0).abs() < 1e-12);
        // 1/8 of 1 + 3 · 1/3 + 3 · 1/9, the mean of f'f.
        assert!((found.mean_variance - (7.0 / 3.0) / 8.0).abs() < 1e-12);
    }
}

/// The I-optimal quadratic in one factor puts 1/4, 1/2, 1/4 on −1, 0, 1
/// (Studden 1977): four runs.
#[test]
fn reference_i_optimal_quadratic_in_one_factor() {
    let options = OptimalOptions {
        criterion: Criterion::I,
        ..runs(8)
    };
    let design = make(&factors(1), DesignModel::Quadratic, 3, &options).unwrap();
    let levels: Vec<f64> = design.runs.iter().map(|run| run.coded[0]).collect();
    assert_eq!(levels, [-1.0, -1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0]);
    // 4/n times the mean of a quadratic form known in closed form: 8/15 · 4/n.
    let variance = quality(&design, DesignModel::Quadratic).mean_variance;
    assert!((8.0 * variance - 32.0 / 15.0).abs() < 1e-12, "{variance}");
}

/// Each criterion is better by its own measure, and a list of all points gives
/// what levels give.
#[test]
fn closed_form_each_criterion_serves_itself() {
    let three = factors(3);
    let d = make(&three, DesignModel::Quadratic, 3, &runs(16)).unwrap();
    let options = OptimalOptions {
        criterion: Criterion::I,
        ..runs(16)
    };
    let i = make(&three, DesignModel::Quadratic, 3, &options).unwrap();
    let (d, i) = (
        quality(&d, DesignModel::Quadratic),
        quality(&i, DesignModel::Quadratic),
    );
    assert!(d.d_efficiency > i.d_efficiency + 1e-3, "{d:?} {i:?}");
    assert!(i.mean_variance < d.mean_variance - 1e-3);
    let grid: Vec<Vec<f64>> = (0..27)
        .map(|n| {
            [n % 3, n / 3 % 3, n / 9]
                .map(|l| f64::from(l) - 1.0)
                .to_vec()
        })
        .collect();
    let row = |x: &[f64]| model_row(&three, DesignModel::Quadratic, x);
    let listed = optimal(
        three.clone(),
        &row,
        Candidates::Points(&grid),
        &[],
        &runs(16),
    )
    .unwrap();
    let listed = quality(&listed, DesignModel::Quadratic);
    assert!((listed.d_efficiency / d.d_efficiency - 1.0).abs() < 1e-9);
}

/// Four runs missing from a factorial are what is added to the other four.
#[test]
fn recovers_the_missing_half() {
    let three = factors(3);
    let half: Vec<Vec<f64>> = (0..8)
        .map(|n| {
            [n & 1, n >> 1 & 1, n >> 2]
                .map(|b| f64::from(2 * b - 1))
                .to_vec()
        })
        .filter(|x: &Vec<f64>| x.iter().product::<f64>() > 0.0)
        .collect();
    let row = |x: &[f64]| model_row(&three, DesignModel::Interactions, x);
    let levels = vec![evenly(2); 3];
    let found = optimal(
        three.clone(),
        &row,
        Candidates::Levels(&levels),
        &half,
        &runs(4),
    )
    .unwrap();
    let old = found
        .runs
        .iter()
        .filter(|run| run.point == Point::Existing && run.block == 1);
    assert_eq!(old.count(), 4);
    let new: Vec<f64> = found.runs[4..]
        .iter()
        .map(|r| r.coded.iter().product())
        .collect();
    assert_eq!(new, [-1.0; 4]);
}

#[test]
fn closed_form_categories_are_balanced() {
    let names = ["Fuji", "Gala", "Elstar"].map(str::to_owned);
    let mut factors = factors(1);
    factors.push(Factor::of_categories("variety", &names).unwrap());
    let design = make(&factors, DesignModel::Interactions, 2, &runs(12)).unwrap();
    for place in 0..3 {
        for end in [-1.0, 1.0] {
            let here = design.runs.iter().filter(|run| {
                run.coded[0] == end && factors[1].category_place(run.coded[1]) == Some(place)
            });
            assert_eq!(here.count(), 2);
        }
    }
}

#[test]
fn repeats_with_the_seed_on_any_number_of_threads() {
    let of = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| make(&factors(3), DesignModel::Quadratic, 5, &runs(12)).unwrap())
    };
    assert_eq!(of(1), of(4));
}

#[test]
fn rejects_what_has_no_optimum() {
    let few = make(&factors(2), DesignModel::Quadratic, 3, &runs(5)).unwrap_err();
    assert!(matches!(
        few,
        DesignError::RunsTooFew {
            runs: 5,
            least: 6,
            ..
        }
    ));
    let singular = make(&factors(2), DesignModel::Quadratic, 2, &runs(8)).unwrap_err();
    assert_eq!(singular, DesignError::ModelSingular { runs: 8, terms: 6 });
    let two = factors(2);
    let row = |x: &[f64]| model_row(&two, DesignModel::Linear, x);
    let short = [vec![0.0, 1.0], vec![1.0]];
    let error = optimal(two.clone(), &row, Candidates::Points(&short), &[], &runs(4)).unwrap_err();
    assert_eq!(
        error,
        DesignError::PointLength {
            point: 2,
            found: 1,
            expected: 2
        }
    );
    let undefined = |x: &[f64]| vec![1.0, x[0].ln()];
    let levels = vec![evenly(3); 2];
    let error = optimal(
        two.clone(),
        &undefined,
        Candidates::Levels(&levels),
        &[],
        &runs(4),
    )
    .unwrap_err();
    assert!(matches!(error, DesignError::ModelUndefined { .. }));
}

/// Figures of the 2^2 factorial for main effects: variance (1 + x² + y²)/4, 3/4 at
/// the corners and 5/12 on average; and the same from lists with corners.
#[test]
fn closed_form_variance_of_a_factorial() {
    let two = factors(2);
    let row = |x: &[f64]| model_row(&two, DesignModel::Linear, x);
    let corners = extreme_points(&two)
        .into_iter()
        .filter(|x| x.iter().all(|v| *v != 0.0));
    let rows: Vec<Vec<f64>> = corners.map(|x| row(&x)).collect();
    assert_eq!(rows.len(), 4);
    let region = region_points(&two).into_iter();
    let region = region.chain(extreme_points(&two).into_iter().map(|x| (0.0, x)));
    let region: Vec<_> = region.map(|(weight, x)| (weight, row(&x))).collect();
    let found = design_quality(&rows[..], &region).unwrap();
    assert!((found.mean_variance - 5.0 / 12.0).abs() < 1e-14);
    assert!((found.max_variance - 0.75).abs() < 1e-14);
    assert!(
        found
            .variances
            .iter()
            .all(|variance| (variance - 0.25).abs() < 1e-14)
    );
}
