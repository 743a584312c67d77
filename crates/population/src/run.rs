//! `windfall population`: how the law's parameters vary between fruit and with
//! covariates.

use crate::covariates::find_covariates;
use crate::detail::draws_document;
use crate::draws_table::DrawsTable;
use crate::outcome::{
    FruitOutcome, PopulationOutcome, Varying, correlations_of, effects_of, parameters_of,
    population_of, posterior_outcome, two_stage_outcome,
};
use rayon::prelude::*;
use serde_json::Value;
use std::cell::Cell;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use windfall_campaign::impacts::answer::{Question, answer};
use windfall_campaign::impacts::bench::find_rig;
use windfall_campaign::impacts::card::add_outer;
use windfall_campaign::impacts::fit::{impacts_and_left_out, law_problem};
use windfall_campaign::impacts::mass::RigFound;
use windfall_campaign::pipeline::evaluate::failure;
use windfall_campaign::pipeline::request::{FitRequest, Reuse, apply_request};
use windfall_campaign::recording::extract::extract_recording;
use windfall_campaign::result::outcome::ImpactOutcome;
use windfall_campaign::result::summary::common_moves;
use windfall_campaign::settings::model::{ImpactCampaign, ImpactEntry};
use windfall_campaign::settings::read::read_campaign;
use windfall_contact::expression::LawExpression;
use windfall_files::error::Error;
use windfall_files::found::{FailureOutcome, FindingOutcome};
use windfall_files::on_threads::on_threads;
use windfall_files::progress::{Progress, for_each};
use windfall_files::provenance::VERSION;
use windfall_files::sheet::form::Form;
use windfall_files::sheet::write::write_rows;
use windfall_files::write_file::{check_outputs, write_whole};
use windfall_identify::fit::problem::LawProblem;
use windfall_identify::population::finding::PopulationFinding;
use windfall_identify::population::fit::fit_population;
use windfall_identify::population::likelihood::{
    DRAWN_REACH, ImpactLikelihood, NORMAL_REACH, impact_likelihood,
};
use windfall_identify::population::model::{
    Covariate, PopulationData, PopulationFit, PopulationOptions,
};
use windfall_identify::population::posterior::population_posterior;
use windfall_identify::population::two_stage::two_stage;

/// Inputs of [`population`].
#[derive(Clone, Debug, Default)]
pub struct PopulationRequest {
    /// The campaign directory.
    pub directory: PathBuf,
    /// Law and fit options that override the campaign's, and threads.
    pub fit: FitRequest,
    /// Covariates in place of those of the campaign; none keeps them.
    pub covariates: Vec<String>,
    /// Whether the posterior is drawn beside the estimate: chains, draws and seed
    /// as of the campaign's intervals.
    pub posterior: bool,
    /// Where the posterior's draws are written.
    pub detail: Option<PathBuf>,
    /// Where a law card of the population is written.
    pub card: Option<PathBuf>,
}

/// An impact that takes part.
struct Member<'a> {
    entry: &'a ImpactEntry,
    likelihood: ImpactLikelihood,
    velocity: f64,
}

/// Estimates the population of a campaign's fruit with the campaign's first law.
///
/// Impacts whose fit is too uncertain, or whose covariates are blank, are left
/// out and named in the outcome. The result has the same bits for any number of
/// threads.
///
/// # Errors
/// The campaign or the request is wrong, or too few impacts are left.
pub fn population(
    request: &PopulationRequest,
    progress: Progress,
) -> Result<PopulationOutcome, Error> {
    let mut campaign = read_campaign(&request.directory)?;
    check_outputs([request.card.as_deref(), request.detail.as_deref()])?;
    apply_request(&mut campaign, &request.fit)?;
    if !request.covariates.is_empty() {
        campaign.covariates.clone_from(&request.covariates);
    }
    on_threads(request.fit.threads, || {
        let priors = campaign.fit.without_priors();
        let rig = find_rig(&mut campaign)?;
        let question = Question {
            campaign: &campaign,
            rig: &rig,
            command: "population",
            options: format!("posterior: {}", request.posterior),
        };
        let mut draws = None;
        let work = || {
            let (outcome, own) = estimate(&campaign, &rig, request.posterior, progress)?;
            draws = own;
            Ok(outcome)
        };
        // Draws are not kept with the answer: the same seed draws them again.
        let reuse = match request.detail {
            Some(_) => Reuse::Nothing,
            None => request.fit.reuse,
        };
        let (mut outcome, told) = answer(&question, reuse, work)?;
        if let (Some(path), Some(draws)) = (&request.detail, draws) {
            write_draws(path, &draws)?;
        }
        outcome.findings.extend(told);
        outcome.findings.extend(priors);
        Ok(outcome)
    })
}

