//! The recordings of a campaign of drops, for a calibration on waveforms.

use crate::calibrate::waveform::RecordedDrop;
use crate::evaluate::bounce_train;
use crate::read::{DropCampaign, drop_of};
use rayon::prelude::*;
use windfall_campaign::recording::read::read_recording;
use windfall_files::error::Error;

/// Force and bounces of every readable recording; failures are reported by the evaluation.
///
/// # Errors
/// Mass or height of a drop is not known.
pub fn recorded_drops(campaign: &DropCampaign) -> Result<Vec<RecordedDrop>, Error> {
    let entries = &campaign.shared.entries;
    let drops: Vec<Option<Result<RecordedDrop, Error>>> = entries
        .par_iter()
        .map(|entry| {
            let recording = read_recording(&campaign.shared.files, entry).ok()?;
            let train = bounce_train(campaign, entry, &recording).ok()?;
            Some(drop_of(campaign, entry).map(|drop| RecordedDrop {
                id: entry.id.clone(),
                specimen: entry.specimen.clone(),
                mass: drop.mass,
                height: drop.height,
                train,
            }))
        })
        .collect();
    drops.into_iter().flatten().collect()
}
