//! `windfall laws`: which law the impacts of a campaign obey.

use crate::ranking::figure::laws_painting;
use crate::ranking::outcome::{ImpactEvidenceOutcome, LawEvidenceOutcome, LawsOutcome};
use std::collections::BTreeMap;
use std::path::Path;
use windfall_campaign::impacts::answer::{Question, answer};
use windfall_campaign::impacts::bench::find_rig;
use windfall_campaign::impacts::figure_impact::figure_of_impact;
use windfall_campaign::impacts::fit::law_problem;
use windfall_campaign::impacts::mass::RigFound;
use windfall_campaign::pipeline::evaluate::failure;
use windfall_campaign::pipeline::request::{FitRequest, Reuse, apply_request};
use windfall_campaign::recording::extract::extract_recording;
use windfall_campaign::result::counted::left_out_under_all_laws;
use windfall_campaign::result::fit_outcome::impact_outcome;
use windfall_campaign::result::outcome::ImpactOutcome;
use windfall_campaign::settings::model::{ImpactCampaign, ImpactEntry};
use windfall_campaign::settings::read::read_campaign;
use windfall_contact::expression::parse_law;
use windfall_draw::files::{FigureFolder, file_name, write_figure, write_paintings};
use windfall_files::error::Error;
use windfall_files::found::{FailureOutcome, FindingOutcome};
use windfall_files::on_threads::on_threads;
use windfall_files::option_value::unusable;
use windfall_files::progress::{Progress, for_each};
use windfall_files::provenance::VERSION;
use windfall_identify::compare::levels::{LevelSource, velocity_levels};
use windfall_identify::compare::ranking::{
    LawEvidence, LawRanking, LeveledImpact, Verdict, fits_of_impact, rank_laws,
};
use windfall_identify::error::Error as IdentifyError;
use windfall_identify::fit::problem::LawProblem;
use windfall_identify::fit::result::Fit;
use windfall_signal::impact::Impact;

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
    request.check_outputs()?;
    apply_request(&mut campaign, request)?;
    if campaign.fit.laws.len() < 2 {
        if request.laws.len() == 1 {
            return Err(unusable(
                format!("--law {}", request.laws[0]),
                "one law has nothing to be compared with; name at least two, or none",
            ));
        }
        campaign.fit.laws = COMPARED
            .iter()
            .filter_map(|name| parse_law(name).ok())
            .collect();
    }
    on_threads(request.threads, || rank(&campaign, request, progress))
}

/// What one recording gives.
struct Fitted {
    impact: Impact,
    /// A fit for each law, where there is one.
    fits: Vec<Option<Fit>>,
    /// What they say, for the rule which impacts count.
    outcomes: Vec<ImpactOutcome>,
}

/// Figures are drawn of a comparison that is made now, of which the fits are at hand.
fn rank(
    campaign: &ImpactCampaign,
    request: &FitRequest,
    progress: Progress,
) -> Result<LawsOutcome, Error> {
    let mut campaign = campaign.clone();
    let priors = campaign.fit.without_priors();
    let rig = find_rig(&mut campaign)?;
    let question = Question {
        campaign: &campaign,
        rig: &rig,
        command: "laws",
        options: String::new(),
    };
    let figures = request.figures.as_ref();
    let reuse = match figures {
        Some(_) => Reuse::Nothing,
        None => request.reuse,
    };
    let work = || compared(&campaign, &rig, figures, progress);
    let (mut outcome, told) = answer(&question, reuse, work)?;
    outcome.findings.extend(told);
    outcome.findings.extend(priors);
    Ok(outcome)
}

