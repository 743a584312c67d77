//! One simulated drop as it is asked for: texts with units → SI.

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
#[derive(Clone, Debug)]
pub struct DropRequest {
    /// Law expression with all parameters, or a law card.
    pub law: String,
    /// A file of the user's own laws.
    pub laws: Option<PathBuf>,
    /// Mass of the fruit.
    pub mass: String,
    /// Drop heights: one for an event, several for a campaign.
    pub heights: Vec<String>,
    /// Mass of the plate; with stiffness and damping, or rigid without all.
    pub plate_mass: Option<String>,
    /// Stiffness under the plate.
    pub plate_stiffness: Option<String>,
    /// Damping under the plate.
    pub plate_damping: Option<String>,
    /// Part of its mass that the contact of the fruit feels; 1.
    pub effective_mass_factor: f64,
    /// Acceleration of gravity.
    pub gravity: String,
    /// "force-zero" or "gap-zero".
    pub end: String,
}

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
/// There are several.
pub fn one_height(plan: &DropPlan) -> Result<f64, Error> {
    match plan.heights[..] {
        [height] => Ok(height),
        _ => Err(unusable(
            "--height",
            "expected one height; several are for a campaign of recordings: name its directory",
        )),
    }
}
