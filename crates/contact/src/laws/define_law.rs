//! A user's definition → a law like any other.

use crate::error::Error;
use crate::formula::compile::compile;
use crate::formula::error::FormulaError;
use crate::formula::graph::{Graph, Id, Node, Variable};
use crate::formula::syntax::{Term, is_reserved, parse_formula};
use crate::formula::unit::{Units, check_units, si_dimension};
use crate::formula::value::node_values;
use crate::laws::any_law_size::LARGEST_PARAMETERS;
use crate::laws::force_table::{ForceTable, MonotoneCubic, check_table};
use crate::laws::kind::LawKind;
use crate::laws::user::{
    Body, FormulaBody, Known, UserForce, UserKind, UserLawDefinition, UserParameter, start_power_of,
};
use crate::laws::user_check::{Looked, check_force};
use crate::laws::user_finding::UserLawFinding;
use crate::parameter::{Elastic, LawDescription, NO_BOUND, ParameterDescription, Power, parameter};
use std::sync::{Mutex, PoisonError};
use windfall_numerics::unit::quantity::Dimension;

/// Change of an exponent with which units are checked again.
const OTHER_EXPONENT: f64 = 0.125;

/// The definitions of this run of the program. They are few, and a law must be
/// as light to pass around as a number: they are kept to the end and never freed.
static KNOWN: Mutex<Vec<&'static Known>> = Mutex::new(Vec::new());

/// A law that can be used wherever a built-in one can.
///
/// Equal definitions give the same law. Each distinct one stays in memory until
/// the program ends.
///
/// # Errors
/// [`Error::UserLaw`] in the terms of who wrote it: what cannot be read, has
/// the wrong unit, is not defined where it must be, or is no contact force.
///
/// # Example
/// ```
/// use windfall_contact::laws::define_law::define_law;
/// use windfall_contact::expression::parse_law_among;
/// use windfall_contact::laws::user::{UserForce, UserLawDefinition, UserParameter};
/// let stiffness = UserParameter {
///     name: "k".into(),
///     unit: "N/m^1.5".into(),
///     meaning: "stiffness".into(),
///     lower: 0.0,
///     upper: f64::INFINITY,
///     start: Some(4e5),
///     default: None,
/// };
/// let sphere = define_law(&UserLawDefinition {
///     name: "my-sphere".into(),
///     force: UserForce::Formula("k*x^1.5".into()),
///     parameters: vec![stiffness],
/// })?;
/// let law = parse_law_among("my-sphere(k=1e6)", &[sphere])?.complete()?;
/// assert!((law.force(1e-4, 0.0, 0.0) - 1.0).abs() < 1e-12);
/// # Ok::<(), windfall_contact::error::Error>(())
/// ```
pub fn define_law(definition: &UserLawDefinition) -> Result<LawKind, Error> {
    let key = format!("{definition:?}");
    let known = |list: &[&'static Known]| list.iter().find(|known| known.key == key).copied();
    if let Some(found) = known(&KNOWN.lock().unwrap_or_else(PoisonError::into_inner)) {
        return Ok(LawKind::User(UserKind(found)));
    }
    let made = make(definition, key.clone()).map_err(|problem| Error::UserLaw {
        law: definition.name.clone(),
        problem: Box::new(problem),
    })?;
    let mut list = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    let kept = known(&list).unwrap_or_else(|| {
        let kept: &'static Known = Box::leak(Box::new(made));
        list.push(kept);
        kept
    });
    Ok(LawKind::User(UserKind(kept)))
}

fn make(definition: &UserLawDefinition, key: String) -> Result<Known, FormulaError> {
    let name = law_name(&definition.name)?;
    match &definition.force {
        UserForce::Table(table) => make_table(definition, key, name, table),
        UserForce::Formula(formula) => make_formula(definition, key, name, formula),
    }
}

/// The name as law expressions write it.
fn law_name(name: &str) -> Result<String, FormulaError> {
    let folded = name.trim().to_lowercase().replace('_', "-");
    let plain = |c: char| c.is_alphanumeric() || c == '-';
    let reason = match () {
        () if !folded.starts_with(char::is_alphabetic) || !folded.chars().all(plain) => {
            "a law's name begins with a letter and has letters, digits and - only"
        }
        () if LawKind::ALL.iter().any(|kind| kind.name() == folded) => {
            "a built-in law has this name"
        }
        () => return Ok(folded),
    };
    Err(FormulaError::BadName {
        name: name.into(),
        reason,
    })
}

fn leaked(text: impl Into<String>) -> &'static str {
    Box::leak(text.into().into_boxed_str())
}

