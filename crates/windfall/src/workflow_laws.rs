//! `windfall laws`: which law the impacts of a campaign obey.

use crate::campaign::{Campaign, ImpactEntry};
use crate::error::Error;
use crate::extract_recording::extract_recording;
use crate::fit_impact::{failure, law_problem};
use crate::fit_mass::{RigFound, find_rig};
use crate::on_threads::on_threads;
use crate::outcome::{FailureOutcome, FindingOutcome};
use crate::progress::{Progress, for_each};
use crate::provenance::VERSION;
use crate::read_campaign::read_campaign;
use crate::request_fit::{FitRequest, apply_request};
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::Path;
use windfall_contact::expression::parse_law;
use windfall_identify::error::Error as IdentifyError;
use windfall_identify::law_ranking::{
    ImpactFit, LawEvidence, LawRanking, LeveledImpact, Verdict, fits_of_impact, rank_laws,
    velocity_levels,
};
use windfall_identify::problem::LawProblem;

/// Laws that are compared when none are named: one of each form.
pub const COMPARED: [&str; 6] = [
    "hertz",
    "kelvin-voigt",
    "kuwabara-kono",
    "hunt-crossley",
    "tsuji",
    "walton-braun",
];
/// Column of impacts.csv with the velocity level.
const LEVEL_COLUMN: &str = "level";
/// Velocities that differ by more than this part belong to different levels,
/// where no column says so; 1.
const LEVEL_GAP: f64 = 0.08;

/// What `windfall laws` gives.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LawsOutcome {
    /// Version of windfall.
    pub windfall: String,
    /// Title of the campaign.
    pub campaign: String,
    /// Label of simulated recordings.
    pub simulated: Option<String>,
    /// Impacts on which all laws are compared.
    pub impacts: usize,
    /// Velocity levels among them.
    pub levels: usize,
    /// One word: "sure", "undecided" or "divided".
    pub verdict: &'static str,
    /// What the verdict means, in a sentence.
    pub meaning: String,
    /// Laws, the best first.
    pub laws: Vec<LawEvidenceOutcome>,
    /// How many specimens each law is first for, in the order of `laws`.
    pub specimens_first: Vec<usize>,
    /// Recordings that took no part.
    pub failed: Vec<FailureOutcome>,
    /// What a reader must know.
    pub findings: Vec<FindingOutcome>,
}

/// Evidence for one law.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LawEvidenceOutcome {
    /// The law.
    pub law: String,
    /// Impacts that it could not be fitted to.
    pub failed: usize,
    /// Free parameters of an impact.
    pub parameters_per_impact: f64,
    /// −2 ln likelihood relative to the best law.
    pub cost: f64,
    /// AICc relative to the best law.
    pub aicc: f64,
    /// BIC relative to the best law.
    pub bic: f64,
    /// Share of resampled campaigns in which it is first.
    pub first_share: f64,
    /// Error of forces foretold for unseen velocities, over the peak.
    pub prediction: Option<f64>,
    /// Its standard error.
    pub prediction_sd: Option<f64>,
    /// Largest residual over noise of a channel, mean over impacts.
    pub residual_ratio: f64,
    /// Runs-test score of the worst channel, mean over impacts.
    pub runs_z: f64,
}

/// Ranks laws over the impacts of a campaign: those of the request, those of the
/// campaign if it names at least two, else [`COMPARED`].
///
/// # Errors
/// The campaign or the request is wrong, or nothing can be compared. A recording
/// that cannot be used is reported in the outcome.
pub fn rank_campaign(
    directory: &Path,
    request: &FitRequest,
    progress: Progress,
) -> Result<LawsOutcome, Error> {
    let mut campaign = read_campaign(directory)?;
    apply_request(&mut campaign, request)?;
    if campaign.fit.laws.len() < 2 {
        if request.laws.len() == 1 {
            return Err(Error::OptionInvalid {
                option: format!("--law {}", request.laws[0]),
                problem: "one law has nothing to be compared with; name at least two, or none"
                    .to_owned(),
            });
        }
        campaign.fit.laws = COMPARED
            .iter()
            .filter_map(|name| parse_law(name).ok())
            .collect();
    }
    on_threads(request.threads, || rank(&campaign, progress))
}

