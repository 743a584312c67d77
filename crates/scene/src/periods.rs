//! Axes along which a scene repeats.

use crate::vector::{Of, Vector};
use windfall_numerics::real::Real;

/// Along which axes a scene repeats, and after which lengths.
///
/// Along such an axis every place has images, a whole number of periods away.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Periods {
    /// Both ends of each axis, infinitely far along an open one; m.
    low: Vector,
    high: Vector,
    /// From one end to the other; m.
    length: Vector,
    /// Whether any axis is periodic.
    repeat: bool,
}

/// A shift that changes no number, not even the sign of a zero.
const NO_SHIFT: f64 = -0.0;

impl Default for Periods {
    fn default() -> Self {
        Self::new(&[None; 3])
    }
}

impl Periods {
    /// * `ends`: low and high of each periodic axis; m
    pub fn new(ends: &[Option<[f64; 2]>; 3]) -> Self {
        let open = [f64::NEG_INFINITY, f64::INFINITY];
        let [x, y, z] = ends.map(|own| own.unwrap_or(open));
        Self {
            low: [x[0], y[0], z[0]],
            high: [x[1], y[1], z[1]],
            length: [x[1] - x[0], y[1] - y[0], z[1] - z[0]],
            repeat: ends.iter().any(Option::is_some),
        }
    }

    /// Whether any axis is periodic.
    pub fn repeat(&self) -> bool {
        self.repeat
    }

    /// Low and high of a periodic axis; m.
    pub fn ends(&self, axis: usize) -> Option<[f64; 2]> {
        let ends = [self.low[axis], self.high[axis]];
        ends[0].is_finite().then_some(ends)
    }

    /// The difference of two places, of which the second is the nearest of its images; m.
    ///
    /// * `difference`: along each periodic axis less than 1.5 periods; m
    #[inline(always)]
    pub(crate) fn nearest<R: Real>(&self, difference: Of<R>) -> Of<R> {
        if !self.repeat {
            return difference;
        }
        let mut found = difference;
        for axis in 0..3 {
            let (own, length) = (difference[axis], self.length[axis]);
            let lower = (own + -0.5 * length).select(own + -length, own);
            // An open axis has no half: nothing is beyond it.
            found[axis] = (-own + -0.5 * length).select(own + length, lower);
        }
        found
    }

    /// The shift by whole periods that takes a place between the ends; m.
    pub(crate) fn shift(&self, place: Vector) -> Vector {
        [0, 1, 2].map(|axis| {
            let (at, low, high) = (place[axis], self.low[axis], self.high[axis]);
            match at < low || at >= high {
                true => -self.length[axis] * ((at - low) / self.length[axis]).floor(),
                false => NO_SHIFT,
            }
        })
    }

    /// The image of a place between the ends; m.
    pub fn wrapped(&self, place: Vector) -> Vector {
        let shift = self.shift(place);
        [0, 1, 2].map(|axis| place[axis] + shift[axis])
    }

    /// The image of a place that is nearest to another place, along each axis; m.
    pub fn image(&self, place: Vector, other: Vector) -> Vector {
        [0, 1, 2].map(|axis| {
            let length = self.length[axis];
            let periods = ((other[axis] - place[axis]) / length).round();
            match length.is_finite() && periods.is_finite() {
                true => place[axis] + length * periods,
                false => place[axis],
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use windfall_numerics::real::Lanes;

    #[test]
    fn closed_form_images_of_places() {
        let own = Periods::new(&[Some([-0.2, 1.0]), None, Some([0.0, 0.5])]);
        assert!(own.repeat() && own.ends(1).is_none());
        let near = |a: Vector, b: Vector| {
            for axis in 0..3 {
                assert!((a[axis] - b[axis]).abs() < 1e-15, "{a:?} {b:?}");
            }
        };
        near(own.wrapped([1.1, 7.0, -0.1]), [-0.1, 7.0, 0.4]);
        near(own.wrapped([-3.8, -7.0, 0.5]), [-0.2, -7.0, 0.0]);
        assert_eq!(own.wrapped([0.3, -0.0, 0.2]), [0.3, -0.0, 0.2]);
        near(
            own.image([0.9, 1.0, 0.1], [-0.1, 0.0, 0.2]),
            [-0.3, 1.0, 0.1],
        );
        near(own.nearest([1.1, 5.0, -0.3]), [-0.1, 5.0, 0.2]);
        near(own.nearest([-1.1, -5.0, 0.2]), [0.1, -5.0, 0.2]);
        near(own.nearest([0.5, 0.0, -0.2]), [0.5, 0.0, -0.2]);
        let lanes = own.nearest([Lanes([1.1, -1.1, 0.4]); 3]);
        assert_eq!(lanes[0].0[0], own.nearest([1.1, 0.0, 0.0])[0]);
        assert_eq!(lanes[0].0[1], own.nearest([-1.1, 0.0, 0.0])[0]);
        assert_eq!(lanes[1], Lanes([1.1, -1.1, 0.4]));
    }

    #[test]
    fn a_scene_without_ends_is_as_it_was() {
        let own = Periods::default();
        let place = [-0.0, 1e300, -7.5];
        assert!(!own.repeat());
        for found in [
            own.wrapped(place),
            own.image(place, [1.0; 3]),
            own.nearest(place),
        ] {
            assert_eq!(found.map(f64::to_bits), place.map(f64::to_bits));
        }
    }
}
