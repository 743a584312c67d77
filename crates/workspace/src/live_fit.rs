//! One impact, fitted repeatedly while windows, laws and options change: the recording is
//! read once, and nothing is kept.

use crate::equal_command::command_of_fit;
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::time::Instant;
use windfall_campaign::impacts::bench::find_rig;
use windfall_campaign::impacts::figure_impact::{
    FittedImpact, figure_of_impact, line_of_law, motion_at, shown_rate,
};
use windfall_campaign::impacts::fit::{fit_law, law_problem};
use windfall_campaign::impacts::mass::RigFound;
use windfall_campaign::pipeline::request::{FitRequest, apply_request};
use windfall_campaign::recording::extract::extract_entry;
use windfall_campaign::recording::read::{read_with_gaps, recording_file};
use windfall_campaign::result::fit_outcome::told;
use windfall_campaign::result::outcome::ImpactOutcome;
use windfall_campaign::settings::model::{ImpactCampaign, ImpactEntry};
use windfall_campaign::settings::read::read_campaign;
use windfall_draw::xy::Figure;
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::known_names::known_names;
use windfall_files::named::Named;
use windfall_files::text::quote::path_word;
use windfall_identify::compare::ranking::aicc_of_laws;
use windfall_identify::fit::interval::{IntervalMethod, IntervalOptions};
use windfall_identify::fit::problem::{FitOptions, LawProblem};
use windfall_identify::rig::kind::Rig;
use windfall_identify::rig::simulate::Trajectory;
use windfall_signal::Finding;
use windfall_signal::impact::{Impact, Series};
use windfall_signal::recording::Recording;

/// Most samples of a series that are shown.
const MOST_SHOWN: usize = 3000;

/// A campaign of impacts with its rig, ready for fits.
#[derive(Clone, Debug)]
pub struct LiveCampaign {
    campaign: ImpactCampaign,
    rig: RigFound,
}

/// An impact of it with its recording in memory.
#[derive(Clone, Debug)]
pub struct LiveImpact {
    // Of this impact and its specimen only.
    campaign: ImpactCampaign,
    rig: RigFound,
    recording: Recording,
}

/// Options of a live fit.
#[derive(Clone, Debug, Default)]
pub struct LiveRequest {
    /// Begin of the part of the recording that is used, overriding impacts.csv; s.
    pub from: Option<f64>,
    /// Its end; s.
    pub to: Option<f64>,
    /// Laws and options in place of those of the campaign.
    pub fit: FitRequest,
    /// Whether measured series and residuals are wanted.
    pub series: bool,
}

/// Values at times on the clock of the recording.
#[derive(Clone, Debug, Default, PartialEq, Serialize, utoipa::ToSchema)]
pub struct ShownSamples {
    /// Times; s.
    pub time: Vec<f64>,
    /// Values, as exact as a picture can be; SI.
    pub value: Vec<f32>,
}

/// The motion under a fitted law.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct ShownMotion {
    /// Times on the clock of the recording; s.
    pub time: Vec<f64>,
    /// Displacement as the recording counts it; m.
    pub displacement: Vec<f32>,
    /// Displacement rate; m/s.
    pub rate: Vec<f32>,
    /// Contact force; N.
    pub force: Vec<f32>,
}

/// One law on the impact.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct LiveLaw {
    /// Name of the law.
    pub law: String,
    /// The result, as `fit` would give it.
    pub outcome: Option<ImpactOutcome>,
    /// Why there is none.
    pub problem: Option<String>,
    /// Akaike's criterion less that of the best law, under one noise for all, where several
    /// laws are fitted and residuals are asked for.
    pub aicc: Option<f64>,
    /// Its motion.
    pub motion: Option<ShownMotion>,
    /// Measured less fitted, of each quantity of the cost; SI.
    pub residuals: Named<ShownSamples>,
}

/// What a live fit gives.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct LiveOutcome {
    /// Id of the impact.
    pub impact: String,
    /// Part of the recording that was used; s.
    pub from: Option<f64>,
    /// Its end; s.
    pub to: Option<f64>,
    /// First time in the recording; s.
    pub start: f64,
    /// Last time in it; s.
    pub stop: f64,
    /// First contact by the threshold; s.
    pub onset: f64,
    /// End of contact by the threshold; s.
    pub end: f64,
    /// What the instruments show around the contact.
    pub measured: Named<ShownSamples>,
    /// Laws, in the order asked for.
    pub laws: Vec<LiveLaw>,
    /// What the signals say of themselves.
    pub findings: Vec<FindingOutcome>,
    /// The equal command.
    pub command: String,
    /// Time that it took; s.
    pub seconds: f64,
}

/// An impact in a recording, and what the signals say of themselves.
type FoundImpact = (Impact, Vec<Finding>);

impl LiveCampaign {
    /// Reads a campaign of single impacts.
    ///
    /// # Errors
    /// The campaign is wrong, or nothing shows the mass of its rig.
    pub fn open(directory: &Path) -> Result<Self, Error> {
        let mut campaign = read_campaign(directory)?;
        campaign.shared.check_rig_given()?;
        let rig = find_rig(&mut campaign)?;
        Ok(Self { campaign, rig })
    }

