//! Box-Behnken designs against what is published.

#![allow(clippy::unwrap_used)]

use windfall_design::box_behnken::{BoxBehnkenOptions, box_behnken};
use windfall_design::error::DesignError;
use windfall_design::kind::{Design, Factor, Point};

fn make(count: usize, centre: usize, blocks: usize) -> Result<Design, DesignError> {
    let name = |i: usize| Factor::between(&format!("x{i}"), "", -1.0, 1.0).unwrap();
    let factors = (0..count).map(name).collect();
    box_behnken(factors, &BoxBehnkenOptions { centre, blocks })
}

/// NIST/SEMATECH e-Handbook of Statistical Methods, table 3.24: the 15 runs of
/// three factors.
#[test]
fn reference_runs_of_three_factors() {
    let published = [
        [-1, -1, 0],
        [1, -1, 0],
        [-1, 1, 0],
        [1, 1, 0],
        [-1, 0, -1],
        [1, 0, -1],
        [-1, 0, 1],
        [1, 0, 1],
        [0, -1, -1],
        [0, 1, -1],
        [0, -1, 1],
        [0, 1, 1],
        [0, 0, 0],
        [0, 0, 0],
        [0, 0, 0],
    ];
    let found = make(3, 3, 1).unwrap();
    for (run, expected) in found.runs.iter().zip(published) {
        assert_eq!(run.coded, expected.map(f64::from));
    }
    assert_eq!(found.runs.len(), 15);
}

/// Box and Behnken (1960), table 4: runs without and with their centre points.
#[test]
fn reference_numbers_of_runs() {
    for (count, edges, centre) in [(3, 12, 3), (4, 24, 3), (5, 40, 6), (6, 48, 6), (7, 56, 6)] {
        let found = make(count, centre, 1).unwrap();
        assert_eq!(found.runs.len(), edges + centre, "{count}");
        let edge = found.runs.iter().filter(|run| run.point == Point::Edge);
        let squares = edge.map(|run| run.coded.iter().map(|x| x * x).sum::<f64>());
        let size = if count < 6 { 2.0 } else { 3.0 };
        assert!(squares.into_iter().all(|sum| sum == size));
    }
}

/// The moments that make the published designs second-order designs: odd ones
/// vanish, Σx_i² is the same for all factors, and for 3, 4, 5 and 7 factors so
/// is Σx_i²x_j² for all pairs.
#[test]
fn closed_form_moments() {
    for count in 3..=7 {
        let runs = make(count, 0, 1).unwrap().runs;
        let sum = |f: &dyn Fn(&[f64]) -> f64| runs.iter().map(|r| f(&r.coded)).sum::<f64>();
        let mut mixed = Vec::new();
        for i in 0..count {
            assert_eq!(sum(&|x| x[i] * x[i]), sum(&|x| x[0] * x[0]));
            for j in (0..count).filter(|j| *j != i) {
                assert_eq!(sum(&|x| x[i] * x[j]), 0.0);
                assert_eq!(sum(&|x| x[i] * x[j] * x[j]), 0.0);
                mixed.push(sum(&|x| x[i] * x[i] * x[j] * x[j]));
                for k in (0..count).filter(|k| *k != i && *k != j) {
                    assert_eq!(sum(&|x| x[i] * x[j] * x[k] * x[k]), 0.0);
                }
            }
        }
        let same = mixed.iter().all(|value| *value == mixed[0]);
        assert_eq!(same, count != 6, "{count}: {mixed:?}");
        assert!(mixed.iter().all(|value| *value > 0.0));
    }
}

/// In every block each term of the quadratic model sums to its share, so that
/// differences between blocks cannot enter the coefficients.
#[test]
fn closed_form_orthogonal_blocks() {
    for (count, blocks) in [(4, 3), (5, 2), (6, 2), (7, 2)] {
        let design = make(count, 2, blocks).unwrap();
        for block in 1..=blocks {
            let chosen: Vec<_> = design.runs.iter().filter(|r| r.block == block).collect();
            assert_eq!(chosen.len() * blocks, design.runs.len());
            let sum = |i: usize, j: usize| -> f64 {
                chosen.iter().map(|r| r.coded[i] * r.coded[j]).sum()
            };
            for i in 0..count {
                assert_eq!(chosen.iter().map(|r| r.coded[i]).sum::<f64>(), 0.0);
                let all: f64 = design.runs.iter().map(|r| r.coded[i].powi(2)).sum();
                assert_eq!(sum(i, i) * blocks as f64, all);
                for j in 0..i {
                    assert_eq!(sum(i, j), 0.0, "{count}: {i} {j}");
                }
            }
        }
    }
}

#[test]
fn rejects_what_is_not_published() {
    for count in [2, 8] {
        assert!(matches!(
            make(count, 3, 1),
            Err(DesignError::FactorCount { .. })
        ));
    }
    for (count, blocks) in [(3, 2), (4, 2), (5, 3), (4, 0)] {
        let error = make(count, 3, blocks).unwrap_err();
        assert!(matches!(error, DesignError::BlocksImpossible { .. }));
    }
}
