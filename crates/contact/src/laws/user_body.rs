//! A checked formula → what evaluates it.

use crate::formula::compile::compile;
use crate::formula::error::FormulaError;
use crate::formula::graph::{Graph, Id, Node, Variable};
use crate::formula::value::node_values;
use crate::laws::user::{FormulaBody, start_power_of};

/// The compiled formula, and how many changes of piece have no known place.
///
/// * `force`: node of loading, and of the whole force
pub(crate) fn formula_body(
    graph: &Graph,
    (loading, force): (Id, Id),
    slopes: &[Id],
    values: &[f64],
) -> Result<(FormulaBody, usize), FormulaError> {
    let mut conditions = Vec::new();
    for node in &graph.nodes[..=force] {
        // What is remembered changes between steps of the integrator alone.
        let moves = |id: Id| {
            let by = [Variable::Displacement, Variable::Rate];
            !graph.is_memory(id) && by.into_iter().any(|by| graph.depends(id, by))
        };
        if let Node::Choice(condition, _, _) = node
            && !conditions.contains(condition)
            && moves(*condition)
        {
            conditions.push(*condition);
        }
    }
    // The first displacement at which a piece ends is located.
    let at = conditions.iter().find_map(|id| displacement_of(graph, *id));
    let unlocated = conditions
        .iter()
        .filter(|id| at.is_none() || displacement_of(graph, **id) != at)
        .count();
    let (start_power, powers) = starting_powers(graph, loading, values);
    let wanted: Vec<Id> = at.into_iter().chain(powers.iter().map(|p| p.1)).collect();
    let roots: Vec<Id> = std::iter::once(force)
        .chain(slopes.iter().copied())
        .collect();
    let compiled = compile(graph, &roots, &wanted, values.len())?;
    let constant = |id: Id| {
        let place = compiled.hoisted.iter().position(|known| *known == id);
        place.map(|place| values.len() + place)
    };
    let body = FormulaBody {
        memory: loading != force,
        start_power,
        powers: powers
            .iter()
            .filter_map(|(order, id)| constant(*id).map(|c| (*order, c)))
            .collect(),
        kink: at.and_then(constant),
        hoisted: compiled.hoisted.len(),
        main: compiled.main,
        prelude: compiled.prelude,
    };
    Ok((body, unlocated))
}

/// The displacement at which a condition x − d or d − x changes.
fn displacement_of(graph: &Graph, condition: Id) -> Option<Id> {
    match graph.nodes[condition] {
        Node::Difference(a, b) => match (graph.nodes[a], graph.nodes[b]) {
            (Node::Displacement, _) if graph.invariant[b] => Some(b),
            (_, Node::Displacement) if graph.invariant[a] => Some(a),
            _ => None,
        },
        _ => None,
    }
}

/// Start power by the powers with a known exponent, and the others: order of
/// the base in x, and exponent.
fn starting_powers(graph: &Graph, force: Id, values: &[f64]) -> (u32, Vec<(f64, Id)>) {
    let near = node_values(graph, values, 1e-12, 0.5);
    let nearer = node_values(graph, values, 1e-14, 0.5);
    let mut power = 1;
    let mut others = Vec::new();
    for node in &graph.nodes[..=force] {
        let Node::Power(base, exponent) = *node else {
            continue;
        };
        let order = (near[base] / nearer[base]).abs().ln() / 100_f64.ln();
        if graph.invariant[base] || !order.is_finite() || order < 1e-3 {
            continue;
        }
        let order = (4.0 * order).round() / 4.0;
        match graph.value(exponent) {
            Some(exponent) => power = power.max(start_power_of(order * exponent)),
            None if graph.invariant[exponent] => others.push((order, exponent)),
            None => power = power.max(2),
        }
    }
    (power, others)
}
