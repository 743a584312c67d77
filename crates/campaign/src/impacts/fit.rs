//! The impacts of a campaign on all cores: recording → impact → fits.

use crate::impacts::mass::RigFound;
use crate::recording::extract::extract_recording;
use crate::recording::pendulum_angles::add_angles;
use crate::result::fit_outcome::impact_outcome;
use crate::result::outcome::ImpactOutcome;
use crate::settings::model::{Campaign, ImpactEntry};
use std::collections::BTreeMap;
use windfall_contact::expression::LawExpression;
use windfall_files::error::Error;
use windfall_files::found::FailureOutcome;
use windfall_files::progress::{Progress, for_each};
use windfall_identify::fit::problem::LawProblem;
use windfall_identify::fit::result::fit_impact;
use windfall_identify::rig::kind::Rig;
use windfall_signal::Finding;
use windfall_signal::impact::Impact;

/// One law on one impact.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FitTask {
    /// Position in the campaign's impacts.
    pub impact: usize,
    /// Position in the campaign's laws.
    pub law: usize,
    /// Digest of everything that the result depends on; `None` when the
    /// recording cannot be read.
    pub key: Option<String>,
    /// Why there is nothing to fit: the recording cannot be read.
    pub problem: Option<String>,
}

/// Does the tasks, grouped by impact, and keeps their order.
///
/// Tasks whose key is in `stored` are answered from there. `progress` is called
/// with the impacts done and all impacts, from any thread.
///
/// # Errors
/// `progress` stopped the work.
pub fn fit_tasks(
    campaign: &Campaign,
    rig: &RigFound,
    tasks: &[FitTask],
    stored: &BTreeMap<String, ImpactOutcome>,
    progress: Progress,
) -> Result<Vec<Result<ImpactOutcome, FailureOutcome>>, Error> {
    let groups: Vec<&[FitTask]> = tasks.chunk_by(|a, b| a.impact == b.impact).collect();
    let results = for_each(progress, groups.len(), |group| {
        fit_group(campaign, rig, groups[group], stored)
    })?;
    Ok(results.into_iter().flatten().collect())
}

/// The laws on one impact; its recording is read only if one of them is new.
fn fit_group(
    campaign: &Campaign,
    rig: &RigFound,
    group: &[FitTask],
    stored: &BTreeMap<String, ImpactOutcome>,
) -> Vec<Result<ImpactOutcome, FailureOutcome>> {
    let entry = &campaign.impacts[group[0].impact];
    let settled = |task: &FitTask| match &task.problem {
        Some(problem) => Some(Err(failure(entry, None, problem.clone()))),
        None => {
            let known = task.key.as_ref().and_then(|key| stored.get(key));
            known.cloned().map(Ok)
        }
    };
    let known: Vec<_> = group.iter().map(settled).collect();
    if known.iter().all(Option::is_some) {
        return known.into_iter().flatten().collect();
    }
    let extracted = match extract_recording(campaign, entry, Some(rig.rig.effective_mass())) {
        Ok(extracted) => extracted,
        Err(error) => {
            let failure = failure(entry, None, error.to_string());
            return group.iter().map(|_| Err(failure.clone())).collect();
        }
    };
    let (impact, findings) = extracted;
    group
        .iter()
        .zip(known)
        .map(|(task, known)| {
            known.unwrap_or_else(|| {
                let law = &campaign.fit.laws[task.law];
                fit_law((campaign, &rig.rig), entry, (&impact, &findings), law)
                    .map_err(|error| failure(entry, Some(law.kind.name()), error.to_string()))
            })
        })
        .collect()
}

/// One law on one impact that has been cut out, with the options of its campaign.
///
/// # Errors
/// The law cannot be fitted to it.
pub fn fit_law(
    (campaign, rig): (&Campaign, &Rig),
    entry: &ImpactEntry,
    (impact, findings): (&Impact, &[Finding]),
    law: &LawExpression,
) -> Result<ImpactOutcome, Error> {
    let problem = law_problem(law, &campaign.fit.free);
    let mut options = campaign.fit.options;
    // Each impact its own chance, whatever the others are.
    options.intervals.seed = seed_of_name(options.intervals.seed, &entry.id);
    let fit = fit_impact(impact, rig, &problem, &options).map_err(|source| Error::Identify {
        subject: law.kind.name().to_owned(),
        source: Box::new(source),
    })?;
    let mut outcome = impact_outcome(entry, impact, findings, &fit, &problem, rig);
    add_angles(campaign, entry, &mut outcome)?;
    Ok(outcome)
}

/// A seed for each name (Fowler, Noll and Vo's hash, 1a).
fn seed_of_name(seed: u64, name: &str) -> u64 {
    name.bytes()
        .fold(seed ^ 0xcbf2_9ce4_8422_2325, |state, byte| {
            (state ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
        })
}

/// The usual question about a law: exponents that are left out have their usual
/// values and are held, and the parameters named in `free` are estimated.
pub fn law_problem(law: &LawExpression, free: &[String]) -> LawProblem {
    let mut problem = LawProblem::from_expression(law);
    let parameters = law.kind.describe().parameters;
    for (parameter, is_free) in parameters.iter().zip(&mut problem.free) {
        *is_free |= free.iter().any(|name| name == parameter.name);
    }
    problem
}

/// An entry, or one law on it, that could not be fitted.
#[must_use]
pub fn failure(entry: &ImpactEntry, law: Option<&str>, message: String) -> FailureOutcome {
    FailureOutcome {
        id: entry.id.clone(),
        specimen: entry.specimen.clone(),
        file: entry.file.clone(),
        law: law.map(str::to_owned),
        message,
    }
}
