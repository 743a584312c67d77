//! Central composite designs against published axial distances and designs.

#![allow(clippy::unwrap_used)]

use nalgebra::DMatrix;
use windfall_design::composite::{Alpha, CompositeOptions, Ends, central_composite};
use windfall_design::error::DesignError;
use windfall_design::kind::{Design, Factor, Point, randomised};
use windfall_design::word::{Generator, parse_generator};

fn factors(count: usize) -> Vec<Factor> {
    (0..count)
        .map(|i| Factor::between(&format!("x{i}"), "", -1.0, 1.0).unwrap())
        .collect()
}

fn generators(texts: &[&str], count: usize) -> Vec<Generator> {
    let names = vec!["x"; count];
    let read = |text: &&str| parse_generator(text, &names).unwrap();
    texts.iter().map(read).collect()
}

fn quadratic_row(x: &[f64]) -> Vec<f64> {
    let k = x.len();
    let mut row = vec![1.0];
    row.extend(x);
    for i in 0..k {
        row.extend((i + 1..k).map(|j| x[i] * x[j]));
    }
    row.extend(x.iter().map(|v| v * v));
    row
}

fn moments(design: &Design) -> DMatrix<f64> {
    let rows: Vec<Vec<f64>> = design
        .runs
        .iter()
        .map(|r| quadratic_row(&r.coded))
        .collect();
    let x = DMatrix::from_fn(rows.len(), rows[0].len(), |i, j| rows[i][j]);
    x.transpose() * x
}

/// Myers, Montgomery and Anderson-Cook (2016), table 8.5: rotatable axial
/// distances of full cubes of 2 to 6 factors and of halves of 5 and 6.
#[test]
fn reference_rotatable_axial_distances() {
    let half = ["E=ABCD", "F=ABCDE"];
    let cases: [(usize, &[&str], f64); 7] = [
        (2, &[], 1.414),
        (3, &[], 1.682),
        (4, &[], 2.000),
        (5, &[], 2.378),
        (5, &half[..1], 2.000),
        (6, &[], 2.828),
        (6, &half[1..], 2.378),
    ];
    for (count, texts, alpha) in cases {
        let options = CompositeOptions {
            generators: generators(texts, count),
            ..CompositeOptions::default()
        };
        let design = central_composite(factors(count), &options).unwrap();
        assert!(
            (design.alpha.unwrap() - alpha).abs() < 5e-4,
            "{count} {alpha}"
        );
        let cube = (1 << count) >> texts.len();
        assert_eq!(design.runs.len(), cube + 2 * count + 5);
    }
}

/// Orthogonal axial distances with one centre point, as printed by Khuri and
/// Cornell (1996), table 4.5, and Montgomery: 1, 1.216, 1.414, and 1.547 for the
/// half of five factors; and the definition: the quadratic terms, each less
/// the mean of x², are uncorrelated.
#[test]
fn reference_orthogonal_axial_distances() {
    let cases: [(usize, &[&str], f64); 4] = [
        (2, &[], 1.0),
        (3, &[], 1.216),
        (4, &[], 1.414),
        (5, &["E=ABCD"], 1.547),
    ];
    for (count, texts, alpha) in cases {
        let options = CompositeOptions {
            alpha: Alpha::Orthogonal,
            generators: generators(texts, count),
            centre: 1,
            ..CompositeOptions::default()
        };
        let design = central_composite(factors(count), &options).unwrap();
        assert!(
            (design.alpha.unwrap() - alpha).abs() < 1e-3,
            "{:?}",
            design.alpha
        );
        let covariance = moments(&design).try_inverse().unwrap();
        let first_square = covariance.nrows() - count;
        let between = covariance[(first_square, first_square + 1)];
        assert!(between.abs() < 1e-12, "{count}: {between}");
    }
}