fn described(parameter: &UserParameter) -> ParameterDescription {
    ParameterDescription {
        name: leaked(parameter.name.as_str()),
        meaning: leaked(parameter.meaning.as_str()),
        unit: leaked(parameter.unit.trim()),
        lower: parameter.lower,
        upper: parameter.upper.min(1e30),
        typical: usual(parameter),
        default: parameter.default,
    }
}

/// A value at which a law is checked.
fn usual(parameter: &UserParameter) -> f64 {
    let (lower, upper) = (parameter.lower, parameter.upper);
    let between = match (lower > 0.0, upper < NO_BOUND) {
        (true, true) => (lower * upper).sqrt(),
        (false, true) => 0.5 * (lower.max(-NO_BOUND) + upper),
        (true, false) => lower,
        (false, false) => f64::max(1.0, lower),
    };
    parameter.start.or(parameter.default).unwrap_or(between)
}

fn check_parameters(parameters: &[UserParameter]) -> Result<(), FormulaError> {
    if parameters.is_empty() {
        return Err(FormulaError::NoParameters);
    }
    if parameters.len() > LARGEST_PARAMETERS {
        return Err(FormulaError::TooManyParameters {
            found: parameters.len(),
            largest: LARGEST_PARAMETERS,
        });
    }
    for (index, parameter) in parameters.iter().enumerate() {
        let name = &parameter.name;
        let plain = |c: char| c.is_alphanumeric() || c == '_';
        let bad = |reason| FormulaError::BadName {
            name: name.clone(),
            reason,
        };
        if is_reserved(name) {
            return Err(bad("it already has a meaning in formulas"));
        }
        if !name.starts_with(char::is_alphabetic) || !name.chars().all(plain) {
            return Err(bad(
                "a parameter's name begins with a letter and has letters, digits and _ only",
            ));
        }
        let same = |other: &UserParameter| other.name.to_lowercase() == name.to_lowercase();
        if parameters[..index].iter().any(same) {
            return Err(FormulaError::RepeatedParameter {
                parameter: name.clone(),
            });
        }
        check_bounds(parameter)?;
    }
    Ok(())
}

fn check_bounds(parameter: &UserParameter) -> Result<(), FormulaError> {
    let (lower, upper) = (parameter.lower, parameter.upper);
    let name = || parameter.name.clone();
    // Also refuses NaN.
    if !matches!(lower.partial_cmp(&upper), Some(std::cmp::Ordering::Less)) {
        return Err(FormulaError::EmptyBounds {
            parameter: name(),
            lower,
            upper,
        });
    }
    for (what, value) in [("start", parameter.start), ("default", parameter.default)] {
        if let Some(value) = value.filter(|value| !(lower..=upper).contains(value)) {
            return Err(FormulaError::StartOutOfBounds {
                parameter: name(),
                what,
                value,
                lower,
                upper,
            });
        }
    }
    Ok(())
}

