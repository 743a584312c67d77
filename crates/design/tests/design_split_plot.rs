//! Split-plot designs against closed forms and a search of all designs.

use nalgebra::DMatrix;
use windfall_design::error::DesignError;
use windfall_design::exchange::Criterion;
use windfall_design::kind::{Design, Factor, evenly, randomised};
use windfall_design::quality::design_quality;
use windfall_design::split_plot::{SplitPlotOptions, decorrelated, split_plot};

fn factors(count: usize) -> Vec<Factor> {
    let factor = |place: usize| Factor::between(&format!("x{place}"), "", -1.0, 1.0).unwrap();
    (0..count).map(factor).collect()
}

fn options(whole_plots: usize, runs: usize) -> SplitPlotOptions {
    SplitPlotOptions {
        hard: vec![0],
        whole_plots,
        runs,
        ratio: 1.0,
        criterion: Criterion::D,
        starts: None,
        seed: 1,
    }
}

fn interactions(x: &[f64]) -> Vec<f64> {
    vec![1.0, x[0], x[1], x[0] * x[1]]
}

fn quadratic(x: &[f64]) -> Vec<f64> {
    vec![1.0, x[0], x[1], x[0] * x[1], x[0] * x[0], x[1] * x[1]]
}

/// X'V⁻¹X with V = I + ratio ZZ', from the inverse of V itself.
fn information(rows: &[Vec<f64>], plots: &[usize], ratio: f64) -> DMatrix<f64> {
    let count = rows.len();
    let v = DMatrix::from_fn(count, count, |i, j| {
        f64::from(u8::from(i == j)) + ratio * f64::from(u8::from(plots[i] == plots[j]))
    });
    let x = DMatrix::from_fn(count, rows[0].len(), |i, j| rows[i][j]);
    x.transpose() * v.try_inverse().unwrap() * x
}

fn parts(design: &Design, row: fn(&[f64]) -> Vec<f64>) -> (Vec<Vec<f64>>, Vec<usize>) {
    let rows = design.runs.iter().map(|run| row(&run.coded)).collect();
    let plots = design.runs.iter().map(|run| run.whole_plot.unwrap());
    (rows, plots.collect())
}

/// Four whole plots of two runs, each at both levels of the second factor: the terms that change
/// between plots have the variance (1 + 2·ratio)/8, the others 1/8.
#[test]
fn closed_form_two_levels_in_pairs() {
    for ratio in [0.0, 0.5, 1.0, 10.0] {
        let own = SplitPlotOptions {
            ratio,
            ..options(4, 8)
        };
        let levels = vec![evenly(2), evenly(2)];
        let design = split_plot(factors(2), &interactions, &levels, &own).unwrap();
        let (rows, plots) = parts(&design, interactions);
        let inverse = information(&rows, &plots, ratio).try_inverse().unwrap();
        let between = (1.0 + 2.0 * ratio) / 8.0;
        // Without a variance between plots every orthogonal design is as good.
        let wanted = match ratio == 0.0 {
            true => [0.125; 4],
            false => [between, between, 0.125, 0.125],
        };
        for (place, variance) in wanted.iter().enumerate() {
            assert!(
                (inverse[(place, place)] - variance).abs() < 1e-12,
                "{ratio}"
            );
        }
    }
}

/// No design of three whole plots of two runs on three levels is better, of all 3³·3⁶.
#[test]
fn closed_form_no_other_design_is_better() {
    let levels = vec![evenly(3), evenly(3)];
    for (criterion, ratio) in [(Criterion::D, 1.0), (Criterion::D, 0.1)] {
        let own = SplitPlotOptions {
            criterion,
            ratio,
            ..options(3, 6)
        };
        let design = split_plot(factors(2), &quadratic, &levels, &own).unwrap();
        let (rows, plots) = parts(&design, quadratic);
        let found = information(&rows, &plots, ratio).determinant();
        let mut best: f64 = 0.0;
        for code in 0..3_usize.pow(9) {
            let digit = |place: u32| ((code / 3_usize.pow(place)) % 3) as f64 - 1.0;
            let point = |run: u32| quadratic(&[digit(run / 2), digit(3 + run)]);
            let rows: Vec<Vec<f64>> = (0..6).map(point).collect();
            best = best.max(information(&rows, &[0, 0, 1, 1, 2, 2], ratio).determinant());
        }
        assert!((found / best - 1.0).abs() < 1e-9, "{found} {best}");
    }
}