    fn entry(&self, id: &str) -> Result<&ImpactEntry, Error> {
        let mut entries = self.campaign.shared.entries.iter();
        let names = entries.clone().map(|entry| entry.id.as_str());
        let entry = entries.find(|entry| entry.id == id);
        entry.ok_or_else(|| Error::ImpactUnknown {
            id: id.to_owned(),
            known: known_names(id, names),
        })
    }

    /// Where the recording of one of its impacts is.
    ///
    /// # Errors
    /// There is no such impact.
    pub fn recording(&self, id: &str) -> Result<PathBuf, Error> {
        let entry = self.entry(id)?;
        let files = &self.campaign.shared.files;
        recording_file(files, entry)
    }

    /// Reads the recording of one of its impacts.
    ///
    /// # Errors
    /// There is no such impact, or its recording cannot be read.
    pub fn impact(&self, id: &str) -> Result<LiveImpact, Error> {
        let entry = self.entry(id)?.clone();
        let recording = read_with_gaps(&self.campaign.shared.files, &entry)?;
        let mut campaign = self.campaign.clone();
        let specimens = &mut campaign.shared.specimens;
        specimens.retain(|specimen| specimen.id == entry.specimen);
        campaign.shared.entries = vec![entry];
        Ok(LiveImpact {
            campaign,
            rig: self.rig.clone(),
            recording,
        })
    }
}

impl LiveImpact {
    /// Bytes that its recording takes in memory, about.
    pub fn bytes(&self) -> usize {
        let channels = self.recording.channels.iter();
        channels.map(|channel| 16 * channel.samples.len()).sum()
    }

    /// Fits the impact as asked; intervals that would take long are asymptotic.
    ///
    /// * `shown`: name of the campaign directory in the equal command
    ///
    /// # Errors
    /// The request is wrong, or there is no contact in the part of the recording. A law
    /// that cannot be fitted is reported in the outcome.
    pub fn refit(&self, request: &LiveRequest, shown: &str) -> Result<LiveOutcome, Error> {
        let begin = Instant::now();
        let (campaign, (impact, findings)) = self.read(request)?;
        let entry = &campaign.shared.entries[0];
        let laws = campaign.fit.laws.iter().map(|law| {
            let own = (&campaign, &self.rig.rig);
            let fitted = fit_law(own, entry, (&impact, &findings), law);
            self.live_law(&campaign, &impact, law.kind.name(), fitted, request.series)
        });
        let mut laws: Vec<LiveLaw> = laws.collect();
        if request.series && laws.len() > 1 {
            let criteria = criteria(&campaign, &self.rig.rig, &impact);
            for (law, aicc) in laws.iter_mut().zip(criteria) {
                law.aicc = aicc.filter(|_| law.outcome.is_some());
            }
        }
        let (start, stop) = ends(&self.recording);
        Ok(LiveOutcome {
            impact: entry.id.clone(),
            from: entry.from,
            to: entry.to,
            start,
            stop,
            onset: impact.onset,
            end: impact.end,
            measured: match request.series {
                true => measured(&impact),
                false => Named::default(),
            },
            laws,
            findings: findings.iter().map(told).collect(),
            command: equal_command(&campaign, entry, shown, &request.fit),
            seconds: begin.elapsed().as_secs_f64(),
        })
    }

    /// The figure that `fit --figures` draws of the impact, fitted as asked.
    ///
    /// # Errors
    /// Those of [`LiveImpact::refit`]; a law cannot be fitted.
    pub fn figure(&self, request: &LiveRequest) -> Result<Figure, Error> {
        let (campaign, (impact, findings)) = self.read(request)?;
        let entry = &campaign.shared.entries[0];
        let rig = &self.rig.rig;
        let laws = campaign.fit.laws.iter();
        let fitted = laws.map(|law| fit_law((&campaign, rig), entry, (&impact, &findings), law));
        let outcomes = fitted.collect::<Result<Vec<ImpactOutcome>, Error>>()?;
        let outcomes: Vec<&ImpactOutcome> = outcomes.iter().collect();
        let used = (rig, campaign.fit.options.end, &campaign.fit.user[..]);
        Ok(figure_of_impact(&entry.id, &impact, &outcomes, used))
    }

    /// The campaign with the options that are asked for, and the impact in that part of its
    /// recording, with what the signals say of themselves.
    fn read(&self, request: &LiveRequest) -> Result<(ImpactCampaign, FoundImpact), Error> {
        let mut campaign = self.campaign.clone();
        apply_request(&mut campaign, &request.fit)?;
        // What resamples or draws takes long, and is for the whole campaign.
        let method = &mut campaign.fit.options.intervals.method;
        if let IntervalMethod::Bootstrap | IntervalMethod::Posterior = method {
            *method = IntervalMethod::Asymptotic;
        }
        let entry = &mut campaign.shared.entries[0];
        entry.from = request.from.or(entry.from);
        entry.to = request.to.or(entry.to);
        let mass = Some(self.rig.rig.effective_mass());
        let entry = &campaign.shared.entries[0];
        let found = extract_entry(&campaign, entry, &self.recording, mass)?;
        Ok((campaign, found))
    }