fn make_formula(
    definition: &UserLawDefinition,
    key: String,
    name: String,
    formula: &str,
) -> Result<Known, FormulaError> {
    let parameters = &definition.parameters;
    check_parameters(parameters)?;
    let names: Vec<String> = parameters.iter().map(|p| p.name.clone()).collect();
    let term = parse_formula(formula, &names)?;
    let mut graph = Graph::default();
    let force = graph.add(&term);
    for (index, name) in names.iter().enumerate() {
        if !graph.depends(force, Variable::Parameter(index)) {
            return Err(FormulaError::UnusedParameter {
                parameter: name.clone(),
            });
        }
    }
    let values: Vec<f64> = parameters.iter().map(usual).collect();
    let descriptions: &'static [ParameterDescription] =
        Box::leak(parameters.iter().map(described).collect());
    // By their names alone, as the built-in laws have them.
    let damping = ["c", "lambda"].into_iter().find_map(|usual| {
        let named = |p: &&ParameterDescription| p.name.to_lowercase() == usual;
        descriptions.iter().find(named)
    });
    let description = LawDescription {
        name: leaked(name),
        formula: leaked(formula.trim()),
        first_touch: "as the formula says",
        source: "the user's own formula",
        elastic: Elastic::Other,
        damping: damping.map(|p| (p.name, Power::Number(0.0))),
        linear: &[],
        from_compression: false,
        parameters: descriptions,
    };
    let mut findings = unit_findings(&term, formula, &names, &description, &values)?;
    let slopes = slopes(&mut graph, force, names.len());
    findings.extend(check_force(&Looked {
        formula,
        term: &term,
        names: &names,
        graph: &graph,
        force,
        slopes: &slopes,
        values: &values,
    })?);
    let (body, unlocated) = formula_body(&graph, force, &slopes, &values)?;
    if unlocated > 0 {
        findings.push(UserLawFinding::KinkNotLocated { places: unlocated });
    }
    Ok(Known {
        definition: definition.clone(),
        key,
        starts: parameters.iter().map(|p| p.start).collect(),
        linear: linear(&graph, &slopes, names.len(), &values),
        description: LawDescription {
            first_touch: first_touch(&graph, force, &values),
            ..description
        },
        findings,
        body: Body::Formula(body),
    })
}

/// ∂F by x, v and each parameter.
fn slopes(graph: &mut Graph, force: Id, parameters: usize) -> Vec<Id> {
    [Variable::Displacement, Variable::Rate]
        .into_iter()
        .chain((0..parameters).map(Variable::Parameter))
        .map(|variable| graph.derivative(force, variable))
        .collect()
}

fn unit_findings(
    term: &Term,
    formula: &str,
    names: &[String],
    description: &LawDescription,
    values: &[f64],
) -> Result<Vec<UserLawFinding>, FormulaError> {
    let check = |values: &[f64]| -> Result<Vec<Dimension>, FormulaError> {
        let dimensions = dimensions(description, values)?;
        let units = Units {
            formula,
            names,
            dimensions: &dimensions,
            values,
        };
        check_units(term, &units)?;
        Ok(dimensions)
    };
    let dimensions = check(values)?;
    let mut findings = Vec::new();
    for (index, name) in names.iter().enumerate() {
        if !dimensions[index].matches(&Dimension::default()) {
            continue;
        }
        let mut other = values.to_vec();
        other[index] += OTHER_EXPONENT;
        if check(&other).is_err() {
            findings.push(UserLawFinding::UnitOfOneExponent {
                exponent: name.clone(),
                value: values[index],
            });
        }
    }
    Ok(findings)
}

/// Unit of each parameter, with numbers for exponents.
fn dimensions(
    description: &LawDescription,
    values: &[f64],
) -> Result<Vec<Dimension>, FormulaError> {
    let values: Vec<Option<f64>> = values.iter().copied().map(Some).collect();
    let parameters = description.parameters.iter().enumerate();
    parameters
        .map(|(index, parameter)| {
            let unit = description.unit_of(index, &values);
            let unit = unit.unwrap_or_else(|| parameter.unit.to_owned());
            si_dimension(&unit).map_err(|problem| match problem {
                Some(problem) => FormulaError::BadUnit {
                    parameter: parameter.name.into(),
                    problem: Box::new(problem),
                },
                None => FormulaError::NotSi {
                    parameter: parameter.name.into(),
                    unit,
                },
            })
        })
        .collect()
}

