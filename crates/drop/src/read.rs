//! campaign.toml of a drop rig → [`DropCampaign`].

use crate::bounces::{BouncePlan, bounce_plan};
use crate::calibrate_settings::{CalibrateSettings, Target, calibrate_settings};
use crate::file::{DropFile, DropRigFile};
use std::path::Path;
use windfall_campaign::settings::channels::channel_plans;
use windfall_campaign::settings::conditioning::refuse_all_conditioning;
use windfall_campaign::settings::file::QuantityText;
use windfall_campaign::settings::files::check_format;
use windfall_campaign::settings::kind::{CAMPAIGN_FILE, CampaignKind};
use windfall_campaign::settings::model::{Campaign, ImpactEntry};
use windfall_campaign::settings::rig::STANDARD_GRAVITY;
use windfall_campaign::settings::shared::read_shared;
use windfall_cards::user_laws::read::user_laws;
use windfall_files::error::{DropQuantity, Error, Place};
use windfall_files::name::Name;
use windfall_files::text::cell_quantity::cell_quantity;
use windfall_files::text::spanned::Spanned;
use windfall_files::text::toml_source::{
    Needed, TomlSource, choice, missing, number_that, parse_source, positive_quantity, read_source,
    refused, suggestion, uncertainty,
};
use windfall_signal::uncertain::Uncertain;

/// Words of `[rig] plate`.
pub(crate) const PLATES: [(&str, PlatePlan); 1] = [("rigid", PlatePlan::Rigid)];

/// A campaign of fruit that fall on a plate.
#[derive(Clone, Debug)]
pub struct DropCampaign {
    /// What all kinds share.
    pub shared: Campaign,
    /// What falls on what, as far as it is given.
    pub rig: DropRigPlan,
    /// How bounces are found.
    pub bounces: BouncePlan,
    /// The law and how it is calibrated.
    pub calibrate: CalibrateSettings,
}

/// What falls on what.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DropRigPlan {
    /// Acceleration of gravity, or of a track; m/s².
    pub gravity: f64,
    /// Mass of fruit that have none in the tables; kg.
    pub mass: Option<f64>,
    /// Standard uncertainty of masses without one of their own; kg.
    pub mass_sd: f64,
    /// Height of drops that have none in impacts.csv; m.
    pub height: Option<f64>,
    /// Standard uncertainty of heights without one of their own; m.
    pub height_sd: f64,
    /// The plate.
    pub plate: PlatePlan,
    /// Part of its mass that the contact of a fruit feels; 1.
    pub effective_mass_factor: f64,
}

/// The plate of a drop rig.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlatePlan {
    /// It does not move.
    Rigid,
    /// It rests on spring and damper.
    Sprung {
        /// Mass of the plate and of what moves with it; kg.
        mass: Uncertain,
        /// Stiffness; from the ringing where there is none. N/m.
        stiffness: Option<Uncertain>,
        /// Damping; from the ringing where there is none. N s/m.
        damping: Option<Uncertain>,
    },
}

/// What is known of one drop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drop {
    /// Mass of the fruit; kg.
    pub mass: Uncertain,
    /// Drop height; m.
    pub height: Uncertain,
}

const TABLE: &str = "[rig]";

const MASS: DropQuantity = DropQuantity {
    name: "mass",
    column: "mass_g of specimens.csv or impacts.csv",
    prefix: "mass",
    example: "mass = \"4.8 g\"",
};

const HEIGHT: DropQuantity = DropQuantity {
    name: "drop height",
    column: "drop_height_mm of impacts.csv",
    prefix: "drop_height",
    example: "height = \"500 mm\"",
};

const ADVICE: &str = "`windfall new drop DIR` writes a template";

/// Reads a campaign directory of drops.
///
/// # Errors
/// A file of the campaign is missing or does not say what it must; a drop has no
/// mass or no height.
pub fn read_drop(directory: &Path) -> Result<DropCampaign, Error> {
    let source = read_source(&directory.join(CAMPAIGN_FILE), ADVICE)?;
    let file: DropFile = parse_source(&source)?;
    check_format(&source, file.format.as_ref())?;
    let channels = channel_plans(&source, file.channels.as_ref())?;
    // A filter would take the ringing for noise, or smear one impact into the next.
    let why = "bounces and ringing are taken from the channel as it was recorded";
    refuse_all_conditioning(&source, file.channels.as_ref(), why)?;
    let shared = (&file.campaign, &file.files, &file.summary);
    let kind = CampaignKind::Drop;
    let campaign = DropCampaign {
        rig: rig_plan(&source, &file.rig)?,
        bounces: bounce_plan(&source, &file.bounces)?,
        calibrate: calibrate_settings(
            &source,
            &file.fit,
            &file.calibrate,
            user_laws(&source, &file.laws, directory)?,
        )?,
        shared: read_shared(&source, directory, kind, shared, channels)?,
    };
    for entry in &campaign.shared.entries {
        drop_of(&campaign, entry)?;
    }
    check_target(&source, &file, &campaign)?;
    Ok(campaign)
}

