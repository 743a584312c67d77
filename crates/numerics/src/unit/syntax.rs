//! Reading a unit: symbols with prefix and power, products and quotients.

use crate::unit::dimension::{Dimension, Unit, reduced};
use crate::unit::error::UnitError;
use crate::unit::nearest_name::nearest_names;
use crate::unit::symbol::{CELSIUS, PREFIXES, UNIT_SYMBOLS, UnitSymbol};

/// Reads a unit without a number, such as `"N s/m^1.5"`.
///
/// # Errors
/// [`UnitError`] when it cannot be read; also for `degC`, which is no factor.
pub fn parse_unit(text: &str) -> Result<Unit, UnitError> {
    parse_unit_at(text, 0)
}

/// A unit that begins at byte `start` of the text and fills the rest of it.
pub(crate) fn parse_unit_at(text: &str, start: usize) -> Result<Unit, UnitError> {
    let mut cursor = Cursor { text, at: start };
    cursor.skip_spaces();
    // "3 /s" is 3 1/s.
    let unit = match cursor.peek() {
        Some('/') => cursor.product_after(Unit::ONE)?,
        _ => cursor.product()?,
    };
    match cursor.peek() {
        None => Ok(unit),
        Some(found) => Err(cursor.unexpected(found)),
    }
}

/// Position in a text that is being read.
struct Cursor<'a> {
    text: &'a str,
    at: usize,
}

impl Cursor<'_> {
    fn peek(&self) -> Option<char> {
        self.text[self.at..].chars().next()
    }

    fn take_if(&mut self, accept: impl Fn(char) -> bool) -> Option<char> {
        let next = self.peek().filter(|&c| accept(c))?;
        self.at += next.len_utf8();
        Some(next)
    }

    fn take_while(&mut self, accept: impl Fn(char) -> bool) -> &str {
        let start = self.at;
        while self.take_if(&accept).is_some() {}
        &self.text[start..self.at]
    }

    fn skip_spaces(&mut self) {
        self.take_while(char::is_whitespace);
    }

    fn unexpected(&self, found: char) -> UnitError {
        UnitError::UnexpectedCharacter {
            text: self.text.trim().into(),
            offset: self.at,
            found,
        }
    }

    fn incomplete(&self) -> UnitError {
        UnitError::Incomplete {
            text: self.text.trim().into(),
        }
    }

    /// Factors up to the end or a closing parenthesis.
    fn product(&mut self) -> Result<Unit, UnitError> {
        let first = self.power()?;
        self.product_after(first)
    }

    fn product_after(&mut self, mut unit: Unit) -> Result<Unit, UnitError> {
        let mut divided = false;
        loop {
            self.skip_spaces();
            let offset = self.at;
            match self.peek() {
                None | Some(')') => return Ok(unit),
                Some('/') => {
                    self.at += 1;
                    unit = unit.product(self.power()?, -1.0);
                    divided = true;
                }
                Some(_) if divided => {
                    return Err(UnitError::AmbiguousQuotient {
                        text: self.text.trim().into(),
                        offset,
                    });
                }
                Some(_) => {
                    self.take_if(|c| matches!(c, '*' | '·' | '⋅'));
                    unit = unit.product(self.power()?, 1.0);
                }
            }
        }
    }

    /// A symbol or a parenthesis, with its power.
    fn power(&mut self) -> Result<Unit, UnitError> {
        self.skip_spaces();
        let base = match self.peek() {
            None => return Err(self.incomplete()),
            Some('(') => {
                self.at += 1;
                let unit = self.product()?;
                self.take_if(|c| c == ')')
                    .ok_or_else(|| self.incomplete())?;
                unit
            }
            Some(_) => self.symbol()?,
        };
        let exponent = self.exponent()?;
        Ok(Unit::ONE.product(base, exponent))
    }

    fn symbol(&mut self) -> Result<Unit, UnitError> {
        let offset = self.at;
        if self.take_if(|c| c == '1').is_some() {
            return Ok(Unit::ONE);
        }
        self.take_while(|c| c.is_alphabetic() || matches!(c, '%' | '°' | '"' | '\u{2033}'));
        // The zero of g0 belongs to the symbol.
        if &self.text[offset..self.at] == "g" && self.text[self.at..].starts_with('0') {
            self.at += 1;
        }
        let symbol = &self.text[offset..self.at];
        if symbol.is_empty() {
            return Err(self
                .peek()
                .map_or_else(|| self.incomplete(), |c| self.unexpected(c)));
        }
        if CELSIUS.contains(&symbol) {
            return Err(UnitError::MisplacedCelsius {
                text: self.text.trim().into(),
            });
        }
        unit_of_symbol(symbol).ok_or_else(|| UnitError::UnknownUnit {
            text: self.text.trim().into(),
            offset,
            symbol: symbol.into(),
            nearest: nearest_units(symbol),
        })
    }

    /// The power behind a factor: `^-1.5`, `**2`, `^(1/2)`, `²`, `-1`; else 1.
    fn exponent(&mut self) -> Result<f64, UnitError> {
        let marked = self.take_if(|c| c == '^').is_some() || {
            let stars = self.text[self.at..].starts_with("**");
            self.at += 2 * usize::from(stars);
            stars
        };
        if marked && self.take_if(|c| c == '(').is_some() {
            return self.fraction();
        }
        let start = self.at;
        let plain: String = self
            .take_while(|c| {
                c.is_ascii_digit() || matches!(c, '.' | '+' | '-') || superscript(c).is_some()
            })
            .chars()
            .map(|c| superscript(c).unwrap_or(c))
            .collect();
        if plain.is_empty() && !marked {
            return Ok(1.0);
        }
        plain.parse().map_err(|_| {
            self.at = start;
            self.peek()
                .map_or_else(|| self.incomplete(), |c| self.unexpected(c))
        })
    }

    /// `1/2)` or `1.5)`.
    fn fraction(&mut self) -> Result<f64, UnitError> {
        let above = self.decimal()?;
        let below = match self.take_if(|c| c == '/') {
            Some(_) => self.decimal()?,
            None => 1.0,
        };
        self.take_if(|c| c == ')')
            .ok_or_else(|| self.incomplete())?;
        match below == 0.0 {
            true => Err(self.unexpected('0')),
            false => Ok(above / below),
        }
    }

    fn decimal(&mut self) -> Result<f64, UnitError> {
        let parsed = self
            .take_while(|c| c.is_ascii_digit() || matches!(c, '.' | '+' | '-'))
            .parse();
        parsed.map_err(|_| {
            self.peek()
                .map_or_else(|| self.incomplete(), |c| self.unexpected(c))
        })
    }
}

