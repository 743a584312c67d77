//! Random groups of runs: which columns tell them, and what they say of a surface.

use crate::design::file::WHOLE_PLOT;
use crate::regress::findings::finding;
use crate::regress::mixed_figures::{MixedShown, mixed_paintings};
use crate::regress::mixed_variances::variances;
use crate::regress::run::random_text;
use crate::surface::fitted::ResponseSurface;
use crate::surface::outcome::{RandomOutcome, SurfaceModel};
use crate::surface::request::SurfaceRequest;
use windfall_draw::files::{Painting, file_name};
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::option_value::unusable;
use windfall_files::table::data::Data;
use windfall_mixed::error::MixedError;
use windfall_mixed::fit::MixedMethod;
use windfall_mixed::profile::{Profiles, profile_variances};
use windfall_mixed::summary::variance_shares;
use windfall_mixed::term::RandomTerm;
use windfall_statistics::error::Error as StatisticsError;
use windfall_statistics::model::anova::AnovaType;
use windfall_statistics::model::contrast::Contrast;
use windfall_statistics::model::formula::{Formula, formula};
use windfall_statistics::model::linear_model::WholeModel;
use windfall_statistics::model::random_terms::random_terms;
use windfall_statistics::surface::analysis::Surface;
use windfall_statistics::surface::random_groups::RandomGroups;

/// The word for no random groups.
const NONE: &str = "none";

/// Random parts as a formula without a response; `None` where runs are in no random groups.
///
/// # Errors
/// A part that cannot be read, whose slopes vary, or that names no column, a factor or a response.
pub(crate) fn random_parts(
    request: &SurfaceRequest,
    factors: &[String],
    data: &Data,
) -> Result<Option<Formula>, Error> {
    let given = match &request.random[..] {
        [] => plots(request, factors, data),
        [only] if only == NONE && data.table.column(NONE).is_err() => Vec::new(),
        given => given.to_vec(),
    };
    if given.is_empty() {
        return Ok(None);
    }
    if request.anova != AnovaType::Partial {
        let problem = "with random groups each term is tested after all others: leave the type out";
        return Err(unusable("--anova", problem));
    }
    let names: Vec<String> = data.table.columns.iter().map(|c| c.name.clone()).collect();
    let texts: String = given.iter().map(|own| random_text(own, &names)).collect();
    let wrong = |problem: &str| unusable(format!("--random '{}'", given.join("' '")), problem);
    let found = formula(&format!("~ 1{texts}"), &names).map_err(Error::Statistics)?;
    for part in &found.random {
        if !part.terms.is_empty() || !part.intercept {
            return Err(wrong(
                "the means of groups alone can vary in a response surface; give their column, as \
                 day or day/whole_plot, or use windfall regress",
            ));
        }
        for group in &part.groups {
            data.table.column(group).map_err(|error| data.told(error))?;
            if factors.contains(group) || request.responses.contains(group) {
                return Err(wrong(&format!("{group} is a factor or a response")));
            }
            if request.block.as_ref() == Some(group) {
                return Err(wrong(&format!(
                    "{group} is given to --block, too: blocks are fixed or random"
                )));
            }
        }
    }
    Ok(Some(found))
}

/// The whole plots of a table, where its column tells several of several runs.
pub fn plots(request: &SurfaceRequest, factors: &[String], data: &Data) -> Vec<String> {
    let name = WHOLE_PLOT.to_owned();
    let used = factors.contains(&name)
        || request.responses.contains(&name)
        || request.block.as_ref() == Some(&name);
    let column = data.table.column(&name).ok().filter(|_| !used);
    let levels = column.map_or(0, |own| own.cells.categories().levels.len());
    match (2..data.table.rows()).contains(&levels) {
        true => vec![name],
        false => Vec::new(),
    }
}

/// Says that whole plots are taken for single runs, where the groups leave them out.
///
/// * `grouped`: columns that name the groups
pub(crate) fn plots_finding(
    request: &SurfaceRequest,
    factors: &[String],
    grouped: &[String],
    data: &Data,
) -> Option<FindingOutcome> {
    let plots = plots(request, factors, data);
    let left = plots.first().filter(|own| !grouped.contains(own))?;
    Some(finding(
        "whole-plots-left-out",
        format!(
            "the column {left} says that runs were made in whole plots, and the model takes them \
             for independent: factors that are set once for each plot look more certain than they \
             are; add --random {left}, or day/{left} where plots are made on several days"
        ),
    ))
}

