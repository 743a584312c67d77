//! `windfall fit`: the main job, recordings → parameters, table, store.

use crate::impacts::bench::{estimate_bench, find_rig};
use crate::impacts::card::card_of_fit;
use crate::impacts::detail::{detail_of_law, write_details};
use crate::impacts::figure_impact::figure_of_impact;
use crate::impacts::fit::Fits;
use crate::impacts::mass::RigFound;
use crate::impacts::response::name_cause;
use crate::pipeline::evaluate::{Evaluated, evaluate};
use crate::pipeline::request::{FitRequest, Reuse, apply_request};
use crate::recording::digests::Digests;
use crate::recording::extract::extract_recording;
use crate::recording::read::recording_path;
use crate::recording::request::{RecordingRequest, campaign_of_bytes, campaign_of_file};
use crate::result::bench::{bench_findings, far_estimates, pooled_bench};
use crate::result::counted::mark_left_out;
use crate::result::given::given_findings;
use crate::result::joint::{joint_findings, joint_fits};
use crate::result::outcome::{BenchOutcome, CampaignOutcome, GroupOutcome, ImpactOutcome};
use crate::result::stacked::law_misfits;
use crate::result::summary::{summarise, summarise_groups};
use crate::result::trend::{times_of, trends};
use crate::result::trend_findings::trend_findings;
use crate::settings::kind::CAMPAIGN_FILE;
use crate::settings::model::{BenchFound, Campaign, ImpactCampaign, ImpactEntry};
use crate::settings::read::read_campaign;
use rayon::prelude::*;
use serde_json::Value;
use std::path::Path;
use std::sync::Arc;
use windfall_cards::law_use::{LawUse, findings_of_use};
use windfall_cards::read_card::write_card;
use windfall_contact::expression::typical;
use windfall_contact::laws::kind::LawKind;
use windfall_draw::files::{FigureFolder, write_figure};
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::named::{Named, grouped};
use windfall_files::on_threads::on_threads;
use windfall_files::option_value::unusable;
use windfall_files::progress::Progress;
use windfall_files::provenance::VERSION;
use windfall_files::text::number::plain;

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
    pub campaign: ImpactCampaign,
    /// The rig, with its mass.
    pub rig: RigFound,
    /// Digests of its recordings.
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
    let reuse = Some(request.reuse);
    on_threads(request.threads, || fit(campaign, reuse, request, progress))
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
    let fitted = on_threads(request.threads, || fit(campaign, None, request, progress))?;
    Ok(fitted.outcome)
}

/// A fitted recording in memory.
pub struct FittedRecording {
    fitted: FittedCampaign,
}

impl FittedRecording {
    /// Its results.
    pub fn outcome(&self) -> &CampaignOutcome {
        &self.fitted.outcome
    }

    /// Samples, residuals, weights, covariance and draws of the fit of a law, as
    /// `--detail` writes them. The impact is fitted once more, with the same bits.
    ///
    /// * `law`: its name
    ///
    /// # Errors
    /// The law was not fitted.
    pub fn detail(&self, law: &str) -> Result<Value, Error> {
        let FittedCampaign { campaign, rig, .. } = &self.fitted;
        let laws = || campaign.fit.laws.iter();
        let entry = campaign.shared.entries.first();
        let found = laws().find(|own| own.kind.name() == law).zip(entry);
        let (law, entry) = found.ok_or_else(|| {
            let names: Vec<&str> = laws().map(|own| own.kind.name()).collect();
            unusable(law, format!("fitted were {}", names.join(", ")))
        })?;
        let (impact, _) = extract_recording(campaign, entry, Some(rig.rig.effective_mass()))?;
        detail_of_law((campaign, &rig.rig), entry, &impact, law)
    }
}

/// [`fit_recording`] of a recording in memory, with what its details rest on.
///
/// * `name`: what it is called in messages and results; the seed of intervals depends on it
/// * `held`: the bytes that its file would have
///
/// It works on the threads of the caller, who may fit many recordings on them: a pool of
/// threads within another one would take up further recordings while it waits for the first,
/// one inside of the other.
///
/// # Errors
/// Those of [`fit_recording`].
pub fn fit_bytes(
    (name, held): (&Path, Arc<[u8]>),
    recording: &RecordingRequest,
    request: &FitRequest,
    progress: Progress,
) -> Result<FittedRecording, Error> {
    let mut campaign = campaign_of_bytes(name, held, recording)?;
    apply_request(&mut campaign, request)?;
    let fitted = fit(campaign, None, request, progress)?;
    Ok(FittedRecording { fitted })
}

