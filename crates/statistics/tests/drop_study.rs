//! The drop study's Tables 4 and 5 from its Table 3 (Kang et al. 2023): runs as
//! printed; expected values recomputed in exact coding by an independent program,
//! with the printed values they agree with beside them.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use windfall_statistics::model::anova::{AnovaType, anova};
use windfall_statistics::surface::analysis::{Surface, fit_surface};
use windfall_statistics::surface::coding::{CodedFactors, Recognised, code_by_levels};
use windfall_statistics::surface::desirability::{
    Goal, Region, Wanted, best_settings, equally_good,
};
use windfall_statistics::surface::terms::surface_terms;

/// k (N/mm^e), e, C (N s/mm), first peak force (N), interval of impacts (ms).
const RUNS: [[f64; 5]; 15] = [
    [1.0, 2.25, 3.5e-4, 14.9, 334.0],
    [0.44, 1.8, 2e-4, 9.4, 380.0],
    [0.65, 2.25, 6e-4, 11.8, 275.0],
    [0.86, 1.8, 5e-4, 11.2, 310.0],
    [0.44, 2.7, 5e-4, 13.6, 282.0],
    [0.65, 2.25, 1e-4, 13.6, 385.0],
    [0.44, 1.8, 5e-4, 7.6, 276.0],
    [0.3, 2.25, 3.5e-4, 9.7, 328.0],
    [0.86, 2.7, 2e-4, 18.3, 334.0],
    [0.86, 2.7, 5e-4, 15.1, 287.0],
    [0.65, 2.25, 3.5e-4, 13.1, 326.0],
    [0.44, 2.7, 2e-4, 14.3, 362.0],
    [0.65, 1.5, 3.5e-4, 8.4, 323.0],
    [0.65, 3.0, 3.5e-4, 17.7, 301.0],
    [0.86, 1.8, 2e-4, 12.4, 372.0],
];

fn column(place: usize) -> Vec<f64> {
    RUNS.iter().map(|run| run[place]).collect()
}

fn coded() -> CodedFactors {
    let columns = [column(0), column(1), column(2)];
    let names = ["k", "e", "C"].map(str::to_owned);
    let pairs: Vec<(String, &[f64])> = names
        .into_iter()
        .zip(columns.iter().map(Vec::as_slice))
        .collect();
    code_by_levels(&pairs)
}

fn surface(response: usize, model: &str) -> Surface {
    let coded = coded();
    let names = ["k", "e", "C"].map(str::to_owned);
    let terms = surface_terms(model, &names).unwrap();
    fit_surface(
        &coded.factors,
        &terms,
        &coded.values,
        &column(response),
        0.95,
    )
    .unwrap()
}

fn close(found: f64, expected: f64, what: &str) {
    assert!(
        (found / expected - 1.0).abs() < 1e-8,
        "{what}: {found} {expected}"
    );
}

const INTERVAL: &str = "A + B + C + AB + AC + BC + B^2";

