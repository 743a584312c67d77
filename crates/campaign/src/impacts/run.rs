//! `windfall fit`: the main job, recordings → parameters, table, store.

use crate::impacts::card::card_of_fit;
use crate::impacts::figure_impact::figure_of_impact;
use crate::impacts::fit::{FitTask, fit_tasks};
use crate::impacts::key::{impact_key, input_digests};
use crate::impacts::mass::{RigFound, find_rig};
use crate::impacts::request::{FitRequest, PENDING, Reuse, apply_request};
use crate::recording::digests::{Digests, recording_digests};
use crate::recording::extract::extract_recording;
use crate::recording::read::recording_path;
use crate::recording::request::{RecordingRequest, campaign_of_file};
use crate::result::outcome::{CampaignOutcome, ImpactOutcome, StatusOutcome};
use crate::result::summary::{summarise, summarise_groups};
use crate::settings::model::{Campaign, ImpactEntry};
use crate::settings::read::{CAMPAIGN_FILE, read_campaign};
use crate::store::runs::{RunRecord, find_results, latest_run, write_run};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::path::Path;
use windfall_cards::law_use::{LawUse, findings_of_use};
use windfall_cards::read_card::write_card;
use windfall_contact::expression::typical;
use windfall_draw::files::{FigureFolder, write_figure};
use windfall_files::error::Error;
use windfall_files::found::{FailureOutcome, FindingOutcome};
use windfall_files::on_threads::on_threads;
use windfall_files::progress::Progress;
use windfall_files::provenance::{VERSION, time_now};

/// Name of the store in a campaign directory.
pub const STORE_FILE: &str = "results.sqlite";

/// Fits the impacts of a campaign and keeps the results in its store.
///
/// Given one recording, fits the impacts that it holds, with the campaign in
/// whose directory, or a directory below it, the recording lies.
///
/// A recording that cannot be used is reported in the outcome and does not stop
/// the others. Results stand in the order of impacts.csv and have the same bits
/// for any number of threads.
///
/// # Errors
/// The campaign or the request is wrong, or the store cannot be used.
pub fn fit_campaign(
    directory: &Path,
    request: &FitRequest,
    progress: Progress,
) -> Result<CampaignOutcome, Error> {
    fitted_campaign(directory, request, progress).map(|fitted| fitted.outcome)
}

/// A fitted campaign with what its results rest on.
pub struct FittedCampaign {
    /// What its files say.
    pub campaign: Campaign,
    /// The rig, with its mass.
    pub rig: RigFound,
    /// Digests of its files.
    pub digests: Digests,
    /// Its results.
    pub outcome: CampaignOutcome,
}

/// [`fit_campaign`], for those who go on with its parts.
pub fn fitted_campaign(
    directory: &Path,
    request: &FitRequest,
    progress: Progress,
) -> Result<FittedCampaign, Error> {
    let mut campaign = match directory.is_file() {
        true => campaign_of_recording(directory)?,
        false => read_campaign(directory)?,
    };
    apply_request(&mut campaign, request)?;
    on_threads(request.threads, || fit(campaign, request, progress))
}

/// Fits the impact in one recording that belongs to no campaign; what it needs
/// to know of rig and channels comes with the request. Nothing is written.
///
/// # Errors
/// The request is wrong, or nothing shows the mass of the rig. A recording that
/// cannot be used is reported in the outcome.
pub fn fit_recording(
    file: &Path,
    recording: &RecordingRequest,
    request: &FitRequest,
    progress: Progress,
) -> Result<CampaignOutcome, Error> {
    let mut campaign = campaign_of_file(file, recording)?;
    apply_request(&mut campaign, request)?;
    on_threads(request.threads, || {
        let rig = find_rig(&campaign)?;
        let task = |law| FitTask {
            impact: 0,
            law,
            key: None,
            problem: None,
        };
        let tasks: Vec<FitTask> = (0..campaign.fit.laws.len()).map(task).collect();
        let stored = BTreeMap::new();
        let results = fit_tasks(&campaign, &rig, &tasks, &stored, progress)?;
        let outcome = assemble(&campaign, &rig, &tasks, results, &stored).shown;
        if let Some(folder) = &request.figures {
            draw(&campaign, &rig, &outcome, folder)?;
        }
        Ok(outcome)
    })
}

