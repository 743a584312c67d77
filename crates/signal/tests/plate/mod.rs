//! A plate on spring and damper under half-sine contacts, by its exact solution:
//! shares no line with the library.

#![allow(dead_code, clippy::unwrap_used)]

use std::f64::consts::PI;
use windfall_signal::noise::gaussian::{noise_source, normal};
use windfall_signal::recording::{Channel, Quantity, Times};

/// Mass, stiffness and damping; kg, N/m, N s/m.
#[derive(Clone, Copy)]
pub struct Plate {
    pub mass: f64,
    pub stiffness: f64,
    pub damping: f64,
}

/// The plate of the study, with its corrected stiffness.
pub const PLATE: Plate = Plate {
    mass: 0.2,
    stiffness: 647_998.779,
    damping: 52.472_408,
};

impl Plate {
    pub fn decay(&self) -> f64 {
        self.damping / (2.0 * self.mass)
    }
    pub fn damped(&self) -> f64 {
        (self.stiffness / self.mass - self.decay().powi(2)).sqrt()
    }
    pub fn period(&self) -> f64 {
        2.0 * PI / self.damped()
    }
    pub fn ratio(&self) -> f64 {
        self.damping / (2.0 * (self.stiffness * self.mass).sqrt())
    }
    /// State (z, z′) after `t` of free motion.
    fn free(&self, (z, v): (f64, f64), t: f64) -> (f64, f64) {
        let (a, w) = (self.decay(), self.damped());
        let b = (v + a * z) / w;
        let (s, c) = (w * t).sin_cos();
        let e = (-a * t).exp();
        (
            e * (z * c + b * s),
            e * ((b * w - a * z) * c - (z * w + a * b) * s),
        )
    }
    /// State at `t` after the begin of P sin(πt/T), 0 ≤ t ≤ T, from rest.
    fn forced(&self, peak: f64, duration: f64, t: f64) -> (f64, f64) {
        // z_p = Im(P e^{iΩt} / (k − mΩ² + icΩ)) = A sin Ωt + B cos Ωt.
        let w = PI / duration;
        let (re, im) = (self.stiffness - self.mass * w * w, self.damping * w);
        let size = re * re + im * im;
        let (a, b) = (peak * re / size, -peak * im / size);
        let particular = |t: f64| {
            let (s, c) = (w * t).sin_cos();
            (a * s + b * c, w * (a * c - b * s))
        };
        let (p0, p) = (particular(0.0), particular(t));
        let f = self.free((-p0.0, -p0.1), t);
        (p.0 + f.0, p.1 + f.1)
    }
    /// Support force `t` after the onset of one contact.
    pub fn support(&self, peak: f64, duration: f64, t: f64) -> f64 {
        if t <= 0.0 {
            return 0.0;
        }
        let (z, v) = if t <= duration {
            self.forced(peak, duration, t)
        } else {
            self.free(self.forced(peak, duration, duration), t - duration)
        };
        self.stiffness * z + self.damping * v
    }
}

/// One contact: onset, peak of the contact force, duration.
#[derive(Clone, Copy, Debug)]
pub struct Contact {
    pub onset: f64,
    pub peak: f64,
    pub duration: f64,
}

impl Contact {
    pub fn impulse(&self) -> f64 {
        2.0 * self.peak * self.duration / PI
    }
}

/// Bounces of a mass that drops from a height with a constant restitution onto
/// a half-sine contact: each impulse is m (v + v′) + m g T, each flight 2 v′/g.
pub fn bounces(mass: f64, height: f64, e: f64, duration: f64, count: usize) -> Vec<Contact> {
    let g = 9.80665;
    let mut onset = 0.02;
    let mut speed = (2.0 * g * height).sqrt();
    (0..count)
        .map(|_| {
            let impulse = mass * speed * (1.0 + e) + mass * g * duration;
            let contact = Contact {
                onset,
                peak: PI * impulse / (2.0 * duration),
                duration,
            };
            speed *= e;
            onset += duration + 2.0 * speed / g;
            contact
        })
        .collect()
}

/// How a recording is made of contacts.
#[derive(Clone, Copy)]
pub struct Record {
    pub rate: f64,
    pub noise: f64,
    pub level: f64,
    pub drift: f64,
    pub from: f64,
    pub to: f64,
    pub sign: f64,
    pub quantum: f64,
    pub limit: f64,
    pub seed: u64,
}

pub const RECORD: Record = Record {
    rate: 10_000.0,
    noise: 0.01,
    level: 1.96,
    drift: 0.0,
    from: 0.0,
    to: 1.0,
    sign: 1.0,
    quantum: 0.0,
    limit: f64::INFINITY,
    seed: 1,
};

pub fn times(record: &Record) -> Vec<f64> {
    let n = ((record.to - record.from) * record.rate).round() as usize;
    (0..n)
        .map(|i| record.from + i as f64 / record.rate)
        .collect()
}

/// Force of a recording; `plate` None is a rigid support.
pub fn force(contacts: &[Contact], plate: Option<&Plate>, record: &Record) -> Vec<f64> {
    let mut source = noise_source(record.seed, 0);
    let one = |c: &Contact, t: f64| match plate {
        Some(plate) => plate.support(c.peak, c.duration, t - c.onset),
        None if t > c.onset && t < c.onset + c.duration => {
            c.peak * (PI * (t - c.onset) / c.duration).sin()
        }
        None => 0.0,
    };
    times(record)
        .iter()
        .map(|&t| {
            let sum: f64 = contacts.iter().map(|c| one(c, t)).sum();
            let value = record.level + record.drift * t + record.sign * sum;
            let value = (value + record.noise * normal(&mut source)).min(record.limit);
            if record.quantum > 0.0 {
                (value / record.quantum).round() * record.quantum
            } else {
                value
            }
        })
        .collect()
}

pub fn channel(contacts: &[Contact], plate: Option<&Plate>, record: &Record) -> Channel {
    Channel {
        name: "force".to_owned(),
        quantity: Quantity::Force,
        times: Times::Uniform {
            start: record.from,
            interval: 1.0 / record.rate,
        },
        samples: force(contacts, plate, record),
    }
}
