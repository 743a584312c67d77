//! `windfall fit`

use crate::args::fit::FitArguments;
use crate::args::format::Format;
use crate::progress::with_bar;
use crate::show::{csv_of_names, message, note, show, tell_failures, tell_unused, write_text};
use std::ops::ControlFlow;
use windfall_campaign::impacts::run::fit_recording;
use windfall_campaign::impacts::shard::{ShardOutcome, fit_part};
use windfall_campaign::pipeline::request::FitRequest;
use windfall_files::error::Error;
use windfall_files::sheet::form::Form;
use windfall_inspect::gather::text::text_of_watched;
use windfall_inspect::gather::watch::watch;
use windfall_measure::any_outcome::AnyOutcome;
use windfall_report::any_text::{csv_of_any, text_of_any, write_any};
use windfall_report::fit_any::fit_any;

/// Fits a campaign and shows the result.
pub fn run(arguments: &FitArguments) -> anyhow::Result<()> {
    let path = &arguments.directory;
    let request = &FitRequest {
        outputs: arguments.out.iter().cloned().collect(),
        ..arguments.request.clone()
    };
    let out = arguments.out.as_deref();
    let out = out.map(|path| Ok::<_, Error>((path, Form::of_path("--out", path)?)));
    let out = out.transpose()?;
    if arguments.watch {
        note(&format!("watching {}/raw; Ctrl-C ends it", path.display()));
        watch(
            path,
            request,
            &|_, _| ControlFlow::Continue(()),
            &mut |told| {
                let shown = match told {
                    Ok(watched) => write_text(|| text_of_watched(watched)),
                    Err(error) => {
                        message(&format!("error: {error}"));
                        Ok(())
                    }
                };
                // Nobody reads any more.
                match shown {
                    Ok(()) => ControlFlow::Continue(()),
                    Err(_) => ControlFlow::Break(()),
                }
            },
        )?;
        return Ok(());
    }
    if let (Some(part), Some((out, _))) = (arguments.part(), out) {
        let work = || {
            let outcome = with_bar(|progress| fit_part(path, request, &part, out, progress));
            outcome.map_err(tell_failures)
        };
        let csv = |own: &ShardOutcome| csv_of_names("file", [own.file.display()]);
        let outcome = show(&arguments.format.into(), work, text_of_shard, csv)?;
        tell_unused(Format::Json, &outcome.failed);
        return Ok(());
    }
    let work = || {
        let outcome = with_bar(|progress| match &arguments.recording {
            Some(recording) => fit_recording(path, recording, request, progress)
                .map(|outcome| AnyOutcome::Impacts(Box::new(outcome))),
            None => fit_any(path, request, progress),
        });
        let outcome = outcome.map_err(tell_failures)?;
        if let Some((path, form)) = out {
            write_any(path, form, &outcome)?;
        }
        Ok::<_, Error>(outcome)
    };
    let outcome = show(&arguments.format.into(), work, text_of_any, csv_of_any)?;
    // The text shows failures itself, beside the results.
    let told = if arguments.format == Format::Text {
        &[][..]
    } else {
        outcome.failed()
    };
    for failure in told {
        message(&format!("not fitted: {}: {}", failure.id, failure.message));
    }
    if outcome.results() == 0 {
        let path = arguments.directory.clone();
        return Err(Error::NothingFitted {
            path,
            failures: outcome.failed().to_vec(),
        }
        .into());
    }
    if arguments.recording.is_none() {
        note(&status_line(outcome.status()));
    }
    Ok(())
}

/// Says what became of a part of a campaign.
fn text_of_shard(outcome: &ShardOutcome) -> String {
    format!(
        "{} impacts: {} rows; {} could not be fitted.\n\nWritten: {}\n",
        outcome.impacts,
        outcome.rows,
        outcome.failed.len(),
        outcome.file.display()
    )
}

fn status_line(status: &windfall_campaign::result::outcome::StatusOutcome) -> String {
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
