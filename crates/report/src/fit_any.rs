//! `windfall fit DIR`, whatever the campaign measures.

use std::path::Path;
use windfall_campaign::impacts::run::fit_campaign;
use windfall_campaign::pipeline::request::FitRequest;
use windfall_campaign::settings::kind::{CampaignKind, campaign_kind};
use windfall_campaign::settings::model::Campaign;
use windfall_draw::files::NamedFigure;
use windfall_drop::read::DropCampaign;
use windfall_files::error::Error;
use windfall_files::progress::Progress;
use windfall_measure::any_outcome::AnyOutcome;
use windfall_measure::compression::read::CompressionCampaign;
use windfall_measure::kind::Measurement;
use windfall_measure::measured::MeasuredOutcome;
use windfall_measure::relaxation::read::RelaxationCampaign;
use windfall_measure::repeats::read::RepeatsCampaign;
use windfall_measure::run::{
    ReportedItems, StoredItem, measure_campaign, reported_campaign, stored_figures, stored_item,
};
use windfall_measure::taps::read::AcousticCampaign;

/// What is done with campaigns of a kind that fits no impacts.
pub struct MeasurementWork {
    /// Reads a campaign directory.
    pub read: fn(&Path) -> Result<Campaign, Error>,
    /// Evaluates a campaign.
    pub fit: fn(&Path, &FitRequest, Progress) -> Result<MeasuredOutcome, Error>,
    /// Evaluates a campaign for a report.
    pub report: fn(&Path, &FitRequest, Progress) -> Result<ReportedItems, Error>,
    /// Figures of the whole of what the store holds.
    pub figures: fn(&Path) -> Result<Vec<NamedFigure>, Error>,
    /// What the store holds of the recording of an id, and its figure.
    pub item: fn(&Path, &str) -> Result<StoredItem, Error>,
}

impl MeasurementWork {
    const fn of<K: Measurement>() -> Self {
        Self {
            read: |directory| K::read(directory).map(|campaign| campaign.shared().clone()),
            fit: measure_campaign::<K>,
            report: reported_campaign::<K>,
            figures: stored_figures::<K>,
            item: stored_item::<K>,
        }
    }
}

/// The measurement of a kind; `None` where single impacts are fitted.
pub fn measurement_of(kind: CampaignKind) -> Option<MeasurementWork> {
    match kind {
        CampaignKind::Impacts => None,
        CampaignKind::Compression => Some(MeasurementWork::of::<CompressionCampaign>()),
        CampaignKind::Relaxation => Some(MeasurementWork::of::<RelaxationCampaign>()),
        CampaignKind::Acoustic => Some(MeasurementWork::of::<AcousticCampaign>()),
        CampaignKind::Repeats => Some(MeasurementWork::of::<RepeatsCampaign>()),
        CampaignKind::Drop => Some(MeasurementWork::of::<DropCampaign>()),
    }
}

/// Evaluates a campaign, or one recording of a campaign of impacts, and stores results.
///
/// # Errors
/// The campaign or the request is wrong, or the store cannot be used.
pub fn fit_any(path: &Path, request: &FitRequest, progress: Progress) -> Result<AnyOutcome, Error> {
    let kind = match path.is_file() {
        true => CampaignKind::Impacts,
        false => campaign_kind(path)?,
    };
    match measurement_of(kind) {
        Some(measurement) => {
            let outcome = (measurement.fit)(path, request, progress)?;
            Ok(AnyOutcome::Measured(Box::new(outcome)))
        }
        None => {
            let outcome = fit_campaign(path, request, progress)?;
            Ok(AnyOutcome::Impacts(Box::new(outcome)))
        }
    }
}