    fn live_law(
        &self,
        campaign: &ImpactCampaign,
        impact: &Impact,
        law: &str,
        fitted: Result<ImpactOutcome, Error>,
        series: bool,
    ) -> LiveLaw {
        let mut shown = LiveLaw {
            law: law.to_owned(),
            outcome: None,
            problem: None,
            aicc: None,
            motion: None,
            residuals: Named::default(),
        };
        let outcome = match fitted {
            Ok(outcome) => outcome,
            Err(error) => {
                shown.problem = Some(error.to_string());
                return shown;
            }
        };
        let fit = &campaign.fit;
        let used = (&self.rig.rig, fit.options.end, &fit.user[..]);
        shown.motion = line_of_law(impact, &outcome, used).map(|motion| shown_motion(&motion));
        if let (true, Some(fitted)) = (series, FittedImpact::of(impact, &outcome, used)) {
            for (name, _) in &outcome.residuals.0 {
                if let Some(left) = residuals(&fitted, impact, name) {
                    shown.residuals.push(name.as_str(), left);
                }
            }
        }
        shown.outcome = Some(outcome);
        shown
    }
}

/// Akaike's criterion of each law, as `windfall laws` compares them: without priors.
fn criteria(campaign: &ImpactCampaign, rig: &Rig, impact: &Impact) -> Vec<Option<f64>> {
    let mut campaign = campaign.clone();
    campaign.fit.without_priors();
    let laws = campaign.fit.laws.iter();
    let problems: Vec<LawProblem> = laws.map(|law| law_problem(law, &campaign.fit)).collect();
    let options = FitOptions {
        intervals: IntervalOptions::default(),
        ..campaign.fit.options
    };
    aicc_of_laws(impact, rig, &problems, &options)
}

fn equal_command(
    campaign: &ImpactCampaign,
    entry: &ImpactEntry,
    shown: &str,
    request: &FitRequest,
) -> String {
    let directory = &campaign.shared.files.directory;
    let folder = directory.strip_prefix(&campaign.shared.directory);
    let path = folder.unwrap_or(directory).join(&entry.file);
    let path = path_word(Path::new(shown).join(path));
    command_of_fit(&["fit", &path], request)
}

/// First and last time of a recording; s.
fn ends(recording: &Recording) -> (f64, f64) {
    let channels = recording.channels.iter().filter(|c| !c.samples.is_empty());
    let ends = channels.map(|c| (c.times.at(0), c.times.at(c.samples.len() - 1)));
    ends.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
        .unwrap_or_default()
}

/// Names of the series of an impact, as the quantities of a cost are called.
fn named_series(impact: &Impact) -> [(&'static str, Option<&Series>); 4] {
    [
        ("force", impact.force.as_ref()),
        ("displacement", impact.displacement.as_ref()),
        ("rate", impact.rate.as_ref()),
        ("acceleration", impact.acceleration.as_ref()),
    ]
}

fn measured(impact: &Impact) -> Named<ShownSamples> {
    let mut shown = Named::default();
    for (name, series) in named_series(impact) {
        if let (Some(series), true) = (series, name != "rate") {
            shown.push(name, shown_samples(&series.times, &series.values));
        }
    }
    // Differences of neighbouring counts would be nothing or a whole count.
    if let Some((_, rate)) = shown_rate(impact) {
        shown.push("rate", shown_samples(&rate.times, &rate.values));
    }
    shown
}

/// Every n-th sample, so that few enough are left.
fn shown_samples(times: &[f64], values: &[f64]) -> ShownSamples {
    let stride = times.len().div_ceil(MOST_SHOWN).max(1);
    ShownSamples {
        time: times.iter().copied().step_by(stride).collect(),
        value: single(values.iter().copied().step_by(stride)),
    }
}

fn single(values: impl Iterator<Item = f64>) -> Vec<f32> {
    values.map(|value| value as f32).collect()
}

fn residuals(fitted: &FittedImpact, impact: &Impact, name: &str) -> Option<ShownSamples> {
    let found = named_series(impact);
    let (_, series) = found.into_iter().find(|(known, _)| *known == name)?;
    let series = series?;
    let motion = motion_at(fitted, &series.times)?;
    let model = match name {
        "force" => &motion.force,
        "displacement" => &motion.displacement,
        "rate" => &motion.rate,
        _ => &motion.acceleration,
    };
    let left = series.values.iter().zip(model);
    let left: Vec<f64> = left.map(|(measured, model)| measured - model).collect();
    Some(shown_samples(&series.times, &left))
}

fn shown_motion(motion: &Trajectory) -> ShownMotion {
    ShownMotion {
        time: motion.times.clone(),
        displacement: single(motion.displacement.iter().copied()),
        rate: single(motion.rate.iter().copied()),
        force: single(motion.force.iter().copied()),
    }
}
