//! `windfall bruise`

use crate::args::bruise::BruiseArguments;
use crate::show::{show, write_result};
use windfall_files::write_file::{check_outputs, write_whole};
use windfall_scene_run::bruise::volumes::{
    bruise_volumes, csv_of_volumes, table_of_volumes, text_of_volumes,
};

/// Volumes of one bruise, or of a table of them.
pub fn run(arguments: &BruiseArguments) -> anyhow::Result<()> {
    if let Some(table) = &arguments.table {
        let out = arguments.shown.out.as_deref();
        check_outputs([out])?;
        let volumes = table_of_volumes(table)?;
        return match out {
            Some(path) => Ok(write_whole(path, volumes.as_bytes())?),
            None => write_result(&volumes),
        };
    }
    let work = || {
        bruise_volumes(
            arguments.widths.as_deref().unwrap_or_default(),
            arguments.depth.as_deref(),
            arguments.radius.as_deref(),
        )
    };
    show(&arguments.shown, work, text_of_volumes, csv_of_volumes)?;
    Ok(())
}
