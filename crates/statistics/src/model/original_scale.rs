//! From the scale of a model back to that of what was measured: `log(k)` to `k`.

use crate::model::expression::values;
use crate::model::formula_syntax::{Kind, Node, Operator, spelling};
use crate::model::model_frame::chosen_rows;
use crate::runs::Runs;
use crate::table::Table;

/// How a transformed response leads back to the column that it was made from.
#[derive(Clone, Debug, PartialEq)]
pub struct OriginalScale {
    /// The column.
    pub column: String,
    /// What was done to it, the last first.
    steps: Vec<Step>,
}

/// A calculation that is undone.
#[derive(Clone, Debug, PartialEq)]
enum Step {
    /// Logarithm to a base, of a number plus another.
    Log { base: f64, shift: f64 },
    /// Exponential.
    Exp,
    /// Positive numbers to a power.
    Power(f64),
    /// a + b y
    Line(f64, f64),
    /// a / y of positive numbers
    Inverse(f64),
}

impl OriginalScale {
    /// Of a response; `None` where it is a column as it is, or cannot be undone in every row: a
    /// square of values of both signs does not tell their signs.
    ///
    /// * `kept`: rows of the table that were modelled
    pub fn of(response: &Node, table: &Table, kept: &Runs) -> Option<Self> {
        let scale = Self::written(response)?;
        let kept: Vec<usize> = kept.iter().collect();
        let table = chosen_rows(table, &kept);
        let transformed = values(response, &table).ok()?;
        let own = table.numbers(&scale.column).ok()?;
        let leads_back = |(own, transformed): (f64, &f64)| {
            own.is_nan() || (scale.value(*transformed) - own).abs() <= 1e-6 * own.abs()
        };
        let mut rows = own.iter().zip(&transformed);
        rows.all(leads_back).then_some(scale)
    }

    /// Of a response as it is written.
    fn written(response: &Node) -> Option<Self> {
        let mut steps = Vec::new();
        let column = undo(response, &mut steps)?;
        (!steps.is_empty()).then_some(Self { column, steps })
    }

    /// A value on the scale of the column; NaN for one that no value of the column leads to.
    pub fn value(&self, transformed: f64) -> f64 {
        let steps = self.steps.iter();
        steps.fold(transformed, |own, step| {
            step.undone(own).unwrap_or(f64::NAN)
        })
    }

    /// An interval there, its lower end first. An end that no value of the column leads to is
    /// where these values end, which may be infinite; NaN unless one leads to `centre`.
    pub fn interval(&self, centre: f64, (low, high): (f64, f64)) -> (f64, f64) {
        if self.value(centre).is_nan() {
            return (f64::NAN, f64::NAN);
        }
        let end = |end: f64| {
            let steps = self.steps.iter();
            steps.fold(end, |own, step| step.undone(own).unwrap_or(step.limit()))
        };
        let (low, high) = (end(low), end(high));
        match low > high {
            true => (high, low),
            false => (low, high),
        }
    }

    /// Whether the response is a logarithm of the column, so that differences are ratios.
    pub fn is_logarithm(&self) -> bool {
        matches!(self.steps[..], [Step::Log { shift: 0.0, .. }])
    }

    /// Whether the response is a straight line of the column, of which means are means.
    fn is_line(&self) -> bool {
        self.steps.iter().all(|own| matches!(own, Step::Line(..)))
    }
}

impl Step {
    /// `None` for a value that this calculation never has.
    fn undone(&self, value: f64) -> Option<f64> {
        match *self {
            Self::Log { base, shift } => Some(match base == std::f64::consts::E {
                true if shift == 1.0 => value.exp_m1(),
                true => value.exp() - shift,
                false => base.powf(value) - shift,
            }),
            Self::Exp => (value > 0.0).then(|| value.ln()),
            Self::Power(power) => (value >= 0.0).then(|| value.powf(power.recip())),
            Self::Line(start, slope) => Some((value - start) / slope),
            Self::Inverse(above) => (value / above > 0.0).then(|| above / value),
        }
    }

    /// What is undone where the values of this calculation end.
    fn limit(&self) -> f64 {
        match *self {
            Self::Exp => f64::NEG_INFINITY,
            Self::Power(power) if power < 0.0 => f64::INFINITY,
            Self::Inverse(_) => f64::INFINITY,
            _ => 0.0,
        }
    }
}

/// The column below, with what undoes the calculations on the way.
fn undo(node: &Node, steps: &mut Vec<Step>) -> Option<String> {
    let (step, inner) = match &node.kind {
        Kind::Name(name) => return Some(name.clone()),
        Kind::Negative(inner) => (Step::Line(0.0, -1.0), inner.as_ref()),
        Kind::Call(function, arguments) => {
            let [argument] = &arguments[..] else {
                return None;
            };
            let log = |base: f64| Step::Log { base, shift: 0.0 };
            let step = match function.as_str() {
                "I" => return undo(&argument.value, steps),
                "log" => log(std::f64::consts::E),
                "log2" => log(2.0),
                "log10" => log(10.0),
                "log1p" => Step::Log {
                    base: std::f64::consts::E,
                    shift: 1.0,
                },
                "exp" => Step::Exp,
                "sqrt" => Step::Power(0.5),
                _ => return None,
            };
            (step, &argument.value)
        }
        Kind::Binary(operator, left, right) => match (constant(left), constant(right)) {
            (None, Some(number)) => {
                let step = match operator {
                    Operator::Plus => Step::Line(number, 1.0),
                    Operator::Minus => Step::Line(-number, 1.0),
                    Operator::Star if number != 0.0 => Step::Line(0.0, number),
                    Operator::Slash => Step::Line(0.0, number.recip()),
                    Operator::Power if number != 0.0 => Step::Power(number),
                    _ => return None,
                };
                (step, left.as_ref())
            }
            (Some(number), None) => {
                let step = match operator {
                    Operator::Plus => Step::Line(number, 1.0),
                    Operator::Minus => Step::Line(number, -1.0),
                    Operator::Star if number != 0.0 => Step::Line(0.0, number),
                    Operator::Slash if number != 0.0 => Step::Inverse(number),
                    _ => return None,
                };
                (step, right.as_ref())
            }
            _ => return None,
        },
        _ => return None,
    };
    steps.push(step);
    undo(inner, steps)
}

