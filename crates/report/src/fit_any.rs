//! `windfall fit DIR`, whatever the campaign measures.

use std::path::Path;
use windfall_campaign::compression::run::fit_compressions;
use windfall_campaign::impacts::request::FitRequest;
use windfall_campaign::impacts::run::fit_campaign;
use windfall_campaign::measure::any_outcome::AnyOutcome;
use windfall_campaign::repeats::run::fit_repeats;
use windfall_campaign::settings::kind::{CampaignKind, campaign_kind};
use windfall_campaign::taps::run::fit_taps;
use windfall_drop::run::fit_drops;
use windfall_files::error::Error;
use windfall_files::progress::Progress;

/// Evaluates a campaign directory, or one recording of a campaign of impacts,
/// and keeps the results in its store.
///
/// # Errors
/// The campaign or the request is wrong, or the store cannot be used.
pub fn fit_any(path: &Path, request: &FitRequest, progress: Progress) -> Result<AnyOutcome, Error> {
    let kind = match path.is_file() {
        true => CampaignKind::Impacts,
        false => campaign_kind(path)?,
    };
    match kind {
        CampaignKind::Compression => fit_compressions(path, request, progress),
        CampaignKind::Acoustic => fit_taps(path, request, progress),
        CampaignKind::Repeats => fit_repeats(path, request, progress),
        CampaignKind::Drop => fit_drops(path, request, progress),
        CampaignKind::Impacts => {
            fit_campaign(path, request, progress).map(|o| AnyOutcome::Impacts(Box::new(o)))
        }
    }
}
