//! Errors of a scene and of its run.

use crate::vector::Vector;

/// The problem.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A parameter of a law left its bounds.
    #[error("{0}")]
    Law(#[from] windfall_contact::error::Error),
    /// A number of the scene cannot be.
    #[error("{what} is {value}: {problem}")]
    Value {
        /// Of what.
        what: &'static str,
        /// The number.
        value: f64,
        /// The problem.
        problem: &'static str,
    },
    /// Two materials meet, and nothing says what then happens.
    #[error("nothing says what {first} and {second} do to each other")]
    InteractionMissing {
        /// One material.
        first: String,
        /// The other.
        second: String,
    },
    /// A wall is not the same one period on.
    #[error("the wall \"{wall}\" cannot be repeated along {axis}: {problem}")]
    Unrepeatable {
        /// Its name.
        wall: String,
        /// The periodic axis.
        axis: char,
        /// Why, and what to do.
        problem: &'static str,
    },
    /// A body overlaps another so much that the law means nothing.
    #[error(
        "at {time:.6} s {} overlaps {partner} by {overlap:.3e} m, {share:.0} % of its radius: take \
         a shorter time step, or a stiffer law",
        fruit_name(*.fruit)
    )]
    Overlap {
        /// When; s.
        time: f64,
        /// Number of the fruit.
        fruit: u32,
        /// What it overlaps.
        partner: String,
        /// By how much; m.
        overlap: f64,
        /// Of its radius; %.
        share: f64,
    },
    /// A fruit moves so far in a step that contacts are missed.
    #[error(
        "at {time:.6} s {} moves at {speed:.3e} m/s, {share:.0} % of its radius in one step: take a \
         shorter time step",
        fruit_name(*.fruit)
    )]
    Speed {
        /// When; s.
        time: f64,
        /// Number of the fruit.
        fruit: u32,
        /// Its speed; m/s.
        speed: f64,
        /// Way in one step over radius; %.
        share: f64,
    },
    /// A place or a velocity is no number.
    #[error("at {time:.6} s the place or velocity of {} is no number any more", fruit_name(*.fruit))]
    NotFinite {
        /// When; s.
        time: f64,
        /// Number of the fruit.
        fruit: u32,
    },
    /// A state that belongs to another scene, or to none.
    #[error("the saved state cannot be taken up: {problem}")]
    StateUnfit {
        /// The problem.
        problem: String,
    },
    /// A fruit is released where another one or a wall is.
    #[error(
        "{} is released at {place:?} m, where it overlaps {partner} by {overlap:.3e} m",
        fruit_name(*.fruit)
    )]
    Occupied {
        /// Number of the fruit.
        fruit: u32,
        /// Where; m.
        place: Vector,
        /// What it overlaps.
        partner: String,
        /// By how much; m.
        overlap: f64,
    },
}

/// A fruit as people count, from 1, as the tables of a scene do.
pub(crate) fn fruit_name(fruit: u32) -> String {
    format!("fruit {}", fruit + 1)
}
