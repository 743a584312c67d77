//! Forward: a body whose contact is not below its centre of mass falls on the
//! plate, turns and bounces.
//!
//! The equations and the choices are in `docs/guide/src/made/eccentric_contact.md` and at
//! [`EccentricBody`].

use crate::eccentric::body::{EccentricBody, Planar, State};
use crate::eccentric::contact::Piece;
use crate::eccentric::flight::Flight;
use crate::eccentric::follow::{EccentricEvent, EccentricSink, follow_eccentric};
use crate::eccentric::impact::{EccentricImpact, EccentricSummary};
use crate::eccentric::tally::EccentricTally;
use crate::rig::{DropRig, Plate};
use windfall_contact::law::EndRule;
use windfall_contact::laws::any_law::AnyLaw;
use windfall_contact::laws::kind::Law;
use windfall_identify::error::{Error, check_positive};
use windfall_identify::rig::simulate::check_ascending;

/// Motion and forces of a planar body at given times from the release; SI.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EccentricTrajectory {
    /// Times; s.
    pub times: Vec<f64>,
    /// Force between body and plate, normal; N.
    pub contact_force: Vec<f64>,
    /// Friction force on the body, positive to the right; N.
    pub friction_force: Vec<f64>,
    /// Force on the plate's support about its static load; N.
    pub support_force: Vec<f64>,
    /// Height of the centre of mass over the static plate; m.
    pub height: Vec<f64>,
    /// Velocity of the centre of mass, up positive; m/s.
    pub velocity: Vec<f64>,
    /// Rotation since release, anticlockwise; rad.
    pub rotation: Vec<f64>,
    /// Angular velocity; rad/s.
    pub angular_velocity: Vec<f64>,
    /// Horizontal place of the centre of mass; m.
    pub tangential_displacement: Vec<f64>,
    /// Horizontal velocity of the centre of mass; m/s.
    pub tangential_velocity: Vec<f64>,
    /// Displacement of the plate, up positive; m.
    pub plate_displacement: Vec<f64>,
    /// Velocity of the plate; m/s.
    pub plate_velocity: Vec<f64>,
}

/// A planar body falls on a plate (`None`: one that does not move) and
/// bounces.
///
/// * `gravity`: m/s²
/// * `height`: of its lowest point above the static plate at release; m
/// * `impacts`: how many to follow
///
/// # Errors
/// [`Error::BadInput`], [`Error::OffsetOutsideDisc`] or
/// [`Error::NoMomentOfInertia`] for a quantity without a physical value; [`Error::Integration`] and
/// [`Error::EndlessContact`] when a contact cannot be integrated.
///
/// # Numerics
/// Contacts by an integrator of order 8 with every event located: touch, end
/// of the force, gap, sticking and sliding, turning points and kinks of laws
/// that have them. Flights in closed form.
///
/// # Example
/// A ball with its centre of mass 2 mm to the side, on a rigid plate, without
/// friction or loss; it starts to spin and rebounds lower than from where it
/// fell:
/// ```
/// use windfall_contact::{expression::parse_law, law::EndRule};
/// use windfall_drop_rig::eccentric::body::EccentricBody;
/// use windfall_drop_rig::eccentric::shape::Shape;
/// use windfall_drop_rig::eccentric::simulate::simulate_eccentric_drop;
///
/// let law = parse_law("hertz(k=1e7)")?.complete()?;
/// let shape = Shape::OffsetDisc { radius: 0.01, offset: 0.002, angle: 90f64.to_radians() };
/// let body = EccentricBody::at_rest(shape, 0.005);
/// let drop = simulate_eccentric_drop(&law, &body, None, 9.80665, 0.5, 1, EndRule::ForceZero)?;
/// let impact = &drop.impacts[0];
/// assert!(impact.angular_velocity.abs() > 50.0);
/// assert!(impact.impact.restitution < 0.85);
/// assert!((impact.impact.contact_restitution - 1.0).abs() < 0.05);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn simulate_eccentric_drop(
    law: &Law,
    body: &EccentricBody,
    plate: Option<Plate>,
    gravity: f64,
    height: f64,
    impacts: usize,
    end: EndRule,
) -> Result<EccentricSummary, Error> {
    let event = release(law, body, plate, gravity, height, end)?;
    let mut tally = EccentricTally::new(&event.planar);
    let at_rest = follow_eccentric(&event, impacts, f64::INFINITY, &mut tally)?;
    let impacts = tally.impacts;
    let onset = |impact: &EccentricImpact| impact.impact.onset_time;
    let intervals = impacts
        .windows(2)
        .map(|pair| onset(&pair[1]) - onset(&pair[0]));
    Ok(EccentricSummary {
        intervals: intervals.collect(),
        impacts,
        at_rest,
        inertia: event.planar.inertia,
    })
}

