//! Simulated impacts on the rubber half-ball of the 2003 pendulum study, from
//! the raw signals of its instrument (encoder phases and volts at 200 kHz).

// Each test file uses a part of this.
#![allow(dead_code, clippy::unwrap_used)]

use windfall_contact::expression::parse_law;
use windfall_contact::law::EndRule;
use windfall_identify::fit::problem::{FitOptions, LawProblem};
use windfall_identify::fit::result::{Estimate, fit_impact};
use windfall_identify::rig::kind::{Pendulum, Rig};
use windfall_identify::rig::simulate::trajectory;
use windfall_signal::extract::extract_impact;
use windfall_signal::impact::Impact;
use windfall_signal::instrument::{
    Instrument, Trajectory, calibrated, pendulum_instrument, record,
};
use windfall_signal::kinematics::Encoder;
use windfall_signal::options::ExtractOptions;
use windfall_signal::trigger::{Threshold, TriggerOptions};

/// Stiffness; N/m^1.5.
pub const K: f64 = 394_931.0;
/// Damping; N s/m^1.5.
pub const C: f64 = 681.0;
/// Velocity at first touch, from an angle of 10 degrees; m/s.
const VELOCITY: f64 = 0.388;

/// The pendulum; its inertia is inferred, the study does not give it.
pub fn rig() -> Rig {
    Rig::Pendulum(Pendulum {
        inertia: 0.014_35,
        arm: 0.505,
        mass: 0.08,
        centre_of_mass: 0.35,
        gravity: 9.806_65,
    })
}

/// One impact, extracted from its recording with a threshold of 1 N.
pub fn impact(seed: u64) -> Impact {
    impact_of(&pendulum_instrument(), seed)
}

/// One impact as another instrument records it.
pub fn impact_of(instrument: &Instrument, seed: u64) -> Impact {
    impact_with_flight(instrument, seed, 2.0)
}

/// One impact with so much free motion, in contact durations.
pub fn impact_with_flight(instrument: &Instrument, seed: u64, free_flight: f64) -> Impact {
    let law = parse_law(&format!("kuwabara-kono(k={K}, c={C})")).unwrap();
    let times: Vec<f64> = (0..2400).map(|i| -3e-3 + 5e-6 * f64::from(i)).collect();
    let law = law.complete().unwrap();
    let motion = trajectory(&law, &rig(), VELOCITY, &times, EndRule::ForceZero).unwrap();
    let motion = Trajectory {
        times: motion.times,
        displacement: motion.displacement,
        rate: motion.rate,
        force: motion.force,
        acceleration: motion.acceleration,
    };
    let raw = record(&motion, instrument, seed).unwrap();
    let recording = calibrated("simulated", &raw, instrument);
    let options = ExtractOptions {
        trigger: TriggerOptions {
            threshold: Threshold::Fixed(1.0),
            ..TriggerOptions::default()
        },
        encoder: Some(Encoder::Rotary {
            counts_per_revolution: 360_000.0,
        }),
        arm: Some(0.505),
        effective_mass: Some(rig().effective_mass()),
        free_flight,
        ..ExtractOptions::default()
    };
    extract_impact(&recording, &options).unwrap().0
}

/// How the estimates of one parameter compare with the truth.
#[derive(Clone, Copy, Debug)]
pub struct Recovery {
    /// Mean estimate over truth, less 1.
    pub bias: f64,
    /// Bias in standard errors of the mean.
    pub standard_errors: f64,
    /// Spread of the estimates over the truth.
    pub spread: f64,
    /// Mean standard deviation told by the fits over the truth.
    pub told: f64,
    /// Share of the 95 % intervals that hold the truth.
    pub coverage: f64,
}

/// Fits every impact and compares k and c with the truth.
pub fn recover(impacts: &[Impact], options: &FitOptions) -> [Recovery; 2] {
    let problem = LawProblem::from_expression(&parse_law("kuwabara-kono").unwrap());
    let fits: Vec<_> = impacts
        .iter()
        .map(|impact| fit_impact(impact, &rig(), &problem, options).unwrap())
        .collect();
    assert!(
        fits.iter().all(|fit| fit.converged),
        "a fit did not converge"
    );
    [K, C].map(|truth| {
        let index = usize::from(truth == C);
        let estimates: Vec<&Estimate> = fits.iter().map(|fit| &fit.parameters[index]).collect();
        compare(&estimates, truth)
    })
}

fn compare(estimates: &[&Estimate], truth: f64) -> Recovery {
    let n = estimates.len() as f64;
    let mean = estimates.iter().map(|e| e.value).sum::<f64>() / n;
    let square: f64 = estimates.iter().map(|e| (e.value - mean).powi(2)).sum();
    let spread = (square / (n - 1.0)).sqrt();
    let covered = estimates
        .iter()
        .filter(|e| e.low <= truth && truth <= e.high);
    Recovery {
        bias: mean / truth - 1.0,
        standard_errors: (mean - truth) / (spread / n.sqrt()),
        spread: spread / truth,
        told: estimates.iter().map(|e| e.sd).sum::<f64>() / n / truth,
        coverage: covered.count() as f64 / n,
    }
}
