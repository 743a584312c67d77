//! An impact to integrate: law, equation of motion, velocity, free parameters.

use crate::rig::motion::Motion;
use windfall_contact::law::EndRule;
use windfall_numerics::ode::step::Tolerance;
use windfall_numerics::real::Lanes;

/// Derivatives of the inputs by each free parameter, one lane each; lane 0 is
/// unused.
#[derive(Clone, Copy, Debug)]
pub struct Seeds<const N: usize, const W: usize> {
    /// Of each parameter of the law.
    pub parameters: [Lanes<W>; N],
    /// Of the velocity at first touch.
    pub velocity: Lanes<W>,
}

impl<const N: usize, const W: usize> Seeds<N, W> {
    /// Nothing is free.
    pub const NONE: Self = Self {
        parameters: [Lanes::ZERO; N],
        velocity: Lanes::ZERO,
    };
}

/// What happens: a body with `motion` touches at time zero with `velocity`.
#[derive(Clone, Copy, Debug)]
pub struct ImpactEvent<L, const N: usize, const W: usize> {
    /// Force law.
    pub law: L,
    /// Equation of motion.
    pub motion: Motion,
    /// Velocity at first touch; m/s.
    pub velocity: f64,
    /// When the contact is over.
    pub end: EndRule,
    /// Free parameters.
    pub seeds: Seeds<N, W>,
    /// Accuracy: relative, absolute for x (m) and v (m/s).
    pub tolerance: Tolerance<2>,
}

impl<L, const N: usize, const W: usize> ImpactEvent<L, N, W> {
    /// Displacement and rate at first touch.
    #[inline(always)]
    pub(crate) fn touch_state(&self) -> [Lanes<W>; 2] {
        let mut velocity = self.seeds.velocity;
        velocity.0[0] = self.velocity;
        [Lanes::ZERO, velocity]
    }
}
