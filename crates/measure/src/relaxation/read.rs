//! campaign.toml of stress relaxation → [`RelaxationCampaign`].

use crate::relaxation::file::{HoldFile, RelaxationFile};
use std::path::Path;
use windfall_campaign::settings::channels::channel_plans;
use windfall_campaign::settings::conditioning::refuse_all_conditioning;
use windfall_campaign::settings::files::check_format;
use windfall_campaign::settings::kind::{CAMPAIGN_FILE, CampaignKind};
use windfall_campaign::settings::model::Campaign;
use windfall_campaign::settings::shared::read_shared;
use windfall_compression::relaxation::maxwell::{Elements, MOST_ELEMENTS};
use windfall_files::error::Error;
use windfall_files::text::toml_source::{
    Needed, TomlSource, number_that, parse_source, positive_quantity, read_source, refused,
};

/// A campaign of stress relaxation.
#[derive(Clone, Debug)]
pub struct RelaxationCampaign {
    /// What all kinds share.
    pub shared: Campaign,
    /// Force from which the fruit counts as touched; from the noise when `None`. N.
    pub touch_force: Option<f64>,
    /// Elements of the Maxwell model.
    pub elements: Elements,
    /// Duration of the ramp where recordings do not show it; s.
    pub ramp: Option<f64>,
    /// Power of time by which the elastic force grows during the ramp; 1.
    pub exponent: f64,
}

const ADVICE: &str = "`windfall new relaxation DIR` writes a template";

const TABLE: &str = "[relaxation]";

const TOUCH: Needed = Needed::of(
    TABLE,
    "touch_force",
    "force from which the fruit counts as touched",
    "N",
    "touch_force = \"0.05 N\"",
);
const RAMP: Needed = Needed::of(
    TABLE,
    "ramp",
    "duration of the ramp before the hold",
    "s",
    "ramp = \"0.5 s\"",
);

/// The force of Hertz's contact grows as deformation to this power, and so as time to it.
const HERTZ: f64 = 1.5;

/// Reads a campaign directory of stress relaxation.
///
/// # Errors
/// A file of the campaign is missing or does not say what it must.
pub fn read_relaxation(directory: &Path) -> Result<RelaxationCampaign, Error> {
    let source = read_source(&directory.join(CAMPAIGN_FILE), ADVICE)?;
    let file: RelaxationFile = parse_source(&source)?;
    check_format(&source, file.format.as_ref())?;
    let why = "a hold is not filtered";
    refuse_all_conditioning(&source, file.channels.as_ref(), why)?;
    let channels = channel_plans(&source, file.channels.as_ref())?;
    let shared = (&file.campaign, &file.files, &file.summary);
    let kind = CampaignKind::Relaxation;
    let hold = &file.relaxation;
    let (key, fits) = ((TABLE, "exponent"), |own| (1.0..=5.0).contains(&own));
    let exponent = number_that(
        &source,
        hold.exponent.as_ref(),
        key,
        fits,
        "a number from 1 to 5",
    )?;
    Ok(RelaxationCampaign {
        touch_force: positive_quantity(&source, hold.touch_force.as_ref(), &TOUCH)?,
        elements: elements(&source, hold)?,
        ramp: positive_quantity(&source, hold.ramp.as_ref(), &RAMP)?,
        exponent: exponent.unwrap_or(HERTZ),
        shared: read_shared(&source, directory, kind, shared, channels)?,
    })
}

fn elements(source: &TomlSource, hold: &HoldFile) -> Result<Elements, Error> {
    let Some(given) = &hold.elements else {
        return Ok(Elements::Chosen);
    };
    match usize::try_from(*given.get_ref()) {
        Ok(number) if (1..=MOST_ELEMENTS).contains(&number) => Ok(Elements::Given(number)),
        _ => {
            let expected = "expected 1, 2 or 3; leave it out to choose by Akaike's criterion";
            Err(refused(source, given, (TABLE, "elements"), expected))
        }
    }
}
