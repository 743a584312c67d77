//! `windfall design`

use crate::args::design::{
    CompositeArguments, DesignArguments, DesignCommand, DesignOptions, FactorialArguments,
    OptimalArguments, RunOrder,
};
use crate::args::format::Format;
use crate::show::{message, write_json, write_result};
use windfall_tables::design::document::design_document;
use windfall_tables::design::file::{save_design, write_design};
use windfall_tables::design::request::{
    Criterion, DesignKind, DesignRequest, OptimalRequest, Order,
};
use windfall_tables::design::run::make_design;
use windfall_tables::design::text::text_of_design;

/// A design of experiments.
pub fn run(arguments: &DesignArguments) -> anyhow::Result<()> {
    let (options, kind) = kind_of(&arguments.kind);
    let outcome = make_design(&DesignRequest {
        kind,
        factors: options.factors.clone(),
        decimals: options.decimals.clone(),
        seed: options.seed,
        order: match options.order {
            RunOrder::Random => Order::Random,
            RunOrder::Standard => Order::Standard,
        },
    })?;
    if let Some(path) = &options.out {
        save_design(path, &outcome.design, &outcome.about)?;
        message(&format!("written: {}", path.display()));
    }
    let format = match (options.format, &options.out) {
        (Some(format), _) => format,
        (None, Some(_)) => Format::Text,
        (None, None) => Format::Csv,
    };
    match format {
        Format::Text => write_result(&text_of_design(&outcome)),
        Format::Json => write_json(&design_document(&outcome)),
        Format::Csv => {
            for finding in &outcome.design.findings {
                message(&format!("note: {finding}"));
            }
            write_result(&write_design(&outcome.design, &outcome.about)?)
        }
    }
}

fn kind_of(command: &DesignCommand) -> (&DesignOptions, DesignKind) {
    match command {
        DesignCommand::Factorial(arguments) => (&arguments.all, factorial(arguments)),
        DesignCommand::Ccd(arguments) => (&arguments.all, composite(arguments)),
        DesignCommand::PlackettBurman(arguments) => (
            &arguments.all,
            DesignKind::PlackettBurman {
                runs: arguments.runs,
                centre: arguments.centre,
            },
        ),
        DesignCommand::BoxBehnken(arguments) => (
            &arguments.all,
            DesignKind::BoxBehnken {
                centre: arguments.centre,
                blocks: arguments.blocks,
            },
        ),
        DesignCommand::LatinHypercube(arguments) => (
            &arguments.all,
            DesignKind::LatinHypercube {
                runs: arguments.runs,
            },
        ),
        DesignCommand::Sobol(arguments) => (
            &arguments.all,
            DesignKind::Sobol {
                runs: arguments.runs,
            },
        ),
        DesignCommand::DOptimal(arguments) => (&arguments.all, optimal(arguments, Criterion::D)),
        DesignCommand::IOptimal(arguments) => (&arguments.all, optimal(arguments, Criterion::I)),
    }
}

fn factorial(arguments: &FactorialArguments) -> DesignKind {
    DesignKind::Factorial {
        points: arguments.points,
        fraction: arguments.fraction.clone(),
        runs: arguments.runs,
        replicates: arguments.replicates,
        centre: arguments.centre,
        blocks: arguments.blocks,
    }
}

fn composite(arguments: &CompositeArguments) -> DesignKind {
    DesignKind::Composite {
        alpha: arguments.alpha.clone(),
        levels: arguments.levels.clone(),
        fraction: arguments.fraction.clone(),
        centre: arguments.centre.clone(),
        blocks: arguments.blocks,
    }
}

fn optimal(arguments: &OptimalArguments, criterion: Criterion) -> DesignKind {
    DesignKind::Optimal(OptimalRequest {
        criterion,
        runs: arguments.runs,
        model: arguments.model.clone(),
        points: arguments.points,
        candidates: arguments.candidates.clone(),
        augment: arguments.augment.clone(),
        starts: arguments.starts,
    })
}