/// Writes draws: as a table where the file's name ends like one, else as JSON.
fn write_draws(path: &Path, draws: &Value) -> Result<(), Error> {
    match Form::of_path("--detail", path) {
        Ok(form) => {
            let table = DrawsTable::new(draws);
            write_rows(path, form, &table.schema, table.rows())
        }
        Err(_) => write_whole(path, format!("{draws}\n").as_bytes()),
    }
}

/// The population, with the draws of its posterior if these are wanted.
fn estimate(
    campaign: &ImpactCampaign,
    rig: &RigFound,
    posterior: bool,
    progress: Progress,
) -> Result<(PopulationOutcome, Option<Value>), Error> {
    let law = &campaign.fit.laws[0];
    let problem = law_problem(law, &campaign.fit);
    let mut first = campaign.clone();
    first.fit.laws.truncate(1);
    let (impacts, mut failed) = impacts_and_left_out(&first, rig, progress)?;
    let left_out: BTreeSet<String> = failed.iter().map(|own| own.id.clone()).collect();
    let entries = campaign.shared.entries.iter();
    first.shared.entries = entries
        .filter(|own| !left_out.contains(&own.id))
        .cloned()
        .collect();
    let (members, unusable) = members(&first, rig, &problem, progress)?;
    failed.extend(unusable);
    if members.is_empty() {
        return Err(Error::NothingFitted {
            path: campaign.shared.directory.clone(),
            failures: failed,
        });
    }
    let entries: Vec<&ImpactEntry> = members.iter().map(|member| member.entry).collect();
    let velocities: Vec<f64> = members.iter().map(|member| member.velocity).collect();
    let found = find_covariates(campaign, &entries, &velocities, &campaign.covariates)?;
    for (i, reason) in &found.left_out {
        failed.push(*failure(entries[*i], None, reason.clone()));
    }
    let members: Vec<&Member> = found.kept.iter().map(|&i| &members[i]).collect();
    let varying = varying(law, &problem);
    let (data, specimens) = data(&members, &varying, found.covariates);
    let starts: Vec<Vec<f64>> = members.iter().map(|m| m.likelihood.estimate()).collect();
    let expand_beyond = |reach: f64, points: &[Vec<f64>]| {
        let own = members.par_iter().zip(points);
        own.map(|(member, at)| member.likelihood.expand_beyond(reach, at))
            .collect()
    };
    let expand = |points: &[Vec<f64>]| expand_beyond(NORMAL_REACH, points);
    let options = PopulationOptions {
        confidence: campaign.fit.options.confidence,
        ..PopulationOptions::default()
    };
    let subject = |source| Error::identify(format!("population of {}", law.kind.name()), source);
    let mut fit = fit_population(&data, &starts, &expand, &options).map_err(subject)?;
    let stages = two_stage(&data, &starts, options.confidence).map_err(subject)?;
    let posterior = match posterior {
        false => None,
        true => {
            let drawing = campaign.fit.options.intervals.drawing();
            let expand = |points: &[Vec<f64>]| expand_beyond(DRAWN_REACH, points);
            // The sampler does not stop halfway: what it gave is then not used.
            let stopped = Cell::new(false);
            let report = |done, all| stopped.set(progress(done, all).is_break());
            let found = population_posterior(&data, &fit, &expand, &options, &drawing, &report);
            if stopped.get() {
                return Err(Error::Cancelled);
            }
            Some(found.map_err(subject)?)
        }
    };
    add_bench(&mut fit, &impacts, &varying);
    let mut findings = findings(campaign, rig, &fit, &specimens);
    let remarks = posterior.iter().flat_map(|posterior| posterior.findings());
    findings.extend(remarks.map(|finding| population_finding(&finding)));
    let method = "REML, Laplace";
    let draws = posterior.as_ref();
    let draws = draws.map(|found| draws_document(found, &fit, &varying));
    let outcome = PopulationOutcome {
        windfall: VERSION.to_owned(),
        campaign: campaign.shared.title.clone(),
        simulated: campaign.shared.simulated.clone(),
        law: law.kind.name().to_owned(),
        method: method.to_owned(),
        fruits: fit.fruit.len(),
        impacts: members.len(),
        parameters: parameters_of(&fit, &varying),
        correlations: correlations_of(&fit),
        effects: effects_of(&fit.effects, &fit.covariates),
        two_stage: two_stage_outcome(&stages, &varying, &fit.covariates),
        log_likelihood: fit.log_likelihood,
        shift_from_fits: fit.shift_from_fits,
        shift_from_first_order: fit.shift_from_first_order,
        converged: fit.converged,
        fruit: fruit(&fit, &data, &specimens, &varying),
        population: population_of(&fit, &varying, method),
        posterior: posterior.map(|found| posterior_outcome(&found, &fit, &varying)),
        findings,
        failed,
    };
    Ok((outcome, draws))
}

