//! Values of a formula's parts one by one, to find the one that fails.

use crate::formula::graph::{Graph, Node, apply};
use crate::formula::syntax::{Function, Operator, Term, What};

/// Value of a term.
pub(crate) fn term_value(term: &Term, parameters: &[f64], x: f64, v: f64) -> f64 {
    let of = |term: &Term| term_value(term, parameters, x, v);
    match &term.what {
        What::Number(value) => *value,
        What::Displacement => x,
        What::Rate => v,
        // Only in `unloading`, whose terms are not looked at one by one.
        What::Peak | What::PeakForce => f64::NAN,
        What::Parameter(index) => parameters[*index],
        What::Negative(a) => -of(a),
        What::Binary(operator, a, b) => {
            let (a, b) = (of(a), of(b));
            match operator {
                Operator::Plus => a + b,
                Operator::Minus => a - b,
                Operator::Times => a * b,
                Operator::Over => a / b,
                Operator::Power => a.powf(b),
            }
        }
        What::Call(function, a) => apply(*function, of(a)),
        What::Smaller(a, b) => of(a).min(of(b)),
        What::Larger(a, b) => of(a).max(of(b)),
        What::If { .. } => of(branch(term, parameters, x, v)),
    }
}

/// The term that is in use of an `if`.
fn branch<'a>(term: &'a Term, parameters: &[f64], x: f64, v: f64) -> &'a Term {
    let What::If {
        left,
        right,
        strict,
        then,
        otherwise,
    } = &term.what
    else {
        return term;
    };
    let of = |term: &Term| term_value(term, parameters, x, v);
    let (left, right) = (of(left), of(right));
    match left > right || (!strict && left == right) {
        true => then,
        false => otherwise,
    }
}

/// The innermost term that has no finite value, and why.
pub(crate) fn culprit<'a>(
    term: &'a Term,
    parameters: &[f64],
    x: f64,
    v: f64,
) -> Option<(&'a Term, &'static str)> {
    let inner = |term: &'a Term| culprit(term, parameters, x, v);
    let of = |term: &Term| term_value(term, parameters, x, v);
    let found = match &term.what {
        What::Number(_)
        | What::Displacement
        | What::Rate
        | What::Peak
        | What::PeakForce
        | What::Parameter(_) => None,
        What::Negative(a) | What::Call(_, a) => inner(a),
        What::Binary(_, a, b) | What::Smaller(a, b) | What::Larger(a, b) => {
            inner(a).or_else(|| inner(b))
        }
        What::If { left, right, .. } => inner(left)
            .or_else(|| inner(right))
            .or_else(|| inner(branch(term, parameters, x, v))),
    };
    if found.is_some() || of(term).is_finite() {
        return found;
    }
    let reason = match &term.what {
        What::Binary(Operator::Over, _, b) if of(b) == 0.0 => "divides by zero",
        What::Binary(Operator::Power, a, b) if of(a) == 0.0 && of(b) < 0.0 => {
            "divides by zero (a negative power of zero)"
        }
        What::Binary(Operator::Power, a, _) if of(a) < 0.0 => {
            "is not defined (a broken power of a negative number)"
        }
        What::Call(Function::Log, a) if of(a) == 0.0 => "is not defined (the logarithm of zero)",
        What::Call(Function::Log, _) => "is not defined (the logarithm of a negative number)",
        What::Call(Function::Sqrt, _) => "is not defined (the root of a negative number)",
        _ => "is not finite",
    };
    Some((term, reason))
}

/// Value of every node during first loading.
pub(crate) fn node_values(graph: &Graph, parameters: &[f64], x: f64, v: f64) -> Vec<f64> {
    values_after(graph, parameters, [x, v, 0.0])
}

/// Value of every node.
///
/// * `state`: displacement, rate and largest displacement so far; m, m/s, m
pub(crate) fn values_after(graph: &Graph, parameters: &[f64], state: [f64; 3]) -> Vec<f64> {
    let [x, v, peak] = state;
    let mut values: Vec<f64> = Vec::with_capacity(graph.nodes.len());
    for node in &graph.nodes {
        let value = match *node {
            Node::Number(bits) => f64::from_bits(bits),
            Node::Displacement => x,
            Node::Rate => v,
            Node::Peak => peak,
            Node::Parameter(index) => parameters[index],
            Node::Sum(a, b) => values[a] + values[b],
            Node::Difference(a, b) => values[a] - values[b],
            Node::Product(a, b) => values[a] * values[b],
            Node::Quotient(a, b) => values[a] / values[b],
            Node::Negative(a) => -values[a],
            Node::Power(a, b) => values[a].powf(values[b]),
            Node::Call(function, a) => apply(function, values[a]),
            Node::Choice(c, a, b) => match values[c] > 0.0 {
                true => values[a],
                false => values[b],
            },
        };
        values.push(value);
    }
    values
}
