//! Words of options for choices of the statistics, which know no command line.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use std::convert::Infallible;
use windfall_design::exchange::Criterion as Optimality;
use windfall_files::option_value::chosen;
use windfall_mixed::fit::MixedMethod;
use windfall_statistics::model::anova::AnovaType;
use windfall_statistics::model::contrast::Contrast;
use windfall_statistics::model::selection::Direction;

/// What is maximised where there are random effects.
pub(crate) fn likelihood() -> impl TypedValueParser<Value = MixedMethod> {
    let methods = [
        ("reml", MixedMethod::Reml),
        ("ml", MixedMethod::MaximumLikelihood),
    ];
    let reml = "Restricted likelihood: variances without bias from the fixed effects";
    let ml = "Plain likelihood: for comparing models with different fixed effects";
    PossibleValuesParser::new([
        PossibleValue::new("reml").help(reml),
        PossibleValue::new("ml").help(ml),
    ])
    .try_map(move |word| chosen("--likelihood", &word, &methods))
}

/// How terms are selected.
pub(crate) fn direction() -> impl TypedValueParser<Value = Direction> {
    let directions = [
        ("backward", Direction::Backward),
        ("forward", Direction::Forward),
        ("stepwise", Direction::Stepwise),
    ];
    PossibleValuesParser::new([
        PossibleValue::new("backward").help("From all terms, taking out"),
        PossibleValue::new("forward").help("From none, putting in"),
        PossibleValue::new("stepwise").help("From none, putting in and taking out"),
    ])
    .try_map(move |word| chosen("--select", &word, &directions))
}

/// Contrasts of categories.
pub(crate) fn contrast() -> impl TypedValueParser<Value = Contrast> {
    PossibleValuesParser::new([
        PossibleValue::new("treatment").help("Each level against the first"),
        PossibleValue::new("sum").help("Each level against the mean of all"),
        PossibleValue::new("helmert").help("Each level against the mean of those before it"),
        PossibleValue::new("poly").help("Polynomials over the order of the levels"),
    ])
    .try_map(|word| chosen("--contrasts", &word, &Contrast::NAMES))
}

/// The number of an analysis of variance.
pub(crate) fn anova_type() -> impl TypedValueParser<Value = AnovaType> {
    clap::value_parser!(u8)
        .range(1..=3)
        .map(|number| match number {
            1 => AnovaType::Sequential,
            2 => AnovaType::Hierarchical,
            _ => AnovaType::Partial,
        })
}

/// What is made good by an exchange of runs.
pub(crate) fn optimality() -> impl TypedValueParser<Value = Optimality> {
    PossibleValuesParser::new([
        PossibleValue::new("d").help("The volume of the confidence region of the coefficients"),
        PossibleValue::new("i").help("The mean variance of predictions"),
    ])
    .try_map(|word| {
        let kinds = [("d", Optimality::D), ("i", Optimality::I)];
        chosen("--criterion", &word, &kinds)
    })
}

/// How many settings as good as the best are listed.
pub(crate) fn members() -> impl TypedValueParser<Value = usize> {
    clap::value_parser!(u16).range(2..=1000).map(usize::from)
}

/// One of several names between commas.
pub(crate) fn trimmed(name: &str) -> Result<String, Infallible> {
    Ok(name.trim().to_owned())
}
