//! What can be wrong with a law of the user, in the terms of who wrote it.

use std::fmt;
use windfall_numerics::unit::quantity::UnitError;

/// A place in a formula.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FormulaPlace {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// The line's text.
    pub text: String,
}

impl FormulaPlace {
    /// Place of a byte offset.
    pub fn new(formula: &str, offset: usize) -> Self {
        let offset = offset.min(formula.len());
        let start = formula[..offset].rfind('\n').map_or(0, |at| at + 1);
        Self {
            line: formula[..offset].matches('\n').count() + 1,
            column: formula[start..offset].chars().count() + 1,
            text: formula[start..].lines().next().unwrap_or_default().into(),
        }
    }
}

impl fmt::Display for FormulaPlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { line, column, text } = self;
        write!(
            f,
            " (line {line}, column {column} of `{}`)",
            text.trim_end()
        )
    }
}

/// Why a law of the user cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FormulaError {
    /// The formula does not follow the syntax.
    #[error("expected {expected}, found {found}{place}")]
    Syntax {
        /// What should stand there.
        expected: &'static str,
        /// What does.
        found: String,
        /// Where.
        place: FormulaPlace,
    },
    /// A name that is neither x, v, a parameter nor a function.
    #[error("unknown name \"{name}\"{place}: {}", known_names(.nearest, .known))]
    UnknownName {
        /// The name.
        name: String,
        /// Known names that are similar, best first.
        nearest: Vec<String>,
        /// All known names.
        known: Vec<String>,
        /// Where.
        place: FormulaPlace,
    },
    /// A function with the wrong number of arguments.
    #[error("{function} takes {expected} argument(s) but has {found}{place}")]
    ArgumentCount {
        /// The function.
        function: &'static str,
        /// How many it takes.
        expected: usize,
        /// How many were given.
        found: usize,
        /// Where.
        place: FormulaPlace,
    },
    /// A parameter that the formula does not use.
    #[error(
        "parameter \"{parameter}\" is declared but not used in the formula: use it, or leave out parameters.{parameter}"
    )]
    UnusedParameter {
        /// The parameter.
        parameter: String,
    },
    /// A name that cannot be used for a parameter or a law.
    #[error("\"{name}\" cannot be a name here: {reason}")]
    BadName {
        /// The name.
        name: String,
        /// Why.
        reason: &'static str,
    },
    /// Two parameters whose names differ in case only.
    #[error(
        "two parameters are called \"{parameter}\" (capital and small letters are one in law expressions): rename one"
    )]
    RepeatedParameter {
        /// The name.
        parameter: String,
    },
    /// More parameters than a law can have.
    #[error(
        "the law has {found} parameters; at most {largest} can be used: write known ones as numbers"
    )]
    TooManyParameters {
        /// How many were declared.
        found: usize,
        /// How many can be used.
        largest: usize,
    },
    /// No parameter at all.
    #[error(
        "the law has no parameter, so there is nothing that a fit could find: declare at least one, such as parameters.k = {{ unit = \"N/m^1.5\", start = 4e5 }}"
    )]
    NoParameters,
    /// A formula too long to be compiled.
    #[error("the formula is too long: it needs more than {limit} intermediate values")]
    TooLong {
        /// Largest number of intermediate values.
        limit: usize,
    },
    /// A unit that cannot be read.
    #[error("the unit of parameter \"{parameter}\": {problem}")]
    BadUnit {
        /// The parameter.
        parameter: String,
        /// What is wrong.
        problem: Box<UnitError>,
    },
    /// A unit that is no SI unit without a factor.
    #[error(
        "the unit of parameter \"{parameter}\" is \"{unit}\": write the SI unit without a prefix, as in N/m^1.5; values in other units are given with their unit where the law is used"
    )]
    NotSi {
        /// The parameter.
        parameter: String,
        /// Its unit.
        unit: String,
    },
    /// A term whose unit does not fit.
    #[error("the term `{term}` is in {found}, where {expected} is expected{place}{hint}")]
    WrongUnit {
        /// The term.
        term: String,
        /// Its unit.
        found: String,
        /// The unit that is expected.
        expected: String,
        /// What to do, from ": " on; may be empty.
        hint: String,
        /// Where.
        place: Box<FormulaPlace>,
    },
    /// A start or default outside the bounds.
    #[error(
        "parameter \"{parameter}\": its {what} {value} is outside its bounds, {lower} to {upper}: move the {what} or the bound"
    )]
    StartOutOfBounds {
        /// The parameter.
        parameter: String,
        /// "start" or "default".
        what: &'static str,
        /// The value; SI.
        value: f64,
        /// Lower bound; SI.
        lower: f64,
        /// Upper bound; SI.
        upper: f64,
    },
    /// Bounds that leave no value.
    #[error(
        "parameter \"{parameter}\": its lower bound {lower} is not below its upper bound {upper}"
    )]
    EmptyBounds {
        /// The parameter.
        parameter: String,
        /// Lower bound; SI.
        lower: f64,
        /// Upper bound; SI.
        upper: f64,
    },
    /// The force has no value at first touch.
    #[error(
        "the force has no finite value at first touch (x = 0): `{term}` {reason}{place}. Write the law so that it has one, such as log(1 + x/d) for log(x)"
    )]
    UndefinedAtTouch {
        /// The term.
        term: String,
        /// Why.
        reason: &'static str,
        /// Where.
        place: Box<FormulaPlace>,
    },
    /// The force, or a derivative, has no value within the working range.
    #[error("`{term}` {reason} at x = {displacement} m, v = {rate} m/s{place}, with {values}")]
    Undefined {
        /// The term.
        term: String,
        /// Why.
        reason: &'static str,
        /// Displacement; m.
        displacement: f64,
        /// Rate; m/s.
        rate: f64,
        /// Values of the parameters, as text.
        values: String,
        /// Where.
        place: Box<FormulaPlace>,
    },
    /// The force pulls while loading.
    #[error(
        "the force pulls the bodies together while loading (F = {force:.4e} N at x = {displacement} m, v = {rate} m/s, with {values}): x counts into the fruit and F must be positive when it pushes"
    )]
    PullsWhileLoading {
        /// Force; N.
        force: f64,
        /// Displacement; m.
        displacement: f64,
        /// Rate; m/s.
        rate: f64,
        /// Values of the parameters, as text.
        values: String,
    },
    /// The force jumps where the formula changes its piece.
    #[error(
        "the force jumps from {below:.6e} N to {above:.6e} N at x = {displacement:.6e} m, v = {rate} m/s, where the formula changes its piece ({values}): make the pieces meet"
    )]
    Jump {
        /// Force on one side; N.
        below: f64,
        /// Force on the other; N.
        above: f64,
        /// Displacement; m.
        displacement: f64,
        /// Rate; m/s.
        rate: f64,
        /// Values of the parameters, as text.
        values: String,
    },
    /// The force jumps after a change of what the contact remembers.
    #[error(
        "the force jumps from {below:.6e} N to {above:.6e} N at x = {displacement:.6e} m, v = {rate} m/s after a largest displacement x_max = {peak:.6e} m, {change} ({values})"
    )]
    StateJumps {
        /// Force on one side; N.
        below: f64,
        /// Force on the other; N.
        above: f64,
        /// Displacement; m.
        displacement: f64,
        /// Rate; m/s.
        rate: f64,
        /// Largest displacement; m.
        peak: f64,
        /// What changes there, and what to do.
        change: &'static str,
        /// Values of the parameters, as text.
        values: String,
    },
    /// Unloading, or a derivative of it, has no value.
    #[error(
        "the force or one of its derivatives is not finite at x = {displacement:.6e} m, v = {rate} m/s after a largest displacement x_max = {peak:.6e} m ({values}): every displacement from 0 to x_max needs a value, also beyond the end of the contact; write (x - d)*sqrt(abs(x - d)) for (x - d)^1.5"
    )]
    UndefinedUnloading {
        /// Displacement; m.
        displacement: f64,
        /// Rate; m/s.
        rate: f64,
        /// Largest displacement; m.
        peak: f64,
        /// Values of the parameters, as text.
        values: String,
    },
    /// What is wrong with the formula of unloading.
    #[error("unloading: {0}")]
    Unloading(Box<FormulaError>),
    /// A table that cannot be used.
    #[error("{}the table: {reason}", of_row(*row))]
    Table {
        /// Row, from 1; 0 for the table as a whole.
        row: usize,
        /// What is wrong in it: [`COLUMNS`](crate::laws::force_table::COLUMNS).
        column: &'static str,
        /// What is wrong and what to do.
        reason: &'static str,
    },
}

