//! `windfall fit DIR`, whatever the campaign measures.

use crate::any_outcome::AnyOutcome;
use crate::campaign_kind::{CampaignKind, campaign_kind};
use crate::error::Error;
use crate::progress::Progress;
use crate::request_fit::FitRequest;
use crate::workflow_acoustic::fit_taps;
use crate::workflow_compression::fit_compressions;
use crate::workflow_drop::fit_drops;
use crate::workflow_fit::fit_campaign;
use crate::workflow_repeats::fit_repeats;
use std::path::Path;

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