/// The value of a number, also of a negative one, or of numbers in a calculation.
fn constant(node: &Node) -> Option<f64> {
    match &node.kind {
        Kind::Number(number) => Some(*number),
        Kind::Negative(inner) => Some(-constant(inner)?),
        Kind::Binary(Operator::Slash, left, right) => Some(constant(left)? / constant(right)?),
        _ => None,
    }
}

/// What a mean of transformed values is on the scale of the column.
pub fn meaning(scale: &OriginalScale, response: &Node) -> String {
    let (column, response) = (&scale.column, spelling(response));
    match scale.is_logarithm() {
        true => format!(
            "{column} of a mean of {response} is the geometric mean of {column}, its median where \
             {response} is normal, and lies below its mean; differences of {response} are ratios"
        ),
        false if scale.is_line() => format!("{column} of a mean of {response} is its mean"),
        false => format!(
            "{column} of a mean of {response} is the median of {column} where {response} is \
             normal, not its mean"
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::formula_syntax::parse;
    use crate::table::{Cells, Column};

    #[test]
    fn closed_form_values_lead_back() {
        for (text, forward) in [
            ("log(k)", f64::ln as fn(f64) -> f64),
            ("log10(k)", f64::log10),
            ("log2(2 * k)", |k| (2.0 * k).log2()),
            ("log1p(k)", f64::ln_1p),
            ("sqrt(k)", f64::sqrt),
            ("exp(-k)", |k| (-k).exp()),
            ("k^0.3", |k| k.powf(0.3)),
            ("I(k^-1)", |k| k.powf(-1.0)),
            ("(k^0.3 - 1) / 0.3", |k| (k.powf(0.3) - 1.0) / 0.3),
            ("1 / k", |k| 1.0 / k),
            ("3 - k / 2", |k| 3.0 - k / 2.0),
        ] {
            let scale = OriginalScale::written(&parse(text).unwrap()).unwrap();
            assert_eq!(scale.column, "k");
            for k in [0.2, 1.0, 3.7] {
                let found = scale.value(forward(k));
                assert!((found - k).abs() < 1e-12 * (1.0 + k), "{text}: {found}");
            }
        }
        for text in ["k", "k + v", "k * v", "abs(k)", "sin(k)", "2"] {
            assert_eq!(
                OriginalScale::written(&parse(text).unwrap()),
                None,
                "{text}"
            );
        }
    }

    #[test]
    fn closed_form_intervals_stay_in_order_and_in_range() {
        let scale = |text: &str| OriginalScale::written(&parse(text).unwrap()).unwrap();
        let infinite = f64::INFINITY;
        assert_eq!(scale("1 / k").interval(1.0, (0.5, 2.0)), (0.5, 2.0));
        assert_eq!(scale("1 / k").interval(1.0, (-0.5, 2.0)), (0.5, infinite));
        assert_eq!(scale("sqrt(k)").interval(1.0, (-0.5, 2.0)), (0.0, 4.0));
        let (low, high) = scale("exp(-k)").interval(0.5, (-0.1, 1.0));
        assert_eq!((low, high), (0.0, infinite));
        // No root is negative.
        assert!(scale("sqrt(k)").value(-1.0).is_nan());
        assert!(scale("sqrt(k)").interval(-1.0, (-2.0, 4.0)).0.is_nan());
        assert!(scale("log10(k)").is_logarithm() && !scale("log1p(k)").is_logarithm());
    }

    /// Squares and inverses of values of both signs lead to none of them.
    #[test]
    fn detects_responses_that_cannot_be_undone() {
        let table = |cells: &[f64]| Table {
            columns: vec![Column {
                name: "k".to_owned(),
                cells: Cells::Numbers(cells.to_vec().into()),
            }],
        };
        let both = table(&[-1.0, 2.0]);
        let positive = table(&[0.5, 2.0, -1.0]);
        for text in ["k^2", "1 / k", "k^3", "(1 - k)^2"] {
            let node = parse(text).unwrap();
            assert_eq!(
                OriginalScale::of(&node, &both, &(0..2).collect()),
                None,
                "{text}"
            );
        }
        for text in ["k^2", "1 / k", "k^3", "log(k)"] {
            let node = parse(text).unwrap();
            assert!(
                OriginalScale::of(&node, &positive, &(0..2).collect()).is_some(),
                "{text}"
            );
        }
    }
}
