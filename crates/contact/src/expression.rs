//! Law expressions: `adams-impact(k="0.868 N/mm^1.91", e=1.91, c=0.556, d="0.001 mm")`.

use crate::error::{Error, Place};
use crate::laws::kind::{Law, LawKind};
use crate::parameter::number_text;
use std::fmt;
use windfall_numerics::unit::nearest_name::nearest_names;
use windfall_numerics::unit::quantity::parse_as;

/// A law with the parameters that were given.
#[derive(Clone, Debug, PartialEq)]
pub struct LawExpression {
    /// Which law.
    pub kind: LawKind,
    /// One per parameter of the law, in the order of its description; SI. `None`
    /// where the expression gave none.
    pub values: Vec<Option<f64>>,
}

impl LawExpression {
    /// The law, with defaults for exponents that were left out.
    ///
    /// # Errors
    /// [`Error::MissingParameters`] naming every parameter without a value;
    /// [`Error::OutOfBounds`]; [`Error::SofterUnloading`].
    pub fn complete(&self) -> Result<Law, Error> {
        let description = self.kind.describe();
        let filled = self.values_or_defaults();
        let named = description.parameters.iter().zip(&filled);
        let missing: Vec<_> = named
            .filter(|(_, value)| value.is_none())
            .map(|(parameter, _)| parameter.name)
            .collect();
        if !missing.is_empty() {
            return Err(Error::MissingParameters {
                law: description.name,
                missing,
                example: typical(self.kind).to_string(),
            });
        }
        let values: Vec<f64> = filled.into_iter().flatten().collect();
        let law = self.kind.with_parameters(&values)?;
        match law {
            Law::WaltonBraun(law) if law.k2 < law.k1 => Err(Error::SofterUnloading {
                loading: law.k1,
                unloading: law.k2,
            }),
            _ => Ok(law),
        }
    }

    /// The values given, and the defaults of those that were not.
    pub fn values_or_defaults(&self) -> Vec<Option<f64>> {
        let parameters = self.kind.describe().parameters.iter();
        parameters
            .enumerate()
            .map(|(index, parameter)| {
                let given = self.values.get(index).copied().flatten();
                given.or(parameter.default)
            })
            .collect()
    }
}

/// The law with a typical value for every parameter.
pub fn typical(kind: LawKind) -> LawExpression {
    let parameters = kind.describe().parameters.iter();
    LawExpression {
        kind,
        values: parameters
            .map(|parameter| Some(parameter.typical))
            .collect(),
    }
}

impl From<Law> for LawExpression {
    fn from(law: Law) -> Self {
        Self {
            kind: law.kind(),
            values: law.parameters().into_iter().map(Some).collect(),
        }
    }
}

/// Canonical form, SI without units; it reads back to the same expression.
impl fmt::Display for LawExpression {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let named = self.kind.describe().parameters.iter().zip(&self.values);
        let given: Vec<String> = named
            .filter_map(|(parameter, value)| {
                value.map(|value| format!("{}={}", parameter.name, number_text(value)))
            })
            .collect();
        f.write_str(self.kind.name())?;
        match given.is_empty() {
            true => Ok(()),
            false => write!(f, "({})", given.join(", ")),
        }
    }
}

/// Reads a law expression.
///
/// The law's name may stand alone. Values are SI numbers or quantities with a
/// unit, quoted (`"…"` or `'…'`) or plain. Case and `_` or `-` in names do not
/// count.
///
/// # Errors
/// [`Error`] with the place: unknown law or parameter (with the nearest names),
/// repeated parameter, value or unit that cannot be read, value out of bounds,
/// broken syntax.
///
/// # Example
/// ```
/// use windfall_contact::expression::parse_law;
/// let law = parse_law("Kelvin_Voigt(k='30 N/mm', c=40)")?;
/// assert_eq!(law.to_string(), "kelvin-voigt(k=30000, c=40)");
/// # Ok::<(), windfall_contact::error::Error>(())
/// ```
pub fn parse_law(text: &str) -> Result<LawExpression, Error> {
    parse_law_among(text, &[])
}

/// Reads a law expression of a built-in law or one of `user`.
///
/// # Errors
/// As [`parse_law`].
pub fn parse_law_among(text: &str, user: &[LawKind]) -> Result<LawExpression, Error> {
    let mut cursor = Cursor { text, at: 0 };
    let (name, offset) = cursor.name("the name of a law")?;
    let kind = LawKind::from_name_among(name, user)
        .map_err(|error| placed(error, cursor.place(offset)))?;
    let arguments = cursor.arguments()?;
    let texts = assigned(kind, &arguments, &cursor)?;
    let values = read_values(kind, &texts, &cursor)?;
    Ok(LawExpression { kind, values })
}

/// `name = value` as it was written.
struct Argument<'a> {
    name: &'a str,
    name_offset: usize,
    value: &'a str,
    value_offset: usize,
}

/// The argument of each parameter of the law.
fn assigned<'a>(
    kind: LawKind,
    arguments: &'a [Argument<'a>],
    cursor: &Cursor,
) -> Result<Vec<Option<&'a Argument<'a>>>, Error> {
    let description = kind.describe();
    let mut texts = vec![None; description.parameters.len()];
    for argument in arguments {
        let place = cursor.place(argument.name_offset);
        let Some(index) = description.index_of(argument.name) else {
            let known: Vec<_> = description.parameters.iter().map(|p| p.name).collect();
            return Err(Error::UnknownParameter {
                law: description.name,
                name: argument.name.into(),
                nearest: nearest_names(argument.name, known.iter().copied()),
                known,
                place,
            });
        };
        if texts[index].replace(argument).is_some() {
            return Err(Error::RepeatedParameter {
                law: description.name,
                parameter: description.parameters[index].name,
                place,
            });
        }
    }
    Ok(texts)
}

