//! `windfall calibrate DIR`: features of drops → a law, what it leaves open, what
//! closes that.

use crate::calibrate::card::card_of_calibration;
use crate::calibrate::design::calibrate_by_design;
use crate::calibrate::drops::{calibrate_rig, drop_data, recorded_features, written_features};
use crate::calibrate::features::{family_line, features_outcome, fit, telling_heights};
use crate::calibrate::figure::write_calibrate_figures;
use crate::calibrate::figure_waveform::write_waveform_figures;
use crate::calibrate::law::{FreeLaw, Setting, free_law};
use crate::calibrate::next::{closing, next_experiment};
use crate::calibrate::outcome::CalibrateOutcome;
use crate::calibrate::store::keep_calibration;
use crate::calibrate::tables_text::write_calibrate_tables;
use crate::calibrate::target::{
    CalibrateRig, DropData, TargetCondition, drop_outcomes, heights_of, plate_outcome, problem_of,
    same_height, target_condition,
};
use crate::calibrate::waveform::waveform_outcome;
use crate::calibrate::waveform_drops::recorded_drops;
use crate::calibrate_settings::{DropLaw, Way};
use crate::measured::MeasuredDrop;
use crate::plate_ringing::{PlateEstimate, plate_of};
use crate::read::{DropCampaign, read_drop};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use windfall_campaign::pipeline::evaluate::failure;
use windfall_campaign::pipeline::request::Reuse;
use windfall_cards::read_card::write_card;
use windfall_draw::files::FigureFolder;
use windfall_drop_rig::feature_problem::FeatureProblem;
use windfall_files::error::Error;
use windfall_files::found::{FailureOutcome, FindingOutcome};
use windfall_files::progress::Progress;
use windfall_files::provenance::VERSION;
use windfall_files::write_file::check_outputs;
use windfall_measure::run::measure_recordings;
use windfall_tables::regress::findings::finding;

/// Options of a calibration.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct CalibrateRequest {
    /// Ways to calibrate in place of the campaign's; may be repeated
    #[cfg_attr(feature = "clap", arg(long = "way", value_parser = way(), value_name = "WAY"))]
    pub ways: Vec<Way>,
    /// The fitted waveforms, the family of equally good laws and the surfaces
    #[cfg_attr(feature = "clap", command(flatten))]
    pub figures: Option<FigureFolder>,
    /// Write all tables as CSV and text into this directory
    #[cfg_attr(feature = "clap", arg(long, value_name = "DIR", value_hint = clap::ValueHint::DirPath))]
    pub tables: Option<PathBuf>,
    /// Write the calibrated law as a law card
    #[cfg_attr(feature = "clap", arg(long, value_name = "FILE", value_hint = clap::ValueHint::FilePath))]
    pub card: Option<PathBuf>,
    /// Intervals from the profile of the sum of squares, which takes longer, in place of ±1.96 sd
    #[cfg_attr(feature = "clap", arg(long))]
    pub profile: bool,
    /// Threads; all cores if left out
    #[cfg_attr(feature = "clap", arg(long, value_name = "N"))]
    pub threads: Option<usize>,
}

/// The word of a way.
#[cfg(feature = "clap")]
fn way() -> impl clap::builder::TypedValueParser<Value = Way> {
    use crate::calibrate_settings::WAYS;
    use clap::builder::{PossibleValuesParser, TypedValueParser};
    use windfall_files::option_value::chosen;
    let words = PossibleValuesParser::new(WAYS.map(|(word, _)| word));
    words.try_map(|word| chosen("--way", &word, &WAYS))
}

/// What a calibration works on.
struct Work<'a> {
    campaign: &'a DropCampaign,
    own: &'a DropLaw,
    law: FreeLaw,
    rig: CalibrateRig,
    drops: Vec<DropData>,
    problem: FeatureProblem,
    target: TargetCondition,
    ways: Vec<Way>,
}

impl Work<'_> {
    fn setting(&self) -> Setting<'_> {
        Setting {
            law: &self.law,
            settings: &self.campaign.calibrate,
            rig: &self.rig,
            target: &self.target,
            drops: &self.drops,
            problem: &self.problem,
            end: self.own.end,
        }
    }
}

