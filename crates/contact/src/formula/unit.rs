//! Units of a formula's terms: the force must come out in newtons.

use crate::formula::error::{FormulaError, FormulaPlace};
use crate::formula::syntax::{Function, Operator, Term, What};
use crate::formula::value::term_value;
use windfall_numerics::unit::quantity::{
    Dimension, EXPONENT_TOLERANCE, UnitError, exponent_text, parse_unit,
};

/// Base units m, kg and s in [`Dimension::exponents`]; rad.
const METRE: usize = 0;
const KILOGRAM: usize = 1;
const SECOND: usize = 2;
const RADIAN: usize = 5;

/// A formula with the units of its parameters.
pub(crate) struct Units<'a> {
    pub formula: &'a str,
    pub names: &'a [String],
    /// Unit of each parameter, numbers for exponents.
    pub dimensions: &'a [Dimension],
    /// Value of each parameter, for exponents.
    pub values: &'a [f64],
}

/// Unit of a term; `None` for a zero, which fits every unit.
type Found = Option<Dimension>;

/// The dimension of a unit without a factor; `Err(None)` for one with a factor.
pub(crate) fn si_dimension(unit: &str) -> Result<Dimension, Option<UnitError>> {
    let unit = parse_unit(unit).map_err(Some)?;
    match unit.multiply == 1.0 && unit.divide == 1.0 {
        true => Ok(unit.dimension),
        false => Err(None),
    }
}

fn dimension(powers: &[(usize, f64)]) -> Dimension {
    let mut dimension = Dimension::default();
    for (base, power) in powers {
        dimension.exponents[*base] = *power;
    }
    dimension
}

fn newton() -> Dimension {
    dimension(&[(METRE, 1.0), (KILOGRAM, 1.0), (SECOND, -2.0)])
}

/// Whether the force comes out in newtons: every term of a sum of forces must be a force, and
/// the message names the one that is not.
pub(crate) fn check_units(term: &Term, units: &Units) -> Result<(), FormulaError> {
    match &term.what {
        What::Binary(Operator::Plus | Operator::Minus, a, b)
        | What::Smaller(a, b)
        | What::Larger(a, b) => {
            check_units(a, units)?;
            check_units(b, units)
        }
        What::Negative(a) | What::Call(Function::Abs, a) => check_units(a, units),
        What::If {
            left,
            right,
            then,
            otherwise,
            ..
        } => {
            units.same(left, right)?;
            check_units(then, units)?;
            check_units(otherwise, units)
        }
        _ => match units.of(term)? {
            Some(found) if !found.matches(&newton()) => Err(units.not_a_force(term, &found)),
            _ => Ok(()),
        },
    }
}

impl Units<'_> {
    fn text(&self, term: &Term) -> String {
        self.formula[term.span.clone()].to_owned()
    }

    fn wrong(
        &self,
        term: &Term,
        found: &Dimension,
        expected: String,
        hint: String,
    ) -> FormulaError {
        FormulaError::WrongUnit {
            term: self.text(term),
            found: unit_text(found),
            expected,
            hint,
            place: Box::new(FormulaPlace::new(self.formula, term.span.start)),
        }
    }

    /// The error of a term of the force, with the unit that its factor needs.
    fn not_a_force(&self, term: &Term, found: &Dimension) -> FormulaError {
        let hint = factor(term).map_or_else(String::new, |index| {
            let mut needed = self.dimensions[index];
            for (cell, (newton, found)) in needed
                .exponents
                .iter_mut()
                .zip(newton().exponents.iter().zip(found.exponents))
            {
                *cell += newton - found;
            }
            format!(
                ": {} would have to be in {}, not {}",
                self.names[index],
                unit_text(&needed),
                unit_text(&self.dimensions[index])
            )
        });
        self.wrong(term, found, "a force, N,".into(), hint)
    }

    fn of(&self, term: &Term) -> Result<Found, FormulaError> {
        let plain = Some(Dimension::default());
        Ok(match &term.what {
            What::Number(0.0) => None,
            What::Number(_) => plain,
            What::Displacement | What::Peak => Some(dimension(&[(METRE, 1.0)])),
            What::PeakForce => Some(newton()),
            What::Rate => Some(dimension(&[(METRE, 1.0), (SECOND, -1.0)])),
            What::Parameter(index) => Some(self.dimensions[*index]),
            What::Negative(a) | What::Call(Function::Abs, a) => self.of(a)?,
            What::Call(Function::Sqrt, a) => scaled(self.of(a)?, 0.5),
            What::Call(function, a) => {
                self.plain(a, *function)?;
                plain
            }
            What::Binary(Operator::Plus | Operator::Minus, a, b)
            | What::Smaller(a, b)
            | What::Larger(a, b) => self.same(a, b)?,
            What::Binary(Operator::Times, a, b) => product(self.of(a)?, self.of(b)?, 1.0),
            What::Binary(Operator::Over, a, b) => product(self.of(a)?, self.of(b)?, -1.0),
            What::Binary(Operator::Power, a, b) => self.power(a, b)?,
            What::If {
                left,
                right,
                then,
                otherwise,
                ..
            } => {
                self.same(left, right)?;
                self.same(then, otherwise)?
            }
        })
    }

    /// Two terms that are added or compared.
    fn same(&self, a: &Term, b: &Term) -> Result<Found, FormulaError> {
        match (self.of(a)?, self.of(b)?) {
            (None, other) | (other, None) => Ok(other),
            (Some(first), Some(second)) if first.matches(&second) => Ok(Some(first)),
            (Some(first), Some(second)) => {
                let expected = format!("{}, the unit of `{}`,", unit_text(&first), self.text(a));
                Err(self.wrong(b, &second, expected, String::new()))
            }
        }
    }

    /// The argument of a function: a plain number, or an angle.
    fn plain(&self, a: &Term, function: Function) -> Result<(), FormulaError> {
        let Some(mut found) = self.of(a)? else {
            return Ok(());
        };
        if matches!(function, Function::Sin | Function::Cos | Function::Tan) {
            found.exponents[RADIAN] = 0.0;
        }
        match found.matches(&Dimension::default()) {
            true => Ok(()),
            false => Err(self.wrong(
                a,
                &found,
                "a plain number".into(),
                ": divide by a parameter or number of its unit, as in log(1 + x/d)".into(),
            )),
        }
    }

    fn power(&self, a: &Term, b: &Term) -> Result<Found, FormulaError> {
        if let Some(found) = self.of(b)?
            && !found.matches(&Dimension::default())
        {
            return Err(self.wrong(b, &found, "a plain number".into(), String::new()));
        }
        let base = self.of(a)?;
        if !varies(b) {
            return Ok(scaled(base, term_value(b, self.values, 0.0, 0.0)));
        }
        match base {
            Some(found) if !found.matches(&Dimension::default()) => Err(self.wrong(
                a,
                &found,
                "a plain number".into(),
                ": its exponent changes with x or v".into(),
            )),
            plain => Ok(plain),
        }
    }
}

