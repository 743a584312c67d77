//! `windfall add`

use crate::args::common::AddArguments;
use crate::show::{csv_of_names, show};
use windfall_files::expand::expanded;
use windfall_inspect::gather::add::add_recordings;
use windfall_inspect::gather::text::text_of_added;

/// Lists recordings, and shows which.
pub fn run(arguments: &AddArguments) -> anyhow::Result<()> {
    let files = expanded(&arguments.files)?;
    let names = arguments.names.as_deref();
    let added = show(
        &arguments.format.into(),
        || add_recordings(&arguments.directory, &files, names),
        |added| text_of_added(added, &arguments.directory),
        |added| csv_of_names("impact", &added.impacts),
    )?;
    let nothing = added.impacts.is_empty() && added.known == 0;
    anyhow::ensure!(
        !nothing || added.left_out.is_empty(),
        "none of the {} recordings could be added",
        added.left_out.len()
    );
    Ok(())
}
