//! Times one Kuwabara-Kono fit of 1,111 samples with the built-in law and with
//! the same law written as a formula, in turns: `user_law_speed [FITS]`.
//!
//! Both go the way of `fit_impact`'s solver: arrays of the same size, the same
//! minimum. Prints one JSON line; `ratio` is that of the median times.

#![allow(clippy::print_stdout, clippy::unwrap_used)]

use std::time::Instant;
use windfall_contact::law::EndRule;
use windfall_contact::laws::define_law::define_law;
use windfall_contact::laws::kind::{Law, LawKind};
use windfall_contact::laws::kuwabara_kono::KuwabaraKono;
use windfall_contact::laws::user::{UserForce, UserLaw, UserLawDefinition, UserParameter};
use windfall_identify::fit::estimator::{
    Coordinate, Estimator, FreeLaw, FreeParameter, Setting, Target, Values,
};
use windfall_identify::fit::model::Sampling;
use windfall_identify::rig::kind::{Pendulum, Rig};
use windfall_identify::rig::motion::Motion;
use windfall_identify::rig::simulate::trajectory;
use windfall_identify::samples::SampleGroup;
use windfall_numerics::least_squares::Options;
use windfall_numerics::ode::step::Tolerance;
use windfall_signal::noise::gaussian::{noise_source, normal};

/// Instants of three channels: 1,110 or 1,113 samples come nearest to 1,111.
const INSTANTS: usize = 371;
const VELOCITY: f64 = 0.35;
const TRUTH: [f64; 2] = [753_599.0, 1524.0];
const ARM: f64 = 0.505;

fn rig() -> Rig {
    Rig::Pendulum(Pendulum {
        inertia: 0.2 * ARM * ARM,
        arm: ARM,
        mass: 0.3,
        centre_of_mass: ARM,
        gravity: 9.81,
    })
}

fn own() -> LawKind {
    let parameter = |name: &str, unit: &str, start| UserParameter {
        name: name.into(),
        unit: unit.into(),
        meaning: String::new(),
        lower: 0.0,
        upper: f64::INFINITY,
        start: Some(start),
        default: None,
    };
    define_law(&UserLawDefinition {
        name: "mine".into(),
        force: UserForce::Formula("k*x^1.5 + c*x^0.5*v".into()),
        parameters: vec![
            parameter("k", "N/m^1.5", 4e5),
            parameter("c", "N s/m^1.5", 600.0),
        ],
    })
    .unwrap()
}

/// Noisy displacement, rate and force of one impact.
fn samples() -> SampleGroup {
    let law = LawKind::KuwabaraKono.with_parameters(&TRUTH).unwrap();
    let times: Vec<f64> = (0..INSTANTS).map(|i| 5e-6 + 1.7e-5 * i as f64).collect();
    let motion = trajectory(&law, &rig(), VELOCITY, &times, EndRule::ForceZero).unwrap();
    let mut source = noise_source(1, 1);
    let mut noisy = |values: &[f64], sd: f64| -> Vec<f64> {
        values
            .iter()
            .map(|v| v + sd * normal(&mut source))
            .collect()
    };
    let x = noisy(&motion.displacement, 2e-6);
    let v = noisy(&motion.rate, 2e-3);
    let force = noisy(&motion.force, 0.3);
    let weight = |sd: f64| 1.0 / (sd * sd);
    let channels = [
        Some((&x[..], weight(2e-6))),
        Some((&v[..], weight(2e-3))),
        Some((&force[..], weight(0.3))),
        None,
    ];
    SampleGroup::new(&times, channels)
}

fn fit<L: FreeLaw<N>, const N: usize, const W: usize, const P: usize>(
    law: L,
    group: &SampleGroup,
) -> [f64; 2] {
    let motion = Motion::from(&rig());
    let setting = Setting {
        motion,
        end: EndRule::ForceZero,
        tolerance: Tolerance {
            relative: 1e-8,
            absolute: [1e-12 * ARM, 1e-10 * ARM],
        },
        tied_velocity: None,
        sampling: Sampling::Instantaneous,
    };
    let free = [0, 1].map(|i| FreeParameter {
        prior: None,
        target: Target::Law(i),
        coordinate: Coordinate::Logarithm,
        lower: 1e-3,
        upper: 1e12,
    });
    let mut law_values = [0.0; N];
    law_values[..2].copy_from_slice(&[2e5, 300.0]);
    let base = Values {
        law: law_values,
        velocity: VELOCITY,
        inverse_mass: motion.inverse_mass,
        onset: 0.0,
        offset: 0.0,
    };
    let mut estimator =
        Estimator::<L, N, W, P>::new(law, setting, std::slice::from_ref(group), &free, base);
    let minimum = estimator.minimise(&Options {
        largest_step: [2.0; P],
        ..Options::default()
    });
    let values = estimator.values(&minimum.parameters);
    [values.law[0], values.law[1]]
}

fn median(mut seconds: Vec<f64>) -> f64 {
    seconds.sort_by(f64::total_cmp);
    seconds[seconds.len() / 2]
}

/// Median seconds of a fit with each law, in turns.
fn race<const P: usize>(own: UserLaw, group: &SampleGroup, fits: usize) -> [f64; 2] {
    let built_in = KuwabaraKono::from(TRUTH);
    let mut seconds = [Vec::new(), Vec::new()];
    for _ in 0..fits {
        let begin = Instant::now();
        std::hint::black_box(fit::<_, 2, 4, P>(built_in, std::hint::black_box(group)));
        seconds[0].push(begin.elapsed().as_secs_f64());
        let begin = Instant::now();
        std::hint::black_box(fit::<_, 6, 4, P>(own, std::hint::black_box(group)));
        seconds[1].push(begin.elapsed().as_secs_f64());
    }
    seconds.map(median)
}

fn main() {
    let fits = std::env::args()
        .nth(1)
        .map_or(2001, |text| text.parse().unwrap());
    let Law::User(law) = own().with_parameters(&TRUTH).unwrap() else {
        unreachable!("a user's law")
    };
    let group = samples();
    let (one, two) = (
        fit::<_, 2, 4, 5>(KuwabaraKono::from(TRUTH), &group),
        fit::<_, 6, 4, 5>(law, &group),
    );
    let deviation = (0..2)
        .map(|i| (two[i] / one[i] - 1.0).abs())
        .fold(0.0, f64::max);
    // Arrays of five free parameters, as fits with onset and velocity use.
    let [built_in, formula] = race::<5>(law, &group, fits);
    println!(
        "{{\"samples\":{},\"built_in_seconds\":{built_in:e},\"formula_seconds\":{formula:e},\"ratio\":{:.3},\"deviation\":{deviation:e}}}",
        3 * INSTANTS,
        formula / built_in
    );
}