/// The variance of prediction of a rotatable design is the same all over a
/// sphere; that of a face-centred one is not.
#[test]
fn closed_form_rotatability() {
    let spread = |alpha: Alpha| {
        let options = CompositeOptions {
            alpha,
            ..CompositeOptions::default()
        };
        let design = central_composite(factors(3), &options).unwrap();
        let covariance = moments(&design).try_inverse().unwrap();
        let directions: [[f64; 3]; 4] = [
            [1.0, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [1.0, -2.0, 0.5],
            [0.3, 1.0, 3.0],
        ];
        let variances = directions.map(|direction| {
            let norm = direction.iter().map(|v| v * v).sum::<f64>().sqrt();
            let row = quadratic_row(&direction.map(|v| 1.3 * v / norm));
            let row = nalgebra::DVector::from_vec(row);
            (row.transpose() * &covariance * row)[0]
        });
        let largest = variances.iter().fold(f64::MIN, |a, b| a.max(*b));
        largest / variances.iter().fold(f64::MAX, |a, b| a.min(*b)) - 1.0
    };
    assert!(spread(Alpha::Rotatable).abs() < 1e-12);
    assert!(spread(Alpha::Face) > 0.1);
}

/// With the axial distance for blocks every block has the mean of each term of
/// the quadratic model: blocks cannot shift its coefficients.
#[test]
fn closed_form_orthogonal_blocks() {
    let cases: [(usize, &[&str], usize); 4] =
        [(2, &[], 2), (3, &[], 3), (4, &[], 3), (6, &["F=ABCDE"], 3)];
    for (count, texts, blocks) in cases {
        let options = CompositeOptions {
            alpha: Alpha::Blocks,
            generators: generators(texts, count),
            blocks,
            centre: 2,
            centre_axial: 3,
            ..CompositeOptions::default()
        };
        let design = central_composite(factors(count), &options).unwrap();
        assert_eq!(design.blocks(), blocks);
        let mean = |block: Option<usize>| -> Vec<f64> {
            let chosen = design
                .runs
                .iter()
                .filter(|r| block.is_none_or(|b| r.block == b));
            let rows: Vec<Vec<f64>> = chosen.map(|r| quadratic_row(&r.coded)).collect();
            (0..rows[0].len())
                .map(|j| rows.iter().map(|row| row[j]).sum::<f64>() / rows.len() as f64)
                .collect()
        };
        let overall = mean(None);
        for block in 1..=blocks {
            for (own, all) in mean(Some(block)).iter().zip(&overall) {
                assert!((own - all).abs() < 1e-12, "{count} factors, block {block}");
            }
        }
        assert!(design.findings.is_empty(), "{:?}", design.findings);
    }
}

/// Box and Hunter (1957): three factors in three blocks of 6, 6 and 8 runs have
/// alpha 1.633.
#[test]
fn reference_three_factors_in_three_blocks() {
    let options = CompositeOptions {
        alpha: Alpha::Blocks,
        blocks: 3,
        centre: 2,
        centre_axial: 2,
        ..CompositeOptions::default()
    };
    let design = central_composite(factors(3), &options).unwrap();
    let sizes = [1, 2, 3].map(|b| design.runs.iter().filter(|r| r.block == b).count());
    assert_eq!(sizes, [6, 6, 8]);
    assert!((design.alpha.unwrap() - 1.633).abs() < 5e-4);
}

/// The 15 runs of the 2023 drop study: k 0.3 to 1, e 1.5 to 3, c 1e-4 to 6e-4 at
/// the axial points of a rotatable design with one centre point.
#[test]
fn reference_runs_of_the_drop_study() {
    let factors = vec![
        Factor::between("k", "N/mm^e", 0.3, 1.0).unwrap(),
        Factor::between("e", "", 1.5, 3.0).unwrap(),
        Factor::between("c", "N s/mm", 1e-4, 6e-4).unwrap(),
    ];
    let options = CompositeOptions {
        ends: Ends::Axial,
        centre: 1,
        ..CompositeOptions::default()
    };
    let design = central_composite(factors, &options).unwrap();
    // Half-ranges of windfall reference data, papers.json.
    let halves = [0.208_111_245_1, 0.445_952_668_1, 1.486_508_894e-4];
    for (factor, half) in design.factors.iter().zip(halves) {
        assert!((factor.half / half - 1.0).abs() < 1e-9, "{}", factor.name);
    }
    // Corners, axial points and centre in levels: 2^(3/4) = 1.6817928305.
    let found: Vec<Vec<f64>> = design
        .runs
        .iter()
        .map(|run| {
            design
                .factors
                .iter()
                .zip(&run.coded)
                .map(|(f, x)| f.actual(*x))
                .collect()
        })
        .collect();
    for expected in drop_study() {
        let matches = found.iter().filter(|run| {
            run.iter()
                .zip(&expected)
                .all(|(a, b)| (a / b - 1.0).abs() < 1e-12)
        });
        assert_eq!(matches.count(), 1, "{expected:?}");
    }
    let points = |kind| design.runs.iter().filter(|run| run.point == kind).count();
    assert_eq!(
        [Point::Factorial, Point::Axial, Point::Centre].map(points),
        [8, 6, 1]
    );
}

/// Exact levels of table 3 of the 2023 drop study (windfall reference data,
/// kang2023_table3_exact.csv).
fn drop_study() -> Vec<[f64; 3]> {
    let (k, e, c) = (
        [0.441_888_754_874_523_84, 0.858_111_245_125_476_2],
        [1.804_047_331_873_979_6, 2.695_952_668_126_020_4],
        [2.013_491_106_246_598_5e-4, 4.986_508_893_753_401e-4],
    );
    let mut runs = vec![
        [0.65, 2.25, 3.5e-4],
        [0.3, 2.25, 3.5e-4],
        [1.0, 2.25, 3.5e-4],
        [0.65, 1.5, 3.5e-4],
        [0.65, 3.0, 3.5e-4],
        [0.65, 2.25, 1e-4],
        [0.65, 2.25, 6e-4],
    ];
    runs.extend((0..8).map(|i| [k[i & 1], e[i >> 1 & 1], c[i >> 2 & 1]]));
    runs
}

#[test]
fn repeats_with_the_seed() {
    let design = central_composite(factors(3), &CompositeOptions::default()).unwrap();
    assert_eq!(randomised(design.clone(), 1), randomised(design, 1));
}

#[test]
fn rejects_what_makes_no_composite() {
    let make =
        |count, options: CompositeOptions| central_composite(factors(count), &options).unwrap_err();
    for alpha in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let options = CompositeOptions {
            alpha: Alpha::Given(alpha),
            ..Default::default()
        };
        assert!(matches!(make(3, options), DesignError::AlphaInvalid { .. }));
    }
    assert!(matches!(
        make(1, Default::default()),
        DesignError::FactorCount { found: 1, .. }
    ));
    for blocks in [0, 4, 9] {
        let options = CompositeOptions {
            blocks,
            ..Default::default()
        };
        assert!(
            matches!(make(3, options), DesignError::BlocksImpossible { .. }),
            "{blocks}"
        );
    }
    let options = CompositeOptions {
        alpha: Alpha::Blocks,
        ..Default::default()
    };
    assert!(matches!(
        make(3, options),
        DesignError::AlphaImpossible { .. }
    ));
}
