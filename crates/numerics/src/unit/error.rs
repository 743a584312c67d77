//! What is said about a quantity that cannot be read.

/// Why a quantity could not be read.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum UnitError {
    /// The text does not begin with a number.
    #[error(
        "\"{text}\" does not begin with a number: write a value and its unit, such as \"0.505 m\""
    )]
    MissingNumber {
        /// What was to be read.
        text: String,
    },
    /// The number is written with a decimal comma.
    #[error("\"{text}\" has a decimal comma: write \"{suggestion}\"")]
    DecimalComma {
        /// What was to be read.
        text: String,
        /// The same with a decimal point.
        suggestion: String,
    },
    /// The number is too large, or not finite in SI units.
    #[error("\"{text}\" is no number below 1e100 in SI units")]
    NotFinite {
        /// What was to be read.
        text: String,
    },
    /// A symbol that is no unit.
    #[error("unknown unit \"{symbol}\" in \"{text}\": {}", nearest_text(.nearest))]
    UnknownUnit {
        /// What was to be read.
        text: String,
        /// Byte offset of the symbol in `text`.
        offset: usize,
        /// The unknown symbol.
        symbol: String,
        /// What may have been meant, best first.
        nearest: Vec<String>,
    },
    /// A character that does not belong there.
    #[error(
        "unexpected \"{found}\" in the unit of \"{text}\": a unit is written like \"N s/m^1.5\""
    )]
    UnexpectedCharacter {
        /// What was to be read.
        text: String,
        /// Byte offset of the character in `text`.
        offset: usize,
        /// The character.
        found: char,
    },
    /// The unit stops where more was expected.
    #[error(
        "the unit of \"{text}\" is not complete: a unit is written like \"N s/m^1.5\" or \"N/(m s)\""
    )]
    Incomplete {
        /// What was to be read.
        text: String,
    },
    /// A product after a quotient, which people read in two ways.
    #[error(
        "the unit of \"{text}\" multiplies after a \"/\": put what is below the line in parentheses, such as \"N/(m s)\", or the product first, such as \"N s/m\""
    )]
    AmbiguousQuotient {
        /// What was to be read.
        text: String,
        /// Byte offset of the factor in `text`.
        offset: usize,
    },
    /// Degrees Celsius as a part of a unit.
    #[error(
        "\"{text}\" uses degC inside a unit, where its zero has no meaning: write K for differences of temperature"
    )]
    MisplacedCelsius {
        /// What was to be read.
        text: String,
    },
    /// A value with an uncertainty that cannot be read.
    #[error(
        "\"{text}\": the uncertainty behind ± cannot be used, since {problem}; write it like \"0.505 ± 0.001 m\""
    )]
    BadUncertainty {
        /// What was to be read.
        text: String,
        /// What is wrong.
        problem: &'static str,
    },
    /// A range that cannot be read.
    #[error("\"{text}\" is no range, since {problem}; write it like \"0 … 50 N s/m\" or \"> 0 N\"")]
    BadRange {
        /// What was to be read.
        text: String,
        /// What is wrong.
        problem: &'static str,
    },
    /// An uncertainty where only a value is asked for.
    #[error("\"{text}\": this takes no ±: write the value alone")]
    NoUncertainty {
        /// What was to be read.
        text: String,
    },
    /// A number alone, where its unit cannot be guessed.
    #[error("\"{text}\" has no unit: write it, such as \"{text} {expected}\"")]
    MissingUnit {
        /// What was to be read.
        text: String,
        /// Unit that was expected.
        expected: String,
    },
    /// Another physical quantity than the one expected.
    #[error("\"{text}\" is {found}, but {expected} was expected: write it like \"{example}\"{}", gravity_text(.gravity))]
    WrongDimension {
        /// What was to be read.
        text: String,
        /// What it is: quantity and SI unit.
        found: String,
        /// What was expected: quantity and unit.
        expected: String,
        /// How it may be written.
        example: String,
        /// The same text with `g0` for `g`, where that would have been right.
        gravity: Option<String>,
    },
}

fn nearest_text(nearest: &[String]) -> String {
    match nearest.is_empty() {
        true => {
            "known are m, g, s, min, h, N, J, W, Pa, V, A, C, Hz, K, degC, rad, deg, rev, rpm, \
                 count, line, g0, %, with SI prefixes p n u m c d h k M G; gf, kgf, lbf, ozf, in, mil, ft"
                .into()
        }
        false => format!("did you mean {}?", nearest.join(" or ")),
    }
}

fn gravity_text(gravity: &Option<String>) -> String {
    gravity.as_ref().map_or_else(String::new, |text| {
        format!(" (\"g\" is the gram; for standard gravity write \"{text}\")")
    })
}