/// The campaign around a recording, with the impacts of that recording only.
fn campaign_of_recording(file: &Path) -> Result<ImpactCampaign, Error> {
    let real = |path: &Path| path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
    let file = real(file);
    let above = file
        .ancestors()
        .skip(1)
        .find(|directory| directory.join(CAMPAIGN_FILE).is_file());
    let unusable = |problem: &str| unusable(file.display().to_string(), problem);
    let directory = above.ok_or_else(|| {
        unusable(
            "no campaign.toml above this recording says what rig and channels it has; \
             say it with --rig, --law, --channel … (`windfall fit --help` has an example), or \
             write a template with `windfall new pendulum DIR` and put the recording into DIR/raw",
        )
    })?;
    let mut campaign = read_campaign(directory)?;
    // The bench is that of all impacts.
    estimate_bench(&mut campaign)?;
    let files = campaign.shared.files.clone();
    campaign
        .shared
        .entries
        .retain(|impact| real(&recording_path(&files, impact)) == file);
    if campaign.shared.entries.is_empty() {
        let list = directory.join("impacts.csv").display().to_string();
        let problem = format!("{list} has no line with this recording; add one");
        return Err(unusable(&problem));
    }
    Ok(campaign)
}

fn fit(
    mut campaign: ImpactCampaign,
    reuse: Option<Reuse>,
    request: &FitRequest,
    progress: Progress,
) -> Result<FittedCampaign, Error> {
    request.check_outputs()?;
    let rig = find_rig(&mut campaign)?;
    let fits = Fits::new(&campaign, &rig);
    let mut evaluated = evaluate(&fits, reuse, progress)?;
    let mut outcome = outcome_of(&fits, &mut evaluated);
    if request.joint {
        outcome.joint = joint_fits(&outcome.impacts);
        outcome.findings.extend(joint_findings(&outcome.joint));
    }
    let digests = evaluated.digests;
    if let Some(folder) = &request.figures {
        draw(&campaign, &rig, &outcome, folder)?;
    }
    if let Some(folder) = &request.detail {
        write_details(&campaign, &rig.rig, &outcome, folder)?;
    }
    if let Some(path) = &request.card {
        write_card(path, &card_of_fit(&campaign, &outcome)?)?;
    }
    Ok(FittedCampaign {
        campaign,
        rig,
        digests,
        outcome,
    })
}

/// A figure of every impact that was fitted.
fn draw(
    campaign: &ImpactCampaign,
    rig: &RigFound,
    outcome: &CampaignOutcome,
    folder: &FigureFolder,
) -> Result<(), Error> {
    let end = campaign.fit.options.end;
    campaign.shared.entries.par_iter().try_for_each(|entry| {
        let own = outcome.impacts.iter().filter(|i| i.id == entry.id);
        let own: Vec<&ImpactOutcome> = own.collect();
        if own.is_empty() {
            return Ok(());
        }
        let mass = Some(rig.rig.effective_mass());
        let (impact, _) = extract_recording(campaign, entry, mass)?;
        let used = (&rig.rig, end, &campaign.fit.user[..]);
        let figure = figure_of_impact(&entry.id, &impact, &own, used);
        write_figure(folder, &entry.id, &figure).map(|_| ())
    })
}

/// Recordings of different fruit that are the same, byte by byte.
fn same_recordings(campaign: &Campaign, digests: &Digests) -> Option<FindingOutcome> {
    let digest = |entry: &ImpactEntry| {
        digests
            .get(&recording_path(&campaign.files, entry))?
            .as_ref()
            .ok()
    };
    let entries = campaign.entries.iter();
    let by_content = grouped(entries.filter_map(|entry| Some((digest(entry)?, entry))));
    let same: Vec<&Vec<&ImpactEntry>> = by_content
        .iter()
        .map(|(_, own)| own)
        .filter(|own| {
            own.iter()
                .any(|entry| entry.specimen != own[0].specimen && entry.file != own[0].file)
        })
        .collect();
    let first = same.first()?;
    let other = first
        .iter()
        .find(|entry| entry.specimen != first[0].specimen)?;
    let more = match same.len() {
        1 => String::new(),
        n => format!(" (and {} more)", n - 1),
    };
    let told = format!(
        "{} of {} and {} of {} are the same recording, byte by byte{more}: one was copied under \
         a wrong name",
        first[0].file, first[0].specimen, other.file, other.specimen
    );
    Some(FindingOutcome::new("same-recording", told))
}

