//! `windfall fit`

use crate::args::{FitArguments, Format};
use crate::show::{message, write_json, write_result};
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use windfall::error::Error;
use windfall::workflow_fit::{FitRequest, Reuse, fit_campaign};
use windfall::write_csv::csv_of_campaign;
use windfall::write_text::text_of_campaign;

/// Fits a campaign and shows the result.
pub fn run(arguments: &FitArguments) -> anyhow::Result<()> {
    let request = FitRequest {
        laws: arguments.laws.clone(),
        free: arguments.free.clone(),
        quantities: arguments.quantities.clone(),
        group: arguments.group.clone(),
        reuse: if arguments.refit {
            Reuse::Nothing
        } else {
            Reuse::Unchanged
        },
        threads: arguments.threads,
    };
    let bar = progress_bar();
    let outcome = fit_campaign(&arguments.directory, &request, &|done, all| {
        bar.set_length(all as u64);
        bar.set_position(done as u64);
    });
    bar.finish_and_clear();
    let outcome = outcome?;
    match arguments.format {
        Format::Json => write_json(&outcome)?,
        Format::Csv => write_result(&csv_of_campaign(&outcome)?)?,
        Format::Text => write_result(&text_of_campaign(&outcome))?,
    }
    // The text shows failures itself, beside the results.
    let told = if arguments.format == Format::Text {
        &[][..]
    } else {
        &outcome.failed
    };
    for failure in told {
        message(&format!("not fitted: {}: {}", failure.id, failure.message));
    }
    if outcome.impacts.is_empty() {
        let path = arguments.directory.clone();
        return Err(Error::NothingFitted {
            path,
            failures: outcome.failed.len(),
        }
        .into());
    }
    message(&status_line(&outcome.status));
    Ok(())
}

fn status_line(status: &windfall::outcome::StatusOutcome) -> String {
    let failed = match status.failed {
        0 => String::new(),
        n => format!("; {n} could not be fitted, the rest was"),
    };
    if status.up_to_date {
        return format!(
            "up to date: nothing has changed since the last fit, {} results from results.sqlite{failed}",
            status.stored
        );
    }
    format!(
        "{} fitted, {} unchanged from results.sqlite{failed}",
        status.fitted, status.stored
    )
}

/// A bar on a terminal, nothing elsewhere.
fn progress_bar() -> ProgressBar {
    if !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template("{bar:40} {pos}/{len} impacts, {eta} left");
    let bar = ProgressBar::new(0);
    match style {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    }
}
