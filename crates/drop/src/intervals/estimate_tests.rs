use super::*;
use crate::intervals::speed::line_over_speed;

const EXACT: Timing = Timing {
    resolution: 0.0,
    trigger_sd: 0.0,
    contact: 0.0,
    gravity: 9.80665,
    height_sd: 0.0,
};

fn drop_of(intervals: &[f64], height: Option<f64>) -> TimedDrop {
    TimedDrop {
        name: "drop".to_owned(),
        height,
        intervals: intervals.iter().copied().map(Some).collect(),
    }
}

#[track_caller]
fn close(found: f64, expected: f64, tolerance: f64) {
    let error = (found / expected - 1.0).abs();
    assert!(error < tolerance, "{found} against {expected}: {error:e}");
}

/// From 0.5 m with a restitution of 0.8: flights of 2 e^n √(2 h/g), rebounds of h e^(2 n).
#[test]
fn closed_form_one_restitution() {
    let first = 1.6 * (1.0 / 9.80665f64).sqrt();
    let intervals = [first, 0.8 * first, 0.64 * first];
    let known = estimate_drop(&drop_of(&intervals, Some(0.5)), &EXACT).unwrap();
    let numbers: Vec<usize> = known.impacts.iter().map(|own| own.number).collect();
    assert_eq!(numbers, [1, 2, 3]);
    for (place, impact) in known.impacts.iter().enumerate() {
        close(impact.restitution, 0.8, 1e-14);
        close(
            impact.speed,
            9.80665f64.sqrt() * 0.8f64.powi(place as i32),
            1e-14,
        );
        close(
            impact.rebound_height,
            0.5 * 0.64f64.powi(place as i32 + 1),
            1e-14,
        );
    }
    close(known.restitution, 0.8, 1e-14);
    // Without the height the first interval tells it.
    let unknown = estimate_drop(&drop_of(&intervals, None), &EXACT).unwrap();
    assert_eq!(unknown.impacts.len(), 2);
    close(unknown.height.unwrap().0, 0.5, 1e-14);
}

/// Ratios of neighbours cancel: the mean of a drop is that of its first and last flight alone.
///
/// With instants known to s, e = T₂/T₁ has the relative variance
/// s² (1/T₁² + (1/T₁ + 1/T₂)² + 1/T₂²), and √(T₃/T₁) a quarter of s² (2/T₁² + 2/T₃²).
#[test]
fn closed_form_uncertainty() {
    let timing = Timing {
        resolution: 0.003,
        trigger_sd: 0.001,
        ..EXACT
    };
    let variance: f64 = 1e-6 + 9e-6 / 12.0;
    close(timing.instant_sd(), variance.sqrt(), 1e-14);
    let (a, b, c) = (0.5, 0.4, 0.3);
    let found = estimate_drop(&drop_of(&[a, b, c], None), &timing).unwrap();
    close(found.restitution, (c / a).sqrt(), 1e-14);
    let pair = |x: f64, y: f64| {
        let relative = 1.0 / (x * x) + (1.0 / x + 1.0 / y).powi(2) + 1.0 / (y * y);
        (y / x) * (variance * relative).sqrt()
    };
    close(found.impacts[0].sd, pair(a, b), 1e-13);
    close(found.impacts[1].sd, pair(b, c), 1e-13);
    let relative = 0.25 * variance * (2.0 / (a * a) + 2.0 / (c * c));
    close(found.sd, found.restitution * relative.sqrt(), 1e-13);
    // Only a height that is not exact, e = g T/(2 √(2 g h)): half of its relative uncertainty.
    let timing = Timing {
        height_sd: 0.01,
        ..EXACT
    };
    let found = estimate_drop(&drop_of(&[0.5], Some(0.5)), &timing).unwrap();
    close(found.sd, found.restitution * 0.01, 1e-13);
}

