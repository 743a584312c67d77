//! One simulated event: options with units → SI.

use crate::impact::{SimulatedImpact, SimulatedMotion, simulate_motion, simulate_one};
use clap::builder::{PossibleValue, PossibleValuesParser};
use std::path::Path;
use windfall_campaign::settings::fit::ENDS;
use windfall_cards::law_card::CardRange;
use windfall_cards::law_use::chosen_law;
use windfall_contact::law::EndRule;
use windfall_contact::laws::kind::Law;
use windfall_files::error::Error;
use windfall_files::option_value::{chosen, positive};
use windfall_identify::rig::kind::Rig;

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

/// Words for the end of a contact; read by [`ENDS`].
pub(crate) fn ends() -> PossibleValuesParser {
    PossibleValuesParser::new([
        PossibleValue::new("force-zero").help("When the law's force returns to zero: no adhesion"),
        PossibleValue::new("gap-zero").help("When the displacement is back at zero"),
    ])
}

/// Reads what all impacts have.
///
/// * `velocity`: at first touch; m/s
pub(crate) fn event(
    (law, laws): (&str, Option<&Path>),
    rig: Rig,
    velocity: f64,
    end: &str,
) -> Result<Event, Error> {
    let asked = chosen_law(law, laws)?;
    Ok(Event {
        law: asked.law,
        range: asked.range,
        rig,
        velocity,
        end: chosen("--end", end, &ENDS)?,
    })
}

/// Simulates one impact.
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