/// Columns that name the groups.
pub(crate) fn group_columns(parts: Option<&Formula>) -> Vec<String> {
    let parts = parts.iter().flat_map(|own| &own.random);
    parts.flat_map(|part| part.groups.clone()).collect()
}

/// The random terms of a table without missing cells.
///
/// # Errors
/// Groups that are none.
pub(crate) fn terms_of_parts(parts: &Formula, data: &Data) -> Result<Vec<RandomTerm>, Error> {
    let framed = random_terms(parts, &data.table, Contrast::Treatment);
    let framed = framed.map_err(|error| data.told(error))?;
    Ok(framed.into_iter().map(|own| own.term).collect())
}

/// Says that coefficients and errors reckon with random groups.
pub(crate) fn random_finding(terms: &[RandomTerm]) -> FindingOutcome {
    let groups = terms
        .iter()
        .map(|own| format!("{} {}", own.groups, own.name));
    let groups: Vec<String> = groups.collect();
    finding(
        "random-groups",
        format!(
            "runs are in random groups ({}): coefficients are estimated by restricted maximum \
             likelihood, with Kenward and Roger's errors and degrees of freedom; surfaces, optimum \
             and figures are those of the mean group (--random none ignores the groups)",
            groups.join(", ")
        ),
    )
}

fn mixed(error: MixedError) -> Error {
    Error::Statistics(StatisticsError::Mixed(error))
}

fn profiles(random: &RandomGroups, confidence: f64) -> Result<Profiles, Error> {
    profile_variances(&random.fit, MixedMethod::Reml, confidence).map_err(mixed)
}

/// What the random groups of a surface are, the test of its model, and what is to be said.
///
/// # Errors
/// Variances without profiles.
pub(crate) fn random_outcome(
    surface: &Surface,
    random: &RandomGroups,
    confidence: f64,
) -> Result<(RandomOutcome, WholeModel, Vec<FindingOutcome>), Error> {
    let (variances, mut findings) = variances(&random.fit, &profiles(random, confidence)?);
    let own = random
        .fit
        .findings
        .iter()
        .chain(&random.uncertainty.findings);
    findings.extend(own.map(|found| finding(found.code(), found.to_string())));
    let terms: Vec<usize> = (1..surface.coded.len()).collect();
    let test = random.test(&terms);
    let shares = variance_shares(&random.fit);
    let groups = random.terms.iter();
    let outcome = RandomOutcome {
        groups: groups.map(|own| (own.name.clone(), own.groups)).collect(),
        method: "REML",
        df_method: "Kenward-Roger",
        model_df_denominator: test.as_ref().map_or(f64::NAN, |own| own.denominator),
        variances,
        r2_conditional: shares.r2_conditional,
        intraclass: shares.intraclass,
    };
    let model = WholeModel {
        ss: f64::NAN,
        df: test.as_ref().map_or(0.0, |own| own.numerator as f64),
        f: test.as_ref().map_or(f64::NAN, |own| own.f),
        p: test.as_ref().map_or(f64::NAN, |own| own.p),
    };
    Ok((outcome, model, findings))
}

/// Residuals, groups and variances of a surface with random groups; none without.
///
/// * `lines`: of the runs in the file
///
/// # Errors
/// Variances without profiles.
pub(crate) fn random_paintings(
    response: &ResponseSurface,
    model: &SurfaceModel,
    lines: &[usize],
    confidence: f64,
) -> Result<Vec<Painting>, Error> {
    let Some(random) = &response.surface.random else {
        return Ok(Vec::new());
    };
    let fit = &random.fit;
    let observed = fit.fitted.iter().zip(&fit.residuals);
    let observed: Vec<f64> = observed.map(|(fitted, left)| fitted + left).collect();
    let mut paintings = mixed_paintings(&MixedShown {
        response: &model.response,
        observed: &observed,
        lines,
        terms: &random.terms,
        fit,
        profiles: &profiles(random, confidence)?,
        confidence,
    })?;
    for painting in &mut paintings {
        let kind = match painting.name.as_str() {
            "diagnostics" => "model",
            kind => kind,
        };
        painting.name = file_name(&format!("{kind}-{}", model.response));
    }
    Ok(paintings)
}
