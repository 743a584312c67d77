//! `[fit.prior]` and `[fit.bounds]` of campaign.toml, and the options in their place.

use crate::settings::model::{FitPlan, KnownKind, KnownText};
use windfall_contact::expression::LawExpression;
use windfall_contact::laws::kind::LawKind;
use windfall_contact::parameter::{IMPACT_VELOCITY, MASS};
use windfall_files::text::number::plain;
use windfall_files::text::toml_source::suggestion;
use windfall_identify::fit::problem::{Known, Prior, Treatment, Weighting};
use windfall_numerics::unit::range::parse_range;
use windfall_numerics::unit::uncertain::parse_uncertain;

/// Nuisances by their names, with their units.
const NUISANCES: [(&str, &str); 3] = [
    ("initial_velocity", "m/s"),
    ("onset", "s"),
    ("displacement_offset", "m"),
];

/// What is known of the parameters of each law of a plan, and of its nuisances.
///
/// A prior frees what has a usual value. Bounds are of what is estimated.
///
/// # Errors
/// Position in `plan.known_texts` of what cannot be used, and why.
pub fn known_of(plan: &FitPlan) -> Result<Vec<(LawKind, Known)>, (usize, String)> {
    let texts = plan.known_texts.iter().enumerate();
    let mut all: Vec<(LawKind, Known)> = Vec::new();
    for (index, own) in texts {
        let at = |problem: String| (index, problem);
        let laws = plan.laws.iter();
        let having: Vec<&LawExpression> = laws.filter(|law| has(law, &own.name)).collect();
        if having.is_empty() {
            return Err(at(unknown(&own.name, &plan.laws)));
        }
        if plan.options.weighting == Weighting::InverseMean && own.kind == KnownKind::Prior {
            let problem = "weights 1/mean say nothing of deviations, against which a prior could \
                           be weighed; use weights = \"inverse-variance\"";
            return Err(at(problem.to_owned()));
        }
        for law in having {
            let found = known_in(law, own, plan).map_err(at)?;
            let mut known = all.iter_mut().map(|(kind, known)| (*kind, known));
            match known.find(|(kind, known)| *kind == law.kind && known.name == own.name) {
                None => all.push((law.kind, found)),
                Some((_, known)) => {
                    known.prior = known.prior.or(found.prior);
                    known.range.0 = known.range.0.max(found.range.0);
                    known.range.1 = known.range.1.min(found.range.1);
                    check(known).map_err(at)?;
                }
            }
        }
    }
    Ok(all)
}

/// Whether a law has a parameter or nuisance of a name.
pub(crate) fn has(law: &LawExpression, name: &str) -> bool {
    let mut parameters = law.kind.describe().parameters.iter();
    parameters.any(|own| own.name == name) || NUISANCES.iter().any(|own| own.0 == name)
}

fn unknown(name: &str, laws: &[LawExpression]) -> String {
    let parameters = laws.iter().flat_map(|law| law.kind.describe().parameters);
    let mut names: Vec<&str> = parameters.map(|parameter| parameter.name).collect();
    names.extend(NUISANCES.iter().map(|own| own.0));
    let hint = suggestion(name, names.iter().copied());
    format!(
        "nothing that is estimated has this name{hint}; there are: {}",
        names.join(", ")
    )
}

/// What one text says of one law.
fn known_in(law: &LawExpression, own: &KnownText, plan: &FitPlan) -> Result<Known, String> {
    let (unit, allowed) = match NUISANCES.iter().find(|nuisance| nuisance.0 == own.name) {
        Some((name, unit)) => {
            estimated_nuisance(name, plan)?;
            ((*unit).to_owned(), (f64::NEG_INFINITY, f64::INFINITY))
        }
        None => parameter(law, own, plan)?,
    };
    let mut known = Known {
        name: own.name.clone(),
        prior: None,
        range: (f64::NEG_INFINITY, f64::INFINITY),
    };
    match own.kind {
        KnownKind::Prior => known.prior = Some(prior(&own.text, &unit, &own.name)?),
        KnownKind::Bounds => {
            known.range = parse_range(&own.text, &unit).map_err(|error| error.to_string())?;
            if known.range.0 >= allowed.1 || known.range.1 <= allowed.0 {
                return Err(outside(law, &own.name, allowed));
            }
        }
    }
    match known.prior {
        Some(prior) if prior.mean < allowed.0 || prior.mean > allowed.1 => {
            Err(outside(law, &own.name, allowed))
        }
        _ => Ok(known),
    }
}

