//! `windfall regress`

use crate::args_format::Format;
use crate::args_regress::{Contrasts, RegressArguments, Select, SelectBy};
use crate::show::{write_json, write_result};
use windfall::workflow_regress::{
    AnovaType, Contrast, Criterion, Direction, ModelText, RegressRequest, SelectionOptions, regress,
};
use windfall::write_regress::{csv_of_regress, text_of_regress};

/// A linear model of a table.
pub fn run(arguments: &RegressArguments) -> anyhow::Result<()> {
    let outcome = regress(&RegressRequest {
        table: arguments.table.clone(),
        model: model_of(arguments),
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
    match arguments.format {
        Format::Json => write_json(&outcome),
        Format::Csv => write_result(&csv_of_regress(&outcome)?),
        Format::Text => write_result(&text_of_regress(&outcome)),
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
