//! One simulated drop: options with units → SI.

use crate::request::event::ends;
use clap::{Args, ValueHint};
use std::path::PathBuf;
use windfall_campaign::settings::fit::ENDS;
use windfall_cards::law_card::CardRange;
use windfall_cards::law_use::chosen_law;
use windfall_contact::law::EndRule;
use windfall_contact::laws::kind::Law;
use windfall_drop_rig::rig::{DropRig, Plate};
use windfall_files::error::Error;
use windfall_files::option_value::{at_least_zero, chosen, positive, unusable};

/// A fruit that falls on a plate; texts with units.
#[derive(Clone, Debug, Args)]
pub struct DropRequest {
    /// Force law with its parameters, or a law card (FILE.toml)
    #[arg(long)]
    pub law: String,
    /// File of own laws ([laws.NAME] tables, as in campaign.toml) that --law can name
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub laws: Option<PathBuf>,
    /// Mass of the fruit, such as "4.8 g"
    #[arg(long)]
    pub mass: String,
    /// Height of its lowest point above the plate, such as "500 mm"; for a campaign, repeated
    #[arg(long = "height", required = true)]
    pub heights: Vec<String>,
    /// Mass of the plate and of what moves with it
    #[arg(long, value_name = "QUANTITY", help_heading = PLATE)]
    pub plate_mass: Option<String>,
    /// Stiffness under the plate
    #[arg(long, value_name = "QUANTITY", help_heading = PLATE)]
    pub plate_stiffness: Option<String>,
    /// Damping under the plate
    #[arg(long, value_name = "QUANTITY", help_heading = PLATE)]
    pub plate_damping: Option<String>,
    /// Part of its mass that the contact of the fruit feels; 1 for a central impact
    #[arg(long, default_value_t = 1.0, value_name = "PART", help_heading = PLATE)]
    pub effective_mass_factor: f64,
    /// Acceleration of gravity
    #[arg(long, default_value = "9.80665 m/s^2", help_heading = PLATE)]
    pub gravity: String,
    /// Impacts to follow
    #[arg(long, default_value_t = 2, help_heading = PLATE)]
    pub impacts: usize,
    /// When a contact is over
    #[arg(long, default_value = "force-zero", value_parser = ends(), help_heading = PLATE)]
    pub end: String,
}

/// Heading of the options of the plate and of those behind them.
pub const PLATE: &str = "Plate (rigid if left out)";

/// A fruit that falls on a plate; SI.
#[derive(Clone, Debug, PartialEq)]
pub struct DropPlan {
    /// The law with all its parameters.
    pub law: Law,
    /// In what it was seen, where it comes from a card.
    pub range: Option<CardRange>,
    /// Fruit and plate.
    pub rig: DropRig,
    /// Drop heights, at least one; m.
    pub heights: Vec<f64>,
    /// Impacts that are followed.
    pub impacts: usize,
    /// End of contact.
    pub end: EndRule,
}

/// Reads the request for a drop.
///
/// # Errors
/// An option cannot be read, or a part of the plate is left out.
pub fn drop_plan(request: &DropRequest) -> Result<DropPlan, Error> {
    let heights = request.heights.iter();
    let heights = heights.map(|height| positive("--height", height, "m"));
    let heights = heights.collect::<Result<Vec<_>, _>>()?;
    if heights.is_empty() {
        return Err(unusable("--height", "expected a height such as \"500 mm\""));
    }
    let factor = request.effective_mass_factor;
    if !(factor > 0.0 && factor <= 1.0) {
        let problem = "expected a number above 0 and up to 1, which is a central impact";
        return Err(unusable("--effective-mass-factor", problem));
    }
    let asked = chosen_law(&request.law, request.laws.as_deref())?;
    Ok(DropPlan {
        law: asked.law,
        range: asked.range,
        rig: DropRig {
            mass: positive("--mass", &request.mass, "kg")?,
            effective_mass_factor: factor,
            gravity: positive("--gravity", &request.gravity, "m/s^2")?,
            plate: plate(request)?,
        },
        heights,
        impacts: request.impacts,
        end: chosen("--end", &request.end, &ENDS)?,
    })
}

fn plate(request: &DropRequest) -> Result<Option<Plate>, Error> {
    let (mass, stiffness, damping) = (
        &request.plate_mass,
        &request.plate_stiffness,
        &request.plate_damping,
    );
    match (mass, stiffness, damping) {
        (None, None, None) => Ok(None),
        (Some(mass), Some(stiffness), Some(damping)) => Ok(Some(Plate {
            mass: positive("--plate-mass", mass, "kg")?,
            stiffness: positive("--plate-stiffness", stiffness, "N/m")?,
            damping: at_least_zero("--plate-damping", damping, "N s/m")?,
        })),
        _ => Err(unusable(
            "--plate-mass, --plate-stiffness, --plate-damping",
            "expected all three for a plate on a spring, or none for a rigid one",
        )),
    }
}

/// The one height of an event; m.
///
/// # Errors
/// There are several, or no impact is to be followed.
pub fn one_height(plan: &DropPlan) -> Result<f64, Error> {
    match plan.heights[..] {
        [_] if plan.impacts == 0 => Err(unusable("--impacts", "expected 1 or more")),
        [height] => Ok(height),
        _ => Err(unusable(
            "--height",
            "expected one height; several are for a campaign of recordings: name its directory",
        )),
    }
}
