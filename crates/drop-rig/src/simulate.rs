//! Forward: a fruit falls on the plate and bounces.

use crate::contact::ContactPiece;
use crate::event::{DropEvent, DropSeeds, RigDuals, rig_duals};
use crate::flight::FlightPiece;
use crate::follow::{DropEnding, DropSink, Touch, follow_drop};
use crate::observe::{Observed, contact_at, flight_at, sigma_at};
use crate::rig::DropRig;
use crate::tally::{DropTally, ImpactTally, Tally};
use windfall_contact::law::{ContactLaw, EndRule};
use windfall_contact::laws::any_law::{AnyLaw, LARGEST_PARAMETERS};
use windfall_contact::laws::kind::Law;
use windfall_identify::error::{Error, check_positive};
use windfall_identify::rig::simulate::{ACCURACY, check_ascending};
use windfall_numerics::ode::step::{StepError, Tolerance};
use windfall_numerics::real_vector::compiled_for_vectors;

/// Impacts of a drop whose motion is read; a fruit rests long before.
const MOST_IMPACTS: usize = 100_000;

/// Summary of one impact of a drop; SI, times from the release.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, utoipa::ToSchema)]
pub struct DropImpact {
    /// First touch; s.
    pub onset_time: f64,
    /// Speed of approach of fruit and plate at first touch; m/s.
    pub impact_velocity: f64,
    /// Largest force between fruit and plate; N.
    pub peak_contact_force: f64,
    /// When it is reached; s.
    pub time_of_peak_contact_force: f64,
    /// Largest force on the plate's support from this onset to the next, about
    /// its static load; N.
    pub peak_support_force: f64,
    /// When it is reached; s.
    pub time_of_peak_support_force: f64,
    /// Largest indentation; m.
    pub max_displacement: f64,
    /// When it is reached; s.
    pub time_of_max_displacement: f64,
    /// When the force is back at zero; s.
    #[schema(value_type = Option<f64>)]
    pub force_end_time: f64,
    /// When the gap between fruit and plate opens; s.
    #[schema(value_type = Option<f64>)]
    pub separation_time: f64,
    /// Velocity of the fruit then, up positive; m/s.
    #[schema(value_type = Option<f64>)]
    pub separation_velocity: f64,
    /// Speed of the fruit at separation over that at onset; 1.
    #[schema(value_type = Option<f64>)]
    pub restitution: f64,
    /// Speed at which the point of contact leaves the plate over the speed of
    /// approach; 1.
    #[schema(value_type = Option<f64>)]
    pub contact_restitution: f64,
    /// Integral of the contact force; N s.
    pub impulse: f64,
    /// Energy that the fruit's centre of mass loses: kinetic, and of height
    /// from onset to separation; J.
    #[schema(value_type = Option<f64>)]
    pub absorbed_energy: f64,
}

impl DropImpact {
    /// An impact that has not ended: what belongs to its end is not a number.
    pub(crate) const LASTING: Self = Self {
        onset_time: 0.0,
        impact_velocity: 0.0,
        peak_contact_force: f64::NEG_INFINITY,
        time_of_peak_contact_force: 0.0,
        peak_support_force: f64::NEG_INFINITY,
        time_of_peak_support_force: 0.0,
        max_displacement: f64::NEG_INFINITY,
        time_of_max_displacement: 0.0,
        force_end_time: f64::NAN,
        separation_time: f64::NAN,
        separation_velocity: f64::NAN,
        restitution: f64::NAN,
        contact_restitution: f64::NAN,
        impulse: 0.0,
        absorbed_energy: f64::NAN,
    };
}

/// The impacts of one drop.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DropSummary {
    /// In order of time.
    pub impacts: Vec<DropImpact>,
    /// From onset to onset; s.
    pub intervals: Vec<f64>,
    /// First touch after the last of `impacts`; `None` where the fruit stays; s.
    pub next_onset: Option<f64>,
    /// The fruit stays on the plate in or after the last of `impacts`: there
    /// may be fewer than requested. The separation of an impact without
    /// one is not a number.
    pub at_rest: bool,
}

/// Motion and forces at given times from the release; SI.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DropTrajectory {
    /// Times; s.
    pub times: Vec<f64>,
    /// Force between fruit and plate; N.
    pub contact_force: Vec<f64>,
    /// Force on the plate's support about its static load; N.
    pub support_force: Vec<f64>,
    /// Height of the fruit: of its centre of mass over where that is when the
    /// fruit touches the static plate; m.
    pub height: Vec<f64>,
    /// Velocity of the fruit, up positive; m/s.
    pub velocity: Vec<f64>,
    /// Displacement of the plate, up positive; m.
    pub plate_displacement: Vec<f64>,
    /// Velocity of the plate; m/s.
    pub plate_velocity: Vec<f64>,
}

/// Accuracy of the integration for a drop that strikes at `velocity`.
pub(crate) fn tolerance(relative: f64, velocity: f64) -> Tolerance<4> {
    Tolerance {
        relative,
        absolute: [
            relative * 1e-6,
            relative * velocity,
            relative * 1e-7,
            relative * 0.1 * velocity,
        ],
    }
}