/// Mass and height of a drop.
///
/// A mass stands in impacts.csv or specimens.csv ("mass_g", its uncertainty
/// "mass_sd_g") or, for all, in `[rig]`; a height in impacts.csv
/// ("drop_height_mm", "drop_height_sd_mm") or in `[rig]`.
///
/// # Errors
/// One of them is nowhere, or a cell is no positive number.
pub fn drop_of(campaign: &DropCampaign, entry: &ImpactEntry) -> Result<Drop, Error> {
    let rig = &campaign.rig;
    let directory = &campaign.shared.directory;
    let place = |file: &str, line| Place::at(&directory.join(file), line);
    let of_entry = (place("impacts.csv", entry.line), &entry.cells[..]);
    let specimen = campaign.shared.specimen_of(entry);
    let of_specimen = specimen.map(|s| (place("specimens.csv", s.line), &s.cells[..]));
    let mut mass = measured(&of_entry, "mass", "kg", (None, rig.mass_sd))?;
    if let (None, Some(row)) = (mass, &of_specimen) {
        mass = measured(row, "mass", "kg", (None, rig.mass_sd))?;
    }
    let given = rig.mass.map(|value| Uncertain::new(value, rig.mass_sd));
    let unknown = |needed: &'static DropQuantity| {
        let rows = of_specimen.iter().chain([&of_entry]);
        let mut columns = rows.flat_map(|(_, cells)| cells.iter().map(|(column, _)| column));
        Error::DropUnknown {
            place: of_entry.0.clone(),
            item: entry.id.clone(),
            needed,
            found: match columns.any(|column: &Name| column.starts_with(needed.prefix)) {
                true => "blank or in no unit of it",
                false => "not there",
            },
        }
    };
    let mass = mass.or(given).ok_or_else(|| unknown(&MASS))?;
    let usual = (rig.height, rig.height_sd);
    let height = measured(&of_entry, "drop_height", "m", usual)?;
    let height = height.ok_or_else(|| unknown(&HEIGHT))?;
    Ok(Drop { mass, height })
}

/// A quantity of a row with its uncertainty.
///
/// * `usual`: value and uncertainty where the row has none
fn measured(
    (place, cells): &(Place, &[(Name, String)]),
    name: &str,
    unit: &str,
    usual: (Option<f64>, f64),
) -> Result<Option<Uncertain>, Error> {
    let cell = |name: &str| cell_quantity(cells, name, unit, place);
    let value = cell(name)?.or(usual.0);
    let sd = cell(&format!("{name}_sd"))?;
    Ok(value.map(|value| Uncertain::new(value, sd.unwrap_or(usual.1))))
}

const fn needed(
    key: &'static str,
    meaning: &'static str,
    unit: &'static str,
    example: &'static str,
) -> Needed {
    Needed::of(TABLE, key, meaning, unit, example)
}

fn rig_plan(source: &TomlSource, file: &Spanned<DropRigFile>) -> Result<DropRigPlan, Error> {
    let rig = file.get_ref();
    let gravity = needed(
        "gravity",
        "acceleration of gravity",
        "m/s^2",
        "gravity = \"9.80665 m/s^2\"",
    );
    let mass = needed("mass", "mass of the fruit", "kg", "mass = \"4.8 g\"");
    let mass_sd = needed(
        "mass_sd",
        "standard uncertainty of masses",
        "kg",
        "mass_sd = \"0.1 g\"",
    );
    let height = needed("height", "drop height", "m", "height = \"500 mm\"");
    let height_sd = needed(
        "height_sd",
        "standard uncertainty of drop heights",
        "m",
        "height_sd = \"1 mm\"",
    );
    let above = |value: &Option<Spanned<QuantityText>>, needed| {
        positive_quantity(source, value.as_ref(), needed)
    };
    Ok(DropRigPlan {
        gravity: above(&rig.gravity, &gravity)?.unwrap_or(STANDARD_GRAVITY),
        mass: above(&rig.mass, &mass)?,
        mass_sd: uncertainty(source, rig.mass_sd.as_ref(), &mass_sd)?,
        height: above(&rig.height, &height)?,
        height_sd: uncertainty(source, rig.height_sd.as_ref(), &height_sd)?,
        plate: plate_plan(source, file)?,
        effective_mass_factor: effective_mass_factor(source, rig)?,
    })
}