/// Adds what is uncertain of the bench to the medians of all fruit, undivided.
fn add_bench(fit: &mut PopulationFit, impacts: &[ImpactOutcome], varying: &[Varying]) {
    let counted: Vec<&ImpactOutcome> = impacts.iter().filter(|own| own.counts()).collect();
    let of = |own: &Varying| (own.name.clone(), own.logarithmic);
    let names: Vec<(String, bool)> = varying.iter().map(of).collect();
    let names: Vec<(&str, bool)> = names.iter().map(|own| (own.0.as_str(), own.1)).collect();
    for moved in common_moves(&counted, &names) {
        let of_effects = fit.effects.iter().map(|effect| {
            let median = effect.covariate.is_none();
            let place = varying.iter().position(|own| own.name == effect.parameter);
            place.filter(|_| median).map_or(0.0, |place| moved[place])
        });
        let of_effects: Vec<f64> = of_effects.collect();
        add_outer(&mut fit.effects_covariance, &of_effects);
        for (effect, moved) in fit.effects.iter_mut().zip(of_effects) {
            let wider = effect.se.hypot(moved) / effect.se;
            if wider.is_finite() {
                effect.se *= wider;
                effect.low = effect.value - (effect.value - effect.low) * wider;
                effect.high = effect.value + (effect.high - effect.value) * wider;
            }
        }
    }
}

/// The likelihoods of all impacts that have one, and why the others have none.
fn members<'a>(
    campaign: &'a ImpactCampaign,
    rig: &RigFound,
    problem: &LawProblem,
    progress: Progress,
) -> Result<(Vec<Member<'a>>, Vec<FailureOutcome>), Error> {
    let found = for_each(progress, campaign.shared.entries.len(), |item| {
        let entry = &campaign.shared.entries[item];
        member(campaign, rig, problem, entry)
            .map_err(|error| failure(entry, None, error.to_string()))
    })?;
    let (mut members, mut failed) = (Vec::new(), Vec::new());
    for result in found {
        match result {
            Ok(member) => members.push(member),
            Err(failure) => failed.push(*failure),
        }
    }
    Ok((members, failed))
}