/// The campaign around a recording, with the impacts of that recording only.
fn campaign_of_recording(file: &Path) -> Result<Campaign, Error> {
    let real = |path: &Path| path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
    let file = real(file);
    let above = file
        .ancestors()
        .skip(1)
        .find(|directory| directory.join(CAMPAIGN_FILE).is_file());
    let unusable = |problem: String| Error::OptionInvalid {
        option: file.display().to_string(),
        problem,
    };
    let directory = above.ok_or_else(|| {
        unusable(
            "no campaign.toml above this recording says what rig and channels it has; \
             say it with --rig, --law, --channel … (`windfall fit --help` has an example), or \
             write a template with `windfall new pendulum DIR` and put the recording into DIR/raw"
                .to_owned(),
        )
    })?;
    let mut campaign = read_campaign(directory)?;
    let files = campaign.files.clone();
    campaign
        .impacts
        .retain(|impact| real(&recording_path(&files, impact)) == file);
    if campaign.impacts.is_empty() {
        let list = directory.join("impacts.csv");
        return Err(unusable(format!(
            "{} has no line with this recording; add one",
            list.display()
        )));
    }
    Ok(campaign)
}

fn fit(
    campaign: Campaign,
    request: &FitRequest,
    progress: Progress,
) -> Result<FittedCampaign, Error> {
    let store = campaign.directory.join(STORE_FILE);
    let digests = recording_digests(&campaign.directory, &campaign.files, &campaign.impacts);
    let rig = find_rig(&campaign)?;

    // What each law on each impact depends on, and what the store knows of it.
    let mut tasks: Vec<FitTask> = tasks(&campaign, &digests, &rig);
    let keys: Vec<String> = tasks.iter().filter_map(|task| task.key.clone()).collect();
    let stored = match request.reuse {
        Reuse::Unchanged | Reuse::Only => find_results(&store, &keys)?,
        Reuse::Nothing => {
            // A store that could not be written is found out before the work.
            latest_run(&store)?;
            vec![None; keys.len()]
        }
    };
    let stored: BTreeMap<String, ImpactOutcome> = keys
        .iter()
        .cloned()
        .zip(stored)
        .filter_map(|(key, found)| Some((key, found?)))
        .collect();

    if request.reuse == Reuse::Only {
        for task in &mut tasks {
            let known = task
                .key
                .as_ref()
                .is_some_and(|key| stored.contains_key(key));
            if !known && task.problem.is_none() {
                task.problem = Some(PENDING.to_owned());
            }
        }
    }
    let results = fit_tasks(&campaign, &rig, &tasks, &stored, progress)?;
    let mut outcome = assemble(&campaign, &rig, &tasks, results, &stored);
    if request.reuse != Reuse::Only {
        keep(&campaign, &store, &digests, &mut outcome)?;
    }
    if let Some(folder) = &request.figures {
        draw(&campaign, &rig, &outcome.shown, folder)?;
    }
    if let Some(path) = &request.card {
        write_card(path, &card_of_fit(&campaign, &outcome.shown)?)?;
    }
    Ok(FittedCampaign {
        campaign,
        rig,
        digests,
        outcome: outcome.shown,
    })
}

/// A figure of every impact that was fitted.
fn draw(
    campaign: &Campaign,
    rig: &RigFound,
    outcome: &CampaignOutcome,
    folder: &FigureFolder,
) -> Result<(), Error> {
    let end = campaign.fit.options.end;
    campaign.impacts.par_iter().try_for_each(|entry| {
        let own = outcome
            .impacts
            .iter()
            .filter(|impact| impact.id == entry.id);
        let own: Vec<&ImpactOutcome> = own.collect();
        if own.is_empty() {
            return Ok(());
        }
        let mass = Some(rig.rig.effective_mass());
        let (impact, _) = extract_recording(campaign, entry, mass)?;
        let figure = figure_of_impact(
            &entry.id,
            &impact,
            &own,
            (&rig.rig, end, &campaign.fit.user),
        );
        write_figure(folder, &entry.id, &figure).map(|_| ())
    })
}

fn tasks(campaign: &Campaign, digests: &Digests, rig: &RigFound) -> Vec<FitTask> {
    let mut tasks = Vec::new();
    for (index, entry) in campaign.impacts.iter().enumerate() {
        let digest = &digests[&recording_path(&campaign.files, entry)];
        for law in 0..campaign.fit.laws.len() {
            let key = digest.as_ref().ok().map(|digest| {
                impact_key(campaign, entry, &campaign.fit.laws[law], &rig.rig, digest)
            });
            let problem = digest.as_ref().err().cloned();
            tasks.push(FitTask {
                impact: index,
                law,
                key,
                problem,
            });
        }
    }
    tasks
}

/// What is shown and what is kept.
struct Assembled {
    shown: CampaignOutcome,
    keys: Vec<String>,
}

