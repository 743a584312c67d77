//! Why a design cannot be made.

use thiserror::Error;

/// What is wrong with the request for a design.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum DesignError {
    /// No factor, or too few for this kind.
    #[error("a {kind} design needs {expected} factors, and {found} are given")]
    FactorCount {
        /// Kind of design.
        kind: &'static str,
        /// Numbers of factors that can be had.
        expected: String,
        /// Factors given.
        found: usize,
    },
    /// Two factors of one name.
    #[error("two factors are named {name:?}; names must differ")]
    FactorRepeated {
        /// The name.
        name: String,
    },
    /// A range that is none.
    #[error(
        "factor {name:?}: the low end {low} must be below the high end {high}; \
         write the smaller number first"
    )]
    RangeEmpty {
        /// The factor.
        name: String,
        /// Low end; unit of the factor.
        low: f64,
        /// High end; unit of the factor.
        high: f64,
    },
    /// A range with NaN or an infinity.
    #[error("factor {name:?}: a level is {value}, which is not a finite number")]
    LevelNotFinite {
        /// The factor.
        name: String,
        /// The level.
        value: f64,
    },
    /// Fewer than two different levels or categories.
    #[error("factor {name:?} has {found} different levels; a factor needs at least 2")]
    LevelsTooFew {
        /// The factor.
        name: String,
        /// Different levels.
        found: usize,
    },
    /// Categories where numbers are needed.
    #[error(
        "factor {name:?} has categories, and a {kind} design needs levels between them; \
         use a factorial or an optimal design, or one design per category"
    )]
    Categories {
        /// The factor.
        name: String,
        /// Kind of design.
        kind: &'static str,
    },
    /// More than two levels where two are needed.
    #[error(
        "factor {name:?} has {found} levels, and a {kind} design has two; \
         use a full factorial for more"
    )]
    LevelsTooMany {
        /// The factor.
        name: String,
        /// Levels given.
        found: usize,
        /// Kind of design.
        kind: &'static str,
    },
    /// More runs than can be meant.
    #[error(
        "the design would have {runs:.0} runs, more than {most}; take fewer factors or levels, \
         a fraction, or an optimal design"
    )]
    RunsTooMany {
        /// Runs it would have.
        runs: f64,
        /// The bound.
        most: usize,
    },
    /// Fewer runs than are needed.
    #[error("{runs} runs are too few: {what} needs at least {least}")]
    RunsTooFew {
        /// Runs asked for.
        runs: usize,
        /// Runs needed.
        least: usize,
        /// What needs them.
        what: String,
    },
    /// A number of runs that this kind does not have.
    #[error("there is no {kind} design of {runs} runs; nearest: {nearest}")]
    RunsUnknown {
        /// Kind of design.
        kind: &'static str,
        /// Runs asked for.
        runs: usize,
        /// Numbers that can be had.
        nearest: String,
    },
    /// A generator that cannot be read.
    #[error("generator {text:?}: expected a letter, '=' and a product of others, such as D=ABC")]
    GeneratorSyntax {
        /// What was given.
        text: String,
    },
    /// A generator that names a factor that is not there.
    #[error("generator {text:?}: there is no factor {letter}; the factors are {known}")]
    GeneratorLetter {
        /// What was given.
        text: String,
        /// The letter.
        letter: char,
        /// The letters there are, with their names.
        known: String,
    },
    /// A letter twice in a product.
    #[error("generator {text:?}: {letter} stands twice in the product and cancels; leave it out")]
    GeneratorRepeats {
        /// What was given.
        text: String,
        /// The letter.
        letter: char,
    },
    /// A factor generated from itself, twice, or from another generated one.
    #[error(
        "generator {text:?}: {letter} is itself generated; generate each factor once, \
         and from factors that are not generated"
    )]
    GeneratorChain {
        /// What was given.
        text: String,
        /// The letter.
        letter: char,
    },
    /// Generators that make two factors the same.
    #[error(
        "the generators make {word} constant (resolution {resolution}): its factors could not be \
         told apart; use products of two or more letters that differ by more than one letter"
    )]
    FactorsAliased {
        /// A word of the defining relation.
        word: String,
        /// Its length.
        resolution: usize,
    },
    /// Too many generators.
    #[error(
        "{generators} generators are more than {most}; \
         for so many factors use a Plackett-Burman design"
    )]
    GeneratorsTooMany {
        /// Generators given.
        generators: usize,
        /// The bound.
        most: usize,
    },
    /// No fraction of this size in the catalogue.
    #[error("there is no catalogued fraction of {factors} factors in {runs} runs; {advice}")]
    FractionUnknown {
        /// Factors.
        factors: usize,
        /// Runs.
        runs: usize,
        /// What there is.
        advice: String,
    },
    /// Blocks that cannot be had.
    #[error("{blocks} blocks cannot be had: {problem}")]
    BlocksImpossible {
        /// Blocks asked for.
        blocks: usize,
        /// Why, and what can be had.
        problem: String,
    },
    /// An axial distance that is none.
    #[error("alpha = {alpha}: the axial distance must be a finite number above zero")]
    AlphaInvalid {
        /// What was given, in half-ranges.
        alpha: f64,
    },
    /// An axial distance that does not exist for this size.
    #[error("no axial distance makes this design {property}: {problem}")]
    AlphaImpossible {
        /// What was asked.
        property: &'static str,
        /// Why.
        problem: String,
    },
    /// More factors than a sequence has dimensions.
    #[error("a {kind} design has at most {most} factors, and {found} are given")]
    FactorsTooMany {
        /// Kind of design.
        kind: &'static str,
        /// The bound.
        most: usize,
        /// Factors given.
        found: usize,
    },
    /// A model too large for the exchange.
    #[error(
        "the model has {terms} terms, more than {most}: an optimal design of it would take very long; \
         leave out terms, or take a composite design"
    )]
    TermsTooMany {
        /// Terms of the model.
        terms: usize,
        /// The bound.
        most: usize,
    },
    /// Candidates that cannot tell the terms of the model apart.
    #[error(
        "no {runs} runs of these candidates can estimate all {terms} terms of the model; \
         give more levels or candidates, or leave out terms"
    )]
    ModelSingular {
        /// Runs asked for.
        runs: usize,
        /// Terms of the model.
        terms: usize,
    },
    /// A point whose number of coordinates is not that of the factors.
    #[error("point {point} has {found} coordinates where there are {expected} factors")]
    PointLength {
        /// The point, from 1.
        point: usize,
        /// Its coordinates.
        found: usize,
        /// Factors.
        expected: usize,
    },
    /// No candidates, or too many.
    #[error("{found} candidates are given; expected 1 to {most}")]
    CandidateCount {
        /// Candidates given.
        found: usize,
        /// The bound.
        most: usize,
    },
    /// A model without a value at a point.
    #[error(
        "the model has no finite value at the coded point {point:?}; models of designs are in \
         coded units, −1 to 1: a logarithm or root of a factor is taken before its range is given"
    )]
    ModelUndefined {
        /// The point.
        point: Vec<f64>,
    },
}
