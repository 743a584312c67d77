//! `windfall calibrate`

use crate::args::calibrate::CalibrateArguments;
use crate::args::format::Format;
use crate::command::fit::{moving, progress_bar};
use crate::show::{message, write_json, write_result};
use windfall_drop::calibrate::run::{CalibrateRequest, calibrate};
use windfall_drop::calibrate::text::{csv_of_calibration, text_of_calibration};
use windfall_drop::calibrate_settings::WAYS;

/// Calibrates the law of a drop campaign.
pub fn run(arguments: &CalibrateArguments) -> anyhow::Result<()> {
    let way = |word: &String| {
        WAYS.iter()
            .find(|(name, _)| name == word)
            .map(|(_, way)| *way)
    };
    let bar = progress_bar();
    let progress = moving(&bar);
    let outcome = calibrate(
        &arguments.directory,
        &CalibrateRequest {
            ways: arguments.ways.iter().filter_map(way).collect(),
            figures: arguments.drawn.folder(),
            tables: arguments.tables.clone(),
            card: arguments.card.clone(),
            profile: arguments.profile,
            threads: arguments.threads,
        },
        &progress,
    )?;
    bar.finish_and_clear();
    match arguments.format {
        Format::Json => write_json(&outcome)?,
        Format::Csv => write_result(&csv_of_calibration(&outcome)?)?,
        Format::Text => write_result(&text_of_calibration(&outcome))?,
    }
    // The text shows failures itself.
    if arguments.format != Format::Text {
        for failure in &outcome.failed {
            message(&format!("not used: {}: {}", failure.id, failure.message));
        }
    }
    Ok(())
}
