//! A table, a mixed model and a term → a plan by simulation.

use crate::model::question::ModelQuestion;
use crate::model::request::ModelRequest;
use crate::model::simulate::Tested;
use crate::outcome::PlanOutcome;
use crate::parse::{finite, simulations};
use crate::run::plan;
use crate::study::{Coded, Study, read_study};
use crate::text::percent;
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::known_names::known_names;
use windfall_files::on_threads::on_threads;
use windfall_files::option_value::unusable;
use windfall_files::text::number::plain;
use windfall_files::text::statistic::number;

/// Plans a study by simulating from a fitted mixed model.
///
/// Studies are drawn from the fitted coefficients and variances, fitted again by restricted
/// likelihood, and the term is tested with Satterthwaite's degrees of freedom, as
/// `windfall regress` does.
///
/// # Errors
/// The table, the model or an option cannot be used; no study tells what is wanted.
///
/// # Source
/// Green and MacLeod (2016), SIMR, Methods Ecol. Evol. 7, 493.
pub fn plan_model(request: &ModelRequest) -> Result<PlanOutcome, Error> {
    simulations(request.simulation.simulations)?;
    let (study, _) = read_study(&request.table, &request.formula, &request.reading)?;
    let term = chosen_term(&study, request.term.as_deref())?;
    let coefficients = true_coefficients(&study, &request.effects)?;
    let (name, columns) = &study.told.terms[term];
    if columns.iter().all(|column| coefficients[*column] == 0.0) {
        let problem = format!("all coefficients of {name} are 0: there is nothing to be found");
        return Err(unusable("--effect", problem));
    }
    if columns.len() > 1 {
        check_single(request, name, columns.len())?;
    }
    let coefficient = match columns[..] {
        [column] => study
            .weights_of(column)
            .map(|weights| (weights, coefficients[column])),
        _ => None,
    };
    let tested = Tested {
        columns: tested_columns(&study.tested, name),
        coefficient,
    };
    let about = about(request, &study, term, &coefficients);
    let question = ModelQuestion {
        own_rows: request.plan.impacts.is_none(),
        simulation: request.simulation,
        findings: findings(&study),
        study,
        coefficients,
        tested,
        about,
    };
    on_threads(request.simulation.threads, || {
        plan(&question, &request.plan)
    })
}

/// Place of the term among those of the study.
fn chosen_term(study: &Study, wanted: Option<&str>) -> Result<usize, Error> {
    let names: Vec<&str> = study
        .told
        .terms
        .iter()
        .map(|(name, _)| name.as_str())
        .collect();
    match (wanted, names.len()) {
        (_, 0) => Err(unusable(
            "--formula",
            "the model has no term beside the mean: plan the mean with `windfall plan mean --from`",
        )),
        (None, 1) => Ok(0),
        (None, _) => Err(unusable(
            "--term",
            format!("say which term is to be found: {}", names.join(", ")),
        )),
        (Some(wanted), _) => names
            .iter()
            .position(|name| factors(name) == factors(wanted))
            .ok_or_else(|| {
                let known = known_names(wanted, names.iter().copied());
                unusable(
                    "--term",
                    format!("the model has no term \"{wanted}\"{known}"),
                )
            }),
    }
}

/// Columns of a term, sorted: V:variety is variety:V.
fn factors(term: &str) -> Vec<&str> {
    let mut factors: Vec<&str> = term.split(':').map(str::trim).collect();
    factors.sort_unstable();
    factors
}

/// Effect in residual standard deviations beyond which rounding hides the scatter.
const LARGEST_EFFECT: f64 = 1e9;

