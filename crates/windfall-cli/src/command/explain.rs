//! `windfall explain`

use crate::args::common::ExplainArguments;
use crate::args::format::Format;
use crate::show::{write_json, write_result};
use windfall_files::table::write::csv_text;
use windfall_report::explain::{explain, text_of_explanations};

/// Shows what findings mean and what to do.
pub fn run(arguments: &ExplainArguments) -> anyhow::Result<()> {
    let found = explain(&arguments.codes)?;
    match arguments.format {
        Format::Text => write_result(&text_of_explanations(&found)),
        Format::Json => write_json(&found),
        Format::Csv => {
            let header = ["code", "section", "meaning", "advice"].map(str::to_owned);
            let rows = found
                .into_iter()
                .map(|one| vec![one.code, one.section, one.meaning, one.advice]);
            write_result(&csv_text(&header, rows)?)
        }
    }
}
