//! Recording → impact → fits of the laws.

use crate::impacts::failed_fit::{found_before, why_it_failed};
use crate::impacts::key::{CommonKey, impact_key, run_options};
use crate::impacts::mass::RigFound;
use crate::pipeline::evaluate::{Evaluation, evaluate, failure};
use crate::recording::extract::extract_recording;
use crate::recording::pendulum_angles::add_angles;
use crate::result::counted::left_out_under_all_laws;
use crate::result::fit_outcome::impact_outcome;
use crate::result::outcome::ImpactOutcome;
use crate::settings::model::{Campaign, FitPlan, ImpactCampaign, ImpactEntry};
use serde_json::{Map, Value};
use windfall_contact::expression::LawExpression;
use windfall_files::error::Error;
use windfall_files::found::FailureOutcome;
use windfall_files::progress::Progress;
use windfall_identify::fit::problem::{FitOptions, LawProblem};
use windfall_identify::fit::result::fit_impact;
use windfall_identify::rig::kind::Rig;
use windfall_signal::Finding;
use windfall_signal::impact::Impact;

/// The laws of a campaign on each of its impacts.
pub struct Fits<'a> {
    /// The campaign.
    pub campaign: &'a ImpactCampaign,
    /// Its rig.
    pub rig: &'a RigFound,
    /// What the keys of all fits have in common.
    common: CommonKey,
}

impl<'a> Fits<'a> {
    /// Of a campaign on its rig.
    pub fn new(campaign: &'a ImpactCampaign, rig: &'a RigFound) -> Self {
        let common = CommonKey::of(campaign, &rig.rig);
        Self {
            campaign,
            rig,
            common,
        }
    }
}

impl Evaluation for Fits<'_> {
    type Found = ImpactOutcome;

    fn campaign(&self) -> &Campaign {
        &self.campaign.shared
    }

    fn parts(&self) -> usize {
        self.campaign.fit.laws.len()
    }

    fn key(&self, entry: &ImpactEntry, part: usize, recording: &str) -> String {
        let law = &self.campaign.fit.laws[part];
        impact_key(self.campaign, entry, law, &self.common, recording)
    }

    /// The recording is read only if one of the laws is new.
    fn evaluate(
        &self,
        entry: &ImpactEntry,
        known: Vec<Option<ImpactOutcome>>,
    ) -> Vec<Result<ImpactOutcome, Box<FailureOutcome>>> {
        let (campaign, rig) = (self.campaign, &self.rig.rig);
        let group = campaign.shared.group_of(entry);
        let grouped = |outcome: ImpactOutcome| ImpactOutcome {
            group: group.clone(),
            ..outcome
        };
        if known.iter().all(Option::is_some) {
            let known = known.into_iter().flatten();
            return known.map(|outcome| Ok(grouped(outcome))).collect();
        }
        let extracted = extract_recording(campaign, entry, Some(rig.effective_mass()))
            .map_err(|error| failure(entry, None, error.to_string()));
        let laws = campaign.fit.laws.iter().zip(known);
        laws.map(|(law, known)| match (known, &extracted) {
            (Some(outcome), _) => Ok(grouped(outcome)),
            (None, Err(failure)) => Err(failure.clone()),
            (None, Ok((impact, findings))) => {
                fit_law((campaign, rig), entry, (impact, findings), law)
                    .map(grouped)
                    .map_err(|error| {
                        let told = why_it_failed(&error, impact, findings);
                        let mut failure = failure(entry, Some(law.kind.name()), told);
                        failure.findings = found_before(impact, findings);
                        failure
                    })
            }
        })
        .collect()
    }

    fn options(&self) -> Map<String, Value> {
        run_options(self.campaign)
    }
}

/// The impacts of a campaign as they are fitted, and those that do not count under any of its
/// laws, with the reasons. Nothing is stored.
///
/// # Errors
/// `progress` stopped the work.
pub fn impacts_and_left_out(
    campaign: &ImpactCampaign,
    rig: &RigFound,
    progress: Progress,
) -> Result<(Vec<ImpactOutcome>, Vec<FailureOutcome>), Error> {
    let evaluated = evaluate(&Fits::new(campaign, rig), None, progress)?;
    let items = evaluated.items.into_iter();
    let mut impacts: Vec<ImpactOutcome> = items.map(|(_, impact)| impact).collect();
    let shared = &campaign.shared;
    let left_out = left_out_under_all_laws(shared, &rig.rig, &mut impacts);
    Ok((impacts, left_out))
}

/// One law on one impact that has been cut out, with the options of its campaign.
///
/// # Errors
/// The law cannot be fitted to it.
pub fn fit_law(
    (campaign, rig): (&ImpactCampaign, &Rig),
    entry: &ImpactEntry,
    (impact, findings): (&Impact, &[Finding]),
    law: &LawExpression,
) -> Result<ImpactOutcome, Error> {
    let problem = law_problem(law, &campaign.fit);
    let options = options_of(campaign, entry);
    let fit = fit_impact(impact, rig, &problem, &options)
        .map_err(|source| Error::identify(law.kind.name(), source))?;
    let mut outcome = impact_outcome(
        entry,
        impact,
        findings,
        &fit,
        &problem,
        (rig, &options.bench),
    );
    add_angles(campaign, entry, &mut outcome)?;
    Ok(outcome)
}

/// How one impact is fitted: each has its own chance, whatever the others are.
pub(crate) fn options_of(campaign: &ImpactCampaign, entry: &ImpactEntry) -> FitOptions {
    let mut options = campaign.fit.options;
    options.intervals.seed = seed_of_name(options.intervals.seed, &entry.id);
    options
}

/// A seed for each name (Fowler, Noll and Vo's hash, 1a).
fn seed_of_name(seed: u64, name: &str) -> u64 {
    name.bytes()
        .fold(seed ^ 0xcbf2_9ce4_8422_2325, |state, byte| {
            (state ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
        })
}

/// The usual question about a law: exponents that are left out have their usual
/// values and are held, and the parameters that a plan frees or has priors of are estimated.
pub fn law_problem(law: &LawExpression, plan: &FitPlan) -> LawProblem {
    let mut problem = LawProblem::from_expression(law);
    let known = plan.known.iter().filter(|(kind, _)| *kind == law.kind);
    problem.known = known.map(|(_, known)| known.clone()).collect();
    for (i, parameter) in law.kind.describe().parameters.iter().enumerate() {
        let known = problem.known(parameter.name);
        problem.free[i] |= plan.free.iter().any(|name| name == parameter.name)
            || known.is_some_and(|known| known.prior.is_some());
    }
    problem
}
