//! One simulated event as it is asked for: texts with units → SI.

use crate::impact::{SimulatedImpact, SimulatedMotion, simulate_motion, simulate_one};
use std::path::PathBuf;
use windfall_campaign::settings::fit::ENDS;
use windfall_campaign::settings::rig::STANDARD_GRAVITY;
use windfall_cards::law_card::CardRange;
use windfall_cards::law_use::chosen_law;
use windfall_contact::law::EndRule;
use windfall_contact::laws::kind::Law;
use windfall_files::error::Error;
use windfall_files::option_value::{chosen, positive, quantity};
use windfall_identify::rig::kind::{Carriage, Pendulum, Rig};

/// One impact, whatever the rig; SI.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// The law with all its parameters.
    pub law: Law,
    /// In what it was seen, where it comes from a card.
    pub range: Option<CardRange>,
    /// The rig.
    pub rig: Rig,
    /// Velocity at first touch; m/s.
    pub velocity: f64,
    /// End of contact.
    pub end: EndRule,
}

/// A free body, or one on a line, strikes once.
#[derive(Clone, Debug)]
pub struct CarriageRequest {
    /// Law expression with all parameters, or a law card.
    pub law: String,
    /// A file of the user's own laws.
    pub laws: Option<PathBuf>,
    /// Mass, with unit.
    pub mass: String,
    /// Impact velocity, with unit.
    pub velocity: String,
    /// Acceleration towards the fruit, with unit.
    pub driving_acceleration: String,
    /// "force-zero" or "gap-zero".
    pub end: String,
}

/// A pendulum strikes once.
#[derive(Clone, Debug)]
pub struct PendulumRequest {
    /// Law expression with all parameters, or a law card.
    pub law: String,
    /// A file of the user's own laws.
    pub laws: Option<PathBuf>,
    /// Moment of inertia about the pivot, with unit.
    pub inertia: String,
    /// Pivot to point of contact, with unit.
    pub arm: String,
    /// Mass of arm and impactor, with unit.
    pub mass: String,
    /// Pivot to centre of mass, with unit.
    pub centre_of_mass: String,
    /// Impact velocity, with unit.
    pub velocity: String,
    /// "force-zero" or "gap-zero".
    pub end: String,
}

/// Reads the request for an impact of a body on a line.
///
/// # Errors
/// An option cannot be read.
pub fn carriage_event(request: &CarriageRequest) -> Result<Event, Error> {
    let driving = &request.driving_acceleration;
    let asked = chosen_law(&request.law, request.laws.as_deref())?;
    Ok(Event {
        law: asked.law,
        range: asked.range,
        rig: Rig::Carriage(Carriage {
            mass: positive("--mass", &request.mass, "kg")?,
            mass_sd: 0.0,
            driving_acceleration: quantity("--driving-acceleration", driving, "m/s^2")?,
        }),
        velocity: positive("--velocity", &request.velocity, "m/s")?,
        end: chosen("--end", &request.end, &ENDS)?,
    })
}

/// Reads the request for an impact of a pendulum.
///
/// # Errors
/// An option cannot be read.
pub fn pendulum_event(request: &PendulumRequest) -> Result<Event, Error> {
    let asked = chosen_law(&request.law, request.laws.as_deref())?;
    Ok(Event {
        law: asked.law,
        range: asked.range,
        rig: Rig::Pendulum(Pendulum {
            inertia: positive("--inertia", &request.inertia, "kg m^2")?,
            arm: positive("--arm", &request.arm, "m")?,
            mass: positive("--mass", &request.mass, "kg")?,
            centre_of_mass: quantity("--centre-of-mass", &request.centre_of_mass, "m")?,
            gravity: STANDARD_GRAVITY,
        }),
        velocity: positive("--velocity", &request.velocity, "m/s")?,
        end: chosen("--end", &request.end, &ENDS)?,
    })
}

/// Simulates one impact.
///
/// # Errors
/// It cannot be simulated.
pub fn impact_of_event(event: &Event) -> Result<SimulatedImpact, Error> {
    simulate_one(
        &event.law,
        &event.rig,
        event.velocity,
        event.end,
        event.range.as_ref(),
    )
}

/// Simulates one impact with its motion.
///
/// * `rate`: samples per second, with unit
///
/// # Errors
/// The rate cannot be read, or the impact cannot be simulated.
pub fn motion_of_event(event: &Event, rate: &str) -> Result<SimulatedMotion, Error> {
    let rate = positive("--rate", rate, "Hz")?;
    simulate_motion(
        &event.law,
        &event.rig,
        event.velocity,
        (rate, event.end),
        event.range.as_ref(),
    )
}
