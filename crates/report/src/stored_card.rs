//! The law card of a campaign that has been fitted or calibrated, without fitting it
//! again.

use std::path::Path;
use windfall_campaign::impacts::card::card_of_fit;
use windfall_campaign::impacts::run::fitted_campaign;
use windfall_campaign::pipeline::request::{FitRequest, Reuse};
use windfall_campaign::settings::kind::{CampaignKind, campaign_kind};
use windfall_cards::read_card::card_text;
use windfall_files::error::Error;
use windfall_files::option_value::unusable;
use windfall_files::progress::quiet;

/// Law card of a calibration started from the page, in the campaign directory.
pub const CARD_FILE: &str = "law.toml";

/// The law card as text: the median fruit of the stored results for a campaign of
/// single impacts, [`CARD_FILE`] for one of drops.
///
/// # Errors
/// There is no result of this law yet, or the campaign has no card.
pub fn stored_card(directory: &Path, law: &str) -> Result<String, Error> {
    match campaign_kind(directory)? {
        CampaignKind::Impacts => {
            let request = FitRequest {
                laws: vec![law.to_owned()],
                reuse: Reuse::Only,
                ..FitRequest::default()
            };
            let fitted = fitted_campaign(directory, &request, &quiet)?;
            card_text(&card_of_fit(&fitted.campaign, &fitted.outcome)?)
        }
        CampaignKind::Drop => {
            let path = directory.join(CARD_FILE);
            std::fs::read_to_string(&path)
                .map_err(|_| Error::absent(path, "calibrate the campaign first; that writes it"))
        }
        kind => {
            let problem = format!("a campaign of kind \"{}\" has none", kind.name());
            Err(unusable("law card", problem))
        }
    }
}
