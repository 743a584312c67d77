//! A calibration in results.sqlite: one document with the numbers that people look
//! for.

use crate::calibrate::outcome::CalibrateOutcome;
use crate::read::DropCampaign;
use serde_json::json;
use windfall_campaign::recording::digests::{campaign_text, recording_digests, run_origin};
use windfall_campaign::settings::kind::STORE_FILE;
use windfall_campaign::store::documents::{DocumentRecord, StoredValue};
use windfall_campaign::store::runs::{RunRecord, latest_run, write_run};
use windfall_files::error::Error;
use windfall_files::provenance::{REVISION, digest_text};
use windfall_measure::measured::plain_value;

/// Keeps a calibration, unless the newest run in the store is the same.
///
/// # Errors
/// The store cannot be used.
pub fn keep_calibration(campaign: &DropCampaign, outcome: &CalibrateOutcome) -> Result<(), Error> {
    let shared = &campaign.shared;
    let document =
        serde_json::to_string(outcome).map_err(|error| Error::unwritable("calibration", error))?;
    let text = campaign_text(&shared.directory)?;
    // What it depends on is in the document: drops, rig, law.
    let key = digest_text(&json!([REVISION, "calibration", text, document]).to_string());
    let store = shared.directory.join(STORE_FILE);
    if latest_run(&store)?.is_some_and(|run| run.keys == [key.clone()]) {
        return Ok(());
    }
    let digests = recording_digests(&shared.directory, &shared.files, &shared.entries);
    let origin = run_origin(shared, &digests, serde_json::Map::new())?;
    let record = DocumentRecord {
        key,
        kind: "calibration".to_owned(),
        item: "calibration".to_owned(),
        specimen: String::new(),
        file: String::new(),
        values: values_of(outcome),
        document,
    };
    let mut run = RunRecord::new(origin, outcome.failed.clone());
    run.documents.push(record);
    write_run(&store, &run)
}

fn values_of(outcome: &CalibrateOutcome) -> Vec<StoredValue> {
    let mut values = Vec::new();
    for parameter in outcome.waveform.iter().flat_map(|w| &w.parameters) {
        let name = format!("waveform {}", parameter.name);
        values.push(parameter.value.stored(name));
    }
    for parameter in outcome.features.iter().flat_map(|f| &f.parameters) {
        values.push(StoredValue {
            name: format!("features {}", parameter.name),
            value: parameter.value,
            sd: parameter.sd,
            unit: parameter.unit.clone(),
        });
    }
    if let Some(design) = &outcome.design {
        for (factor, level) in design.factors.iter().zip(&design.optimum.levels) {
            let name = format!("design {}, one of a family", factor.name);
            values.push(plain_value(*level, &factor.unit).stored(name));
        }
    }
    values
}