fn compared(
    campaign: &ImpactCampaign,
    rig: &RigFound,
    figures: Option<&FigureFolder>,
    progress: Progress,
) -> Result<LawsOutcome, Error> {
    let problems: Vec<LawProblem> = campaign
        .fit
        .laws
        .iter()
        .map(|law| law_problem(law, &campaign.fit))
        .collect();
    let results = for_each(progress, campaign.shared.entries.len(), |item| {
        fits(campaign, &campaign.shared.entries[item], rig, &problems)
    })?;
    let (mut impacts, mut fitted, mut entries, mut failed) = (vec![], vec![], vec![], vec![]);
    let outcomes = results.iter().flatten().flat_map(|own| &own.outcomes);
    let mut outcomes: Vec<ImpactOutcome> = outcomes.cloned().collect();
    let left_out = left_out_under_all_laws(&campaign.shared, &rig.rig, &mut outcomes);
    for (entry, result) in campaign.shared.entries.iter().zip(results) {
        let out = left_out.iter().find(|own| own.id == entry.id);
        match (result, out) {
            (Ok(own), None) => {
                let impact = own.impact;
                impacts.push(LeveledImpact { impact, level: 0 });
                fitted.push(own.fits);
                entries.push(entry);
            }
            (Ok(_), Some(reasons)) => failed.push(reasons.clone()),
            (Err(failure), _) => failed.push(*failure),
        }
    }
    let mut findings = rig.findings.clone();
    set_levels(&mut impacts, &entries, &fitted, &mut findings);
    let compare = |impacts: &[LeveledImpact], fits: &[Vec<Option<Fit>>]| {
        rank_laws(impacts, fits, &rig.rig, &problems, &campaign.fit.options)
    };
    let ranking = compare(&impacts, &fitted)
        .map_err(|source| Error::identify(&campaign.shared.title, source))?;
    let specimens_first = firsts(&impacts, &fitted, &entries, &ranking, &compare);
    let ids: Vec<String> = ranking
        .compared
        .iter()
        .map(|place| entries[*place].id.clone())
        .collect();
    let shown = middle_impact(&ranking.compared, &fitted);
    let outcome = outcome(campaign, ranking, &ids, specimens_first, failed, findings);
    if let Some(folder) = figures {
        write_paintings(folder, &[laws_painting(&outcome, folder.width)?])?;
        if let Some(place) = shown {
            draw_impact(campaign, rig, entries[place], &problems, &outcome, folder)?;
        }
    }
    Ok(outcome)
}

/// Of the impacts that are compared the one with the middle velocity.
fn middle_impact(compared: &[usize], fits: &[Vec<Option<Fit>>]) -> Option<usize> {
    let mut order = compared.to_vec();
    order.sort_by(|a, b| velocity(&fits[*a]).total_cmp(&velocity(&fits[*b])));
    order.get(order.len() / 2).copied()
}

/// Impact velocity by the law that fits best; m/s.
fn velocity(fits: &[Option<Fit>]) -> f64 {
    let found = fits.iter().flatten();
    let best = found.min_by(|a, b| a.cost.total_cmp(&b.cost));
    best.map_or(f64::NAN, |fit| fit.velocity)
}

/// One impact with the best fit of each law over its signals, the best law first.
fn draw_impact(
    campaign: &ImpactCampaign,
    rig: &RigFound,
    entry: &ImpactEntry,
    problems: &[LawProblem],
    outcome: &LawsOutcome,
    folder: &FigureFolder,
) -> Result<(), Error> {
    let mass = Some(rig.rig.effective_mass());
    let (impact, findings) = extract_recording(campaign, entry, mass)?;
    let fits = fits_of_impact(&impact, &rig.rig, problems, &campaign.fit.options);
    let ranked = outcome.laws.iter().filter_map(|law| {
        let place = problems.iter().position(|p| p.kind.name() == law.law)?;
        let fit = fits[place].as_ref()?;
        Some(impact_outcome(
            entry,
            &impact,
            &findings,
            fit,
            &problems[place],
            (&rig.rig, &campaign.fit.options.bench),
        ))
    });
    let ranked: Vec<ImpactOutcome> = ranked.collect();
    let own: Vec<&ImpactOutcome> = ranked.iter().collect();
    let used = (&rig.rig, campaign.fit.options.end, &campaign.fit.user[..]);
    let title = format!("{}: every law at its best", entry.id);
    let figure = figure_of_impact(&title, &impact, &own, used);
    let name = file_name(&format!("laws-impact-{}", entry.id));
    write_figure(folder, &name, &figure).map(|_| ())
}

fn fits(
    campaign: &ImpactCampaign,
    entry: &ImpactEntry,
    rig: &RigFound,
    problems: &[LawProblem],
) -> Result<Fitted, Box<FailureOutcome>> {
    let mass = Some(rig.rig.effective_mass());
    let (impact, findings) = extract_recording(campaign, entry, mass)
        .map_err(|error| failure(entry, None, error.to_string()))?;
    let fits = fits_of_impact(&impact, &rig.rig, problems, &campaign.fit.options);
    if fits.iter().all(Option::is_none) {
        let message = "none of the laws could be fitted".to_owned();
        return Err(failure(entry, None, message));
    }
    let of_law = problems.iter().zip(&fits).filter_map(|(problem, fit)| {
        let outcome = impact_outcome(
            entry,
            &impact,
            &findings,
            fit.as_ref()?,
            problem,
            (&rig.rig, &campaign.fit.options.bench),
        );
        let group = campaign.shared.group_of(entry);
        Some(ImpactOutcome { group, ..outcome })
    });
    let outcomes = of_law.collect();
    Ok(Fitted {
        impact,
        fits,
        outcomes,
    })
}