#[test]
fn hard_factors_stay_within_whole_plots_in_every_order() {
    let levels = vec![evenly(3); 3];
    let own = SplitPlotOptions {
        hard: vec![2, 0],
        ..options(7, 24)
    };
    let row = |x: &[f64]| vec![1.0, x[0], x[1], x[2], x[0] * x[1], x[2] * x[2]];
    let design = split_plot(factors(3), &row, &levels, &own).unwrap();
    let random = randomised(design.clone(), 3);
    assert_eq!(random, randomised(randomised(design.clone(), 9), 3));
    for design in [&design, &random] {
        let plots: Vec<usize> = design.runs.iter().map(|r| r.whole_plot.unwrap()).collect();
        assert!(plots.is_sorted());
        assert_eq!(design.whole_plots(), Some(7));
        for plot in design.runs.chunk_by(|a, b| a.whole_plot == b.whole_plot) {
            assert!([3, 4].contains(&plot.len()));
            let first = &plot[0].coded;
            assert!(
                plot.iter()
                    .all(|run| (run.coded[0], run.coded[2]) == (first[0], first[2]))
            );
        }
    }
    let order = |design: &Design| -> Vec<usize> {
        design.runs.iter().map(|run| run.standard_order).collect()
    };
    assert_ne!(order(&design), order(&random));
}

/// Decorrelated rows have the information of the correlated ones.
#[test]
fn closed_form_decorrelated_rows() {
    let design = split_plot(
        factors(2),
        &quadratic,
        &[evenly(3), evenly(3)],
        &options(5, 13),
    );
    let design = design.unwrap();
    let (rows, plots) = parts(&design, quadratic);
    for ratio in [0.0, 0.3, 4.0] {
        let expected = information(&rows, &plots, ratio).try_inverse().unwrap();
        let found = design_quality(&decorrelated(&rows, &design, ratio), &[]).unwrap();
        for (place, variance) in found.variances.iter().enumerate() {
            assert!((variance / expected[(place, place)] - 1.0).abs() < 1e-10);
        }
    }
}

#[test]
fn predictions_are_better_by_their_own_criterion() {
    let levels = vec![evenly(3), evenly(3)];
    let mean = |criterion| {
        let own = SplitPlotOptions {
            criterion,
            ..options(6, 18)
        };
        let design = split_plot(factors(2), &quadratic, &levels, &own).unwrap();
        let (rows, _) = parts(&design, quadratic);
        let region = windfall_design::model::region_points(&factors(2));
        let region: Vec<(f64, Vec<f64>)> = region
            .into_iter()
            .map(|(weight, point)| (weight, quadratic(&point)))
            .collect();
        let rows = decorrelated(&rows, &design, 1.0);
        design_quality(&rows, &region).unwrap().mean_variance
    };
    assert!(mean(Criterion::I) <= mean(Criterion::D));
}

#[test]
fn rejects_what_is_no_split_plot() {
    let levels = vec![evenly(3), evenly(3)];
    let made = |change: fn(&mut SplitPlotOptions)| {
        let mut own = options(5, 15);
        change(&mut own);
        split_plot(factors(2), &quadratic, &levels, &own).unwrap_err()
    };
    let impossible = |error: DesignError| matches!(error, DesignError::WholePlotsImpossible { .. });
    assert!(impossible(made(|own| own.hard = vec![])));
    assert!(impossible(made(|own| own.hard = vec![0, 1])));
    assert!(impossible(made(|own| own.whole_plots = 1)));
    assert!(impossible(made(|own| own.runs = 5)));
    assert!(impossible(made(|own| own.ratio = -0.1)));
    assert!(impossible(made(|own| own.ratio = f64::NAN)));
    let few = made(|own| own.whole_plots = 2);
    assert_eq!(few, DesignError::WholePlotsTooFew { found: 2, terms: 3 });
    let none = split_plot(factors(2), &quadratic, &levels, &options(3, 9)).unwrap();
    let codes: Vec<&str> = none.findings.iter().map(|found| found.code()).collect();
    assert_eq!(codes, ["no-whole-plot-error"]);
}
