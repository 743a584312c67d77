//! Walls: where they are, what they are made of, how they move.

use crate::shape::motion::Motion;
use crate::shape::surface::Shape;
use crate::vector::{Vector, cross, length, subtract};

/// A wall of the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Wall {
    /// Name, for people.
    pub name: String,
    /// Material, by its number in the scene.
    pub material: usize,
    /// Its surface at rest.
    pub shape: Shape,
    /// How it moves.
    pub motion: Motion,
}

impl Wall {
    /// The largest speed of its points between two times; of an endless plane without its
    /// rotation; m/s.
    pub fn largest_speed(&self, between: [f64; 2]) -> f64 {
        self.motion.largest_speed(self.reach(), between)
    }

    /// How far its points are from the axis that it turns about; 0 of an endless plane, and where it
    /// does not turn; m.
    pub(crate) fn reach(&self) -> f64 {
        let Some(axis) = self.motion.axis() else {
            return 0.0;
        };
        let (points, reach) = self.shape.skeleton();
        let off = |own: &Vector| length(cross(subtract(*own, axis.point), axis.direction));
        let reach = points.iter().map(off).fold(0.0, f64::max) + reach;
        if reach.is_finite() { reach } else { 0.0 }
    }
}