/// Levels from the column of impacts.csv, else from the velocities; says what became of them.
fn set_levels(
    impacts: &mut [LeveledImpact],
    entries: &[&ImpactEntry],
    fits: &[Vec<Option<Fit>>],
    findings: &mut Vec<FindingOutcome>,
) {
    let cell = |entry: &ImpactEntry| {
        let mut cells = entry.cells.iter();
        cells
            .find(|(name, _)| name == LEVEL_COLUMN)
            .map(|(_, cell)| cell.clone())
    };
    let cells: Option<Vec<String>> = entries.iter().map(|entry| cell(entry)).collect();
    let given = cells.map(|cells| {
        let mut numbers = BTreeMap::new();
        let numbered = cells.into_iter().map(|cell| {
            let next = numbers.len();
            *numbers.entry(cell).or_insert(next)
        });
        numbered.collect()
    });
    let velocities: Vec<f64> = fits.iter().map(|own| velocity(own)).collect();
    let levels = velocity_levels(&velocities, given);
    for (impact, level) in impacts.iter_mut().zip(&levels.of) {
        impact.level = *level;
    }
    if levels.source == LevelSource::Thirds {
        findings.push(FindingOutcome::new(
            "velocity-thirds",
            thirds_text(&velocities, &levels.of),
        ));
    }
    if levels.of.iter().all(|level| *level == 0) {
        findings.push(FindingOutcome::new(
            "one-level",
            "all impacts have the same velocity, so prediction at other velocities \
             cannot be tested; laws that differ only in velocity look alike",
        ));
    }
}

fn thirds_text(velocities: &[f64], levels: &[usize]) -> String {
    let range = |level: usize| {
        let own = || velocities.iter().zip(levels).filter(|own| *own.1 == level);
        let low = own().map(|own| *own.0).fold(f64::INFINITY, f64::min);
        let high = own().map(|own| *own.0).fold(0.0, f64::max);
        format!("{} impacts at {low:.3} to {high:.3} m/s", own().count())
    };
    format!(
        "the velocities are continuous, so each third of them is predicted from the two others: \
         {}, {}, {}",
        range(0),
        range(1),
        range(2)
    )
}

/// Ranks the laws over some of the impacts.
type Compare<'a> =
    dyn Fn(&[LeveledImpact], &[Vec<Option<Fit>>]) -> Result<LawRanking, IdentifyError> + 'a;

/// For how many specimens each law of the ranking is first.
fn firsts(
    impacts: &[LeveledImpact],
    fits: &[Vec<Option<Fit>>],
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
        let own_fits: Vec<Vec<Option<Fit>>> = indices.iter().map(|&i| fits[i].clone()).collect();
        let first = compare(&own, &own_fits).ok().map(|r| r.laws[0].kind);
        if let Some(place) = ranking.laws.iter().position(|law| Some(law.kind) == first) {
            counts[place] += 1;
        }
    }
    counts
}

fn outcome(
    campaign: &ImpactCampaign,
    ranking: LawRanking,
    ids: &[String],
    specimens_first: Vec<usize>,
    failed: Vec<FailureOutcome>,
    findings: Vec<FindingOutcome>,
) -> LawsOutcome {
    let (verdict, meaning) = words(&ranking.verdict);
    let least = ranking.laws.first().map_or(0.0, |law| law.cost);
    LawsOutcome {
        windfall: VERSION.to_owned(),
        campaign: campaign.shared.title.clone(),
        simulated: campaign.shared.simulated.clone(),
        impacts: ranking.impacts,
        levels: ranking.levels,
        verdict: verdict.to_owned(),
        meaning,
        laws: ranking
            .laws
            .iter()
            .map(|law| evidence(law, ids, least))
            .collect(),
        specimens_first,
        failed,
        findings,
    }
}

fn evidence(law: &LawEvidence, ids: &[String], least: f64) -> LawEvidenceOutcome {
    LawEvidenceOutcome {
        law: law.kind.name().to_owned(),
        failed: law.failed,
        parameters_per_impact: law.parameters as f64 / law.impacts.max(1) as f64,
        cost: law.cost - least,
        aicc: law.aicc,
        aicc_low: law.aicc_low,
        aicc_high: law.aicc_high,
        impacts: ids
            .iter()
            .zip(&law.aicc_of_impacts)
            .map(|(id, aicc)| ImpactEvidenceOutcome {
                id: id.clone(),
                aicc: *aicc,
            })
            .collect(),
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
                "these impacts cannot separate {} from {}: another sample might rank them differently",
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
                "{} describes each impact best, but {} predicts other velocities better: the \
                 parameters of the first change with velocity",
                likelihood.name(),
                prediction.name()
            ),
        ),
    }
}
