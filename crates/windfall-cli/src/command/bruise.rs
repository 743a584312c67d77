//! `windfall bruise`

use crate::args::bruise::BruiseArguments;
use crate::args::format::Format;
use crate::show::{write_json, write_result};
use windfall_scene_run::bruise::volumes::{
    bruise_volumes, csv_of_volumes, table_of_volumes, text_of_volumes,
};

/// Volumes of one bruise, or of a table of them.
pub fn run(arguments: &BruiseArguments) -> anyhow::Result<()> {
    if let Some(table) = &arguments.table {
        return write_result(&table_of_volumes(table)?);
    }
    let outcome = bruise_volumes(
        arguments.widths.as_deref().unwrap_or_default(),
        arguments.depth.as_deref(),
        arguments.radius.as_deref(),
    )?;
    match arguments.format {
        Format::Json => write_json(&outcome),
        Format::Csv => write_result(&csv_of_volumes(&outcome)?),
        Format::Text => write_result(&text_of_volumes(&outcome)),
    }
}