fn member<'a>(
    campaign: &ImpactCampaign,
    rig: &RigFound,
    problem: &LawProblem,
    entry: &'a ImpactEntry,
) -> Result<Member<'a>, Error> {
    let (impact, _) = extract_recording(campaign, entry, Some(rig.rig.effective_mass()))?;
    let options = &campaign.fit.options;
    let likelihood = impact_likelihood(&impact, &rig.rig, problem, options);
    let likelihood = likelihood.map_err(|source| Error::identify(problem.kind.name(), source))?;
    Ok(Member {
        entry,
        velocity: impact
            .measured
            .impact_velocity
            .unwrap_or(likelihood.velocity()),
        likelihood,
    })
}

fn varying(law: &LawExpression, problem: &LawProblem) -> Vec<Varying> {
    let parameters = law.kind.describe().parameters;
    let own = problem.free_positions().map(|i| Varying {
        name: parameters[i].name.to_owned(),
        unit: unit_of(problem, i),
        logarithmic: parameters[i].unit != "1",
    });
    own.collect()
}

/// Unit of a parameter, with the exponent that the law has.
fn unit_of(problem: &LawProblem, position: usize) -> String {
    let parameters = problem.kind.describe().parameters;
    let values = parameters.iter().zip(&problem.values);
    let values: Vec<f64> = values
        .map(|(p, v)| v.or(p.default).unwrap_or(1.0))
        .collect();
    match problem.kind.with_parameters(&values) {
        Ok(law) => law.unit_of(position),
        Err(_) => parameters[position].unit.to_owned(),
    }
}

/// The data, and the specimens in the order of their numbers.
fn data(
    members: &[&Member],
    varying: &[Varying],
    covariates: Vec<Covariate>,
) -> (PopulationData, Vec<String>) {
    let mut specimens: Vec<String> = Vec::new();
    let fruit = members.iter().map(|member| {
        let specimen = &member.entry.specimen;
        match specimens.iter().position(|known| known == specimen) {
            Some(index) => index,
            None => {
                specimens.push(specimen.clone());
                specimens.len() - 1
            }
        }
    });
    let fruit = fruit.collect();
    let data = PopulationData {
        parameters: varying.iter().map(|v| v.name.clone()).collect(),
        fruit,
        covariates,
    };
    (data, specimens)
}

fn fruit(
    fit: &PopulationFit,
    data: &PopulationData,
    specimens: &[String],
    varying: &[Varying],
) -> Vec<FruitOutcome> {
    let own = specimens.iter().zip(&fit.fruit).enumerate();
    own.map(|(i, (specimen, phi))| FruitOutcome {
        specimen: specimen.clone(),
        impacts: data.fruit.iter().filter(|fruit| **fruit == i).count(),
        parameters: varying
            .iter()
            .zip(phi)
            .map(|(v, phi)| v.value(*phi))
            .collect(),
    })
    .collect()
}

fn findings(
    campaign: &ImpactCampaign,
    rig: &RigFound,
    fit: &PopulationFit,
    specimens: &[String],
) -> Vec<FindingOutcome> {
    let mut out = rig.findings.clone();
    let mut lost: Vec<&str> = campaign
        .shared
        .entries
        .iter()
        .map(|i| i.specimen.as_str())
        .collect();
    lost.sort_unstable();
    lost.dedup();
    lost.retain(|id| !specimens.iter().any(|known| known == id));
    if !lost.is_empty() {
        let message = format!("no usable impact: {}", lost.join(", "));
        out.push(FindingOutcome::new("fruit-left-out", message));
    }
    if campaign.fit.laws.len() > 1 {
        let message = format!(
            "the campaign fits {} laws; the population is that of the first, {} (choose with --law)",
            campaign.fit.laws.len(),
            campaign.fit.laws[0].kind.name()
        );
        out.push(FindingOutcome::new("first-law", message));
    }
    out.extend(fit.findings.iter().map(population_finding));
    out
}

fn population_finding(finding: &PopulationFinding) -> FindingOutcome {
    FindingOutcome::new(finding.code(), finding.to_string())
}
