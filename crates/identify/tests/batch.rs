//! Fits of many impacts side by side against fits one by one: the same bits,
//! whatever the number, the order and the neighbours; and nothing allocated but what a
//! fit's condensed samples need.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use windfall_contact::law::EndRule;
use windfall_contact::laws::any_law::{AnyLaw, LARGEST_PARAMETERS};
use windfall_contact::laws::kind::LawKind;
use windfall_contact::laws::kuwabara_kono::KuwabaraKono;
use windfall_identify::fit::batch::{BatchProblem, Room, minimise_batch};
use windfall_identify::fit::batch_law::BatchLaw;
use windfall_identify::fit::estimator::{
    Coordinate, Estimator, FreeLaw, FreeParameter, Setting, Target, Values,
};
use windfall_identify::fit::model::Sampling;
use windfall_identify::rig::kind::{Carriage, Pendulum, Rig};
use windfall_identify::rig::motion::Motion;
use windfall_identify::samples::SampleGroup;
use windfall_numerics::least_squares::{Minimum, Options, Stop, minimise};
use windfall_numerics::ode::step::Tolerance;

/// Standard deviations of displacement, rate and force: a pendulum's.
const NOISE: [f64; 3] = [5e-6, 3e-3, 0.3];

fn pendulum() -> Motion {
    Motion::from(&Rig::Pendulum(Pendulum {
        inertia: 0.051,
        arm: 0.505,
        mass: 0.3,
        centre_of_mass: 0.5,
        gravity: 9.81,
    }))
}

fn carriage() -> Motion {
    Motion::from(&Rig::Carriage(Carriage {
        mass: 0.25,
        driving_acceleration: 0.4,
    }))
}

fn parameter(target: Target, coordinate: Coordinate, lower: f64, upper: f64) -> FreeParameter {
    FreeParameter {
        prior: None,
        target,
        coordinate,
        lower,
        upper,
    }
}

/// k, c, velocity and onset.
fn free() -> [FreeParameter; 4] {
    [
        parameter(Target::Law(0), Coordinate::Logarithm, 1e-3, 1e12),
        parameter(Target::Law(1), Coordinate::Logarithm, 1e-6, 1e9),
        parameter(Target::InitialVelocity, Coordinate::Logarithm, 0.01, 5.0),
        parameter(Target::Onset, Coordinate::Linear(1e-3), -1e-3, 1e-3),
    ]
}

/// One impact of a batch.
struct Case {
    motion: Motion,
    end: EndRule,
    /// First and last time; s.
    span: (f64, f64),
    samples: usize,
    velocity: f64,
}

impl Case {
    fn setting(&self) -> Setting {
        Setting {
            motion: self.motion,
            end: self.end,
            tolerance: Tolerance {
                relative: 1e-8,
                absolute: [5e-13, 5e-11],
            },
            tied_velocity: None,
            sampling: Sampling::Instantaneous,
        }
    }

    fn values<const N: usize>(&self, law: [f64; N]) -> Values<N> {
        Values {
            law,
            velocity: self.velocity,
            inverse_mass: self.motion.inverse_mass,
            onset: 0.0,
            offset: 0.0,
        }
    }
}

/// Lengths, spans and rigs that make the lanes of a batch unlike each other: with
/// flight before and after, without, and ending in contact.
fn cases() -> Vec<Case> {
    (0..11)
        .map(|i| {
            let before = [0.0, -1e-3, 0.0][i % 3];
            let after = [12e-3, 9e-3, 4e-3, 30e-3][i % 4];
            Case {
                motion: if i % 3 == 1 { carriage() } else { pendulum() },
                end: if i % 5 == 3 {
                    EndRule::GapZero
                } else {
                    EndRule::ForceZero
                },
                span: (before, after),
                samples: 301 + 97 * i,
                velocity: 0.2 + 0.05 * i as f64,
            }
        })
        .collect()
}

/// Standard normal numbers by the sum of twelve uniform ones (Marsaglia's
/// xorshift64).
fn noise(seed: usize) -> impl FnMut() -> f64 {
    let mut state = 0x9E37_79B9_7F4A_7C15_u64.wrapping_mul(seed as u64 + 1);
    move || {
        let uniform = |state: &mut u64| {
            *state ^= *state << 13;
            *state ^= *state >> 7;
            *state ^= *state << 17;
            (*state >> 11) as f64 / (1_u64 << 53) as f64
        };
        (0..12).map(|_| uniform(&mut state)).sum::<f64>() - 6.0
    }
}