/// SI values; those whose unit contains an exponent come after the exponents.
fn read_values(
    kind: LawKind,
    texts: &[Option<&Argument>],
    cursor: &Cursor,
) -> Result<Vec<Option<f64>>, Error> {
    let description = kind.describe();
    let mut values = vec![None; texts.len()];
    let (dependent, plain): (Vec<usize>, Vec<usize>) =
        (0..texts.len()).partition(|&index| description.parameters[index].unit_names_exponents());
    for index in plain.into_iter().chain(dependent) {
        let Some(argument) = texts[index] else {
            continue;
        };
        let place = cursor.place(argument.value_offset);
        values[index] = Some(read_value(
            kind,
            index,
            argument.value,
            &values,
            place.clone(),
        )?);
        kind.check_bounds(index, &values)
            .map_err(|error| placed(error, place))?;
    }
    Ok(values)
}

fn read_value(
    kind: LawKind,
    index: usize,
    text: &str,
    values: &[Option<f64>],
    place: Place,
) -> Result<f64, Error> {
    let description = kind.describe();
    let parameter = &description.parameters[index];
    let number: Result<f64, _> = text.trim().parse();
    let unit = match (description.missing_exponent(index, values), number) {
        (None, _) => description.unit_of(index, values).unwrap_or_default(),
        // A number alone is SI whatever the exponent.
        (Some(_), Ok(_)) => "1".into(),
        (Some(exponent), Err(_)) => {
            return Err(Error::UnknownExponent {
                law: description.name,
                parameter: parameter.name,
                unit: parameter.unit,
                exponent,
                place,
            });
        }
    };
    parse_as(text, &unit).map_err(|problem| Error::BadValue {
        law: description.name,
        parameter: parameter.name,
        problem: Box::new(problem),
        place,
    })
}

/// The same error with its place in the expression.
fn placed(mut error: Error, at: Place) -> Error {
    if let Error::UnknownLaw { place, .. } | Error::OutOfBounds { place, .. } = &mut error {
        *place = Some(at);
    }
    error
}

/// Position in an expression that is being read.
struct Cursor<'a> {
    text: &'a str,
    at: usize,
}

impl<'a> Cursor<'a> {
    fn place(&self, offset: usize) -> Place {
        Place {
            text: self.text.into(),
            offset,
        }
    }

    fn syntax(&self, expected: &'static str) -> Error {
        Error::Syntax {
            expected,
            place: self.place(self.at),
        }
    }

    fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    fn skip_spaces(&mut self) {
        self.at = self.text.len() - self.rest().trim_start().len();
    }

    /// Whether `wanted` comes next; it is then behind the cursor.
    fn take(&mut self, wanted: char) -> bool {
        self.skip_spaces();
        let found = self.rest().starts_with(wanted);
        if found {
            self.at += wanted.len_utf8();
        }
        found
    }

    /// Text up to the first character that `stop` accepts.
    fn until(&mut self, stop: impl FnMut(char) -> bool) -> &'a str {
        let rest = self.rest();
        let end = rest.find(stop).unwrap_or(rest.len());
        self.at += end;
        &rest[..end]
    }

    /// A name and where it begins.
    fn name(&mut self, expected: &'static str) -> Result<(&'a str, usize), Error> {
        self.skip_spaces();
        let offset = self.at;
        let name = self.until(|c| !(c.is_alphanumeric() || matches!(c, '-' | '_')));
        match name.starts_with(char::is_alphabetic) {
            true => Ok((name, offset)),
            false => {
                self.at = offset;
                Err(self.syntax(expected))
            }
        }
    }

    /// `(name=value, …)` up to the end of the text; nothing is also accepted.
    fn arguments(&mut self) -> Result<Vec<Argument<'a>>, Error> {
        let mut arguments = Vec::new();
        if self.take('(') {
            while !self.take(')') {
                arguments.push(self.argument()?);
                if self.take(',') {
                    continue;
                }
                if !self.rest().starts_with(')') {
                    return Err(self.syntax("\",\" or \")\""));
                }
            }
        }
        self.skip_spaces();
        match self.rest().is_empty() {
            true => Ok(arguments),
            false if arguments.is_empty() => Err(self.syntax("\"(\" or the end of the expression")),
            false => Err(self.syntax("the end of the expression")),
        }
    }

    fn argument(&mut self) -> Result<Argument<'a>, Error> {
        let (name, name_offset) = self.name("a parameter, such as k=753599, or \")\"")?;
        if !self.take('=') {
            return Err(self.syntax("\"=\" and a value"));
        }
        self.skip_spaces();
        let quote = self
            .rest()
            .chars()
            .next()
            .filter(|c| matches!(c, '"' | '\''));
        let (value, value_offset) = match quote {
            Some(quote) => {
                self.at += 1;
                let start = self.at;
                let value = self.until(|c| c == quote);
                if !self.take(quote) {
                    return Err(self.syntax("a closing quotation mark"));
                }
                (value, start)
            }
            None => {
                let start = self.at;
                (self.plain_value(), start)
            }
        };
        if value.trim().is_empty() {
            self.at = value_offset;
            return Err(self.syntax("a value"));
        }
        Ok(Argument {
            name,
            name_offset,
            value,
            value_offset,
        })
    }

    /// Up to the next comma or closing parenthesis; units may hold parentheses.
    fn plain_value(&mut self) -> &'a str {
        let mut depth = 0_usize;
        let value = self.until(|c| {
            match c {
                '(' => depth += 1,
                ')' if depth == 0 => return true,
                ')' => depth -= 1,
                _ => {}
            }
            c == ','
        });
        value.trim_end()
    }
}