#[test]
fn reference_exact_coding_behind_the_printed_levels() {
    let found = coded();
    for (factor, half) in found
        .factors
        .iter()
        .zip([0.2081112451, 0.4459526681, 1.486508894e-4])
    {
        close(factor.half, half, &factor.name);
    }
    match found.recognised {
        Recognised::CentralComposite { alpha, rounded } => {
            close(alpha, 8.0_f64.powf(0.25), "alpha");
            assert_eq!(rounded.len(), 3);
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn reference_table_4() {
    let force = surface(3, "A + B + C");
    let coefficients = [12.74, 1.526363417, 2.660984196, -0.7269043744];
    for (found, expected) in force.coded.iter().zip(coefficients) {
        assert!((found - expected).abs() < 1e-9 * expected.abs() + 5e-10);
    }
    let expected_ss = [31.8175380146818, 96.7019573830742, 7.216144801255779];
    let probabilities = [
        3.8920658413343895e-07,
        1.1739524921111045e-09,
        0.00035703725536073634,
    ];
    for kind in [AnovaType::Partial, AnovaType::Sequential] {
        let table = anova(&force.frame, &force.reduced, &[0, 1, 2], kind);
        for ((row, ss), p) in table.rows.iter().zip(expected_ss).zip(probabilities) {
            close(row.ss, ss, &row.term);
            close(row.p, p, &row.term);
        }
    }
    close(force.fit.residual_ss, 3.0803598009882505, "residual");
    let quality = force.fit.quality(&column(3));
    close(quality.r2, 0.9778097639970302, "R2");
    close(quality.r2_adjusted, 0.9717578814507658, "adjusted");
    close(quality.r2_predicted, 0.9576068201971438, "predicted");
    close(quality.press, 5.884851647513279, "PRESS");
    close(
        quality.adequate_precision,
        35.9665408300973,
        "adequate precision",
    );
    close(quality.sigma, 0.5291811685809974, "s");
    let whole = force.fit.whole();
    close(whole.f, 161.5711733534192, "F");
    close(whole.p, 2.240485760012386e-09, "p");
}

#[test]
fn reference_table_5() {
    let interval = surface(4, INTERVAL);
    let expected = [
        (12.548125304589092, 0.7216299361788183, 0.4237074367280116),
        (885.9930024087923, 50.95255731541909, 0.00018729816503940128),
        (16730.158343194624, 962.1344068859223, 9.346623867934658e-09),
        (300.12500000000153, 17.259883794471016, 0.004270994229671148),
        (703.1250000000035, 40.436004308163035, 0.0003819521972547835),
        (190.12500000000028, 10.933895564927246, 0.013001386324119141),
        (430.2054164297739, 24.740676369279036, 0.0016118718876309023),
    ];
    let every: Vec<usize> = (0..7).collect();
    let table = anova(
        &interval.frame,
        &interval.reduced,
        &every,
        AnovaType::Partial,
    );
    for (row, (ss, f, p)) in table.rows.iter().zip(expected) {
        close(row.ss, ss, &row.term);
        close(row.f, f, &row.term);
        close(row.p, p, &row.term);
    }
    let quality = interval.fit.quality(&column(4));
    close(quality.r2, 0.9937173473385863, "R2");
    close(quality.r2_predicted, 0.9667526970275302, "predicted");
    close(quality.press, 644.1332477886309, "PRESS");
    close(
        quality.adequate_precision,
        38.65855921516329,
        "adequate precision",
    );
    close(interval.fit.model_ss(), 19252.27988733777, "model");
    close(interval.fit.residual_ss, 121.72011266223006, "residual");
    close(interval.fit.whole().f, 158.16843631062284, "F");
    // The printed equation in actual units lost its term of k; recovered to the digits
    // it is given with.
    let printed = [
        (vec![0, 0, 0], 325.690),
        (vec![1, 0, 0], 47.032),
        (vec![0, 1, 0], 137.098),
        (vec![0, 0, 1], -597897.0),
        (vec![1, 1, 0], -65.997),
        (vec![1, 0, 1], 303046.0),
        (vec![0, 1, 1], 73539.0),
        (vec![0, 2, 0], -30.667),
    ];
    for (powers, value) in printed {
        let found = interval
            .actual
            .iter()
            .find(|(known, _)| *known == powers)
            .unwrap();
        assert!(
            (found.1 / value - 1.0).abs() < 2e-5,
            "{powers:?}: {}",
            found.1
        );
    }
    let at: f64 = interval
        .actual
        .iter()
        .map(|(powers, b)| {
            let point = [0.7_f64, 2.0, 3e-4];
            let parts = powers.iter().zip(point);
            b * parts
                .map(|(power, x)| x.powi(*power as i32))
                .product::<f64>()
        })
        .sum();
    let actual = [0.7, 2.0, 3e-4];
    let pairs = interval.factors.iter().zip(actual);
    let point: Vec<f64> = pairs.map(|(factor, value)| factor.coded(value)).collect();
    assert!((interval.value(&point) - at).abs() < 1e-9);
}

fn target(value: f64, low: f64, high: f64) -> Goal {
    Goal {
        wanted: Wanted::Target(value),
        low,
        high,
        weight_low: 1.0,
        weight_high: 1.0,
        importance: 3.0,
    }
}

/// The study's optimum is one of a line of equally good ones.
#[test]
fn reference_optimum_and_its_family() {
    let surfaces = [surface(3, "A + B + C"), surface(4, INTERVAL)];
    let goals = [target(11.3, 7.6, 18.3), target(299.0, 275.0, 385.0)];
    let alpha = 8.0_f64.powf(0.25);
    let region = Region {
        low: vec![-alpha; 3],
        high: vec![alpha; 3],
        radius: None,
    };
    let actual = |place: usize, coded: f64| surfaces[0].factors[place].actual(coded);
    let held = |k: f64| {
        let coded = surfaces[0].factors[0].coded(k);
        let mut held = region.clone();
        (held.low[0], held.high[0]) = (coded, coded);
        best_settings(&surfaces, &goals, &held)
    };
    let published = held(0.868);
    close(actual(1, published.point[1]), 1.9095231060188587, "e");
    close(actual(2, published.point[2]), 0.0005559867348, "C");
    for (k, e, c) in [
        (0.3, 2.5130, 4.4046e-4),
        (0.65, 2.1203, 4.8625e-4),
        (0.95, 1.8431, 5.9797e-4),
    ] {
        let found = held(k);
        assert!(found.desirability > 1.0 - 1e-12);
        assert!((actual(1, found.point[1]) - e).abs() < 5.1e-5);
        assert!((actual(2, found.point[2]) - c).abs() < 5.1e-9);
    }
    let best = best_settings(&surfaces, &goals, &region);
    assert!(best.desirability > 1.0 - 1e-12);
    let family = equally_good(&surfaces, &goals, &region, &best, Some(0), 21).unwrap();
    assert_eq!(family.dimension, 1);
    // Every k from 0.3 to 0.953 has such settings within the design's box.
    assert!((actual(0, family.range.0) - 0.3).abs() < 1e-6);
    assert!((actual(0, family.range.1) - 0.953).abs() < 1e-3);
    println!("k to {}", actual(0, family.range.1));
    // The largest force at this interval is one point of the line.
    let mut alone = goals;
    alone[0].wanted = Wanted::Maximum;
    alone[0].high = 30.0;
    let best = best_settings(&surfaces, &alone, &region);
    assert!(equally_good(&surfaces, &alone, &region, &best, None, 21).is_none());
}