fn superscript(c: char) -> Option<char> {
    const SUPERSCRIPTS: &str = "⁰¹²³⁴⁵⁶⁷⁸⁹⁻˙";
    let index = SUPERSCRIPTS.chars().position(|s| s == c)?;
    "0123456789-.".chars().nth(index)
}

/// Unit of a symbol with or without prefix.
fn unit_of_symbol(symbol: &str) -> Option<Unit> {
    if let Some(known) = spelled(symbol) {
        return Some(unit_of(known, 1.0, 1.0));
    }
    let (prefix, multiply, divide) = PREFIXES
        .into_iter()
        .find(|(prefix, _, _)| symbol.starts_with(*prefix))?;
    let known = spelled(&symbol[prefix.len_utf8()..]).filter(|known| known.takes_prefix)?;
    Some(unit_of(known, multiply, divide))
}

fn spelled(symbol: &str) -> Option<&'static UnitSymbol> {
    UNIT_SYMBOLS
        .iter()
        .find(|known| known.spellings.contains(&symbol))
}

fn unit_of(known: &UnitSymbol, multiply: f64, divide: f64) -> Unit {
    let (multiply, divide) = reduced(known.multiply * multiply, known.divide * divide);
    Unit {
        multiply,
        divide,
        dimension: Dimension {
            exponents: known.exponents.map(f64::from),
        },
    }
}

/// What may have been meant by an unknown symbol.
fn nearest_units(symbol: &str) -> Vec<String> {
    // Two units run together, such as "Nm" or "Ns".
    let split = symbol.char_indices().skip(1).find_map(|(at, _)| {
        let (left, right) = symbol.split_at(at);
        let known = unit_of_symbol(left).is_some() && unit_of_symbol(right).is_some();
        known.then(|| format!("\"{left} {right}\" (with a space)"))
    });
    let spellings = || UNIT_SYMBOLS.iter().flat_map(|known| known.spellings);
    // With a prefix only what differs in case alone: all would be near by.
    let prefixed = PREFIXES
        .iter()
        .flat_map(|(prefix, _, _)| spellings().map(move |spelling| format!("{prefix}{spelling}")));
    let known: Vec<String> = prefixed
        .filter(|name| name.eq_ignore_ascii_case(symbol) && unit_of_symbol(name).is_some())
        .chain(spellings().map(|spelling| (*spelling).to_string()))
        .collect();
    let near = nearest_names(symbol, known.iter().map(String::as_str));
    split
        .into_iter()
        .chain(near.into_iter().map(|name| format!("\"{name}\"")))
        .take(3)
        .collect()
}