/// What one recording gives: the impact, its fits, or why there are none.
type Fitted = Result<(windfall_signal::impact::Impact, Vec<ImpactFit>), FailureOutcome>;

fn rank(campaign: &Campaign, progress: Progress) -> Result<LawsOutcome, Error> {
    let rig = find_rig(campaign)?;
    let problems: Vec<LawProblem> = campaign
        .fit
        .laws
        .iter()
        .map(|law| law_problem(law, &campaign.fit.free))
        .collect();
    let results = for_each(progress, campaign.impacts.len(), |item| {
        fits(campaign, &campaign.impacts[item], &rig, &problems)
    })?;
    let (mut impacts, mut fitted, mut entries, mut failed) = (vec![], vec![], vec![], vec![]);
    for (entry, result) in campaign.impacts.iter().zip(results) {
        match result {
            Ok((impact, fits)) => {
                impacts.push(LeveledImpact { impact, level: 0 });
                fitted.push(fits);
                entries.push(entry);
            }
            Err(failure) => failed.push(failure),
        }
    }
    let mut findings = rig.findings.clone();
    set_levels(&mut impacts, &entries, &fitted, &mut findings);
    let compare = |impacts: &[LeveledImpact], fits: &[Vec<ImpactFit>]| {
        rank_laws(impacts, fits, &rig.rig, &problems, &campaign.fit.options)
    };
    let ranking = compare(&impacts, &fitted).map_err(|source| Error::Identify {
        subject: campaign.title.clone(),
        source: Box::new(source),
    })?;
    let specimens_first = firsts(&impacts, &fitted, &entries, &ranking, &compare);
    Ok(outcome(
        campaign,
        ranking,
        specimens_first,
        failed,
        findings,
    ))
}

fn fits(
    campaign: &Campaign,
    entry: &ImpactEntry,
    rig: &RigFound,
    problems: &[LawProblem],
) -> Fitted {
    let mass = Some(rig.rig.effective_mass());
    let (impact, _) = extract_recording(campaign, entry, mass)
        .map_err(|error| failure(entry, None, error.to_string()))?;
    let fits = fits_of_impact(&impact, &rig.rig, problems, &campaign.fit.options);
    if fits.iter().all(|fit| fit.fit.is_none()) {
        let message = "none of the laws could be fitted".to_owned();
        return Err(failure(entry, None, message));
    }
    Ok((impact, fits))
}

/// Levels from the column of impacts.csv, else from the velocities.
fn set_levels(
    impacts: &mut [LeveledImpact],
    entries: &[&ImpactEntry],
    fits: &[Vec<ImpactFit>],
    findings: &mut Vec<FindingOutcome>,
) {
    let cell = |entry: &ImpactEntry| {
        let mut cells = entry.cells.iter();
        cells
            .find(|(name, _)| name == LEVEL_COLUMN)
            .map(|(_, cell)| cell.clone())
    };
    let cells: Option<Vec<String>> = entries.iter().map(|entry| cell(entry)).collect();
    let levels = match cells {
        Some(cells) => {
            let mut numbers = BTreeMap::new();
            cells
                .into_iter()
                .map(|cell| {
                    let next = numbers.len();
                    *numbers.entry(cell).or_insert(next)
                })
                .collect()
        }
        None => {
            let velocities: Vec<f64> = fits
                .iter()
                .map(|fits| {
                    let fit = fits.iter().find_map(|fit| fit.fit.as_ref());
                    fit.map_or(f64::NAN, |fit| fit.velocity)
                })
                .collect();
            velocity_levels(&velocities, LEVEL_GAP)
        }
    };
    for (impact, level) in impacts.iter_mut().zip(&levels) {
        impact.level = *level;
    }
    if levels.iter().all(|level| *level == 0) {
        findings.push(FindingOutcome {
            code: "one-level".to_owned(),
            message: "all impacts have one velocity: whether a law foretells others cannot be \
                      told; laws that differ in velocity only look alike"
                .to_owned(),
        });
    }
}