fn outside(law: &LawExpression, name: &str, (low, high): (f64, f64)) -> String {
    format!(
        "{name} of {} lies between {} and {}",
        law.kind.name(),
        plain(low),
        plain(high)
    )
}

fn prior(text: &str, unit: &str, name: &str) -> Result<Prior, String> {
    let (mean, sd) = parse_uncertain(text, unit).map_err(|error| error.to_string())?;
    match sd {
        Some(sd) if sd > 0.0 => Ok(Prior { mean, sd }),
        Some(_) => Err(format!(
            "an uncertainty of zero holds {name} at a value; give it in the law instead: \
             law = \"LAW({name}=…)\""
        )),
        None => Err(
            "a prior is a value with its standard deviation, such as \"2.4e5 ± 0.3e5 N/m^1.5\""
                .to_owned(),
        ),
    }
}

/// Two texts on one parameter that contradict each other.
fn check(known: &Known) -> Result<(), String> {
    let (low, high) = known.range;
    if low >= high {
        return Err("its bounds exclude each other".to_owned());
    }
    match known.prior {
        Some(prior) if prior.mean < low || prior.mean > high => {
            Err("the mean of its prior lies outside of its bounds".to_owned())
        }
        _ => Ok(()),
    }
}

/// Refuses what is known of a nuisance that is held.
fn estimated_nuisance(name: &str, plan: &FitPlan) -> Result<(), String> {
    let options = &plan.options;
    let treatment = match name {
        "initial_velocity" => options.initial_velocity,
        "onset" => options.onset,
        _ => options.displacement_offset,
    };
    match treatment {
        Treatment::Fixed => Err(format!(
            "{name} is held, as the settings ask; remove one of the two"
        )),
        Treatment::Auto | Treatment::Free => Ok(()),
    }
}

/// Unit and allowed values of a parameter that is estimated.
fn parameter(
    law: &LawExpression,
    own: &KnownText,
    plan: &FitPlan,
) -> Result<(String, (f64, f64)), String> {
    let description = law.kind.describe();
    let named = description.parameters.iter().enumerate();
    let mut named = named.filter(|(_, parameter)| parameter.name == own.name);
    let (index, parameter) = named.next().ok_or_else(String::new)?;
    let name = parameter.name;
    if name == IMPACT_VELOCITY || name == MASS {
        return Err(format!(
            "{name} is that of each impact and is not estimated"
        ));
    }
    let asked = |name: &str| plan.free.iter().any(|free| free == name);
    if law.values[index].is_some() && !asked(name) {
        return Err(format!(
            "{law} holds {name} at a value; remove it there, or add free = [\"{name}\"]"
        ));
    }
    if own.kind == KnownKind::Bounds && parameter.default.is_some() && !is_free(plan, name) {
        return Err(format!(
            "{name} is held at its usual value; add free = [\"{name}\"] to estimate it"
        ));
    }
    let others = description.parameters.iter().filter(|other| {
        let unit = parameter.unit;
        let inside = unit.contains(&format!("^{}", other.name))
            || unit.contains(&format!("({}", other.name));
        inside && is_free(plan, other.name)
    });
    if let Some(other) = others.map(|other| other.name).next() {
        return Err(format!(
            "the unit of {name} depends on {other}, which is estimated too: what is known of \
             {name} has no meaning before {other} has a value"
        ));
    }
    let values = law.values_or_defaults();
    let unit = description
        .unit_of(index, &values)
        .ok_or_else(|| format!("the unit of {name} depends on an exponent without a value"))?;
    Ok((unit, (parameter.lower, parameter.upper)))
}

/// Whether a parameter is estimated although it has a usual value.
fn is_free(plan: &FitPlan, name: &str) -> bool {
    let mut priors = plan.known_texts.iter();
    plan.free.iter().any(|free| free == name)
        || priors.any(|own| own.kind == KnownKind::Prior && own.name == name)
}
