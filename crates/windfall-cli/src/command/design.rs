//! `windfall design`

use crate::args::design::{DesignArguments, DesignCommand};
use crate::args::format::Format;
use crate::show::{note, show, tell_written};
use windfall_files::write_file::check_outputs;
use windfall_tables::design::document::{DesignDocument, design_document};
use windfall_tables::design::file::{save_design, write_design};
use windfall_tables::design::request::{Criterion, DesignKind};
use windfall_tables::design::run::make_design;
use windfall_tables::design::text::text_of_design;

/// A design of experiments.
pub fn run(arguments: &DesignArguments) -> anyhow::Result<()> {
    use DesignCommand as Command;
    let (options, kind) = match &arguments.kind {
        Command::Factorial(own) => (&own.all, DesignKind::Factorial(own.kind.clone())),
        Command::PlackettBurman(own) => (&own.all, DesignKind::PlackettBurman(own.kind.clone())),
        Command::Ccd(own) => (&own.all, DesignKind::Composite(own.kind.clone())),
        Command::BoxBehnken(own) => (&own.all, DesignKind::BoxBehnken(own.kind.clone())),
        Command::LatinHypercube(own) => (&own.all, DesignKind::LatinHypercube(own.kind.clone())),
        Command::Sobol(own) => (&own.all, DesignKind::Sobol(own.kind.clone())),
        Command::SplitPlot(own) => (&own.all, DesignKind::SplitPlot(own.kind.clone())),
        Command::DOptimal(own) => {
            let kind = DesignKind::Optimal(Criterion::D, own.kind.clone());
            (&own.all, kind)
        }
        Command::IOptimal(own) => {
            let kind = DesignKind::Optimal(Criterion::I, own.kind.clone());
            (&own.all, kind)
        }
    };
    // A search takes a while.
    check_outputs([options.out.as_deref()])?;
    let outcome = make_design(&kind, &options.request)?;
    if let Some(path) = &options.out {
        save_design(path, &outcome.design, &outcome.about)?;
        tell_written([path]);
    }
    let format = match (options.format, &options.out) {
        (Some(format), _) => format,
        (None, Some(_)) => Format::Text,
        (None, None) => Format::Csv,
    };
    if format == Format::Csv {
        for finding in &outcome.design.findings {
            note(&format!("note: {finding}"));
        }
    }
    let document = || Ok::<_, anyhow::Error>(design_document(&outcome));
    let csv = |_: &DesignDocument| write_design(&outcome.design, &outcome.about);
    show(&format.into(), document, |_| text_of_design(&outcome), csv)?;
    Ok(())
}