impl FormulaError {
    /// The parameter that is to blame, where it is one of the parameters, and what of it:
    /// "unit", "start", "default", "upper", or nothing.
    pub fn parameter(&self) -> Option<(&str, &'static str)> {
        match self {
            Self::UnusedParameter { parameter } | Self::RepeatedParameter { parameter } => {
                Some((parameter, ""))
            }
            Self::BadUnit { parameter, .. } | Self::NotSi { parameter, .. } => {
                Some((parameter, "unit"))
            }
            Self::StartOutOfBounds {
                parameter, what, ..
            } => Some((parameter, what)),
            Self::Unloading(inner) => inner.parameter(),
            // An upper bound that is left out is above all others.
            Self::EmptyBounds { parameter, .. } => Some((parameter, "upper")),
            _ => None,
        }
    }

    /// The column of the table that is to blame, and its row, from 0, where one row is.
    pub fn cell(&self) -> Option<(Option<usize>, &'static str)> {
        match self {
            Self::Table { row, column, .. } => Some((row.checked_sub(1), column)),
            _ => None,
        }
    }
}

fn of_row(row: usize) -> String {
    match row {
        0 => String::new(),
        row => format!("row {row} of "),
    }
}

fn known_names(nearest: &[String], known: &[String]) -> String {
    match nearest.is_empty() {
        true => format!("known here are {}", known.join(", ")),
        false => format!("did you mean {}?", nearest.join(" or ")),
    }
}