/// Calibrates the law of a drop campaign and keeps the result in its store.
///
/// # Errors
/// The campaign is no drop campaign, has no law to calibrate, or no drop shows a
/// first peak and an interval.
pub fn calibrate(
    directory: &Path,
    request: &CalibrateRequest,
    progress: Progress,
) -> Result<CalibrateOutcome, Error> {
    let campaign = read_drop(directory)?;
    campaign.shared.check_rig_given()?;
    let figures = request.figures.as_ref().map(|own| &own.directory);
    let outputs = [figures, request.tables.as_ref(), request.card.as_ref()];
    check_outputs(outputs.map(|own| own.map(PathBuf::as_path)))?;
    windfall_files::on_threads::on_threads(request.threads, || {
        let seen = feature_drops(&campaign, progress)?;
        let outcome = calibrated(&campaign, request, seen, progress)?;
        keep_calibration(&campaign, &outcome)?;
        if let Some(figures) = &request.figures {
            write_calibrate_figures(figures, &outcome)?;
        }
        if let Some(path) = &request.card {
            write_card(path, &card_of_calibration(&campaign, &outcome)?)?;
        }
        if let Some(tables) = &request.tables {
            write_calibrate_tables(tables, &outcome)?;
        }
        Ok(outcome)
    })
}

/// What the drops of a campaign show.
struct Seen {
    /// Drops with their features.
    drops: Vec<DropData>,
    /// The plate.
    plate: Option<PlateEstimate>,
    /// Drops that show nothing.
    failed: Vec<FailureOutcome>,
    /// Whether features come from recordings.
    recorded: bool,
}

/// Features of every drop, from impacts.csv or otherwise from its recording.
fn feature_drops(campaign: &DropCampaign, progress: Progress) -> Result<Seen, Error> {
    let entries = &campaign.shared.entries;
    let written: Vec<_> = entries
        .iter()
        .map(|entry| written_features(campaign, entry))
        .collect::<Result<_, Error>>()?;
    let (recorded, mut failed) = match written.iter().all(|features| !features.is_empty()) {
        true => (Vec::new(), Vec::new()),
        false => {
            let evaluated = measure_recordings(campaign, Reuse::Unchanged, progress)?;
            (evaluated.items, evaluated.failed)
        }
    };
    failed.retain(|failure| {
        let place = entries.iter().position(|entry| entry.id == failure.id);
        place.is_none_or(|place| written[place].is_empty())
    });
    let mut drops = Vec::new();
    for (place, entry) in entries.iter().enumerate() {
        let own = recorded.iter().find(|(position, _)| *position == place);
        let features = match (written[place].is_empty(), own) {
            (false, _) => written[place].clone(),
            (true, Some((_, measured))) => recorded_features(measured, campaign.calibrate.bounces),
            (true, None) => continue,
        };
        match features.is_empty() {
            false => drops.push(drop_data(campaign, entry, features)?),
            true => {
                let message = "no bounce of it is complete and below the limit of the instrument";
                failed.push(*failure(entry, None, message.to_owned()));
            }
        }
    }
    if drops.is_empty() && !failed.is_empty() {
        return Err(Error::NothingFitted {
            path: campaign.shared.directory.clone(),
            failures: failed,
        });
    }
    let measured: Vec<MeasuredDrop> = recorded.into_iter().map(|(_, drop)| drop).collect();
    Ok(Seen {
        drops,
        plate: plate_of(campaign, &measured)?,
        failed,
        recorded: !measured.is_empty(),
    })
}

fn calibrated(
    campaign: &DropCampaign,
    request: &CalibrateRequest,
    seen: Seen,
    progress: Progress,
) -> Result<CalibrateOutcome, Error> {
    let Seen {
        drops,
        plate,
        failed,
        recorded,
    } = seen;
    let Some(own) = &campaign.calibrate.law else {
        let advice = "add to campaign.toml: [fit] law = 'adams-impact(d=\"0.001 mm\")'";
        let missing = "there is no law to calibrate";
        return Err(Error::not_known(&campaign.shared.title, missing, advice));
    };
    let rig = calibrate_rig(campaign, plate.as_ref());
    let (target, mut findings) = target_condition(&campaign.calibrate, &drops)?;
    let speed = rig.rig.impact_velocity(target.height.value);
    let energy = 0.5 * target.mass.value * rig.rig.effective_mass_factor * speed * speed;
    let law = free_law(own, &campaign.calibrate, energy)?;
    let work = Work {
        problem: problem_of(&rig, &drops, own.end),
        ways: ways(campaign, request, (&law, recorded), &mut findings),
        campaign,
        own,
        law,
        rig,
        drops,
        target,
    };
    let mut outcome = CalibrateOutcome {
        windfall: VERSION.to_owned(),
        campaign: campaign.shared.title.clone(),
        simulated: campaign.shared.simulated.clone(),
        law: own.law.to_string(),
        free: work.law.names(),
        plate: plate_outcome(&work.rig),
        drops: drop_outcomes(&work.drops),
        target: work.target.outcome.clone(),
        start: work.law.outcome.clone(),
        waveform: None,
        features: None,
        family: None,
        closing: Vec::new(),
        design: None,
        next: None,
        failed,
        findings,
    };
    by_features(&work, request, &mut outcome, progress)?;
    still_wanted(&work, progress)?;
    if work.ways.contains(&Way::Design) {
        let (design, found) = calibrate_by_design(&work.setting())?;
        outcome.design = Some(design);
        outcome.findings.extend(of_way("design", found));
    }
    Ok(outcome)
}

