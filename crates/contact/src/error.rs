//! What can be wrong with a law or its expression.

use crate::formula::error::FormulaError;
use crate::parameter::number_text;
use std::fmt;
use windfall_numerics::unit::quantity::UnitError;

/// A place in a law expression.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// The whole expression.
    pub text: String,
    /// Byte offset of the error in `text`.
    pub offset: usize,
}

impl Place {
    /// Column for people: characters from 1.
    pub fn column(&self) -> usize {
        self.text
            .char_indices()
            .filter(|&(at, _)| at < self.offset)
            .count()
            + 1
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, " (column {} of `{}`)", self.column(), self.text)
    }
}

/// Errors of laws and law expressions. Offsets are in bytes of the expression.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// No law has this name.
    #[error("unknown law \"{name}\"{}: {}", at(.place), suggestion(.nearest, "the laws are", .known))]
    UnknownLaw {
        /// The name given.
        name: String,
        /// Laws of similar name, best first.
        nearest: Vec<&'static str>,
        /// All laws.
        known: Vec<&'static str>,
        /// Where in the expression.
        place: Option<Place>,
    },
    /// The law has no such parameter.
    #[error("{law} has no parameter \"{name}\"{place}: {}", suggestion(.nearest, "its parameters are", .known))]
    UnknownParameter {
        /// The law.
        law: &'static str,
        /// The name given.
        name: String,
        /// Parameters of similar name, best first.
        nearest: Vec<&'static str>,
        /// All parameters of the law.
        known: Vec<&'static str>,
        /// Where in the expression.
        place: Place,
    },
    /// A parameter is given more than once.
    #[error("parameter \"{parameter}\" of {law} is given twice{place}: give it once")]
    RepeatedParameter {
        /// The law.
        law: &'static str,
        /// The parameter.
        parameter: &'static str,
        /// Where in the expression it is given again.
        place: Place,
    },
    /// The value or unit of a parameter cannot be read.
    #[error("parameter \"{parameter}\" of {law}{place}: {problem}")]
    BadValue {
        /// The law.
        law: &'static str,
        /// The parameter.
        parameter: &'static str,
        /// What is wrong.
        problem: Box<UnitError>,
        /// Where in the expression.
        place: Place,
    },
    /// The unit of a parameter depends on an exponent that is not given.
    #[error("parameter \"{parameter}\" of {law} is in {unit}{place}: give {exponent} as well")]
    UnknownExponent {
        /// The law.
        law: &'static str,
        /// The parameter.
        parameter: &'static str,
        /// Its unit.
        unit: &'static str,
        /// The exponent.
        exponent: &'static str,
        /// Where in the expression.
        place: Place,
    },
    /// A value outside its bounds, or not finite.
    #[error("{parameter} = {} of {law} is out of bounds{}: it must be from {} to {}", with_unit(.value, .unit), at(.place), number_text(*.lower), with_unit(.upper, .unit))]
    OutOfBounds {
        /// The law.
        law: &'static str,
        /// The parameter.
        parameter: &'static str,
        /// Value given; SI.
        value: f64,
        /// Unit of value and bounds; empty for a plain number.
        unit: String,
        /// Smallest legal value; SI.
        lower: f64,
        /// Largest legal value; SI.
        upper: f64,
        /// Where in the expression.
        place: Option<Place>,
    },
    /// A law was given another number of parameters than it has.
    #[error("{law} takes {expected} parameters ({}) but was given {found}", .names.join(", "))]
    ParameterCount {
        /// The law.
        law: &'static str,
        /// How many it takes.
        expected: usize,
        /// Their names.
        names: Vec<&'static str>,
        /// How many were given.
        found: usize,
    },
    /// Parameters without a value.
    #[error("{law} needs {}: write it like {example}", .missing.join(" and "))]
    MissingParameters {
        /// The law.
        law: &'static str,
        /// Names of the parameters that have neither value nor default.
        missing: Vec<&'static str>,
        /// The law with typical values.
        example: String,
    },
    /// Walton-Braun with an unloading that returns more energy than it got.
    #[error(
        "walton-braun with k1 = {loading} N/m and k2 = {unloading} N/m would return more energy than it got: k2 must be at least k1"
    )]
    SofterUnloading {
        /// k1; N/m.
        loading: f64,
        /// k2; N/m.
        unloading: f64,
    },
    /// The expression does not follow the syntax.
    #[error(
        "expected {expected}{place}: a law is written like kuwabara-kono(k=753599, c=\"1524 N s/m^1.5\")"
    )]
    Syntax {
        /// What should stand there.
        expected: &'static str,
        /// Where in the expression.
        place: Place,
    },
    /// A law of the user that cannot be used.
    #[error("law \"{law}\": {problem}")]
    UserLaw {
        /// Its name.
        law: String,
        /// What is wrong.
        problem: Box<FormulaError>,
    },
    /// A coefficient of restitution that no impact can have.
    #[error("a coefficient of restitution is above 0 and at most 1, not {value}")]
    ImpossibleRestitution {
        /// Value given; 1.
        value: f64,
    },
}

fn with_unit(value: &f64, unit: &str) -> String {
    match unit.is_empty() {
        true => number_text(*value),
        false => format!("{} {unit}", number_text(*value)),
    }
}

fn at(place: &Option<Place>) -> String {
    place.as_ref().map_or_else(String::new, Place::to_string)
}

fn suggestion(nearest: &[&str], introduction: &str, known: &[&str]) -> String {
    match nearest.is_empty() {
        true => format!("{introduction} {}", known.join(", ")),
        false => format!("did you mean {}?", nearest.join(" or ")),
    }
}
