//! campaign.toml, specimens.csv and impacts.csv → [`ImpactCampaign`].

use crate::settings::bench::bench_plan;
use crate::settings::channels::channel_plans;
use crate::settings::contact::contact_plan;
use crate::settings::file::CampaignFile;
use crate::settings::files::check_format;
use crate::settings::fit::fit_plan;
use crate::settings::kind::{CAMPAIGN_FILE, CampaignKind};
use crate::settings::model::{ChannelPlan, ImpactCampaign, RigPlan};
use crate::settings::response::response_plan;
use crate::settings::rig::rig_plan;
use crate::settings::shared::read_shared;
use std::path::Path;
use windfall_cards::user_laws::read::user_laws;
use windfall_files::error::Error;
use windfall_files::text::toml_source::{parse_source, read_source};
use windfall_identify::samples::{QUANTITIES, Quantity};
use windfall_signal::recording::Quantity as Recorded;

/// Reads a campaign directory.
///
/// Recordings are not looked at: one that is missing must not stop the others.
///
/// # Errors
/// A file of the campaign is missing or does not say what it must; the message
/// names file, line and key.
pub fn read_campaign(directory: &Path) -> Result<ImpactCampaign, Error> {
    let advice = "a campaign directory holds a campaign.toml; \
                  `windfall new pendulum DIR` or `windfall new carriage DIR` writes a template";
    let source = read_source(&directory.join(CAMPAIGN_FILE), advice)?;
    let file: CampaignFile = parse_source(&source)?;
    check_format(&source, file.format.as_ref())?;

    let (rig, sd) = rig_plan(&source, file.rig.as_ref())?;
    let channels = channel_plans(&source, file.channels.as_ref())?;
    let (response, sd) = response_plan(&source, &file.response, sd)?;
    let mut contact = contact_plan(&source, &file, &rig)?;
    contact.response = response;
    let bench = bench_plan(&source, &file, (&rig, sd), &channels)?;
    let user = user_laws(&source, &file.laws, directory)?;
    let noise_sd = noise_of_quantities(&rig, &channels);
    let mut fit = fit_plan(&source, &file.fit, noise_sd, user)?;
    fit.options.response = response;
    let shared = (&file.campaign, &file.files, &file.summary);
    let kind = CampaignKind::Impacts;
    Ok(ImpactCampaign {
        shared: read_shared(&source, directory, kind, shared, channels)?,
        rig,
        bench,
        contact,
        fit,
        covariates: file.population.covariates,
    })
}

/// The noise that channels are given, as that of the quantities that are fitted; SI.
fn noise_of_quantities(rig: &RigPlan, channels: &[ChannelPlan]) -> [Option<f64>; QUANTITIES] {
    let mut all = [None; QUANTITIES];
    for channel in channels {
        let own = match channel.quantity {
            Recorded::Displacement | Recorded::Angle => Quantity::Displacement,
            Recorded::Rate => Quantity::Rate,
            Recorded::Force => Quantity::Force,
            Recorded::Acceleration => Quantity::Acceleration,
            _ => continue,
        };
        let arm = match (channel.quantity, rig) {
            (Recorded::Angle, RigPlan::Pendulum(pendulum)) => pendulum.arm,
            _ => 1.0,
        };
        let found = channel.noise_sd.map(|sd| arm * sd);
        all[own as usize] = found.or(all[own as usize]);
    }
    all
}
