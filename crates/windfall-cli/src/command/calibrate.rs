//! `windfall calibrate`

use crate::args::calibrate::CalibrateArguments;
use crate::caller::told;
use crate::progress::with_bar;
use crate::show::{show, tell_failures, tell_unused};
use windfall_drop::calibrate::run::calibrate;
use windfall_drop::calibrate::text::{csv_of_calibration, text_of_calibration};
use windfall_workspace::kept_work::kept;

/// Calibrates the law of a drop campaign.
pub fn run(arguments: &CalibrateArguments) -> anyhow::Result<()> {
    let (directory, request) = (&arguments.directory, &arguments.request);
    let work = || {
        let outcome = with_bar(|progress| calibrate(directory, request, progress));
        outcome.map_err(tell_failures)
    };
    let outcome = show(
        &arguments.shown,
        || kept(directory, ("calibrate", told()), work),
        text_of_calibration,
        csv_of_calibration,
    )?;
    tell_unused(arguments.shown.format, &outcome.failed);
    Ok(())
}