/// Fewest impacts of a group whose mean and median are compared.
const COMPARED: usize = 8;

/// Parameters whose mean is far from their median, in any group.
fn skewed(groups: &[GroupOutcome]) -> Vec<FindingOutcome> {
    let mut findings = Vec::new();
    for group in groups {
        for (name, spread) in &group.parameters.0 {
            let (Some(deviation), true) = (spread.robust_sd, spread.n >= COMPARED) else {
                continue;
            };
            let apart = (spread.mean - spread.median).abs();
            // The median of a normal sample scatters 1.25 times as much as its mean.
            let usual = 1.25 * deviation / (spread.n as f64).sqrt();
            if apart > (5.0 * usual).max(0.02 * spread.median.abs()) {
                let of = group
                    .group
                    .as_ref()
                    .map_or_else(String::new, |own| format!("{own}: "));
                let told = format!(
                    "{of}{name} of {} has the mean {} and the median {}: a few impacts decide the \
                     mean; look at the largest and the smallest",
                    group.law,
                    plain(spread.mean),
                    plain(spread.median)
                );
                findings.push(FindingOutcome::new("mean-and-median-differ", told));
            }
        }
    }
    findings
}

/// What of the bench was estimated.
fn estimated(campaign: &ImpactCampaign) -> Named<BenchOutcome> {
    let of = |found: &BenchFound| BenchOutcome {
        value: found.value,
        sd: found.sd,
        unit: found.quantity.unit().to_owned(),
        told: found.told,
        impacts: found.impacts,
    };
    let found = campaign.bench.found.iter();
    found.map(|own| (own.quantity.name(), of(own))).collect()
}

/// Results with their summary.
fn outcome_of(fits: &Fits, evaluated: &mut Evaluated<ImpactOutcome>) -> CampaignOutcome {
    let (campaign, rig) = (fits.campaign, fits.rig);
    let items = std::mem::take(&mut evaluated.items).into_iter();
    let mut impacts: Vec<ImpactOutcome> = items.map(|(_, impact)| impact).collect();
    mark_left_out(&campaign.shared, &rig.rig, &mut impacts);
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
    let bench = pooled_bench(&impacts);
    let of_bench = bench_findings(&rig.rig, &campaign.bench.sd, &bench, &impacts);
    let misfits = law_misfits(&impacts, !of_bench.is_empty());
    let times = times_of(&campaign.shared);
    let trends = trends(&impacts, &times);
    let laws: Vec<LawKind> = campaign.fit.laws.iter().map(|law| law.kind).collect();
    let of_trends = trend_findings(&trends, &laws, !of_bench.is_empty(), &misfits);
    let estimated = estimated(campaign);
    let far = far_estimates(&estimated, &impacts);
    let cause = match of_bench.is_empty() {
        true => None,
        false => name_cause(campaign, &rig.rig, &impacts),
    };
    findings.extend(of_bench.into_iter().chain(far).chain(misfits).chain(cause));
    findings.extend(of_trends.into_iter().chain(times.unread));
    findings.extend(given_findings(&campaign.fit, &impacts));
    findings.extend(same_recordings(&campaign.shared, &evaluated.digests));
    findings.extend(skewed(&groups));
    CampaignOutcome {
        windfall: VERSION.to_owned(),
        campaign: campaign.shared.title.clone(),
        simulated: campaign.shared.simulated.clone(),
        note: campaign.shared.note.clone(),
        effective_mass: rig.mass,
        bench,
        estimated,
        trends,
        status: evaluated.status,
        impacts,
        failed: std::mem::take(&mut evaluated.failed),
        summary,
        groups,
        joint: Vec::new(),
        findings,
    }
}

/// Remarks on the laws as they were used.
fn law_findings(campaign: &ImpactCampaign, impacts: &[ImpactOutcome]) -> Vec<FindingOutcome> {
    let mut findings: Vec<FindingOutcome> = Vec::new();
    for law in &campaign.fit.laws {
        let Ok(typical) = typical(law.kind).complete() else {
            continue;
        };
        let known = |impact: &ImpactOutcome, name: &str| impact.fitted(name).unwrap_or(f64::NAN);
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
