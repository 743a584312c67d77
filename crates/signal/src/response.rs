//! What stands between the contact and the recorded force and displacement: a filter, a force
//! sensor that swings, an arm that bends.

use serde::Serialize;
use std::f64::consts::TAU;

/// Steps of the calculation for each period of what swings.
const STEPS: f64 = 60.0;
/// Most steps between two samples: what swings faster shows nothing there.
const MOST_STEPS: f64 = 100.0;

/// A swing of one mass on one spring.
///
/// ```text
/// y'' + 2 ζ ω y' + ω² y = ω² u
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Swing {
    /// Natural frequency, ω/2π; Hz.
    pub frequency: f64,
    /// Damping ratio, ζ, less than 1; 1.
    pub damping: f64,
}

/// Bending of the arm between the impactor and the place where its motion is measured: the
/// measured displacement lacks what the force bends.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Bending {
    /// How it swings.
    pub swing: Swing,
    /// Bending by a force at rest; m/N.
    pub compliance: f64,
}

/// What the instruments of a bench make of force and displacement; nothing by default.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Response {
    /// Corner of a filter of first order that the force passes; Hz.
    pub pole: Option<f64>,
    /// How the force sensor swings.
    pub sensor: Option<Swing>,
    /// How the arm bends.
    pub arm: Option<Bending>,
}

impl Swing {
    /// ω; 1/s.
    fn omega(self) -> f64 {
        TAU * self.frequency
    }

    /// How `input`, at even times `interval` apart, makes it swing from rest.
    ///
    /// Exact for an input that is straight between the times.
    fn follow(self, interval: f64, input: &[f64]) -> Vec<f64> {
        let (w, z) = (self.omega(), self.damping);
        let damped = w * (1.0 - z * z).max(0.0).sqrt();
        let decay = (-z * w * interval).exp();
        let (cos, sin) = ((damped * interval).cos(), (damped * interval).sin());
        let sin = match damped > 0.0 {
            true => sin / damped,
            false => interval,
        };
        // Free motion over an interval, of displacement and velocity.
        let free = |y: f64, v: f64| {
            (
                decay * (y * (cos + z * w * sin) + v * sin),
                decay * (v * (cos - z * w * sin) - y * w * w * sin),
            )
        };
        let (mut y, mut v) = (0.0, 0.0);
        let mut before = 0.0;
        let step = |&own: &f64| {
            let slope = (own - before) / interval;
            // The motion that an input on this line keeps up.
            let at = before - 2.0 * z / w * slope;
            let (free_y, free_v) = free(y - at, v - slope);
            y = free_y + own - 2.0 * z / w * slope;
            v = free_v + slope;
            before = own;
            y
        };
        input.iter().map(step).collect()
    }
}

/// How `input` passes a filter of first order, from rest; exact for an input that is straight
/// between the times.
fn follow_pole(corner: f64, interval: f64, input: &[f64]) -> Vec<f64> {
    let lag = 1.0 / (TAU * corner);
    let decay = (-interval / lag).exp();
    let (mut y, mut before) = (0.0, 0.0);
    let step = |&own: &f64| {
        let slope = (own - before) / interval;
        y = (y - before + lag * slope) * decay + own - lag * slope;
        before = own;
        y
    };
    input.iter().map(step).collect()
}