/// Between two pieces of work that are done in one go.
fn still_wanted(work: &Work, progress: Progress) -> Result<(), Error> {
    match progress(work.drops.len(), work.drops.len()) {
        ControlFlow::Continue(()) => Ok(()),
        ControlFlow::Break(()) => Err(Error::Cancelled),
    }
}

/// Features, the line that the target leaves, what closes it and what to do next.
fn by_features(
    work: &Work,
    request: &CalibrateRequest,
    outcome: &mut CalibrateOutcome,
    progress: Progress,
) -> Result<(), Error> {
    let end = work.own.end;
    // Where features only give a start, one drop of each height is enough.
    let few = match work.ways.contains(&Way::Features) {
        true => None,
        false => Some(problem_of(&work.rig, &one_of_each_height(&work.drops), end)),
    };
    let problem = few.as_ref().unwrap_or(&work.problem);
    let fitted = fit(&work.law, problem, &work.target, request.profile)?;
    if work.ways.contains(&Way::Waveform) {
        // Features that tell all parameters give the better start.
        let told = fitted.converged && fitted.information.rank == work.law.count();
        let start = if told { &fitted.law } else { &work.law.start };
        still_wanted(work, progress)?;
        let drops = recorded_drops(work.campaign)?;
        still_wanted(work, progress)?;
        let law = (start, &work.own.free[..]);
        let rig = &work.rig.rig;
        let (waveform, found) = waveform_outcome(work.campaign, law, end, rig, &drops)?;
        if let Some(figures) = &request.figures {
            let settings = &work.campaign.calibrate;
            let setting = (rig, end, settings.bounces);
            write_waveform_figures(figures, &waveform, setting, &drops, &settings.user)?;
        }
        outcome.waveform = Some(waveform);
        outcome.findings.extend(of_way("waveform", found));
    }
    still_wanted(work, progress)?;
    if work.ways.contains(&Way::Features) {
        let (features, found) = features_outcome(&work.law, &work.drops, &work.problem, &fitted);
        outcome.features = Some(features);
        outcome.findings.extend(of_way("features", found));
    }
    let heights = telling_heights(&heights_of(&work.drops), work.target.height.value);
    outcome.family = family_line(&work.law, &work.rig, &work.target, &heights, end)?;
    let setting = work.setting();
    outcome.closing = closing(&setting, &fitted.at)?;
    outcome.next = Some(next_experiment(&setting, &fitted.at)?);
    Ok(())
}

/// The first drop of each height.
fn one_of_each_height(drops: &[DropData]) -> Vec<DropData> {
    let mut chosen: Vec<DropData> = Vec::new();
    for drop in drops {
        let height = drop.height.value;
        if !chosen.iter().any(|c| same_height(c.height.value, height)) {
            chosen.push(drop.clone());
        }
    }
    chosen
}

/// The requested ways, or all that apply.
fn ways(
    campaign: &DropCampaign,
    request: &CalibrateRequest,
    (law, recorded): (&FreeLaw, bool),
    findings: &mut Vec<FindingOutcome>,
) -> Vec<Way> {
    let asked = match request.ways.is_empty() {
        true => &campaign.calibrate.ways,
        false => &request.ways,
    };
    if !asked.is_empty() {
        return asked.clone();
    }
    let mut ways = match recorded {
        true => vec![Way::Waveform, Way::Features],
        false => vec![Way::Features],
    };
    if law.count() > 1 {
        let names = law.names().into_iter().zip(&law.ranges);
        let unranged = names.filter(|(_, range)| range.is_none());
        let unranged: Vec<String> = unranged.map(|(name, _)| name).collect();
        if unranged.is_empty() {
            ways.push(Way::Design);
        } else {
            let names = unranged.join(", ");
            let message = format!("no design and surface: [calibrate] ranges has none for {names}");
            findings.push(finding("no-design", message));
        }
    }
    ways
}

fn of_way(way: &str, findings: Vec<FindingOutcome>) -> impl Iterator<Item = FindingOutcome> {
    let way = way.to_owned();
    findings.into_iter().map(move |finding| FindingOutcome {
        message: format!("{way}: {}", finding.message),
        ..finding
    })
}
