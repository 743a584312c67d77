//! `windfall report`

use crate::args::report::ReportArguments;
use crate::progress::with_bar;
use crate::show::{csv_of_names, show, tell_failures};
use windfall_campaign::pipeline::request::FitRequest;
use windfall_files::progress::Progress;
use windfall_report::run::{ReportOutcome, ReportRequest, report_campaign};

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
        width: arguments.width,
        formats: arguments.figure_format.clone(),
    };
    let work = || {
        let report = |progress: Progress| report_campaign(&arguments.directory, &request, progress);
        with_bar(report).map_err(tell_failures)
    };
    let text = |outcome: &ReportOutcome| {
        let failed = match outcome.failed {
            0 => String::new(),
            n => format!("; {n} could not be fitted, the page says why"),
        };
        let (page, files) = (outcome.page.display(), outcome.files.len());
        format!(
            "{page}: {} results, {files} files{failed}\n",
            outcome.impacts
        )
    };
    let csv = |outcome: &ReportOutcome| {
        csv_of_names("file", outcome.files.iter().map(|file| file.display()))
    };
    show(&arguments.format.into(), work, text, csv)?;
    Ok(())
}
