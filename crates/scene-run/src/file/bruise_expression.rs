//! Terms of a regression of bruises, as what they make of one contact.

use windfall_statistics::model::expression::{columns_of, function_of, known_functions};
use windfall_statistics::model::formula_syntax::{Kind, Node, Operator, parse, spelling};

/// A calculation with the columns of one row.
#[derive(Clone, Debug)]
pub enum Expression {
    Number(f64),
    /// A column, by its place.
    Column(usize),
    /// A function of something.
    Function(fn(f64) -> f64, Box<Expression>),
    /// Two parts, and what is made of them.
    Both(Join, Box<[Expression; 2]>),
}

/// What is made of two parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Join {
    /// a + b
    Sum,
    /// a − b
    Difference,
    /// a b
    Product,
    /// a/b
    Quotient,
    /// a to the power of b
    Power,
}

impl Expression {
    /// Its value for a row.
    pub fn value(&self, columns: &[f64]) -> f64 {
        match self {
            Self::Number(number) => *number,
            Self::Column(place) => columns.get(*place).copied().unwrap_or(f64::NAN),
            Self::Function(function, inner) => function(inner.value(columns)),
            Self::Both(join, parts) => {
                let [a, b] = [parts[0].value(columns), parts[1].value(columns)];
                match join {
                    Join::Sum => a + b,
                    Join::Difference => a - b,
                    Join::Product => a * b,
                    Join::Quotient => a / b,
                    Join::Power => a.powf(b),
                }
            }
        }
    }
}

/// A term as `windfall regress` writes it: "(Intercept)", "log(energy_J)", "a:b", "a^2".
///
/// * `columns`: names of columns; those that the term adds are put behind them
///
/// # Errors
/// What is wrong with it, in words.
pub fn expression_of(term: &str, columns: &mut Vec<String>) -> Result<Expression, String> {
    if term == "(Intercept)" {
        return Ok(Expression::Number(1.0));
    }
    let node = parse(term).map_err(|error| error.to_string())?;
    for name in columns_of(&node) {
        if !columns.contains(&name) {
            columns.push(name);
        }
    }
    compiled(&node, columns)
}

fn compiled(node: &Node, columns: &[String]) -> Result<Expression, String> {
    let unknown = || {
        Err(format!(
            "a scene cannot calculate \"{}\"; it knows columns of numbers, their products, \
             powers and functions ({}), but poly, center, scale and categories only the table \
             that the regression was of",
            spelling(node),
            known_functions()
        ))
    };
    let both = |join, left: &Node, right: &Node| {
        let parts = [compiled(left, columns)?, compiled(right, columns)?];
        Ok(Expression::Both(join, Box::new(parts)))
    };
    match &node.kind {
        Kind::Number(number) => Ok(Expression::Number(*number)),
        Kind::Name(name) => {
            let place = columns.iter().position(|own| own == name);
            place.map_or_else(unknown, |place| Ok(Expression::Column(place)))
        }
        Kind::Negative(inner) => {
            let parts = [Expression::Number(0.0), compiled(inner, columns)?];
            Ok(Expression::Both(Join::Difference, Box::new(parts)))
        }
        Kind::Call(name, arguments) => {
            let [argument] = &arguments[..] else {
                return unknown();
            };
            let inner = compiled(&argument.value, columns);
            match (name.as_str(), function_of(name)) {
                ("I", _) => inner,
                (_, Some(function)) => Ok(Expression::Function(function, Box::new(inner?))),
                (_, None) => unknown(),
            }
        }
        Kind::Binary(operator, left, right) => match operator {
            Operator::Plus => both(Join::Sum, left, right),
            Operator::Minus => both(Join::Difference, left, right),
            Operator::Star | Operator::Colon => both(Join::Product, left, right),
            Operator::Slash => both(Join::Quotient, left, right),
            Operator::Power => both(Join::Power, left, right),
            Operator::Modelled | Operator::Within => unknown(),
        },
        Kind::Text(_) | Kind::Dot | Kind::Nothing => unknown(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_values_of_terms() {
        let mut columns = Vec::new();
        let values = [2.0, 3.0, 0.5];
        for (term, wanted) in [
            ("(Intercept)", 1.0),
            ("energy_J", 2.0),
            ("log(energy_J)", 2.0_f64.ln()),
            ("energy_J:radius_mm", 6.0),
            ("log(energy_J):radius_mm^2", 9.0 * 2.0_f64.ln()),
            ("I(energy_J / `S 1`)", 4.0),
            ("sqrt(-energy_J + 11)", 3.0),
        ] {
            let own = expression_of(term, &mut columns).unwrap();
            assert!((own.value(&values) - wanted).abs() < 1e-12, "{term}");
        }
        assert_eq!(columns, ["energy_J", "radius_mm", "S 1"]);
    }

    #[test]
    fn rejects_terms_that_need_their_table() {
        for term in ["poly(a, 2)", "variety[Golden]", "center(a)", "a | b"] {
            assert!(expression_of(term, &mut Vec::new()).is_err(), "{term}");
        }
    }
}
