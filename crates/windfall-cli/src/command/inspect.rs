//! `windfall inspect`

use crate::args::common::InspectArguments;
use crate::args::format::Format;
use crate::show::{message, show, write_json, write_result};
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
        return show_presets(arguments.format);
    }
    let preset = arguments.preset.as_deref().map(preset_of).transpose()?;
    let request = InspectRequest {
        open: arguments.open.clone(),
        channels: arguments.channels.clone(),
    };
    let mut inspections = Vec::new();
    let mut first_failure = None;
    let files = expanded(&arguments.files)?;
    for file in &files {
        match inspect_by(file, &request, preset.as_ref()) {
            Ok(inspection) => inspections.push(inspection),
            Err(error) => {
                // The first failure is the command's own and is shown at the end.
                if let Some(before) = first_failure.replace(error) {
                    message(&format!("error: {before}"));
                }
            }
        }
    }
    if let Some(path) = &arguments.plot {
        for written in write_figure(path, &inspections)? {
            message(&format!("written: {}", written.display()));
        }
    }
    if let Some(path) = &arguments.export {
        let [file] = files.as_slice() else {
            let problem = "it takes the samples of one recording; name one";
            return Err(unusable(format!("--export {}", path.display()), problem).into());
        };
        export_recording(file, path, &request)?;
        message(&format!("written: {}", path.display()));
    }
    match arguments.format {
        Format::Json => write_json(&serde_json::json!({ "files": inspections }))?,
        Format::Csv => write_result(&csv_of_inspections(&inspections)?)?,
        Format::Text => {
            let texts = inspections.iter().map(|i| text_of_inspection(i, COLUMNS));
            write_result(&texts.collect::<Vec<_>>().join("\n"))?;
        }
    }
    first_failure.map_or(Ok(()), |error| Err(error.into()))
}

/// Says which presets there are, and whose exports they were made from.
fn show_presets(format: Format) -> anyhow::Result<()> {
    let all = presets()?;
    show(
        format,
        &all,
        |all| text_of_presets(all),
        |all| csv_of_presets(all),
    )
}