fn assemble(
    campaign: &Campaign,
    rig: &RigFound,
    tasks: &[FitTask],
    results: Vec<Result<ImpactOutcome, FailureOutcome>>,
    stored: &BTreeMap<String, ImpactOutcome>,
) -> Assembled {
    let (mut impacts, mut failed, mut keys) = (Vec::new(), Vec::new(), Vec::new());
    let mut status = StatusOutcome::default();
    for (task, result) in tasks.iter().zip(results) {
        match result {
            Ok(mut impact) => {
                let key = task.key.clone().unwrap_or_default();
                match stored.contains_key(&key) {
                    true => status.stored += 1,
                    false => status.fitted += 1,
                }
                impact.group = group_of(campaign, &campaign.impacts[task.impact]);
                keys.push(key);
                impacts.push(impact);
            }
            Err(failure) => {
                // A recording that cannot be read is one failure, not one per law.
                if !failed.contains(&failure) {
                    failed.push(failure);
                }
            }
        }
    }
    status.failed = failed.len();
    let first_law: Vec<&ImpactOutcome> = impacts
        .iter()
        .filter(|i| Some(&i.law) == impacts.first().map(|first| &first.law))
        .collect();
    let law = first_law.first().map_or("", |impact| impact.law.as_str());
    let all = summarise(law, None, &first_law);
    let mut summary = all.parameters;
    summary.0.extend(all.derived.0);
    let groups = summarise_groups(&impacts);
    let mut findings = rig.findings.clone();
    findings.extend(law_findings(campaign, &impacts));
    let shown = CampaignOutcome {
        windfall: VERSION.to_owned(),
        campaign: campaign.title.clone(),
        simulated: campaign.simulated.clone(),
        effective_mass: rig.mass,
        status,
        impacts,
        failed,
        summary,
        groups,
        findings,
    };
    Assembled { shown, keys }
}

/// Remarks on the laws as they were used.
fn law_findings(campaign: &Campaign, impacts: &[ImpactOutcome]) -> Vec<FindingOutcome> {
    let mut findings: Vec<FindingOutcome> = Vec::new();
    for law in &campaign.fit.laws {
        let Ok(typical) = typical(law.kind).complete() else {
            continue;
        };
        let known = |impact: &ImpactOutcome, name: &str| {
            let found = impact.fitted.get(name).copied().flatten();
            found.unwrap_or(f64::NAN)
        };
        let used: Vec<LawUse> = impacts
            .iter()
            .filter(|impact| impact.law == law.kind.name())
            .map(|impact| LawUse {
                impact_velocity: known(impact, "impact_velocity"),
                peak_force: known(impact, "peak_force"),
                displacement: known(impact, "max_displacement"),
                mass: f64::NAN,
            })
            .collect();
        for mut finding in findings_of_use(&typical, None, &used) {
            finding.message = format!("{}: {}", law.kind.name(), finding.message);
            findings.push(finding);
        }
    }
    findings
}

fn group_of(campaign: &Campaign, entry: &ImpactEntry) -> Option<String> {
    let column = campaign.group.as_ref()?;
    let specimen = campaign
        .specimens
        .iter()
        .find(|specimen| specimen.id == entry.specimen);
    let specimen_cells = specimen.map_or(&[][..], |specimen| &specimen.cells);
    let mut cells = specimen_cells.iter().chain(&entry.cells);
    cells
        .find(|(name, _)| name == column)
        .map(|(_, cell)| cell.clone())
}

/// Writes the run, unless the newest one in the store is the same.
fn keep(
    campaign: &Campaign,
    store: &Path,
    digests: &Digests,
    outcome: &mut Assembled,
) -> Result<(), Error> {
    // A run of nothing but failures is told, not kept.
    if outcome.keys.is_empty() {
        return Ok(());
    }
    let same = latest_run(store)?
        .is_some_and(|run| run.keys == outcome.keys && run.failures == outcome.shown.failed);
    if same && outcome.shown.status.fitted == 0 {
        outcome.shown.status.up_to_date = true;
        return Ok(());
    }
    let (inputs, options) = input_digests(campaign, digests)?;
    let results = outcome
        .keys
        .iter()
        .cloned()
        .zip(outcome.shown.impacts.iter().cloned());
    write_run(
        store,
        &RunRecord {
            time: time_now(),
            windfall: VERSION.to_owned(),
            options,
            seed: None,
            inputs,
            results: results.collect(),
            documents: Vec::new(),
            failures: outcome.shown.failed.clone(),
        },
    )
}
