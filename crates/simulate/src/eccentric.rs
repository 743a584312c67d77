//! `windfall simulate drop` of a body whose contact is not below its centre of
//! mass.

use crate::drop::motion_times;
use crate::impact::failed;
use crate::request::drop::{DropPlan, one_height};
use serde::Serialize;
use windfall_cards::law_use::end_name;
use windfall_contact::expression::LawExpression;
use windfall_drop_rig::eccentric::body::EccentricBody;
use windfall_drop_rig::eccentric::impact::EccentricImpact;
use windfall_drop_rig::eccentric::shape::Shape;
use windfall_drop_rig::eccentric::simulate::{
    EccentricTrajectory, eccentric_trajectory, simulate_eccentric_drop,
};
use windfall_drop_rig::rig::Plate;
use windfall_files::error::Error;
use windfall_files::option_value::unusable;

/// The body in results; SI.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct BodyOutcome {
    /// "offset-disc" or "ellipse".
    pub shape: &'static str,
    /// Radius of the disc; m.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    pub radius: Option<f64>,
    /// Distance of its centre of mass from its centre; m.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    pub offset: Option<f64>,
    /// Semi-axes of the ellipse; m.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    pub semi_axes: Option<[f64; 2]>,
    /// Attitude at release: direction of the offset from straight down, or tilt
    /// of the first axis from the horizontal; rad.
    pub angle: f64,
    /// Moment of inertia about the centre of mass; kg m².
    pub inertia: f64,
    /// Coefficient of friction; 1.
    pub friction: f64,
    /// Angular velocity at release; rad/s.
    pub angular_velocity: f64,
    /// Velocity to the right at release; m/s.
    pub tangential_velocity: f64,
}

/// A simulated drop of a planar body; SI.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct SimulatedEccentricDrop {
    /// The law.
    pub law: String,
    /// Mass of the fruit; kg.
    pub mass: f64,
    /// Part of it that the contact would feel in the attitude at release; 1.
    pub effective_mass_factor: f64,
    /// Its outline and motion at release.
    pub body: BodyOutcome,
    /// Drop height, of the lowest point; m.
    pub height: f64,
    /// Acceleration of gravity; m/s².
    pub gravity: f64,
    /// The plate; `None` where it is rigid.
    pub plate: Option<Plate>,
    /// End of contact.
    pub end: &'static str,
    /// Impacts in order of time.
    pub impacts: Vec<EccentricImpact>,
    /// From onset to onset; s.
    pub intervals: Vec<f64>,
    /// Whether the fruit comes to stay on the plate before the next impact.
    pub at_rest: bool,
}

/// Simulates one drop of a planar body.
///
/// # Errors
/// There is no impact to follow or more than one height, an effective mass
/// factor is given besides the body, or it cannot be simulated.
pub fn simulate_one_eccentric_drop(
    plan: &DropPlan,
    body: &EccentricBody,
) -> Result<SimulatedEccentricDrop, Error> {
    let height = one_height(plan)?;
    let rig = &plan.rig;
    if rig.effective_mass_factor != 1.0 {
        let problem = "it stands for the rotation of a body; expected without --offset and \
                       --semi-axes, which turn it";
        return Err(unusable("--effective-mass-factor", problem));
    }
    let (law, gravity) = (&plan.law, rig.gravity);
    let found = simulate_eccentric_drop(
        law,
        body,
        rig.plate,
        gravity,
        height,
        plan.impacts,
        plan.end,
    )
    .map_err(|source| failed(law, source))?;
    Ok(SimulatedEccentricDrop {
        law: LawExpression::from(*law).to_string(),
        mass: body.mass,
        effective_mass_factor: body.effective_mass_factor(),
        body: body_outcome(body),
        height,
        gravity,
        plate: rig.plate,
        end: end_name(plan.end),
        impacts: found.impacts,
        intervals: found.intervals,
        at_rest: found.at_rest,
    })
}

/// Motion of one drop of a planar body, from the release to a little after the
/// last of its impacts.
///
/// * `rate`: samples per second, with unit
/// * `duration`: how long otherwise, with unit
///
/// # Errors
/// As [`simulate_one_eccentric_drop`]; an option cannot be read.
pub fn eccentric_motion(
    plan: &DropPlan,
    body: &EccentricBody,
    drop: &SimulatedEccentricDrop,
    rate: &str,
    duration: Option<&str>,
) -> Result<EccentricTrajectory, Error> {
    let last = drop.impacts.last().map(|own| &own.impact);
    let times = motion_times(rate, duration, last)?;
    let (rig, law) = (&plan.rig, &plan.law);
    eccentric_trajectory(
        law,
        body,
        rig.plate,
        rig.gravity,
        drop.height,
        &times,
        plan.end,
    )
    .map_err(|source| failed(law, source))
}

fn body_outcome(body: &EccentricBody) -> BodyOutcome {
    let outcome = BodyOutcome {
        shape: "offset-disc",
        radius: None,
        offset: None,
        semi_axes: None,
        angle: 0.0,
        inertia: body.moment_of_inertia(),
        friction: body.friction,
        angular_velocity: body.angular_velocity,
        tangential_velocity: body.tangential_velocity,
    };
    match body.shape {
        Shape::OffsetDisc {
            radius,
            offset,
            angle,
        } => BodyOutcome {
            radius: Some(radius),
            offset: Some(offset),
            angle,
            ..outcome
        },
        Shape::Ellipse { semi_axes, tilt } => BodyOutcome {
            shape: "ellipse",
            semi_axes: Some(semi_axes),
            angle: tilt,
            ..outcome
        },
    }
}
