//! `windfall report`

use crate::args::format::Format;
use crate::args::report::ReportArguments;
use crate::progress::with_bar;
use crate::show::{tell_failures, write_json, write_names, write_result};
use windfall_campaign::pipeline::request::FitRequest;
use windfall_report::run::{ReportRequest, report_campaign};

/// Writes the report of a campaign and says which files it is.
pub fn run(arguments: &ReportArguments) -> anyhow::Result<()> {
    let request = ReportRequest {
        fit: FitRequest {
            laws: arguments.laws.clone(),
            free: arguments.free.clone(),
            intervals: arguments.intervals.clone(),
            group: arguments.group.clone(),
            threads: arguments.threads,
            ..FitRequest::default()
        },
        out: arguments.out.clone(),
        theme: arguments.theme,
    };
    let outcome = with_bar(|progress| report_campaign(&arguments.directory, &request, progress));
    let outcome = outcome.map_err(tell_failures)?;
    match arguments.format {
        Format::Json => write_json(&outcome),
        Format::Csv => {
            let files = outcome.files.iter();
            let names: Vec<String> = files.map(|file| file.display().to_string()).collect();
            write_names("file", &names)
        }
        Format::Text => {
            let failed = match outcome.failed {
                0 => String::new(),
                n => format!("; {n} could not be fitted, the page says why"),
            };
            write_result(&format!(
                "{}: {} results, {} files{failed}\n",
                outcome.page.display(),
                outcome.impacts,
                outcome.files.len()
            ))
        }
    }
}