pub(crate) fn drop_event<const W: usize>(
    law: &Law,
    rig: &DropRig,
    velocity: f64,
    end: EndRule,
    (seeds, accuracy): (DropSeeds<LARGEST_PARAMETERS, W>, f64),
) -> DropEvent<AnyLaw, LARGEST_PARAMETERS, W> {
    DropEvent {
        law: AnyLaw(*law),
        rig: *rig,
        velocity,
        end,
        seeds,
        tolerance: tolerance(accuracy, velocity),
    }
}

/// Impacts of a drop with their derivatives, times from first touch.
///
/// # Errors
/// As [`simulate_drop`].
pub(crate) fn tally_drop<const W: usize>(
    event: &DropEvent<AnyLaw, LARGEST_PARAMETERS, W>,
    impacts: usize,
) -> Result<DropTally<W>, Error> {
    Ok(compiled_for_vectors(TallyPass { event, impacts })?)
}

/// A drop, compiled for the processor's vector instructions.
struct TallyPass<'a, const W: usize> {
    event: &'a DropEvent<AnyLaw, LARGEST_PARAMETERS, W>,
    impacts: usize,
}

impl<const W: usize> pulp::NullaryFnOnce for TallyPass<'_, W> {
    type Output = Result<DropTally<W>, StepError>;

    #[inline(always)]
    fn call(self) -> Self::Output {
        let rig = rig_duals(self.event);
        let plain = self.event.values();
        let plain_rig = rig_duals(&plain);
        let mut tally = Tally {
            event: self.event,
            rig: &rig,
            values: (&plain, &plain_rig),
            impacts: Vec::new(),
            beyond: None,
        };
        let ending = follow_drop(self.event, self.impacts, f64::INFINITY, &mut tally)?;
        Ok(DropTally {
            impacts: tally.impacts,
            beyond: tally.beyond,
            ending,
        })
    }
}

/// A fruit falls from rest on the plate of `rig` and bounces.
///
/// * `height`: of its lowest point above the plate; m
/// * `impacts`: how many to follow
///
/// # Errors
/// [`Error::BadInput`] when a quantity of the rig or the height is not
/// positive, [`Error::Integration`] when a contact cannot be integrated.
///
/// # Source
/// Rig and law of Kang et al. (2023), INMATEH 71:63, with the impact function
/// of its eq. (13) or any other law.
pub fn simulate_drop(
    law: &Law,
    rig: &DropRig,
    height: f64,
    impacts: usize,
    end: EndRule,
) -> Result<DropSummary, Error> {
    simulate_drop_within(ACCURACY, law, rig, height, impacts, end)
}

/// [`simulate_drop`] to a relative accuracy of the integration.
pub(crate) fn simulate_drop_within(
    accuracy: f64,
    law: &Law,
    rig: &DropRig,
    height: f64,
    impacts: usize,
    end: EndRule,
) -> Result<DropSummary, Error> {
    rig.check()?;
    check_positive("height", height)?;
    let velocity = rig.impact_velocity(height);
    let event = drop_event::<1>(law, rig, velocity, end, (DropSeeds::NONE, accuracy));
    let found = tally_drop(&event, impacts)?;
    let fall = velocity / rig.gravity;
    let impacts: Vec<DropImpact> = found
        .impacts
        .iter()
        .map(|one| impact_of(one, rig, fall))
        .collect();
    let intervals = impacts
        .windows(2)
        .map(|pair| pair[1].onset_time - pair[0].onset_time);
    Ok(DropSummary {
        intervals: intervals.collect(),
        impacts,
        next_onset: found.beyond.map(|touch| fall + touch.time.0[0]),
        at_rest: found.ending == DropEnding::AtRest,
    })
}

/// One impact in plain numbers.
///
/// * `fall`: from the release to first touch of the drop; s
pub(crate) fn impact_of<const W: usize>(
    tally: &ImpactTally<W>,
    rig: &DropRig,
    fall: f64,
) -> DropImpact {
    let touch = tally.touch;
    let onset = -touch.velocity.0[0];
    let approach = touch.plate_velocity.0[0] + onset;
    let mut impact = DropImpact {
        onset_time: fall + touch.time.0[0],
        impact_velocity: approach,
        peak_contact_force: tally.contact_force.value.0[0],
        time_of_peak_contact_force: fall + tally.contact_force.time,
        peak_support_force: tally.support_force.value.0[0],
        time_of_peak_support_force: fall + tally.support_force.time,
        max_displacement: tally.displacement.value.0[0],
        time_of_max_displacement: fall + tally.displacement.time,
        impulse: tally.impulse,
        ..DropImpact::LASTING
    };
    if let Some(left) = &tally.departure {
        let speed = left.velocity.0[0];
        let fallen = touch.height.0[0] - left.height.0[0];
        impact.force_end_time = fall + left.force_end.0[0];
        impact.separation_time = fall + left.time.0[0];
        impact.separation_velocity = speed;
        impact.restitution = speed / onset;
        impact.contact_restitution = left.relative_velocity.0[0] / approach;
        impact.absorbed_energy =
            rig.mass * (0.5 * (onset - speed) * (onset + speed) + rig.gravity * fallen);
    }
    impact
}