impl Response {
    /// Whether force and displacement are recorded as they are.
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }

    /// Whether the force passes a filter or a sensor that swings.
    pub fn smooths(&self) -> bool {
        self.pole.is_some() || self.sensor.is_some()
    }

    /// Coefficients of what the force is, F + a F' + b F'', of the force that is recorded; s, s².
    ///
    /// Exact for a filter or a sensor alone.
    pub fn force_terms(&self) -> (f64, f64) {
        let lag = self.pole.map_or(0.0, |corner| 1.0 / (TAU * corner));
        let (late, slow) = self.sensor.map_or((0.0, 0.0), |own| {
            (2.0 * own.damping / own.omega(), own.omega().powi(-2))
        });
        (lag + late, slow + lag * late)
    }

    /// Time between the steps of a calculation, which divides `interval`; s.
    pub fn step(&self, interval: f64) -> f64 {
        let swings = [self.sensor, self.arm.map(|arm| arm.swing)];
        let swings = swings.into_iter().flatten().map(|own| own.frequency);
        let highest = swings.chain(self.pole).fold(0.0, f64::max);
        interval / (interval * highest * STEPS).ceil().clamp(1.0, MOST_STEPS)
    }

    /// The force as it is recorded, less the force: of a force at times `interval` apart that
    /// begins at nothing; N.
    pub fn force_error(&self, interval: f64, force: &[f64]) -> Vec<f64> {
        let mut seen = force.to_vec();
        if let Some(corner) = self.pole {
            seen = follow_pole(corner, interval, &seen);
        }
        if let Some(sensor) = self.sensor {
            seen = sensor.follow(interval, &seen);
        }
        seen.iter()
            .zip(force)
            .map(|(seen, own)| seen - own)
            .collect()
    }

    /// The displacement as it is recorded, less that of the impactor, by the force; m.
    pub fn displacement_error(&self, interval: f64, force: &[f64]) -> Vec<f64> {
        match self.arm {
            None => vec![0.0; force.len()],
            Some(arm) => {
                let mut bent = arm.swing.follow(interval, force);
                bent.iter_mut().for_each(|own| *own *= -arm.compliance);
                bent
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A force of half a sine, every `interval` from 0.
    fn pulse(interval: f64, count: usize) -> Vec<f64> {
        let at = |i: usize| {
            let phase = i as f64 * interval / 4e-3;
            if phase < 1.0 {
                60.0 * (0.5 * TAU * phase).sin().powi(2)
            } else {
                0.0
            }
        };
        (0..count).map(at).collect()
    }

    #[test]
    fn closed_form_ramp() {
        // After the transients a ramp comes late by 2ζ/ω, or by the lag of the filter.
        let ramp: Vec<f64> = (0..4000).map(|i| f64::from(i) * 1e-6).collect();
        let sensor = Swing {
            frequency: 4e3,
            damping: 0.6,
        };
        let late = 2.0 * 0.6 / (TAU * 4e3);
        let own = Response {
            sensor: Some(sensor),
            ..Response::default()
        };
        let error = own.force_error(1e-6, &ramp)[3999];
        assert!((error + late).abs() < 1e-9 * late, "{error} {late}");
        let own = Response {
            pole: Some(4e3),
            ..Response::default()
        };
        let error = own.force_error(1e-6, &ramp)[3999];
        assert!((error * TAU * 4e3 + 1.0).abs() < 1e-9, "{error}");
    }

    #[test]
    fn converges_to_the_equation_of_motion() {
        // F = y + a y' + b y'' of what is recorded, by central differences.
        let h = 1e-6;
        let force = pulse(h, 5000);
        for own in [
            Response {
                pole: Some(3e3),
                ..Response::default()
            },
            Response {
                sensor: Some(Swing {
                    frequency: 2e3,
                    damping: 0.05,
                }),
                ..Response::default()
            },
        ] {
            let error = own.force_error(h, &force);
            let seen: Vec<f64> = error.iter().zip(&force).map(|(e, f)| e + f).collect();
            let (a, b) = own.force_terms();
            for i in (10..4990).filter(|i| i % 7 == 0) {
                let first = (seen[i + 1] - seen[i - 1]) / (2.0 * h);
                let second = (seen[i + 1] - 2.0 * seen[i] + seen[i - 1]) / (h * h);
                let back = seen[i] + a * first + b * second;
                assert!((back - force[i]).abs() < 2e-3, "{i}: {back} {}", force[i]);
            }
        }
    }

    #[test]
    fn closed_form_bending_at_rest() {
        let swing = Swing {
            frequency: 1500.0,
            damping: 0.3,
        };
        let arm = Some(Bending {
            swing,
            compliance: 1e-7,
        });
        let own = Response {
            arm,
            ..Response::default()
        };
        let error = own.displacement_error(1e-5, &[50.0; 2000]);
        assert!((error[1999] + 5e-6).abs() < 1e-15);
        assert!(own.force_error(1e-5, &[50.0; 20]).iter().all(|e| *e == 0.0));
        assert_eq!(own.step(5e-6), 5e-6);
        assert!(own.step(1e-3) <= 1.0 / (STEPS * 1500.0));
    }
}