/// Fitted coefficients, those that are stated in their place.
fn true_coefficients(study: &Study, effects: &[String]) -> Result<Vec<f64>, Error> {
    let mut coefficients = study.fit.coefficients.clone();
    let mut stated = Vec::new();
    for text in effects {
        let wrong = |problem: &str| unusable(format!("--effect {text}"), problem);
        let expected = "expected COEFFICIENT=VALUE, as V=-0.3";
        let (name, value) = text.rsplit_once('=').ok_or_else(|| wrong(expected))?;
        let value: f64 = value.trim().parse().map_err(|_| wrong(expected))?;
        let value = finite("--effect", value)?;
        let names = &study.told.names;
        let place = names
            .iter()
            .position(|own| own == name.trim())
            .ok_or_else(|| {
                let known = known_names(name.trim(), names.iter().map(String::as_str));
                wrong(&format!("the model has no such coefficient{known}"))
            })?;
        if stated.contains(&place) {
            return Err(wrong(&format!("{} is stated twice", name.trim())));
        }
        let largest = study.told.x.column(place).amax() * value.abs();
        if largest > LARGEST_EFFECT * study.fit.residual_sd {
            return Err(wrong(&format!(
                "the effect is too large to calculate with: impacts scatter by {}",
                number(study.fit.residual_sd)
            )));
        }
        stated.push(place);
        coefficients[place] = value;
    }
    Ok(coefficients)
}

/// What a term of several coefficients cannot be asked.
fn check_single(request: &ModelRequest, name: &str, count: usize) -> Result<(), Error> {
    let problem = |what: &str| format!("{name} has {count} coefficients: {what}");
    if request.plan.one_sided {
        return Err(unusable(
            "--one-sided",
            problem("an F test of them has no sides"),
        ));
    }
    match request.plan.half_width {
        None => Ok(()),
        Some(_) => Err(unusable(
            "--half-width",
            problem("plan the power of their test"),
        )),
    }
}

fn tested_columns(tested: &Coded, name: &str) -> Vec<usize> {
    let found = tested.terms.iter().find(|(own, _)| own == name);
    found
        .map(|(_, columns)| columns.clone())
        .unwrap_or_default()
}

fn about(request: &ModelRequest, study: &Study, term: usize, coefficients: &[f64]) -> Vec<String> {
    let (name, columns) = &study.told.terms[term];
    let effects: Vec<String> = columns
        .iter()
        .map(|column| {
            format!(
                "{} = {}",
                study.told.names[*column],
                plain(coefficients[*column])
            )
        })
        .collect();
    let variances = study.fit.variances.iter().flat_map(|own| {
        let columns = own.columns.iter().zip(&own.sds);
        columns.map(|(column, sd)| format!("{column} {}", number(*sd)))
    });
    let variances: Vec<String> = variances.collect();
    let sides = if request.plan.one_sided {
        "one-sided"
    } else {
        "two-sided"
    };
    vec![
        format!("{name} in {}: {}", request.formula, effects.join(", ")),
        format!(
            "SD between {}: {}; residual {}; {} {} with {} impacts in {}",
            study.by,
            variances.join(", "),
            number(study.fit.residual_sd),
            study.fruit.len(),
            study.by,
            study.told.x.nrows(),
            request.table.display()
        ),
        format!(
            "{} simulated studies of each size (seed {}), Satterthwaite's test at {}, {sides}; \
             in brackets the 95 % interval of the simulation",
            request.simulation.simulations,
            request.simulation.seed,
            percent(1.0 - request.plan.confidence)
        ),
    ]
}

/// What the fit of the table says against planning by it.
fn findings(study: &Study) -> Vec<FindingOutcome> {
    let mut findings: Vec<FindingOutcome> = Vec::new();
    for own in &study.fit.findings {
        findings.push(FindingOutcome::new(own.code(), own.to_string()));
    }
    if study.fit.variances.iter().any(|own| own.sds.contains(&0.0)) {
        findings.push(FindingOutcome::new(
            "no-variance-between",
            format!(
                "the table shows no variance between {0}: the plan takes impacts on one {0} for \
                 as good as impacts on as many; state variances, `windfall plan difference \
                 --between … --within …`, to be safe",
                study.by
            ),
        ));
    }
    findings
}
