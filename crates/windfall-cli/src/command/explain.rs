//! `windfall explain`

use crate::args::common::ExplainArguments;
use crate::outcome::Explanations;
use crate::show::show;
use windfall_files::error::Error;
use windfall_files::table::write::csv_text;
use windfall_report::explain::{explain, text_of_explanations};

/// Shows what findings mean and what to do.
pub fn run(arguments: &ExplainArguments) -> anyhow::Result<()> {
    let work = || explain(&arguments.codes).map(|findings| Explanations { findings });
    let text = |own: &Explanations| text_of_explanations(&own.findings);
    show(&arguments.shown, work, text, csv)?;
    Ok(())
}

fn csv(found: &Explanations) -> Result<String, Error> {
    let rows = found.findings.iter().map(|one| {
        let word = one.severity.word();
        let cells = [&one.code, &one.section, &one.meaning, &one.advice];
        let cells = cells.map(String::as_str).into_iter().chain([word]);
        cells.map(str::to_owned).collect()
    });
    csv_text(&["code", "section", "meaning", "advice", "severity"], rows)
}
