//! Which terms contain which.

use crate::model::encoding::Encoding;
use crate::model::formula_syntax::{Kind, Node, Operator};
use crate::model::model_frame::ModelFrame;

/// Powers of what a term is a product of: `V^2:R` is V twice and R once.
pub type Powers = Vec<(String, f64)>;

/// Powers of the terms of a frame.
pub fn powers_of_terms(frame: &ModelFrame) -> Vec<Powers> {
    let terms = frame.terms.iter();
    terms
        .map(|term| {
            let mut powers: Powers = Vec::new();
            for (atom, _) in &term.atoms {
                let (name, power) = match &frame.atoms[*atom] {
                    Encoding::Numbers { name, node } => power_of(node, name),
                    Encoding::Polynomial { name, .. }
                    | Encoding::Scaled { name, .. }
                    | Encoding::Category { name, .. } => (name.clone(), 1.0),
                };
                match powers.iter_mut().find(|(known, _)| *known == name) {
                    Some((_, sum)) => *sum += power,
                    None => powers.push((name, power)),
                }
            }
            powers
        })
        .collect()
}

/// `V` to the second, whether written `V^2` or `I(V^2)`.
fn power_of(node: &Node, name: &str) -> (String, f64) {
    match &node.kind {
        Kind::Call(function, arguments) if function == "I" && arguments.len() == 1 => {
            power_of(&arguments[0].value, name)
        }
        Kind::Binary(Operator::Power, base, exponent) => match (&base.kind, &exponent.kind) {
            (Kind::Name(base), Kind::Number(power)) if *power > 0.0 => (base.clone(), *power),
            _ => (name.to_owned(), 1.0),
        },
        Kind::Name(column) => (column.clone(), 1.0),
        _ => (name.to_owned(), 1.0),
    }
}

/// Whether a term divides another, so that a hierarchical model with that keeps it.
pub fn divides(inner: &Powers, outer: &Powers) -> bool {
    inner.iter().all(|(name, power)| {
        let found = outer.iter().find(|(other, _)| other == name);
        found.is_some_and(|(_, other)| other >= power)
    })
}
