//! campaign.toml, specimens.csv and impacts.csv → [`Campaign`].

use crate::settings::channels::channel_plans;
use crate::settings::contact::contact_plan;
use crate::settings::file::CampaignFile;
use crate::settings::files::{check_format, check_group, check_placeholders, file_plan};
use crate::settings::fit::fit_plan;
use crate::settings::model::Campaign;
use crate::settings::rig::rig_plan;
use crate::settings::tables::{read_impacts, read_specimens};
use std::path::Path;
use windfall_cards::user_laws::read::user_laws;
use windfall_files::error::Error;
use windfall_files::text::toml_source::{parse_source, read_source};

/// Name of the campaign file.
pub const CAMPAIGN_FILE: &str = "campaign.toml";

/// Reads a campaign directory.
///
/// Recordings are not looked at: one that is missing must not stop the others.
///
/// # Errors
/// A file of the campaign is missing or does not say what it must; the message
/// names file, line and key.
pub fn read_campaign(directory: &Path) -> Result<Campaign, Error> {
    let advice = "a campaign directory holds a campaign.toml; \
                  `windfall new pendulum DIR` or `windfall new carriage DIR` writes a template";
    let source = read_source(&directory.join(CAMPAIGN_FILE), advice)?;
    let file: CampaignFile = parse_source(&source)?;
    check_format(&source, file.format.as_ref())?;

    let rig = rig_plan(&source, file.rig.as_ref())?;
    let channels = channel_plans(&source, file.channels.as_ref())?;
    let files = file_plan(&source, directory, &file.files, channels)?;
    let contact = contact_plan(&source, &file, &rig)?;
    let user = user_laws(&source, &file.laws, directory)?;
    let fit = fit_plan(&source, &file.fit, user)?;

    let specimens_file = directory.join("specimens.csv");
    let specimens = if specimens_file.exists() {
        Some(read_specimens(&specimens_file)?)
    } else {
        None
    };
    let impacts = read_impacts(&directory.join("impacts.csv"), specimens.as_deref())?;
    let campaign = Campaign {
        directory: directory.to_path_buf(),
        title: file
            .campaign
            .title
            .unwrap_or_else(|| directory.display().to_string()),
        simulated: file.campaign.simulated,
        rig,
        files,
        contact,
        fit,
        group: file
            .summary
            .group
            .as_ref()
            .map(|group| group.get_ref().clone()),
        covariates: file.population.covariates,
        specimens: specimens.unwrap_or_default(),
        impacts,
    };
    let group = file.summary.group.as_ref();
    check_group(&source, group, &campaign.specimens, &campaign.impacts)?;
    check_placeholders(&source, &campaign.files, &campaign.impacts)?;
    Ok(campaign)
}
