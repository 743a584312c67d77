//! `windfall add`

use crate::args::common::AddArguments;
use crate::args::format::Format;
use crate::show::{write_json, write_result};
use windfall_files::expand::expanded;
use windfall_files::table::write::csv_text;
use windfall_inspect::gather::add::add_recordings;
use windfall_inspect::gather::text::text_of_added;

/// Lists recordings, and shows which.
pub fn run(arguments: &AddArguments) -> anyhow::Result<()> {
    let files = expanded(&arguments.files)?;
    let names = arguments.names.as_deref();
    let added = add_recordings(&arguments.directory, &files, names)?;
    match arguments.format {
        Format::Json => write_json(&added)?,
        Format::Csv => {
            let rows = added.impacts.iter().map(|id| vec![id.clone()]);
            write_result(&csv_text(&["impact".to_owned()], rows)?)?;
        }
        Format::Text => write_result(&text_of_added(&added, &arguments.directory))?,
    }
    let nothing = added.impacts.is_empty() && added.known == 0;
    anyhow::ensure!(
        !nothing || added.left_out.is_empty(),
        "none of the {} recordings could be added",
        added.left_out.len()
    );
    Ok(())
}
