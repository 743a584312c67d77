//! The impacts of a campaign on all cores: recording → impact → fits.

use crate::campaign::{Campaign, ImpactEntry};
use crate::error::Error;
use crate::extract_recording::extract_recording;
use crate::fit_mass::RigFound;
use crate::fit_outcome::impact_outcome;
use crate::outcome::{FailureOutcome, ImpactOutcome};
use crate::pendulum_angles::add_angles;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use windfall_contact::expression::LawExpression;
use windfall_identify::fit::fit_impact;
use windfall_identify::problem::LawProblem;

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
    /// Why the recording cannot be read.
    pub problem: Option<String>,
}

/// Does the tasks, grouped by impact, and keeps their order.
///
/// Tasks whose key is in `stored` are answered from there. `progress` is called
/// with the impacts done and all impacts, from any thread.
pub fn fit_tasks(
    campaign: &Campaign,
    rig: &RigFound,
    tasks: &[FitTask],
    stored: &BTreeMap<String, ImpactOutcome>,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Vec<Result<ImpactOutcome, FailureOutcome>> {
    let groups: Vec<&[FitTask]> = tasks.chunk_by(|a, b| a.impact == b.impact).collect();
    let done = AtomicUsize::new(0);
    progress(0, groups.len());
    let results: Vec<Vec<Result<ImpactOutcome, FailureOutcome>>> = groups
        .par_iter()
        .map(|group| {
            let results = fit_group(campaign, rig, group, stored);
            progress(done.fetch_add(1, Ordering::Relaxed) + 1, groups.len());
            results
        })
        .collect();
    results.into_iter().flatten().collect()
}

/// The laws on one impact; its recording is read only if one of them is new.
fn fit_group(
    campaign: &Campaign,
    rig: &RigFound,
    group: &[FitTask],
    stored: &BTreeMap<String, ImpactOutcome>,
) -> Vec<Result<ImpactOutcome, FailureOutcome>> {
    let entry = &campaign.impacts[group[0].impact];
    let find = |task: &FitTask| task.key.as_ref().and_then(|key| stored.get(key));
    if let Some(problem) = &group[0].problem {
        let failure = failure(entry, None, problem.clone());
        return group.iter().map(|_| Err(failure.clone())).collect();
    }
    if group.iter().all(|task| find(task).is_some()) {
        return group.iter().filter_map(find).cloned().map(Ok).collect();
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
        .map(|task| match find(task) {
            Some(known) => Ok(known.clone()),
            None => {
                let law = &campaign.fit.laws[task.law];
                let problem = law_problem(law, &campaign.fit.free);
                fit_impact(&impact, &rig.rig, &problem, &campaign.fit.options)
                    .map(|fit| impact_outcome(entry, &impact, &findings, &fit, &problem, &rig.rig))
                    .map_err(|source| Error::Identify {
                        subject: law.kind.name().to_owned(),
                        source: Box::new(source),
                    })
                    .and_then(|mut outcome| {
                        add_angles(campaign, entry, &mut outcome)?;
                        Ok(outcome)
                    })
                    .map_err(|error| failure(entry, Some(law.kind.name()), error.to_string()))
            }
        })
        .collect()
}

/// The usual question about a law: exponents that are left out have their usual
/// values and are held, and the parameters named in `free` are estimated.
pub(crate) fn law_problem(law: &LawExpression, free: &[String]) -> LawProblem {
    let mut problem = LawProblem::from_expression(law);
    let parameters = law.kind.describe().parameters;
    for (parameter, is_free) in parameters.iter().zip(&mut problem.free) {
        *is_free |= free.iter().any(|name| name == parameter.name);
    }
    problem
}

fn failure(entry: &ImpactEntry, law: Option<&str>, message: String) -> FailureOutcome {
    FailureOutcome {
        id: entry.id.clone(),
        specimen: entry.specimen.clone(),
        file: entry.file.clone(),
        law: law.map(str::to_owned),
        message,
    }
}