fn effective_mass_factor(source: &TomlSource, rig: &DropRigFile) -> Result<f64, Error> {
    let (value, key) = (rig.effective_mass_factor.as_ref(), "effective_mass_factor");
    let fits = |factor| factor > 0.0 && factor <= 1.0;
    let expected = "a number above 0 and up to 1, which is a central impact";
    let factor = number_that(source, value, (TABLE, key), fits, expected)?;
    Ok(factor.unwrap_or(1.0))
}

fn plate_plan(source: &TomlSource, file: &Spanned<DropRigFile>) -> Result<PlatePlan, Error> {
    let rig = file.get_ref();
    let key = (TABLE, "plate");
    let rigid = choice(source, rig.plate.as_ref(), key, &PLATES)?;
    let values = [
        (&rig.plate_mass, "plate_mass"),
        (&rig.plate_mass_sd, "plate_mass_sd"),
        (&rig.plate_stiffness, "plate_stiffness"),
        (&rig.plate_stiffness_sd, "plate_stiffness_sd"),
        (&rig.plate_damping, "plate_damping"),
        (&rig.plate_damping_sd, "plate_damping_sd"),
    ];
    if let Some(rigid) = rigid {
        let mut given = values
            .iter()
            .filter_map(|(value, key)| Some((value.as_ref()?, key)));
        return given.next().map_or(Ok(rigid), |(value, key)| {
            let problem = "a rigid plate has no such value; remove the line";
            Err(refused(source, value, (TABLE, key), problem))
        });
    }
    let mass = needed(
        "plate_mass",
        "mass of the plate and of what moves with it; or plate = \"rigid\"",
        "kg",
        "plate_mass = \"0.2 kg\"",
    );
    let value = positive_quantity(source, rig.plate_mass.as_ref(), &mass)?;
    let value = value.ok_or_else(|| missing(source, &file.span(), &mass, TABLE.to_owned()))?;
    let sd = needed(
        "plate_mass_sd",
        "its uncertainty",
        "kg",
        "plate_mass_sd = \"1 g\"",
    );
    Ok(PlatePlan::Sprung {
        mass: Uncertain::new(value, uncertainty(source, rig.plate_mass_sd.as_ref(), &sd)?),
        stiffness: plate_value(
            source,
            [&rig.plate_stiffness, &rig.plate_stiffness_sd],
            ["plate_stiffness", "plate_stiffness_sd"],
            "N/m",
            "plate_stiffness = \"645.8 N/mm\"",
        )?,
        damping: plate_value(
            source,
            [&rig.plate_damping, &rig.plate_damping_sd],
            ["plate_damping", "plate_damping_sd"],
            "N s/m",
            "plate_damping = \"0.05247 N s/mm\"",
        )?,
    })
}

/// A value of the plate that the ringing gives where it is left out.
///
/// * `keys`: of the value and of its uncertainty
fn plate_value(
    source: &TomlSource,
    [value, sd]: [&Option<Spanned<QuantityText>>; 2],
    keys: [&'static str; 2],
    unit: &'static str,
    example: &'static str,
) -> Result<Option<Uncertain>, Error> {
    let [own, of_sd] = keys.map(|key| needed(key, "", unit, example));
    let number = positive_quantity(source, value.as_ref(), &own)?;
    let deviation = uncertainty(source, sd.as_ref(), &of_sd)?;
    match (number, sd) {
        (None, Some(sd)) => {
            let problem = format!("an uncertainty without its value: {example}");
            Err(refused(source, sd, (TABLE, keys[1]), problem))
        }
        (number, _) => Ok(number.map(|value| Uncertain::new(value, deviation))),
    }
}

/// Whether a drop is the one, or at the height, that `[calibrate]` names.
fn check_target(
    source: &TomlSource,
    file: &DropFile,
    campaign: &DropCampaign,
) -> Result<(), Error> {
    let entries = &campaign.shared.entries;
    match (&campaign.calibrate.target, &file.calibrate.target_drop) {
        (Target::Drop(id), Some(text)) if entries.iter().all(|entry| entry.id != *id) => {
            let ids = entries.iter().map(|entry| entry.id.as_str());
            let problem = format!("impacts.csv has no drop of this id{}", suggestion(id, ids));
            let key = ("[calibrate]", "target_drop");
            Err(refused(source, text, key, problem))
        }
        _ => Ok(()),
    }
}
