//! campaign.toml of taps → [`AcousticCampaign`].

use crate::taps::file::{AcousticFile, ResonanceFile, SoundFile};
use std::path::Path;
use windfall_campaign::settings::channels::{Kind, channel_plan};
use windfall_campaign::settings::conditioning::refuse_conditioning;
use windfall_campaign::settings::files::check_format;
use windfall_campaign::settings::kind::{CAMPAIGN_FILE, CampaignKind};
use windfall_campaign::settings::model::Campaign;
use windfall_campaign::settings::shared::read_shared;
use windfall_files::error::Error;
use windfall_files::text::spanned::Spanned;
use windfall_files::text::toml_source::{
    Needed, TomlSource, choice, missing, number_that, parse_source, positive_quantity, read_source,
    refused, uncertainty,
};
use windfall_numerics::unit::quantity::parse_as;
use windfall_signal::recording::Quantity;
use windfall_signal::tap::find::TapOptions;
use windfall_signal::tap::first_mode::FirstModeOptions;
use windfall_signal::tap::resonance::ResonanceOptions;
use windfall_signal::uncertain::Uncertain;

/// Words of `[acoustic] shared`.
pub(crate) const COMMON: [(&str, Common); 2] = [("reject", Common::Reject), ("keep", Common::Keep)];

/// A campaign of taps.
#[derive(Clone, Debug)]
pub struct AcousticCampaign {
    /// What all kinds share.
    pub shared: Campaign,
    /// Standard uncertainty of the masses; kg.
    pub mass_sd: f64,
    /// Density of fruit that have none in specimens.csv; kg/m³.
    pub density: Option<f64>,
    /// Standard uncertainty of densities; kg/m³.
    pub density_sd: f64,
    /// How taps are found.
    pub taps: TapOptions,
    /// Which peaks count.
    pub resonances: ResonanceOptions,
    /// How the first mode is accepted.
    pub first_mode: FirstModeOptions,
    /// What becomes of frequencies that all fruit show.
    pub common: Common,
}

/// What becomes of frequencies that all fruit show alike.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Common {
    /// They belong to support or microphone.
    #[default]
    Reject,
    /// They are kept: where one fruit stands for several specimens.
    Keep,
}

const ADVICE: &str = "`windfall new acoustic DIR` writes a template";

/// The channel of a campaign of taps.
const SOUND: Kind = Kind::new("[channels.sound]", Quantity::Sound, "");

const MASS_SD: Needed = Needed::of(
    "[rig]",
    "mass_sd",
    "standard uncertainty of the masses",
    "kg",
    "mass_sd = \"0.1 g\"",
);
const DENSITY: Needed = Needed::of(
    "[rig]",
    "density",
    "density of the fruit",
    "kg/m^3",
    "density = \"850 kg/m^3\"",
);
const DENSITY_SD: Needed = Needed::of(
    "[rig]",
    "density_sd",
    "standard uncertainty of densities",
    "kg/m^3",
    "density_sd = \"10 kg/m^3\"",
);

/// Reads a campaign directory of taps.
///
/// # Errors
/// A file of the campaign is missing or does not say what it must.
pub fn read_acoustic(directory: &Path) -> Result<AcousticCampaign, Error> {
    let source = read_source(&directory.join(CAMPAIGN_FILE), ADVICE)?;
    let file: AcousticFile = parse_source(&source)?;
    check_format(&source, file.format.as_ref())?;
    let rig = file.rig.get_ref();
    let density = positive_quantity(&source, rig.density.as_ref(), &DENSITY)?;
    let settings = &file.acoustic;
    let (low, high) = band(&source, settings)?;
    let channel = channel(&source, file.channels.as_ref())?;
    let shared = (&file.campaign, &file.files, &file.summary);
    let kind = CampaignKind::Acoustic;
    let key = ("[acoustic]", "shared");
    Ok(AcousticCampaign {
        mass_sd: uncertainty(&source, rig.mass_sd.as_ref(), &MASS_SD)?,
        density,
        density_sd: uncertainty(&source, rig.density_sd.as_ref(), &DENSITY_SD)?,
        taps: tap_options(&source, settings, (low, high))?,
        resonances: ResonanceOptions {
            low,
            high,
            least_prominence: part(
                &source,
                settings.least_prominence.as_ref(),
                "least_prominence",
            )?
            .unwrap_or(ResonanceOptions::default().least_prominence),
            ..ResonanceOptions::default()
        },
        first_mode: first_mode_options(&source, settings)?,
        common: choice(&source, settings.shared.as_ref(), key, &COMMON)?.unwrap_or_default(),
        shared: read_shared(&source, directory, kind, shared, vec![channel])?,
    })
}