/// Whether a term contains x or v.
fn varies(term: &Term) -> bool {
    match &term.what {
        What::Displacement | What::Rate | What::Peak | What::PeakForce => true,
        What::Number(_) | What::Parameter(_) => false,
        What::Negative(a) | What::Call(_, a) => varies(a),
        What::Binary(_, a, b) | What::Smaller(a, b) | What::Larger(a, b) => varies(a) || varies(b),
        What::If {
            left,
            right,
            then,
            otherwise,
            ..
        } => [left, right, then, otherwise].iter().any(|t| varies(t)),
    }
}

/// The first parameter that stands as a plain factor of a term.
fn factor(term: &Term) -> Option<usize> {
    match &term.what {
        What::Parameter(index) => Some(*index),
        What::Negative(a) => factor(a),
        What::Binary(Operator::Times, a, b) => factor(a).or_else(|| factor(b)),
        What::Binary(Operator::Over, a, _) => factor(a),
        _ => None,
    }
}

fn scaled(unit: Found, power: f64) -> Found {
    let exponents = unit?.exponents.map(|exponent| exponent * power);
    Some(Dimension { exponents })
}

/// The unit of a product; zero times anything is a zero.
fn product(a: Found, b: Found, power: f64) -> Found {
    let (mut product, factor) = (a?, scaled(b, power)?);
    for (sum, term) in product.exponents.iter_mut().zip(factor.exponents) {
        *sum += term;
    }
    Some(product)
}

/// A unit with the newton in place of the kilogram: "N s/m^1.5".
pub(crate) fn unit_text(dimension: &Dimension) -> String {
    let mut exponents = dimension.exponents;
    let others = exponents[SECOND + 1..]
        .iter()
        .all(|e| e.abs() <= EXPONENT_TOLERANCE);
    if (exponents[KILOGRAM] - 1.0).abs() > EXPONENT_TOLERANCE || !others {
        return match dimension.to_string() {
            plain if plain == "1" => "no unit (1)".into(),
            text => text,
        };
    }
    exponents[METRE] -= 1.0;
    exponents[SECOND] += 2.0;
    let powers = [("s", exponents[SECOND]), ("m", exponents[METRE])];
    let symbol = |name: &str, power: f64| match (power - 1.0).abs() <= EXPONENT_TOLERANCE {
        true => name.to_owned(),
        false => format!("{name}^{}", exponent_text(power)),
    };
    let above = powers
        .iter()
        .filter(|(_, power)| *power > EXPONENT_TOLERANCE);
    let below: Vec<String> = powers
        .iter()
        .filter(|(_, power)| *power < -EXPONENT_TOLERANCE)
        .map(|(name, power)| symbol(name, -power))
        .collect();
    let mut text: String = std::iter::once("N".to_owned())
        .chain(above.map(|(name, power)| symbol(name, *power)))
        .collect::<Vec<_>>()
        .join(" ");
    match below.as_slice() {
        [] => {}
        [one] => text.push_str(&format!("/{one}")),
        several => text.push_str(&format!("/({})", several.join(" "))),
    }
    text
}