/// The compiled formula, and how many changes of piece have no known place.
fn formula_body(
    graph: &Graph,
    force: Id,
    slopes: &[Id],
    values: &[f64],
) -> Result<(FormulaBody, usize), FormulaError> {
    let mut conditions = Vec::new();
    for node in &graph.nodes[..=force] {
        if let Node::Choice(condition, _, _) = node
            && !conditions.contains(condition)
        {
            conditions.push(*condition);
        }
    }
    // The first displacement at which a piece ends is located.
    let at = conditions.iter().find_map(|id| displacement_of(graph, *id));
    let unlocated = conditions
        .iter()
        .filter(|id| at.is_none() || displacement_of(graph, **id) != at)
        .filter(|id| !graph.invariant[**id])
        .count();
    let (start_power, powers) = starting_powers(graph, force, values);
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

/// Parameters that the force is linear in: those of the force at rest, and those
/// of the rate alone.
fn linear(
    graph: &Graph,
    slopes: &[Id],
    parameters: usize,
    values: &[f64],
) -> (Vec<usize>, Vec<usize>) {
    let at_rest = node_values(graph, values, 1e-3, 0.0);
    let depends = |i: usize, j: usize| graph.depends(slopes[2 + i], Variable::Parameter(j));
    // Linear in all of them at once: no slope depends on another of them.
    let mut linear: Vec<usize> = Vec::new();
    for i in 0..parameters {
        let apart = |&j: &usize| !depends(i, j) && !depends(j, i);
        if !depends(i, i) && linear.iter().all(apart) {
            linear.push(i);
        }
    }
    let (rest, rate) = linear
        .into_iter()
        .partition(|&i| at_rest[slopes[2 + i]] != 0.0);
    (rest, rate)
}

/// Force and slope at first touch, in words.
fn first_touch(graph: &Graph, force: Id, values: &[f64]) -> &'static str {
    let at = |x: f64, v: f64| node_values(graph, values, x, v)[force];
    let scale = at(1e-3, 0.0).abs();
    let (moving, rest) = (at(1e-30, 0.5).abs(), at(1e-30, 0.0).abs());
    match () {
        () if rest > 1e-6 * scale => "the force does not begin at zero",
        () if moving > 1e-6 * scale => "the force jumps by what depends on the rate",
        () if at(1e-20, 0.5).abs() > 1e-9 * scale * 1e-5 => {
            "the force is zero and its slope in d infinite"
        }
        () => "the force is zero and its slope finite",
    }
}

fn make_table(
    definition: &UserLawDefinition,
    key: String,
    name: String,
    table: &ForceTable,
) -> Result<Known, FormulaError> {
    check_table(table)?;
    let factor = |name, meaning| parameter(name, "1", meaning, [0.0, 1e6], 1.0);
    let mut parameters = vec![factor("scale", "factor of the table's force")];
    let cubic = |values: &[f64]| MonotoneCubic::new(&table.displacement, values);
    let damping = table.damping.as_deref().map(cubic);
    let formula = match damping {
        Some(_) => "F = scale f(d) + damping_scale c(d) v",
        None => "F = scale f(d)",
    };
    if damping.is_some() {
        parameters.push(factor("damping_scale", "factor of the table's damping"));
    }
    let count = parameters.len();
    Ok(Known {
        definition: definition.clone(),
        key,
        starts: vec![Some(1.0); count],
        linear: ((0..1).collect(), (1..count).collect()),
        description: LawDescription {
            name: leaked(name),
            formula,
            first_touch: "the force is zero and its slope finite",
            source: "the user's own table",
            elastic: Elastic::Other,
            damping: None,
            linear: &[],
            from_compression: false,
            parameters: Box::leak(parameters.into_boxed_slice()),
        },
        findings: Vec::new(),
        body: Body::Table {
            force: cubic(&table.force),
            damping,
        },
    })
}