/// A recording of the case under a law: the model where nothing is measured,
/// with noise.
fn recording<L: FreeLaw<N>, const N: usize>(
    case: &Case,
    law: L,
    values: [f64; N],
    seed: usize,
) -> SampleGroup {
    let (from, to) = case.span;
    let times: Vec<f64> = (0..case.samples)
        .map(|i| from + (to - from) * i as f64 / (case.samples - 1) as f64)
        .collect();
    let zero = vec![0.0; times.len()];
    let blank = [SampleGroup::new(
        &times,
        [
            Some((&zero, 1.0)),
            Some((&zero, 1.0)),
            Some((&zero, 1.0)),
            None,
        ],
    )];
    let estimator =
        Estimator::<L, N, 4, 2>::new(law, case.setting(), &blank, &[], case.values(values));
    let (_, rows) = estimator.rows(&[0.0; 2]).unwrap();
    let mut noise = noise(seed);
    let measured: Vec<Vec<f64>> = (0..3)
        .map(|q| {
            let model = rows.residuals[0][q].iter();
            model.map(|value| value + NOISE[q] * noise()).collect()
        })
        .collect();
    let channel = |q: usize| Some((measured[q].as_slice(), NOISE[q].powi(-2)));
    SampleGroup::new(&times, [channel(0), channel(1), channel(2), None])
}

fn options<const P: usize>() -> Options<P> {
    Options {
        largest_step: [2.0; P],
        roughness: 1e-6,
        foresight: 0.01,
        ..Options::default()
    }
}

/// Fits of the cases, together and one by one, with the first `P` of the free
/// parameters; all fits together are those one by one.
fn compare<L: BatchLaw<N>, const N: usize, const W: usize, const P: usize>(
    law: L,
    truth: impl Fn(usize) -> [f64; N],
    start: [f64; N],
) -> Vec<Minimum<P>> {
    let cases = cases();
    let groups: Vec<[SampleGroup; 1]> = cases
        .iter()
        .enumerate()
        .map(|(i, case)| [recording(case, law.with_values(truth(i)), truth(i), i)])
        .collect();
    let free = free();
    let problems: Vec<BatchProblem<L, N, W, P>> = cases
        .iter()
        .zip(&groups)
        .map(|(case, groups)| BatchProblem {
            estimator: Estimator::new(law, case.setting(), groups, &free[..P], case.values(start)),
            from: None,
            options: options(),
        })
        .collect();
    let mut together = vec![Minimum::NONE; problems.len()];
    let longest = groups.iter().max_by_key(|own| own[0].times().len());
    let mut room = Room::of(longest.unwrap());
    let work = || minimise_batch(&problems, &mut together, &mut room);
    let allocated = allocation_counter::measure(work);
    assert_eq!(allocated.count_total, 0, "{allocated:?}");
    for (i, problem) in problems.iter().enumerate() {
        let alone = problem.estimator.clone().minimise(&problem.options);
        assert_eq!(together[i], alone, "impact {i}");
    }
    // From coordinates near the minima, as replicates of a bootstrap start.
    let near: Vec<_> = problems
        .iter()
        .zip(&together)
        .map(|(problem, minimum)| BatchProblem {
            from: Some(minimum.parameters.map(|u| u + 0.01)),
            ..problem.clone()
        })
        .collect();
    let mut found = vec![Minimum::NONE; problems.len()];
    minimise_batch(&near, &mut found, &mut room);
    for (i, problem) in near.iter().enumerate() {
        let from = problem.from.unwrap();
        let mut alone = problem.estimator.clone();
        let alone = alone.minimise_from(&from, &problem.options);
        assert_eq!(found[i], alone, "impact {i}");
    }
    // In another order, and fewer of them.
    let backwards: Vec<_> = problems.iter().rev().cloned().collect();
    let mut found = vec![Minimum::NONE; problems.len()];
    minimise_batch(&backwards, &mut found, &mut room);
    found.reverse();
    assert_eq!(found, together);
    let mut few = vec![Minimum::NONE; 3];
    minimise_batch(&problems[5..], &mut few, &mut room);
    assert_eq!(few, together[5..8]);
    together
}

