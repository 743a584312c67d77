//! Every derivative of every law against a finite difference of its force, and
//! lanes against single numbers.

use windfall_contact::law::{ContactForce, ContactLaw, SMALLEST_DISPLACEMENT};
use windfall_contact::laws::kind::{Law, LawKind};
use windfall_contact::with_law;
use windfall_numerics::real::{Lanes, Real};

/// d, v, peak.
type State = (f64, f64, f64);

/// States of loading (peak 0), unloading, reloading and loading beyond a peak,
/// away from the places where a law changes its formula.
fn states() -> Vec<State> {
    let mut states = Vec::new();
    for d in [1.3e-6, 3.7e-5, 2.1e-4, 6.3e-4, 1.17e-3, 2.9e-3] {
        for v in [0.52, 0.03, -0.011, -0.38] {
            for peak in [0.0, 1.9e-4, 6.1e-4, 1.6e-3, 3.3e-3] {
                states.push((d, v, peak));
            }
        }
    }
    states
}

/// Parameters on both sides of what is typical.
fn parameter_sets(kind: LawKind) -> Vec<Vec<f64>> {
    let typical: Vec<f64> = kind
        .describe()
        .parameters
        .iter()
        .map(|p| p.typical)
        .collect();
    let bounds = kind
        .describe()
        .parameters
        .iter()
        .map(|p| (p.lower, p.upper));
    let bounds: Vec<_> = bounds.collect();
    [1.0, 0.83, 1.31]
        .map(|factor| {
            let scaled = typical.iter().enumerate();
            let scaled = scaled.map(|(i, p)| p * if i % 2 == 0 { factor } else { 2.0 - factor });
            let pairs = scaled.zip(&bounds);
            pairs
                .map(|(p, &(lower, upper))| p.clamp(lower, upper))
                .collect()
        })
        .into()
}

/// Everything a law returns, as numbers: force, by d, by v, by peak, by each
/// parameter.
fn numbers<const N: usize, L: ContactLaw<N>>(law: &L, (d, v, peak): State) -> Vec<f64> {
    let ContactForce {
        force,
        by_displacement,
        by_rate,
        by_parameter,
        by_peak,
    } = law.evaluate(d, v, peak);
    let mut all = vec![force, by_displacement, by_rate, by_peak];
    all.extend(by_parameter);
    all
}

fn evaluate(law: &Law, state: State) -> Vec<f64> {
    with_law!(law, law => numbers(law, state))
}

/// Difference quotient of order 4; the step is relative to `at`.
fn slope(at: f64, force: impl Fn(f64) -> f64) -> f64 {
    let step = 1e-4 * at.abs();
    let odd = |h: f64| force(at + h) - force(at - h);
    (8.0 * odd(step) - odd(2.0 * step)) / (12.0 * step)
}

/// Force with argument `index` replaced: 0 d, 1 v, 2 peak, 3… parameters.
fn force_with(kind: LawKind, parameters: &[f64], state: State, index: usize, value: f64) -> f64 {
    let mut parameters = parameters.to_vec();
    let mut state = [state.0, state.1, state.2];
    match index {
        0..3 => state[index] = value,
        _ => parameters[index - 3] = value,
    }
    let law = made(kind, &parameters);
    law.force(state[0], state[1], state[2])
}

fn made(kind: LawKind, parameters: &[f64]) -> Law {
    kind.with_parameters(parameters)
        .unwrap_or_else(|error| panic!("{error}"))
}

fn check(kind: LawKind, parameters: &[f64], state: State) -> Vec<f64> {
    let law = made(kind, parameters);
    let numbers = evaluate(&law, state);
    let (d, v, peak) = state;
    let arguments: Vec<(usize, f64, f64)> = [
        (0, d, numbers[1]),
        (1, v, numbers[2]),
        (2, peak, numbers[3]),
    ]
    .into_iter()
    .chain((0..parameters.len()).map(|i| (3 + i, parameters[i], numbers[4 + i])))
    .collect();
    // The largest part of the force, where its terms nearly cancel.
    let parts = arguments.iter().map(|&(_, at, slope)| (at * slope).abs());
    let scale = parts.fold(numbers[0].abs(), f64::max);
    for (index, at, analytic) in arguments {
        if index == 2 && peak == 0.0 {
            assert_eq!(analytic, 0.0, "{} depends on a peak of 0", kind.name());
            continue;
        }
        let numeric = slope(at, |value| {
            force_with(kind, parameters, state, index, value)
        });
        let error = ((analytic - numeric) * at).abs();
        assert!(
            error < 1e-10 * scale,
            "{} at {state:?} with {parameters:?}, argument {index}: {analytic} against {numeric}",
            kind.name()
        );
    }
    numbers
}

