//! Simulated recordings of the pendulum of the 2003 study, for studies of many.

// Each study uses a part of this.
#![allow(dead_code)]

use windfall_contact::law::EndRule;
use windfall_contact::laws::kind::Law;
use windfall_identify::rig::kind::{Pendulum, Rig};
use windfall_identify::rig::simulate::trajectory;
use windfall_signal::extract::extract_impact;
use windfall_signal::impact::Impact;
use windfall_signal::instrument::{
    Instrument, Trajectory, calibrated, pendulum_instrument, record,
};
use windfall_signal::kinematics::Encoder;
use windfall_signal::noise::gaussian::{noise_source, uniform};
use windfall_signal::options::ExtractOptions;
use windfall_signal::trigger::{Threshold, TriggerOptions};

/// Recorded before first touch and after it; s.
const SPAN: (f64, f64) = (12e-3, 24e-3);
/// Sampling interval of encoder and force; s.
const INTERVAL: f64 = 5e-6;
/// Length of the arm; m.
const ARM: f64 = 0.505;

/// An instrument with its name.
#[derive(Clone)]
pub struct Bench {
    /// What it is.
    pub name: &'static str,
    instrument: Instrument,
    encoder: Encoder,
    threshold: Threshold,
    /// Contact durations of free motion that are used.
    free_flight: f64,
}

impl Bench {
    /// The same with the threshold that the recordings themselves suggest, in place
    /// of 1 N.
    pub fn with_found_threshold(mut self) -> Self {
        self.threshold = Threshold::default();
        self
    }

    /// The same with that many contact durations of free motion.
    pub fn with_flight(mut self, durations: f64) -> Self {
        self.free_flight = durations;
        self
    }
}

/// The study's encoder with another resolution, its force sensor with another
/// noise.
pub fn bench(
    name: &'static str,
    counts_per_revolution: f64,
    noise: f64,
    persistence: f64,
) -> Bench {
    let mut instrument = pendulum_instrument();
    let encoder = Encoder::Rotary {
        counts_per_revolution,
    };
    if let Some(force) = &mut instrument.force {
        force.noise = noise;
        force.persistence = persistence;
    }
    if let Some(sensor) = &mut instrument.encoder {
        sensor.encoder = encoder;
        // Good lines; the fit reckons with at least as much.
        sensor.line_error = 0.02;
    }
    Bench {
        name,
        instrument,
        encoder,
        threshold: Threshold::Fixed(1.0),
        free_flight: ExtractOptions::default().free_flight,
    }
}

/// The pendulum; its inertia is inferred, the study does not give it.
pub fn rig() -> Rig {
    Rig::Pendulum(Pendulum {
        inertia: 0.014_35,
        arm: ARM,
        mass: 0.08,
        centre_of_mass: 0.35,
        gravity: 9.806_65,
    })
}

/// One impact as it is cut out of its raw recording; `None` where it cannot be.
pub fn recorded(bench: &Bench, law: &Law, velocity: f64, seed: u64) -> Option<Impact> {
    // The clock of the instrument knows nothing of the impact.
    let start = -SPAN.0 - INTERVAL * uniform(&mut noise_source(seed, 1001));
    let count = ((SPAN.0 + SPAN.1) / INTERVAL) as usize;
    let times: Vec<f64> = (0..count).map(|i| start + INTERVAL * i as f64).collect();
    let motion = trajectory(law, &rig(), velocity, &times, EndRule::ForceZero).ok()?;
    let motion = Trajectory {
        times: motion.times,
        displacement: motion.displacement,
        rate: motion.rate,
        force: motion.force,
        acceleration: motion.acceleration,
    };
    let raw = record(&motion, &bench.instrument, seed).ok()?;
    let recording = calibrated("simulated", &raw, &bench.instrument);
    let options = ExtractOptions {
        trigger: TriggerOptions {
            threshold: bench.threshold,
            ..TriggerOptions::default()
        },
        encoder: Some(bench.encoder),
        arm: Some(ARM),
        free_flight: bench.free_flight,
        effective_mass: Some(rig().effective_mass()),
        ..ExtractOptions::default()
    };
    extract_impact(&recording, &options)
        .ok()
        .map(|found| found.0)
}

/// Words of the command line, and the first number of all seeds, from `--seed S` (0): other
/// studies of the same kind.
pub fn arguments() -> (Vec<String>, u64) {
    let mut words: Vec<String> = std::env::args().skip(1).collect();
    let Some(at) = words.iter().position(|word| word == "--seed") else {
        return (words, 0);
    };
    let seed: Vec<String> = words.drain(at..(at + 2).min(words.len())).collect();
    let seed: u64 = seed.get(1).map_or(0, |text| text.parse().unwrap());
    (words, seed * 1_000_000)
}

/// `work` on 0 … count − 1 on that many threads; results in order.
pub fn on_threads<T: Send>(count: u64, threads: u64, work: impl Fn(u64) -> T + Sync) -> Vec<T> {
    let work = &work;
    let mut out: Vec<(u64, T)> = std::thread::scope(|scope| {
        let workers: Vec<_> = (0..threads)
            .map(|worker| {
                let own = (worker..count).step_by(threads as usize);
                scope.spawn(move || own.map(|i| (i, work(i))).collect::<Vec<_>>())
            })
            .collect();
        let done = workers.into_iter().filter_map(|worker| worker.join().ok());
        done.flatten().collect()
    });
    out.sort_by_key(|(i, _)| *i);
    out.into_iter().map(|(_, result)| result).collect()
}