fn kuwabara_kono(i: usize) -> [f64; 2] {
    [2e5 + 4e4 * i as f64, 300.0 + 60.0 * i as f64]
}

/// Two parameters of the law compiled for lanes, from a start a factor away: the
/// parameters that the recordings were made with, within what their noise allows.
#[test]
fn repeats_single_fits_and_recovers_two_parameters() {
    let law = KuwabaraKono { k: 1e5, c: 100.0 };
    let found = compare::<_, 2, 3, 2>(law, kuwabara_kono, [1e5, 200.0]);
    let cases = cases();
    for (i, minimum) in found.iter().enumerate() {
        // Where the gap ends the contact, the slope of this law has no bound.
        if cases[i].end == EndRule::GapZero {
            continue;
        }
        assert_eq!(minimum.stop, Stop::Converged, "impact {i}");
        assert!(minimum.equations.cost > 0.0);
        let truth = kuwabara_kono(i);
        let normal = minimum.equations.normal;
        let determinant = normal[0][0] * normal[1][1] - normal[0][1] * normal[1][0];
        for p in 0..2 {
            let sd = (normal[1 - p][1 - p] / determinant).sqrt();
            let off = (minimum.parameters[p] - truth[p].ln()).abs();
            assert!(off < 5.0 * sd, "impact {i}, parameter {p}: {off} of {sd}");
        }
    }
}

/// Four columns, the onset among them: samples are condensed, not left out.
#[test]
fn repeats_single_fits_with_velocity_and_onset() {
    let law = KuwabaraKono { k: 1e5, c: 100.0 };
    let found = compare::<_, 2, 4, 4>(law, kuwabara_kono, [1.5e5, 250.0]);
    assert!(found.iter().any(|minimum| minimum.stop == Stop::Converged));
}

/// Where fits with condensed samples end, the minimiser that is given all samples at once
/// finds nothing left to gain.
#[test]
fn converges_at_the_minimum_of_all_samples() {
    let law = KuwabaraKono { k: 1e5, c: 100.0 };
    let free = free();
    let mut compared = 0;
    for (i, case) in cases().iter().enumerate() {
        let truth = kuwabara_kono(i);
        let groups = [recording(case, law.with_values(truth), truth, i)];
        let start = case.values([1.5e5, 250.0]);
        let mut estimator =
            Estimator::<_, 2, 4, 4>::new(law, case.setting(), &groups, &free, start);
        let found = estimator.minimise(&options());
        let bounds = estimator.bounds();
        let all = minimise(&mut estimator, &found.parameters, &bounds, &options());
        if [found.stop, all.stop] != [Stop::Converged; 2] {
            continue;
        }
        compared += 1;
        let covariance = all.equations.inverse(4).unwrap();
        for p in 0..4 {
            let off = (found.parameters[p] - all.parameters[p]).abs();
            let sd = covariance[p][p].sqrt();
            assert!(off < 1e-3 * sd, "impact {i}, parameter {p}: {off} of {sd}");
        }
    }
    assert!(compared > 5, "{compared}");
}

/// Laws that go through lanes one by one (Hunt-Crossley), and laws with history or
/// a kink that do not go through lanes at all.
#[test]
fn repeats_single_fits_of_any_law() {
    for name in ["hunt-crossley", "walton-braun", "thornton"] {
        let kind = LawKind::from_name(name).unwrap();
        let parameters = kind.describe().parameters;
        let typical: Vec<f64> = parameters.iter().map(|p| p.typical).collect();
        let law = AnyLaw(kind.from_values(&typical).unwrap());
        let scaled = |factor: f64| {
            let mut values = [0.0; LARGEST_PARAMETERS];
            values[..typical.len()].copy_from_slice(&typical);
            values[0] *= factor;
            values
        };
        let found = compare::<_, LARGEST_PARAMETERS, 8, 2>(
            law,
            |i| scaled(1.0 + 0.02 * i as f64),
            scaled(0.9),
        );
        assert!(found.iter().any(|m| m.stop == Stop::Converged), "{name}");
    }
}

/// Empty batches, and fewer places than problems.
#[test]
fn rejects_nothing_of_an_empty_batch() {
    let none: [BatchProblem<KuwabaraKono, 2, 3, 2>; 0] = [];
    let mut places = vec![Minimum::NONE; 1];
    minimise_batch(&none, &mut places, &mut Room::of(&[]));
    assert_eq!(places[0].evaluations, 0);
}
