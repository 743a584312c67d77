//! `windfall bruise`

use crate::args::bruise::BruiseArguments;
use crate::args::format::Format;
use crate::show::{kept_form, show, tell_written, write_result};
use windfall_files::option_value::unusable;
use windfall_files::write_file::write_whole;
use windfall_scene_run::bruise::volumes::{
    bruise_volumes, csv_of_volumes, table_of_volumes, text_of_volumes,
};

/// Volumes of one bruise, or of a table of them.
pub fn run(arguments: &BruiseArguments) -> anyhow::Result<()> {
    if let Some(table) = &arguments.table {
        let kept = kept_form(&arguments.shown)?;
        if let Some((path, Format::Json | Format::Text)) = kept {
            let problem = "a table of bruises is CSV: give the file the ending .csv";
            return Err(unusable(format!("--out {}", path.display()), problem).into());
        }
        let volumes = table_of_volumes(table)?;
        if let Some((path, _)) = kept {
            write_whole(path, volumes.as_bytes())?;
            tell_written([path]);
        }
        return write_result(&volumes);
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
