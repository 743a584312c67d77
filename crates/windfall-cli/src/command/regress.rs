//! `windfall regress`

use crate::args::format::Format;
use crate::args::regress::{Contrasts, Freedom, Likelihood, RegressArguments, Select, SelectBy};
use crate::show::{write_json, write_result};
use windfall_tables::regress::mixed_text::{csv_of_mixed, text_of_mixed};
use windfall_tables::regress::request::{
    AnovaType, Contrast, Criterion, Direction, FreedomMethod, MixedChoice, ModelText,
    RegressRequest, SelectionOptions,
};
use windfall_tables::regress::run::{AnyRegressOutcome, regress};
use windfall_tables::regress::text::{csv_of_regress, text_of_regress};

/// A linear model of a table.
pub fn run(arguments: &RegressArguments) -> anyhow::Result<()> {
    let outcome = regress(&RegressRequest {
        table: arguments.table.clone(),
        model: model_of(arguments),
        random: arguments.random.clone(),
        mixed: MixedChoice {
            maximum_likelihood: arguments.likelihood == Likelihood::Ml,
            freedom: match arguments.df {
                Freedom::Satterthwaite => FreedomMethod::Satterthwaite,
                Freedom::KenwardRoger => FreedomMethod::KenwardRoger,
            },
        },
        contrast: match arguments.contrasts {
            Contrasts::Treatment => Contrast::Treatment,
            Contrasts::Sum => Contrast::Sum,
            Contrasts::Helmert => Contrast::Helmert,
            Contrasts::Poly => Contrast::Polynomial,
        },
        anova: match arguments.anova {
            1 => AnovaType::Sequential,
            2 => AnovaType::Hierarchical,
            _ => AnovaType::Partial,
        },
        selection: arguments.select.map(|how| selection_of(arguments, how)),
        confidence: arguments.confidence,
        robust: arguments.robust,
        folds: arguments.folds,
        seed: arguments.seed,
        predict: arguments.predict.clone(),
    })?;
    match (arguments.format, &outcome) {
        (Format::Json, _) => write_json(&outcome),
        (Format::Csv, AnyRegressOutcome::Linear(own)) => write_result(&csv_of_regress(own)?),
        (Format::Csv, AnyRegressOutcome::Mixed(own)) => write_result(&csv_of_mixed(own)?),
        (Format::Text, AnyRegressOutcome::Linear(own)) => write_result(&text_of_regress(own)),
        (Format::Text, AnyRegressOutcome::Mixed(own)) => write_result(&text_of_mixed(own)),
    }
}

fn model_of(arguments: &RegressArguments) -> ModelText {
    match &arguments.formula {
        Some(formula) => ModelText::Formula(formula.clone()),
        None => ModelText::Parts {
            response: arguments.response.clone().unwrap_or_default(),
            terms: arguments.terms.clone().unwrap_or_default(),
        },
    }
}

fn selection_of(arguments: &RegressArguments, how: Select) -> SelectionOptions {
    SelectionOptions {
        direction: match how {
            Select::Backward => Direction::Backward,
            Select::Forward => Direction::Forward,
            Select::Stepwise => Direction::Stepwise,
        },
        criterion: match arguments.criterion {
            SelectBy::P => Criterion::Probability {
                enter: arguments.p_enter,
                remove: arguments.p_remove,
            },
            SelectBy::Aicc => Criterion::Aicc,
            SelectBy::Bic => Criterion::Bic,
        },
        hierarchy: arguments.hierarchy,
    }
}
