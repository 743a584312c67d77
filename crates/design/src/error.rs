//! Why a design cannot be made.

use thiserror::Error;

/// What is wrong with the request for a design.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
#[allow(missing_docs, reason = "each message names its fields")]
pub enum DesignError {
    #[error("a {kind} design needs {expected} factors, and {found} are given")]
    FactorCount {
        kind: &'static str,
        expected: String,
        found: usize,
    },
    #[error("two factors are named {name:?}; names must differ")]
    FactorRepeated { name: String },
    #[error(
        "factor {name:?}: the low end {low} must be below the high end {high}; \
         write the smaller number first"
    )]
    RangeEmpty { name: String, low: f64, high: f64 },
    #[error("factor {name:?}: a level is {value}, which is not a finite number")]
    LevelNotFinite { name: String, value: f64 },
    #[error("factor {name:?} has {found} different levels; a factor needs at least 2")]
    LevelsTooFew { name: String, found: usize },
    #[error(
        "factor {name:?} has categories, and a {kind} design needs levels between them; \
         use a factorial or an optimal design, or one design per category"
    )]
    Categories { name: String, kind: &'static str },
    #[error(
        "factor {name:?} has {found} levels, and a {kind} design has two; \
         use a full factorial for more"
    )]
    LevelsTooMany {
        name: String,
        found: usize,
        kind: &'static str,
    },
    #[error(
        "the design would have {runs:.0} runs, more than {most}; take fewer factors or levels, \
         a fraction, or an optimal design"
    )]
    RunsTooMany { runs: f64, most: usize },
    #[error("{runs} runs are too few: {what} needs at least {least}")]
    RunsTooFew {
        runs: usize,
        least: usize,
        what: String,
    },
    #[error("there is no {kind} design of {runs} runs; nearest: {nearest}")]
    RunsUnknown {
        kind: &'static str,
        runs: usize,
        nearest: String,
    },
    #[error("generator {text:?}: expected a letter, '=' and a product of others, such as D=ABC")]
    GeneratorSyntax { text: String },
    #[error("generator {text:?}: there is no factor {letter}; the factors are {known}")]
    GeneratorLetter {
        text: String,
        letter: char,
        known: String,
    },
    #[error("generator {text:?}: {letter} stands twice in the product and cancels; leave it out")]
    GeneratorRepeats { text: String, letter: char },
    #[error(
        "generator {text:?}: {letter} is itself generated; generate each factor once, \
         and from factors that are not generated"
    )]
    GeneratorChain { text: String, letter: char },
    #[error(
        "the generators make {word} constant (resolution {resolution}): its factors could not be \
         told apart; use products of two or more letters that differ by more than one letter"
    )]
    FactorsAliased { word: String, resolution: usize },
    #[error(
        "{generators} generators are more than {most}; \
         for so many factors use a Plackett-Burman design"
    )]
    GeneratorsTooMany { generators: usize, most: usize },
    #[error("there is no catalogued fraction of {factors} factors in {runs} runs; {advice}")]
    FractionUnknown {
        factors: usize,
        runs: usize,
        advice: String,
    },
    #[error("{blocks} blocks cannot be had: {problem}")]
    BlocksImpossible { blocks: usize, problem: String },
    #[error("this split-plot design cannot be made: {problem}")]
    WholePlotsImpossible { problem: String },
    #[error(
        "{found} whole plots are too few: {terms} terms of the model, the mean included, change \
         only between whole plots; give at least {terms}, and one or more beyond that to estimate \
         the scatter between whole plots"
    )]
    WholePlotsTooFew { found: usize, terms: usize },
    #[error("alpha = {alpha}: the axial distance must be a finite number above zero")]
    AlphaInvalid { alpha: f64 },
    #[error("no axial distance makes this design {property}: {problem}")]
    AlphaImpossible {
        property: &'static str,
        problem: String,
    },
    #[error("a {kind} design has at most {most} factors, and {found} are given")]
    FactorsTooMany {
        kind: &'static str,
        most: usize,
        found: usize,
    },
    #[error(
        "the model has {terms} terms, more than {most}: an optimal design of it would take very long; \
         leave out terms, or take a composite design"
    )]
    TermsTooMany { terms: usize, most: usize },
    #[error(
        "no {runs} runs of these candidates can estimate all {terms} terms of the model; \
         give more levels or candidates, or leave out terms"
    )]
    ModelSingular { runs: usize, terms: usize },
    #[error("point {point} has {found} coordinates where there are {expected} factors")]
    PointLength {
        point: usize,
        found: usize,
        expected: usize,
    },
    #[error("{found} candidates are given; expected 1 to {most}")]
    CandidateCount { found: usize, most: usize },
    #[error(
        "the model has no finite value at the coded point {point:?}; models of designs are in \
         coded units, −1 to 1: a logarithm or root of a factor is taken before its range is given"
    )]
    ModelUndefined { point: Vec<f64> },
}
