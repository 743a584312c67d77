//! `windfall inspect`

use crate::args::InspectArguments;
use crate::args_format::Format;
use crate::show::{message, write_json, write_result};
use windfall::request_open::OpenRequest;
use windfall::workflow_inspect::inspect_recording;
use windfall::write_inspection::{csv_of_inspections, text_of_inspection};

/// Looks through every file; one that cannot be read does not stop the others.
pub fn run(arguments: &InspectArguments) -> anyhow::Result<()> {
    let mut inspections = Vec::new();
    let mut first_failure = None;
    for file in &arguments.files {
        match inspect_recording(file, &OpenRequest::default()) {
            Ok(inspection) => inspections.push(inspection),
            Err(error) => {
                // The first failure is the command's own and is shown at the end.
                if let Some(before) = first_failure.replace(error) {
                    message(&format!("error: {before}"));
                }
            }
        }
    }
    match arguments.format {
        Format::Json => write_json(&serde_json::json!({ "files": inspections }))?,
        Format::Csv => write_result(&csv_of_inspections(&inspections)?)?,
        Format::Text => {
            let texts: Vec<String> = inspections.iter().map(text_of_inspection).collect();
            write_result(&texts.join("\n"))?;
        }
    }
    first_failure.map_or(Ok(()), |error| Err(error.into()))
}
