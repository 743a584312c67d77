//! A user's definition → a law like any other.

use crate::error::Error;
use crate::formula::error::FormulaError;
use crate::formula::graph::{Graph, Id, Variable};
use crate::formula::syntax::{REMEMBERED, Term, is_reserved, parse_formula, parse_unloading};
use crate::formula::unit::{Units, check_units, si_dimension};
use crate::formula::value::node_values;
use crate::laws::any_law_size::LARGEST_PARAMETERS;
use crate::laws::force_table::{ForceTable, check_table};
use crate::laws::kind::LawKind;
use crate::laws::user::{
    Body, Known, OUTPUTS, UserForce, UserKind, UserLawDefinition, UserParameter,
};
use crate::laws::user_body::formula_body;
use crate::laws::user_check::{Looked, check_force};
use crate::laws::user_finding::UserLawFinding;
use crate::laws::user_memory_check::check_unloading;
use crate::parameter::{Elastic, LawDescription, NO_BOUND, ParameterDescription, Power, parameter};
use std::sync::{Mutex, PoisonError};
use windfall_numerics::monotone_cubic::MonotoneCubic;
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
        UserForce::Formula(formula) => make_formula(definition, key, name, (formula, None)),
        UserForce::WithMemory { force, unloading } => {
            make_formula(definition, key, name, (force, Some(unloading)))
        }
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
    (formula, unloading): (&str, Option<&String>),
) -> Result<Known, FormulaError> {
    let parameters = &definition.parameters;
    check_parameters(parameters)?;
    let names: Vec<String> = parameters.iter().map(|p| p.name.clone()).collect();
    let term = parse_formula(formula, &names)?;
    let mut graph = Graph::default();
    let loading = graph.add(&term);
    let unloading = unloading
        .map(|text| Unloading::new(&mut graph, loading, text, &names))
        .transpose()?;
    let force = unloading.as_ref().map_or(loading, |own| own.force);
    for (index, name) in names.iter().enumerate() {
        if !graph.depends(force, Variable::Parameter(index)) {
            return Err(FormulaError::UnusedParameter {
                parameter: name.clone(),
            });
        }
    }
    let values: Vec<f64> = parameters.iter().map(usual).collect();
    let description = described_formula(parameters, name, formula, unloading.as_ref());
    let mut findings = unit_findings(&term, formula, &names, &description, &values)?;
    let mut slopes = slopes(&mut graph, force, names.len());
    let linear = linear(&graph, &slopes, names.len(), &values);
    if let Some(own) = &unloading {
        let units = unit_findings(&own.term, own.text, &names, &description, &values);
        let new = units.map_err(|error| FormulaError::Unloading(Box::new(error)))?;
        findings.extend(
            new.into_iter()
                .filter(|one| !findings.contains(one))
                .collect::<Vec<_>>(),
        );
        slopes.resize_with(OUTPUTS - 2, || graph.number(0.0));
        slopes.push(graph.derivative(force, Variable::Peak));
    }
    let looked = Looked {
        formula,
        term: &term,
        names: &names,
        graph: &graph,
        force: loading,
        slopes: &slopes,
        values: &values,
    };
    findings.extend(check_force(&looked)?);
    if let Some(own) = &unloading {
        let found = check_unloading(&looked, own.node);
        findings.extend(found.map_err(|error| FormulaError::Unloading(Box::new(error)))?);
    }
    let (body, unlocated) = formula_body(&graph, (loading, force), &slopes, &values)?;
    if unlocated > 0 {
        findings.push(UserLawFinding::KinkNotLocated { places: unlocated });
    }
    Ok(Known {
        definition: definition.clone(),
        key,
        starts: parameters.iter().map(|p| p.start).collect(),
        linear,
        description: LawDescription {
            first_touch: first_touch(&graph, loading, &values),
            ..description
        },
        findings,
        body: Body::Formula(body),
    })
}

/// The formula below the largest displacement so far.
struct Unloading<'a> {
    text: &'a str,
    term: Term,
    /// Its node, and that of the whole force.
    node: Id,
    force: Id,
}

impl<'a> Unloading<'a> {
    fn new(
        graph: &mut Graph,
        loading: Id,
        text: &'a str,
        names: &[String],
    ) -> Result<Self, FormulaError> {
        if let Some(name) = names.iter().find(|own| REMEMBERED.contains(&own.as_str())) {
            return Err(FormulaError::BadName {
                name: name.clone(),
                reason: "it has a meaning in `unloading`",
            });
        }
        let term = parse_unloading(text, names);
        let term = term.map_err(|error| FormulaError::Unloading(Box::new(error)))?;
        let (node, force) = graph.remembering(loading, &term);
        Ok(Self {
            text,
            term,
            node,
            force,
        })
    }
}

fn described_formula(
    parameters: &[UserParameter],
    name: String,
    formula: &str,
    unloading: Option<&Unloading>,
) -> LawDescription {
    let descriptions: &'static [ParameterDescription] =
        Box::leak(parameters.iter().map(described).collect());
    // By their names alone, as the built-in laws have them.
    let damping = ["c", "lambda"].into_iter().find_map(|usual| {
        let named = |p: &&ParameterDescription| p.name.to_lowercase() == usual;
        descriptions.iter().find(named)
    });
    let formula = formula.trim();
    LawDescription {
        name: leaked(name),
        formula: match unloading {
            None => leaked(formula),
            Some(own) => leaked(format!(
                "{formula}; below the largest displacement x_max so far, {}",
                own.text.split_whitespace().collect::<Vec<&str>>().join(" ")
            )),
        },
        first_touch: "as the formula says",
        source: "the user's own formula",
        elastic: Elastic::Other,
        damping: damping.map(|p| (p.name, Power::Number(0.0))),
        linear: &[],
        from_compression: false,
        parameters: descriptions,
    }
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
