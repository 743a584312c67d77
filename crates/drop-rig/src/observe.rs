//! What a drop rig would show at an instant: contact force and support force.

use crate::contact::{ContactPiece, force_dual};
use crate::dual::{fixed, product};
use crate::event::{DropEvent, RigDuals};
use crate::flight::FlightPiece;
use windfall_contact::law::{ContactLaw, EndRule};
use windfall_identify::rig::contact_time::{scaled_time, time_of};
use windfall_numerics::real::Lanes;

/// Forces and motion at an instant; derivatives at fixed time of the piece.
#[derive(Clone, Copy, Debug)]
pub struct Observed<const W: usize> {
    /// Since the start of the piece; s.
    pub time: f64,
    /// Indentation; m.
    pub displacement: Lanes<W>,
    /// Its rate; m/s.
    pub rate: Lanes<W>,
    /// Displacement of the plate, up positive; m.
    pub plate: Lanes<W>,
    /// Velocity of the plate; m/s.
    pub plate_velocity: Lanes<W>,
    /// Force between fruit and plate; N.
    pub contact_force: Lanes<W>,
    /// Force on the support, −(k x + c x') about the static position, positive
    /// downwards; that of contact where the plate does not move; N.
    pub support_force: Lanes<W>,
    /// Its rate; N/s.
    pub support_rate: f64,
    /// Rate of the contact force; N/s.
    pub contact_rate: f64,
}

/// Fraction of a contact's step at a time since its start.
#[inline(always)]
pub(crate) fn sigma_at<const W: usize>(piece: &ContactPiece<W>, time: f64) -> f64 {
    (scaled_time(time, piece.power) - piece.step.start) / piece.step.width
}

/// What is seen within a contact, at a fraction of its step.
#[inline(always)]
pub(crate) fn contact_at<L: ContactLaw<N>, const N: usize, const W: usize>(
    event: &DropEvent<L, N, W>,
    rig: &RigDuals<W>,
    piece: &ContactPiece<W>,
    sigma: f64,
) -> Observed<W> {
    let [displacement, rate, plate, plate_velocity] = piece.step.at(sigma);
    let (mut force, law) = force_dual(event, displacement, rate, piece.peak, piece.peak_lanes);
    if event.end == EndRule::ForceZero && force.0[0] < 0.0 {
        force = Lanes::ZERO;
    }
    let s = piece.step.start + sigma * piece.step.width;
    let (v, u) = (rate.0[0], plate_velocity.0[0]);
    let fruit = force.0[0] * rig.inverse_contact_mass.0[0] - rig.gravity.0[0];
    let mut seen = Observed {
        time: time_of(s, piece.power),
        displacement,
        rate,
        plate,
        plate_velocity,
        contact_force: force,
        support_force: force,
        support_rate: 0.0,
        contact_rate: law.by_displacement * v - law.by_rate * fruit,
    };
    if rig.ringing.is_some() {
        let support = support_force(rig, plate, plate_velocity);
        let acceleration = (support.0[0] - force.0[0]) * rig.inverse_plate_mass.0[0];
        seen.support_force = support;
        seen.support_rate = -(rig.stiffness.0[0] * u + rig.damping.0[0] * acceleration);
        seen.contact_rate += law.by_rate * acceleration;
    } else {
        seen.support_rate = seen.contact_rate;
    }
    seen
}

/// What is seen in flight, at a time since its start.
#[inline(always)]
pub(crate) fn flight_at<const W: usize>(
    rig: &RigDuals<W>,
    piece: &FlightPiece<W>,
    time: f64,
) -> Observed<W> {
    let (plate, plate_velocity) = piece.plate(time);
    let support = support_force(rig, plate, plate_velocity);
    let acceleration = support.0[0] * rig.inverse_plate_mass.0[0];
    Observed {
        time,
        displacement: fixed(0.0),
        rate: fixed(0.0),
        plate,
        plate_velocity,
        contact_force: fixed(0.0),
        support_force: support,
        support_rate: -(rig.stiffness.0[0] * plate_velocity.0[0] + rig.damping.0[0] * acceleration),
        contact_rate: 0.0,
    }
}

/// −(k x + c x'), with derivatives; N.
#[inline(always)]
fn support_force<const W: usize>(rig: &RigDuals<W>, x: Lanes<W>, u: Lanes<W>) -> Lanes<W> {
    -(product(rig.stiffness, x) + product(rig.damping, u))
}