#[test]
fn derivative_of_every_law_by_every_argument() {
    for kind in LawKind::ALL {
        let mut largest: Vec<f64> = vec![0.0; 4 + kind.describe().parameters.len()];
        for parameters in parameter_sets(kind) {
            // The finite difference may not reach across a bound.
            let parameters: Vec<f64> = parameters
                .iter()
                .zip(kind.describe().parameters)
                .map(|(p, about)| p.clamp(about.lower, about.upper * 0.99))
                .collect();
            for state in states() {
                let numbers = check(kind, &parameters, state);
                for (largest, number) in largest.iter_mut().zip(numbers) {
                    *largest = largest.max(number.abs());
                }
            }
        }
        // No derivative is zero everywhere, but those that must be.
        let law = made(kind, &parameter_sets(kind)[0]);
        let history = with_law!(&law, law => law.history());
        for (index, largest) in largest.iter().enumerate() {
            let absent = match index {
                2 => matches!(kind, LawKind::Hertz) || history,
                3 => !history,
                _ => false,
            };
            assert_eq!(*largest == 0.0, absent, "{} number {index}", kind.name());
        }
    }
}

/// One sample per lane, in bits.
fn lanes<const N: usize, L: ContactLaw<N>>(law: &L, states: &[State]) -> Vec<Vec<f64>> {
    let mut all = Vec::new();
    for four in states.chunks_exact(4) {
        let pick =
            |f: fn(&State) -> f64| Lanes::<4>([f(&four[0]), f(&four[1]), f(&four[2]), f(&four[3])]);
        let force = law.evaluate(pick(|s| s.0), pick(|s| s.1), pick(|s| s.2));
        for lane in 0..4 {
            let mut numbers = vec![
                force.force.0[lane],
                force.by_displacement.0[lane],
                force.by_rate.0[lane],
                force.by_peak.0[lane],
            ];
            numbers.extend(force.by_parameter.iter().map(|by| by.0[lane]));
            all.push(numbers);
        }
    }
    all
}

#[test]
fn repeats_in_lanes_bit_for_bit() {
    // Neighbouring lanes are on different branches of the laws with history.
    let mut states = states();
    states.extend([
        (SMALLEST_DISPLACEMENT, 0.5, 0.0),
        (SMALLEST_DISPLACEMENT, -0.5, 1e-3),
        (1e-3, 0.0, 1e-3),
        (5e-4, 0.1, 1e-30),
    ]);
    assert_eq!(states.len() % 4, 0);
    for kind in LawKind::ALL {
        for parameters in parameter_sets(kind) {
            let law = made(kind, &parameters);
            let wide = with_law!(&law, law => lanes(law, &states));
            for (state, wide) in states.iter().zip(wide) {
                let narrow = evaluate(&law, *state);
                let bits =
                    |numbers: &[f64]| numbers.iter().map(|n| n.to_bits()).collect::<Vec<_>>();
                assert_eq!(bits(&narrow), bits(&wide), "{} at {state:?}", kind.name());
                assert!(
                    narrow.iter().all(|n| n.is_finite()),
                    "{} at {state:?}: {narrow:?}",
                    kind.name()
                );
            }
        }
    }
}

/// The derivatives hold within the integrator too, where several numbers are
/// one value with its sensitivities: all operations are lane by lane.
#[test]
fn closed_form_lanes_do_not_mix() {
    let law = LawKind::KuwabaraKono.with_parameters(&[4.0, 2.0]).unwrap();
    let force = with_law!(&law, law => forces(law, Lanes([1.0, 4.0, 9.0, 0.25]), Lanes([0.0, 1.0, -1.0, 2.0])));
    // k d^1.5 + c d^0.5 v by hand.
    assert_eq!(force.0, [4.0, 32.0 + 4.0, 108.0 - 6.0, 0.5 + 2.0]);
}

fn forces<const N: usize, R: Real>(law: &impl ContactLaw<N>, d: R, v: R) -> R {
    law.evaluate(d, v, d.constant(0.0)).force
}
