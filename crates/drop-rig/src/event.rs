//! A drop as the integrator sees it: law, rig and free parameters.

use crate::dual::{fixed, inverse, mapped, product};
use crate::plate_ringing::Ringing;
use crate::rig::DropRig;
use windfall_contact::law::EndRule;
use windfall_numerics::ode::step::Tolerance;
use windfall_numerics::real::Lanes;

/// Derivatives of the inputs by each free parameter, one lane each; lane 0 is
/// unused.
#[derive(Clone, Copy, Debug)]
pub struct DropSeeds<const N: usize, const W: usize> {
    /// Of each parameter of the law.
    pub parameters: [Lanes<W>; N],
    /// Of the velocity at first touch.
    pub velocity: Lanes<W>,
    /// Of the fruit's mass.
    pub mass: Lanes<W>,
    /// Of the effective mass factor.
    pub effective_mass_factor: Lanes<W>,
    /// Of the acceleration between impacts.
    pub gravity: Lanes<W>,
    /// Of the plate's mass.
    pub plate_mass: Lanes<W>,
    /// Of the plate's stiffness.
    pub plate_stiffness: Lanes<W>,
    /// Of the plate's damping.
    pub plate_damping: Lanes<W>,
}

impl<const N: usize, const W: usize> DropSeeds<N, W> {
    /// Nothing is free.
    pub const NONE: Self = Self {
        parameters: [Lanes::ZERO; N],
        velocity: Lanes::ZERO,
        mass: Lanes::ZERO,
        effective_mass_factor: Lanes::ZERO,
        gravity: Lanes::ZERO,
        plate_mass: Lanes::ZERO,
        plate_stiffness: Lanes::ZERO,
        plate_damping: Lanes::ZERO,
    };
}

/// What happens: a fruit touches the plate, which is at rest, at time zero.
#[derive(Clone, Copy, Debug)]
pub struct DropEvent<L, const N: usize, const W: usize> {
    /// Force law.
    pub law: L,
    /// Fruit and plate.
    pub rig: DropRig,
    /// Velocity at first touch; m/s.
    pub velocity: f64,
    /// When a contact is over.
    pub end: EndRule,
    /// Free parameters.
    pub seeds: DropSeeds<N, W>,
    /// Accuracy: relative, absolute for d, d', x, x'.
    pub tolerance: Tolerance<4>,
}

impl<L: Copy, const N: usize, const W: usize> DropEvent<L, N, W> {
    /// The event without derivatives.
    pub(crate) fn values(&self) -> DropEvent<L, N, 1> {
        DropEvent {
            law: self.law,
            rig: self.rig,
            velocity: self.velocity,
            end: self.end,
            seeds: DropSeeds::NONE,
            tolerance: self.tolerance,
        }
    }
}

/// The rig's quantities with their derivatives.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RigDuals<const W: usize> {
    pub inverse_contact_mass: Lanes<W>,
    pub factor: Lanes<W>,
    pub gravity: Lanes<W>,
    /// Zero for a plate that does not move.
    pub inverse_plate_mass: Lanes<W>,
    pub stiffness: Lanes<W>,
    pub damping: Lanes<W>,
    /// Free motion of the plate from rest; `None` for a plate that does not
    /// move.
    pub ringing: Option<Ringing<W>>,
}

pub(crate) fn rig_duals<L, const N: usize, const W: usize>(
    event: &DropEvent<L, N, W>,
) -> RigDuals<W> {
    let (rig, seeds) = (&event.rig, &event.seeds);
    let with = |value: f64, seed: Lanes<W>| mapped(seed, value, 1.0);
    let factor = with(rig.effective_mass_factor, seeds.effective_mass_factor);
    let mass = with(rig.mass, seeds.mass);
    let mut duals = RigDuals {
        inverse_contact_mass: inverse(product(factor, mass)),
        factor,
        gravity: with(rig.gravity, seeds.gravity),
        inverse_plate_mass: Lanes::ZERO,
        stiffness: Lanes::ZERO,
        damping: Lanes::ZERO,
        ringing: None,
    };
    if let Some(plate) = &rig.plate {
        duals.inverse_plate_mass = inverse(with(plate.mass, seeds.plate_mass));
        duals.stiffness = with(plate.stiffness, seeds.plate_stiffness);
        duals.damping = with(plate.damping, seeds.plate_damping);
        let decay = product(duals.damping, duals.inverse_plate_mass) * 0.5;
        let squared = mapped(decay, decay.0[0] * decay.0[0], 2.0 * decay.0[0]);
        duals.ringing = Some(Ringing {
            displacement: fixed(0.0),
            velocity: fixed(0.0),
            decay,
            frequency_squared: product(duals.stiffness, duals.inverse_plate_mass) - squared,
        });
    }
    duals
}
