//! What happens between first touch and the crossing of the threshold, and again at the end.

use crate::measure::{GUARD, Surroundings};
use std::f64::consts::PI;

/// Mean of sin^1.5 over half a period, the shape of an elastic contact of two spheres; 1.
const MEAN_OF_PULSE: f64 = 0.556;

/// The force between touch and a low threshold grows with this power of the time; 1.
const ONSET_POWER: f64 = 1.5;

/// Touch and separation beside a window that a threshold has cut out of a contact.
///
/// The force is taken for a pulse F = P sin^1.5(π t / T), which Hertz contacts resemble. Damping
/// moves the two ends apart by a factor of about two, so these are uncertainties, not
/// corrections.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Touch {
    /// Threshold over peak; 1.
    share: f64,
    /// Between touch and crossing; s.
    late: f64,
    /// Onset to end; s.
    duration: f64,
}

impl Touch {
    /// * `threshold`, `peak`: of the force, or of whatever shows the contact; one unit
    pub(crate) fn new(threshold: f64, peak: f64, place: &Surroundings) -> Self {
        let (share, duration) = ((threshold / peak).clamp(0.0, 1.0), place.duration());
        let angle = share.powf(1.0 / ONSET_POWER).asin();
        // T = duration + 2 late, of which late is the part angle / π.
        let late = duration * angle / (PI - 2.0 * angle).max(angle);
        Self {
            share,
            late,
            duration,
        }
    }

    /// What a velocity read off the motion beside the window may be off; m/s.
    ///
    /// The driving acceleration acts from touch to crossing, and a part of the force reaches
    /// into the samples that were taken for free motion.
    ///
    /// * `change`: of the velocity in the whole contact; m/s
    /// * `driving`: acceleration of the free motion; m/s²
    pub(crate) fn velocity_sd(&self, change: f64, driving: f64) -> f64 {
        let reaches = (1.0 - GUARD * self.duration / self.late).max(0.0);
        let (power, whole) = (ONSET_POWER + 1.0, self.duration + 2.0 * self.late);
        let pushed = change.abs() * self.share * self.late / (power * MEAN_OF_PULSE * whole);
        (driving * self.late).hypot(pushed * reaches.powf(power))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLACE: Surroundings = Surroundings {
        onset: 0.0,
        end: 6e-3,
        from: -1.0,
        until: 1.0,
    };

    #[test]
    fn closed_form_half_of_a_pulse() {
        // sin^1.5 is above one half from 0.2169 T on. By the midpoint rule it pushes with 0.0589
        // of the whole from touch until a guard of 5 % of the window before the crossing.
        let touch = Touch::new(10.0, 20.0, &PLACE);
        let whole = 6e-3 / (1.0 - 2.0 * 0.2169);
        assert!((touch.late / whole - 0.2169).abs() < 1e-4, "{touch:?}");
        let pushed = touch.velocity_sd(1.0, 0.0);
        assert!((pushed / 0.0589 - 1.0).abs() < 0.1, "{pushed}");
        let driven = touch.velocity_sd(0.0, 9.81);
        assert!((driven - 9.81 * touch.late).abs() < 1e-12);
    }

    #[test]
    fn closed_form_nothing_is_left_of_a_low_threshold() {
        let touch = Touch::new(0.01, 20.0, &PLACE);
        assert_eq!(touch.velocity_sd(1.0, 0.0), 0.0);
        assert_eq!(Touch::new(0.0, 20.0, &PLACE).velocity_sd(1.0, 9.81), 0.0);
    }
}
