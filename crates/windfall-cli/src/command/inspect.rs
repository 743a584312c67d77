//! `windfall inspect`

use crate::args::common::InspectArguments;
use crate::args::format::Shown;
use crate::outcome::{Inspections, Presets};
use crate::show::{message, show, tell_written};
use windfall_files::error::Error;
use windfall_files::expand::expanded;
use windfall_files::option_value::unusable;
use windfall_inspect::export::export_recording;
use windfall_inspect::gather::preset::{
    csv_of_presets, inspect_by, preset_of, presets, text_of_presets,
};
use windfall_inspect::run::{InspectRequest, write_figure};
use windfall_inspect::text::{csv_of_inspections, text_of_inspection};

/// Width of a terminal that does not say.
const COLUMNS: usize = 80;

/// Looks through every file; one that cannot be read does not stop the others.
pub fn run(arguments: &InspectArguments) -> anyhow::Result<()> {
    if arguments.presets {
        return show_presets(&arguments.shown);
    }
    let mut first_failure = None;
    let work = || look_through(arguments, &mut first_failure);
    let text = |own: &Inspections| {
        let texts = own.files.iter().map(|i| text_of_inspection(i, COLUMNS));
        texts.collect::<Vec<_>>().join("\n")
    };
    let csv = |own: &Inspections| csv_of_inspections(&own.files);
    show(&arguments.shown, work, text, csv)?;
    first_failure.map_or(Ok(()), |error| Err(error.into()))
}

/// Inspects all files, and draws and exports them.
///
/// * `first_failure`: the error of the first file that cannot be read, which is the command's own
///   and is shown at the end
fn look_through(
    arguments: &InspectArguments,
    first_failure: &mut Option<Error>,
) -> Result<Inspections, Error> {
    let preset = arguments.preset.as_deref().map(preset_of).transpose()?;
    let request = InspectRequest {
        open: arguments.open.clone(),
        channels: arguments.channels.clone(),
    };
    let mut inspections = Vec::new();
    let files = expanded(&arguments.files)?;
    for file in &files {
        match inspect_by(file, &request, preset.as_ref()) {
            Ok(inspection) => inspections.push(inspection),
            Err(error) => {
                if let Some(before) = first_failure.replace(error) {
                    message(&format!("error: {before}"));
                }
            }
        }
    }
    if let Some(path) = &arguments.plot {
        tell_written(write_figure(path, &inspections, arguments.width)?);
    }
    if let Some(path) = &arguments.export {
        let [file] = files.as_slice() else {
            let problem = "it takes the samples of one recording; name one";
            return Err(unusable(format!("--export {}", path.display()), problem));
        };
        export_recording(file, path, &request)?;
        tell_written([path]);
    }
    Ok(Inspections { files: inspections })
}

/// Says which presets there are, and whose exports they were made from.
fn show_presets(shown: &Shown) -> anyhow::Result<()> {
    let work = || presets().map(|presets| Presets { presets });
    let csv = |own: &Presets| csv_of_presets(&own.presets);
    show(shown, work, |own| text_of_presets(&own.presets), csv)?;
    Ok(())
}
