//! Free flight of the fruit over the free plate, in closed form.

use crate::dual::instant;
use crate::plate_ringing::Ringing;
use windfall_numerics::real::Lanes;
use windfall_numerics::root::bracketed_root;

/// Events are located to this fraction of the bracket.
const EVENT_TOLERANCE: f64 = 1e-15;
/// Part of a step at which a gap that opens from zero is known to be open.
const JUST_OPEN: f64 = 1e-6;
/// Steps before a search is given up.
const LARGEST_STEPS: usize = 1_000_000;

/// A body in free flight, and the plate on its own.
#[derive(Clone, Copy, Debug)]
pub struct FlightPiece<const W: usize> {
    /// When it began, since first touch of the drop; s.
    pub start: Lanes<W>,
    /// How long it lasts; infinite where nothing follows; s.
    pub duration: f64,
    /// Height of the fruit at the start, 0 where it touches the plate in its
    /// static position; m.
    pub height: Lanes<W>,
    /// Velocity of the fruit at the start, up positive; m/s.
    pub velocity: Lanes<W>,
    /// Acceleration towards the plate; m/s².
    pub gravity: Lanes<W>,
    /// The plate; `None` where it does not move.
    pub plate: Option<Ringing<W>>,
}

impl<const W: usize> FlightPiece<W> {
    /// Height (m) and velocity (m/s) of the fruit at a time since the start (s).
    #[inline(always)]
    pub fn fruit(&self, time: f64) -> (Lanes<W>, Lanes<W>) {
        let height = self.height + self.velocity * time + self.gravity * (-0.5 * time * time);
        (height, self.velocity + self.gravity * (-time))
    }

    /// Displacement (m) and velocity (m/s) of the plate at a time since the
    /// start (s).
    #[inline(always)]
    pub fn plate(&self, time: f64) -> (Lanes<W>, Lanes<W>) {
        self.plate
            .as_ref()
            .map_or((Lanes::ZERO, Lanes::ZERO), |plate| plate.at(time))
    }

    /// Gap between fruit and plate; m.
    fn gap(&self, time: f64) -> f64 {
        let plate = self.plate.as_ref().map_or(0.0, |p| p.values_at(time).0);
        self.fruit_height(time) - plate
    }

    fn fruit_height(&self, time: f64) -> f64 {
        let (y, w, g) = (self.height.0[0], self.velocity.0[0], self.gravity.0[0]);
        y + (w - 0.5 * g * time) * time
    }

    /// When the fruit next comes down to a level below it; s.
    fn falls_to(&self, level: f64) -> f64 {
        let (w, g) = (self.velocity.0[0], self.gravity.0[0]);
        let above = (self.height.0[0] - level).max(0.0);
        let root = (w * w + 2.0 * g * above).sqrt();
        // Without loss of digits where the fruit falls already.
        if w > 0.0 {
            (w + root) / g
        } else {
            2.0 * above / (root - w)
        }
    }

    /// When fruit and plate next touch, after their gap has been open; s.
    ///
    /// `None` where they never do.
    pub fn next_touch(&self) -> Option<f64> {
        let Some(plate) = &self.plate else {
            let time = self.falls_to(0.0);
            return time.is_finite().then_some(time);
        };
        let (largest, decay) = plate.bound();
        let last = self.falls_to(-largest);
        if !last.is_finite() {
            return None;
        }
        let short = plate.short_time().min(0.25 * last.max(f64::MIN_POSITIVE));
        let (mut before, mut open) = (0.0, self.gap(0.0) > 0.0);
        for _ in 0..LARGEST_STEPS {
            // Above anything that the plate can reach: on to where it is not.
            let above = |t: f64| self.fruit_height(t) - largest * (-decay * t).exp();
            if open && above(before) > 0.0 {
                before = bracketed_root(before, last, EVENT_TOLERANCE * last, above);
                before = f64::max(before - EVENT_TOLERANCE * last, 0.0);
            }
            let after = before + short;
            if self.gap(after) <= 0.0 {
                if open {
                    let tolerance = EVENT_TOLERANCE * after;
                    return Some(bracketed_root(before, after, tolerance, |t| self.gap(t)));
                }
                // Opened and closed again within the step.
                let soon = before + JUST_OPEN * short;
                if before == 0.0 && self.gap(soon) > 0.0 {
                    let tolerance = EVENT_TOLERANCE * after;
                    return Some(bracketed_root(soon, after, tolerance, |t| self.gap(t)));
                }
                if after > last {
                    return None;
                }
            } else {
                open = true;
            }
            before = after;
        }
        None
    }

    /// Total derivatives of a flight's end: the time at which fruit and plate
    /// touch, since the start, and (height, velocity, plate displacement, plate
    /// velocity) there.
    pub(crate) fn touch_at(&self, time: f64) -> (Lanes<W>, [Lanes<W>; 4]) {
        let (height, velocity) = self.fruit(time);
        let (x, u) = self.plate(time);
        let slope = velocity.0[0] - u.0[0];
        let shift = instant(height - x, slope);
        let acceleration = self.plate_acceleration(x, u);
        (
            shift + Lanes::unit(0, time),
            [
                height + shift * velocity.0[0],
                velocity + shift * (-self.gravity.0[0]),
                x + shift * u.0[0],
                u + shift * acceleration,
            ],
        )
    }

    fn plate_acceleration(&self, x: Lanes<W>, u: Lanes<W>) -> f64 {
        self.plate.as_ref().map_or(0.0, |plate| {
            let (b, q) = (plate.decay.0[0], plate.frequency_squared.0[0]);
            -2.0 * b * u.0[0] - (b * b + q) * x.0[0]
        })
    }
}