/// Ranks the laws over some of the impacts.
type Compare<'a> =
    dyn Fn(&[LeveledImpact], &[Vec<ImpactFit>]) -> Result<LawRanking, IdentifyError> + 'a;

/// For how many specimens each law of the ranking is first.
fn firsts(
    impacts: &[LeveledImpact],
    fits: &[Vec<ImpactFit>],
    entries: &[&ImpactEntry],
    ranking: &LawRanking,
    compare: &Compare,
) -> Vec<usize> {
    let mut by_specimen: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for (i, entry) in entries.iter().enumerate() {
        by_specimen.entry(&entry.specimen).or_default().push(i);
    }
    let mut counts = vec![0; ranking.laws.len()];
    for indices in by_specimen.values() {
        let own: Vec<LeveledImpact> = indices.iter().map(|&i| impacts[i].clone()).collect();
        let own_fits: Vec<Vec<ImpactFit>> = indices.iter().map(|&i| fits[i].clone()).collect();
        let first = compare(&own, &own_fits).ok().map(|r| r.laws[0].kind);
        if let Some(place) = ranking.laws.iter().position(|law| Some(law.kind) == first) {
            counts[place] += 1;
        }
    }
    counts
}

fn outcome(
    campaign: &Campaign,
    ranking: LawRanking,
    specimens_first: Vec<usize>,
    failed: Vec<FailureOutcome>,
    findings: Vec<FindingOutcome>,
) -> LawsOutcome {
    let (verdict, meaning) = words(&ranking.verdict);
    let least = ranking.laws.first().map_or(0.0, |law| law.cost);
    LawsOutcome {
        windfall: VERSION.to_owned(),
        campaign: campaign.title.clone(),
        simulated: campaign.simulated.clone(),
        impacts: ranking.impacts,
        levels: ranking.levels,
        verdict,
        meaning,
        laws: ranking
            .laws
            .iter()
            .map(|law| evidence(law, least))
            .collect(),
        specimens_first,
        failed,
        findings,
    }
}

fn evidence(law: &LawEvidence, least: f64) -> LawEvidenceOutcome {
    LawEvidenceOutcome {
        law: law.kind.name().to_owned(),
        failed: law.failed,
        parameters_per_impact: law.parameters as f64 / law.impacts.max(1) as f64,
        cost: law.cost - least,
        aicc: law.aicc,
        bic: law.bic,
        first_share: law.first_share,
        prediction: law.prediction,
        prediction_sd: law.prediction_error,
        residual_ratio: law.residual_ratio,
        runs_z: law.runs_z,
    }
}

fn words(verdict: &Verdict) -> (&'static str, String) {
    match verdict {
        Verdict::Sure { law, to_noise } => {
            let rest = match to_noise {
                true => "it describes them to their noise",
                false => {
                    "but it does not describe them to their noise: of these laws it is only the least wrong"
                }
            };
            let name = law.name();
            (
                "sure",
                format!("{name} describes these impacts better than the others; {rest}"),
            )
        }
        Verdict::Undecided { first, second } => (
            "undecided",
            format!(
                "these impacts cannot tell {} from {}: another sample of them would rank them otherwise",
                first.name(),
                second.name()
            ),
        ),
        Verdict::Divided {
            likelihood,
            prediction,
        } => (
            "divided",
            format!(
                "{} describes each impact best, but {} foretells other velocities better: the \
                 parameters of the first change with velocity",
                likelihood.name(),
                prediction.name()
            ),
        ),
    }
}
