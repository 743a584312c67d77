//! Values of the expressions in formulas.

use crate::error::Error;
use crate::model::formula_syntax::{Argument, Kind, Node, Operator, spelling};
use crate::table::Table;
use windfall_numerics::double_double::DoubleDouble;

type Function = (&'static str, fn(f64) -> f64);

const FUNCTIONS: [Function; 9] = [
    ("log", f64::ln),
    ("log2", f64::log2),
    ("log10", f64::log10),
    ("log1p", f64::ln_1p),
    ("exp", f64::exp),
    ("sqrt", f64::sqrt),
    ("abs", f64::abs),
    ("sin", f64::sin),
    ("cos", f64::cos),
];

/// Functions that may stand in formulas, for messages.
pub fn known_functions() -> String {
    let names = FUNCTIONS.iter().map(|(name, _)| *name);
    let names: Vec<&str> = names.chain(["I", "poly", "C", "center", "scale"]).collect();
    names.join(", ")
}

/// A function of one number that may stand in formulas.
pub fn function_of(name: &str) -> Option<fn(f64) -> f64> {
    let known = FUNCTIONS.iter().find(|(own, _)| *own == name);
    known.map(|(_, function)| *function)
}

/// Values of an arithmetic expression per row; NaN where a cell is missing.
///
/// # Errors
/// Unknown columns or functions; columns of categories; a value that is infinite
/// or undefined.
pub fn values(node: &Node, table: &Table) -> Result<Vec<f64>, Error> {
    let found = evaluate(node, table)?;
    // All of them at once, which takes less time than one by one.
    if found
        .iter()
        .fold(true, |all, value| all & value.is_finite())
    {
        return Ok(found);
    }
    let known = columns_of(node);
    for (row, value) in found.iter().enumerate() {
        let missing = || known.iter().any(|name| missing_at(table, name, row));
        if !value.is_finite() && !missing() {
            return Err(Error::NotFinite {
                expression: spelling(node),
                value: *value,
                row: row + 1,
            });
        }
    }
    Ok(found)
}

fn missing_at(table: &Table, name: &str, row: usize) -> bool {
    table
        .column(name)
        .is_ok_and(|column| column.cells.is_missing(row))
}

/// Names of the columns in an expression, each once.
pub fn columns_of(node: &Node) -> Vec<String> {
    let mut found = Vec::new();
    collect(node, &mut found);
    found
}

fn collect(node: &Node, found: &mut Vec<String>) {
    match &node.kind {
        Kind::Name(name) if !found.contains(name) => found.push(name.clone()),
        Kind::Call(function, arguments) => {
            // What stands behind the first argument of these are options.
            let options = matches!(function.as_str(), "C" | "poly");
            let count = if options { 1 } else { arguments.len() };
            let values = arguments.iter().take(count);
            values.for_each(|argument| collect(&argument.value, found));
        }
        Kind::Negative(inner) => collect(inner, found),
        Kind::Binary(_, left, right) => {
            collect(left, found);
            collect(right, found);
        }
        _ => {}
    }
}

fn evaluate(node: &Node, table: &Table) -> Result<Vec<f64>, Error> {
    match &node.kind {
        Kind::Number(number) => Ok(vec![*number; table.rows()]),
        Kind::Name(name) => Ok(table.numbers(name)?.values().into_owned()),
        Kind::Negative(inner) => {
            let mut values = evaluate(inner, table)?;
            values.iter_mut().for_each(|value| *value = -*value);
            Ok(values)
        }
        Kind::Call(function, arguments) => call(node, function, arguments, table),
        Kind::Binary(operator, left, right) => {
            let left_values = evaluate(left, table)?;
            let right_values = evaluate(right, table)?;
            let combine: fn(f64, f64) -> f64 = match operator {
                Operator::Plus => |a, b| a + b,
                Operator::Minus => |a, b| a - b,
                Operator::Star => |a, b| a * b,
                Operator::Slash => |a, b| a / b,
                Operator::Power => power,
                Operator::Colon | Operator::Within | Operator::Modelled => {
                    return Err(Error::Request {
                        what: spelling(node),
                        problem: "this is no calculation with numbers".to_owned(),
                    });
                }
            };
            let pairs = left_values.iter().zip(&right_values);
            Ok(pairs.map(|(a, b)| combine(*a, *b)).collect())
        }
        Kind::Text(_) | Kind::Dot | Kind::Nothing => Err(Error::Request {
            what: spelling(node),
            problem: "this is no number".to_owned(),
        }),
    }
}

/// Whole powers rounded once, since high powers are nearly dependent on lower ones.
fn power(base: f64, exponent: f64) -> f64 {
    match exponent.fract() == 0.0 && (0.0..=64.0).contains(&exponent) && base.is_finite() {
        true => DoubleDouble::from(base).powi(exponent as u32).value(),
        false => base.powf(exponent),
    }
}

fn call(
    node: &Node,
    function: &str,
    arguments: &[Argument],
    table: &Table,
) -> Result<Vec<f64>, Error> {
    let [Argument { name: None, value }] = arguments else {
        return match FUNCTIONS.iter().any(|(name, _)| *name == function) || function == "I" {
            true => Err(Error::Request {
                what: spelling(node),
                problem: format!("{function} takes one expression"),
            }),
            false => Err(unknown(function)),
        };
    };
    if function == "I" {
        return evaluate(value, table);
    }
    let known = FUNCTIONS.iter().find(|(name, _)| *name == function);
    let (_, apply) = known.ok_or_else(|| unknown(function))?;
    let mut values = evaluate(value, table)?;
    values.iter_mut().for_each(|value| *value = apply(*value));
    Ok(values)
}

fn unknown(function: &str) -> Error {
    Error::UnknownFunction {
        function: function.to_owned(),
        known: known_functions(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::formula_syntax::parse;
    use crate::table::{Cells, Column};

    fn table() -> Table {
        Table {
            columns: vec![Column {
                name: "x".to_owned(),
                cells: Cells::Numbers(vec![4.0, f64::NAN, -1.0].into()),
            }],
        }
    }

    #[test]
    fn closed_form_arithmetic_and_missing_cells() {
        let found = values(&parse("I(2 * x^2 - x / 4)").unwrap(), &table()).unwrap();
        assert_eq!((found[0], found[2]), (31.0, 2.25));
        assert!(found[1].is_nan());
    }

    #[test]
    fn rejects_undefined_values_and_unknown_functions() {
        let message = |text: &str| {
            let found = values(&parse(text).unwrap(), &table());
            found.unwrap_err().to_string()
        };
        assert!(message("log(x)").contains("NaN in row 3"));
        assert!(message("I(1 / (x - 4))").contains("inf in row 1"));
        assert!(message("sine(x)").contains("there are log"));
        assert!(message("log(y)").contains("no column \"y\""));
    }
}