/// Motion and forces of a planar body at `times` (ascending, from the
/// release). Times after it has come to stay on the plate are not followed:
/// the values there are not a number.
///
/// # Errors
/// As [`simulate_eccentric_drop`], and [`Error::UnorderedTimes`].
pub fn eccentric_trajectory(
    law: &Law,
    body: &EccentricBody,
    plate: Option<Plate>,
    gravity: f64,
    height: f64,
    times: &[f64],
    end: EndRule,
) -> Result<EccentricTrajectory, Error> {
    check_ascending(times)?;
    let event = release(law, body, plate, gravity, height, end)?;
    let mut reader = Reader {
        planar: &event.planar,
        next: 0,
        out: EccentricTrajectory {
            times: times.to_vec(),
            ..EccentricTrajectory::default()
        },
    };
    let until = times.last().copied().unwrap_or(0.0);
    follow_eccentric(&event, usize::MAX, until, &mut reader)?;
    while reader.next < times.len() {
        reader.push([f64::NAN; 11]);
    }
    Ok(reader.out)
}

fn release(
    law: &Law,
    body: &EccentricBody,
    plate: Option<Plate>,
    gravity: f64,
    height: f64,
    end: EndRule,
) -> Result<EccentricEvent, Error> {
    body.check()?;
    check_positive("height", height)?;
    let rig = DropRig {
        mass: body.mass,
        effective_mass_factor: 1.0,
        gravity,
        plate,
    };
    rig.check()?;
    Ok(EccentricEvent {
        planar: Planar {
            shape: body.shape,
            mass: body.mass,
            inertia: body.moment_of_inertia(),
            friction: body.friction,
            gravity,
            plate,
        },
        law: AnyLaw(*law),
        end,
        release: State {
            displacement: -height,
            velocity_x: body.tangential_velocity,
            spin: body.angular_velocity,
            ..State::default()
        },
    })
}

/// Reads a drop at given times.
struct Reader<'a> {
    planar: &'a Planar,
    /// First time that has not been read.
    next: usize,
    out: EccentricTrajectory,
}

impl Reader<'_> {
    /// Times up to `end` of a piece that began at `start`.
    fn read(&mut self, start: f64, end: f64, seen: impl Fn(f64) -> (State, [f64; 2])) {
        while let Some(&time) = self.out.times.get(self.next) {
            if time > end {
                return;
            }
            let (state, [normal, tangential]) = seen((time - start).max(0.0));
            let support = self.planar.support_force(&state);
            self.push([
                normal,
                tangential,
                support.unwrap_or(normal),
                self.planar.height(&state),
                state.velocity_y,
                state.rotation,
                state.spin,
                state.x,
                state.velocity_x,
                state.plate,
                state.plate_velocity,
            ]);
        }
    }

    fn push(&mut self, values: [f64; 11]) {
        let out = &mut self.out;
        let columns = [
            &mut out.contact_force,
            &mut out.friction_force,
            &mut out.support_force,
            &mut out.height,
            &mut out.velocity,
            &mut out.rotation,
            &mut out.angular_velocity,
            &mut out.tangential_displacement,
            &mut out.tangential_velocity,
            &mut out.plate_displacement,
            &mut out.plate_velocity,
        ];
        for (column, value) in columns.into_iter().zip(values) {
            column.push(value);
        }
        self.next += 1;
    }
}

impl EccentricSink for Reader<'_> {
    fn flight(&mut self, start: f64, flight: &Flight, duration: f64) {
        self.read(start, start + duration, |time| (flight.at(time), [0.0; 2]));
    }

    fn contact(&mut self, start: f64, piece: &Piece) {
        self.read(start, start + piece.time_at(piece.to), |time| {
            let state = piece.at(piece.sigma_of(time)).state;
            let forces = piece.phase.forces(&state);
            (state, [forces.normal, forces.tangential])
        });
    }
}