/// An impact that was not noticed is not bridged.
#[test]
fn closed_form_gap() {
    let mut drop = drop_of(&[0.5, 0.4, 0.3, 0.24, 0.18], None);
    drop.intervals[2] = None;
    let found = estimate_drop(&drop, &EXACT).unwrap();
    let numbers: Vec<usize> = found.impacts.iter().map(|own| own.number).collect();
    assert_eq!(numbers, [2, 5]);
    close(found.impacts[0].restitution, 0.8, 1e-14);
    close(found.impacts[1].restitution, 0.75, 1e-14);
    drop.intervals = vec![Some(0.5), None, Some(0.3)];
    assert_eq!(estimate_drop(&drop, &EXACT), None);
}

/// SciPy 1.17 (`solve_ivp`, DOP853, tolerance 1e-12, impacts as events): a body of
/// e = 0.85 − 0.04 v dropped from three heights, in vacuum; speeds and restitutions at the
/// events, and the intervals once more with contacts of 5 ms.
#[test]
fn reference_flights_followed_by_scipy() {
    let trains = [
        (0.3, [0.372498266, 0.289409100, 0.229570100, 0.184797899]),
        (0.5, [0.462860927, 0.351412207, 0.274479806, 0.218531339]),
        (0.8, [0.558670792, 0.413654504, 0.318046001, 0.250499609]),
    ];
    let of = |with: Option<f64>| -> Vec<DropEstimate> {
        let all = trains.iter();
        all.map(|(height, intervals)| {
            estimate_drop(&drop_of(intervals, with.map(|own| own * height)), &EXACT).unwrap()
        })
        .collect()
    };
    let found = of(Some(1.0));
    let speeds = [3.131557, 2.269558, 1.723088, 1.345864];
    let restitutions = [0.724737715, 0.759217698, 0.781076470, 0.796165452];
    for (impact, (speed, e)) in found[1].impacts.iter().zip(speeds.iter().zip(restitutions)) {
        close(impact.speed, *speed, 1e-6);
        close(impact.restitution, e, 1e-8);
    }
    let impacts: Vec<&[TimedImpact]> = found.iter().map(|own| &own.impacts[..]).collect();
    let line = line_over_speed(&impacts, 0.95).unwrap();
    close(line.slope, -0.04, 1e-5);
    close(line.restitution, 0.85 - 0.04 * line.speed, 1e-7);
    // The same with contacts.
    let longer = [0.467860927, 0.356412207, 0.279479806, 0.223531339];
    let timing = Timing {
        contact: 0.005,
        ..EXACT
    };
    let found = estimate_drop(&drop_of(&longer, Some(0.5)), &timing).unwrap();
    for (impact, e) in found.impacts.iter().zip(restitutions) {
        close(impact.restitution, e, 1e-8);
    }
}

/// Uniform numbers between 0 and 1 (Knuth's linear congruence).
fn uniform(state: &mut u64) -> f64 {
    *state = state
        .wrapping_mul(6_364_136_223_846_793_005)
        .wrapping_add(1_442_695_040_888_963_407);
    (*state >> 11) as f64 / (1u64 << 53) as f64
}

/// 2,000 drops on a stopwatch of 5 ms, whose instants are rounded: restitutions scatter as
/// their uncertainties say.
#[test]
fn recovers_uncertainty_of_a_coarse_stopwatch() {
    let timing = Timing {
        resolution: 0.005,
        ..EXACT
    };
    let mut state = 7;
    let (mut squares, mut drops) = ([0.0; 2], 0.0);
    for _ in 0..2000 {
        let e = 0.7 + 0.1 * uniform(&mut state);
        let mut instant = uniform(&mut state);
        let mut flight = 0.45 + 0.1 * uniform(&mut state);
        let mut noticed = Vec::new();
        for _ in 0..5 {
            noticed.push((instant / 0.005f64).round() * 0.005);
            instant += flight;
            flight *= e;
        }
        let intervals: Vec<f64> = noticed.windows(2).map(|own| own[1] - own[0]).collect();
        let found = estimate_drop(&drop_of(&intervals, None), &timing).unwrap();
        squares[0] += ((found.restitution - e) / found.sd).powi(2);
        let last = found.impacts[2];
        squares[1] += ((last.restitution - e) / last.sd).powi(2);
        drops += 1.0;
    }
    for square in squares {
        assert!((square / drops - 1.0).abs() < 0.1, "{squares:?}");
    }
}
