//! `windfall calibrate`

use crate::args::calibrate::CalibrateArguments;
use crate::command::fit::with_bar;
use crate::show::{show, tell_unused};
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
    let request = CalibrateRequest {
        ways: arguments.ways.iter().filter_map(way).collect(),
        figures: arguments.drawn.folder(),
        tables: arguments.tables.clone(),
        card: arguments.card.clone(),
        profile: arguments.profile,
        threads: arguments.threads,
    };
    let outcome = with_bar(|progress| calibrate(&arguments.directory, &request, progress))?;
    show(
        arguments.format,
        &outcome,
        text_of_calibration,
        csv_of_calibration,
    )?;
    tell_unused(arguments.format, &outcome.failed);
    Ok(())
}