/// Density of a fruit with its uncertainty, where it is known; kg/m³.
pub fn density_of(campaign: &AcousticCampaign, own: Option<f64>) -> Option<Uncertain> {
    own.or(campaign.density)
        .map(|value| Uncertain::new(value, campaign.density_sd))
}

fn channel(
    source: &TomlSource,
    channels: Option<&Spanned<SoundFile>>,
) -> Result<windfall_campaign::settings::model::ChannelPlan, Error> {
    match channels.and_then(|channels| channels.get_ref().sound.as_ref()) {
        Some(sound) => {
            let why = "taps are not filtered: `band` says where the first mode may be";
            refuse_conditioning(source, SOUND.table, sound.get_ref(), why)?;
            channel_plan(source, &SOUND, sound)
        }
        None => {
            let needed = Needed {
                table: "[channels]",
                key: "sound",
                meaning: "the channel of microphone or accelerometer",
                unit: "",
                example: "[channels.sound] column = \"channel 1\"",
            };
            let at = channels.map_or(0..0, Spanned::span);
            Err(missing(source, &at, &needed, needed.table.to_owned()))
        }
    }
}

/// "150 Hz … 2500 Hz"; also with "..." or "to".
fn band(source: &TomlSource, file: &ResonanceFile) -> Result<(f64, f64), Error> {
    let defaults = TapOptions::default();
    let Some(text) = &file.band else {
        return Ok((defaults.low, defaults.high));
    };
    let word = text.get_ref();
    let separated = ["…", "...", " to "]
        .iter()
        .find_map(|separator| word.split_once(separator));
    let end = |text: &str| parse_as(text.trim(), "Hz").ok();
    let ends = separated.and_then(|(low, high)| Some((end(low)?, end(high)?)));
    match ends {
        Some((low, high)) if low > 0.0 && high > low => Ok((low, high)),
        _ => {
            let problem = "expected two frequencies, the lower first: \"150 Hz … 2500 Hz\"";
            let key = ("[acoustic]", "band");
            Err(refused(source, text, key, problem))
        }
    }
}

fn tap_options(
    source: &TomlSource,
    file: &ResonanceFile,
    (low, high): (f64, f64),
) -> Result<TapOptions, Error> {
    let defaults = TapOptions::default();
    let time = |key, meaning, example| Needed::of("[acoustic]", key, meaning, "s", example);
    let hit = time("hit", "left out after the begin of a tap", "hit = \"2 ms\"");
    let longest = time("longest", "longest part of a tap", "longest = \"250 ms\"");
    let hit = positive_quantity(source, file.hit.as_ref(), &hit)?.unwrap_or(defaults.hit);
    let given = positive_quantity(source, file.longest.as_ref(), &longest)?;
    let longest = given.unwrap_or(defaults.longest);
    if let (Some(text), true) = (&file.longest, longest < defaults.shortest) {
        let problem = format!("must be at least {} s", defaults.shortest);
        let key = ("[acoustic]", "longest");
        return Err(refused(source, text, key, problem));
    }
    Ok(TapOptions {
        low,
        high,
        hit,
        longest,
        ..defaults
    })
}

fn first_mode_options(
    source: &TomlSource,
    file: &ResonanceFile,
) -> Result<FirstModeOptions, Error> {
    let defaults = FirstModeOptions::default();
    let key = ("[acoustic]", "least_quality");
    let (fits, expected) = (|quality| quality >= 0.5, "a number of at least 0.5");
    let quality = number_that(source, file.least_quality.as_ref(), key, fits, expected)?;
    let part =
        |value, key, default: f64| Ok::<f64, Error>(part(source, value, key)?.unwrap_or(default));
    Ok(FirstModeOptions {
        least_quality: quality.unwrap_or(defaults.least_quality),
        agreement: part(file.agreement.as_ref(), "agreement", defaults.agreement)?,
        least_share: part(
            file.least_share.as_ref(),
            "least_share",
            defaults.least_share,
        )?,
        doublet: part(file.doublet.as_ref(), "doublet", defaults.doublet)?,
    })
}

fn part(
    source: &TomlSource,
    value: Option<&Spanned<f64>>,
    key: &'static str,
) -> Result<Option<f64>, Error> {
    let fits = |part| part > 0.0 && part <= 1.0;
    let key = ("[acoustic]", key);
    number_that(source, value, key, fits, "a part above 0 and up to 1")
}
