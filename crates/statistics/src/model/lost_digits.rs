//! What rounding to doubles takes from columns of a model: high powers of one column depend so
//! nearly on each other that the last digit decides.

use crate::model::encoding::Encoding;
use crate::model::formula_syntax::{Kind, Node, Operator};
use crate::table::Table;
use windfall_numerics::as_written::as_written;
use windfall_numerics::double_double::DoubleDouble;

/// Columns with what is to be added to them in each row: of products of whole powers of columns,
/// read as the decimals that are written.
pub type LostDigits = Vec<(usize, Vec<f64>)>;

/// What a column lacks of the product that it was made from; `None` where it is no product of
/// whole powers, or lacks nothing.
pub(crate) fn lost_digits<'a>(
    atoms: impl Iterator<Item = &'a Encoding>,
    table: &Table,
    rounded: &[f64],
) -> Option<Vec<f64>> {
    let mut product = vec![DoubleDouble::ONE; rounded.len()];
    for atom in atoms {
        let Encoding::Numbers { node, .. } = atom else {
            return None;
        };
        let (column, power) = whole_power(node)?;
        let values = table.numbers(column).ok()?;
        for (own, value) in product.iter_mut().zip(values.iter()) {
            *own = *own * as_written(value).powi(power);
        }
    }
    let pairs = product.iter().zip(rounded);
    let lost: Vec<f64> = pairs
        .map(|(precise, rounded)| (*precise - DoubleDouble::from(*rounded)).value())
        .collect();
    lost.iter().any(|own| *own != 0.0).then_some(lost)
}

/// A column and its power.
fn whole_power(node: &Node) -> Option<(&str, u32)> {
    match &node.kind {
        Kind::Name(name) => Some((name, 1)),
        Kind::Call(function, arguments) if function == "I" && arguments.len() == 1 => {
            whole_power(&arguments[0].value)
        }
        Kind::Binary(Operator::Power, base, exponent) => match (&base.kind, &exponent.kind) {
            (Kind::Name(name), Kind::Number(power))
                if power.fract() == 0.0 && (1.0..=64.0).contains(power) =>
            {
                Some((name, *power as u32))
            }
            _ => None,
        },
        _ => None,
    }
}