/// Motion and forces of a drop at `times` (ascending, from the release).
///
/// * `height`: of the fruit's lowest point above the plate at the release; m
///
/// # Errors
/// As [`simulate_drop`], and [`Error::UnorderedTimes`].
pub fn drop_trajectory(
    law: &Law,
    rig: &DropRig,
    height: f64,
    times: &[f64],
    end: EndRule,
) -> Result<DropTrajectory, Error> {
    rig.check()?;
    check_positive("height", height)?;
    check_ascending(times)?;
    let velocity = rig.impact_velocity(height);
    let fall = velocity / rig.gravity;
    let event = drop_event::<1>(law, rig, velocity, end, (DropSeeds::NONE, ACCURACY));
    let duals = rig_duals(&event);
    let zeros = vec![0.0; times.len()];
    let mut reader = Reader {
        event: &event,
        rig: &duals,
        fall,
        next: 0,
        touch: (0.0, 0.0, 0.0),
        out: DropTrajectory {
            times: times.to_vec(),
            contact_force: zeros.clone(),
            support_force: zeros.clone(),
            height: zeros.clone(),
            velocity: zeros.clone(),
            plate_displacement: zeros.clone(),
            plate_velocity: zeros,
        },
    };
    reader.fall_freely(height);
    let until = times.last().map_or(0.0, |last| last - fall);
    if until >= 0.0 {
        follow_drop(&event, MOST_IMPACTS, until.next_up(), &mut reader)?;
    }
    Ok(reader.out)
}

/// Reads a drop at given times.
struct Reader<'a, L, const N: usize> {
    event: &'a DropEvent<L, N, 1>,
    rig: &'a RigDuals<1>,
    fall: f64,
    /// First time that has not been read.
    next: usize,
    /// Time, height and velocity of the present impact's first touch.
    touch: (f64, f64, f64),
    out: DropTrajectory,
}

impl<L: ContactLaw<N>, const N: usize> Reader<'_, L, N> {
    /// Times before first touch.
    fn fall_freely(&mut self, height: f64) {
        let gravity = self.event.rig.gravity;
        while let Some(&time) = self.out.times.get(self.next) {
            if time >= self.fall {
                return;
            }
            let since = time.max(0.0);
            self.out.height[self.next] = height - 0.5 * gravity * since * since;
            self.out.velocity[self.next] = -gravity * since;
            self.next += 1;
        }
    }

    /// Times up to `end` since first touch, of a piece that began at `start`.
    fn read(&mut self, start: f64, end: f64, seen: impl Fn(f64) -> (Observed<1>, f64, f64)) {
        while let Some(&time) = self.out.times.get(self.next) {
            let since = time - self.fall;
            if since > end {
                return;
            }
            let (seen, height, velocity) = seen((since - start).max(0.0));
            let (i, out) = (self.next, &mut self.out);
            out.contact_force[i] = seen.contact_force.0[0];
            out.support_force[i] = seen.support_force.0[0];
            out.plate_displacement[i] = seen.plate.0[0];
            out.plate_velocity[i] = seen.plate_velocity.0[0];
            out.height[i] = height;
            out.velocity[i] = velocity;
            self.next += 1;
        }
    }
}

impl<L: ContactLaw<N>, const N: usize> DropSink<1> for Reader<'_, L, N> {
    fn touch(&mut self, touch: &Touch<1>) {
        self.touch = (touch.time.0[0], touch.height.0[0], touch.velocity.0[0]);
    }

    fn contact(&mut self, piece: &ContactPiece<1>) {
        let (event, rig) = (self.event, self.rig);
        let (touched, level, speed) = self.touch;
        let start = piece.start.0[0];
        self.read(start, start + piece.to, |time| {
            let seen = contact_at(event, rig, piece, sigma_at(piece, time));
            // From the point of contact to the centre of mass: it is moved by
            // the part f of what the force does to that point.
            let (factor, gravity) = (rig.factor.0[0], rig.gravity.0[0]);
            let since = start + time - touched;
            let falling = level + (speed - 0.5 * gravity * since) * since;
            let point = seen.plate.0[0] - seen.displacement.0[0];
            let rate = seen.plate_velocity.0[0] - seen.rate.0[0];
            let fallen = speed - gravity * since;
            let height = falling + factor * (point - falling);
            (seen, height, fallen + factor * (rate - fallen))
        });
    }

    fn flight(&mut self, piece: &FlightPiece<1>) {
        let rig = self.rig;
        let start = piece.start.0[0];
        self.read(start, start + piece.duration, |time| {
            let (height, velocity) = piece.fruit(time);
            (flight_at(rig, piece, time), height.0[0], velocity.0[0])
        });
    }
}
