//! A campaign: channels, specimens, entries, and of impacts rig and options, in SI units.

use crate::settings::kind::CampaignKind;
use crate::settings::rig_given::RigAsked;
use serde::Serialize;
use std::path::PathBuf;
use std::sync::Arc;
use windfall_contact::expression::LawExpression;
use windfall_contact::laws::kind::LawKind;
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::name::Name;
use windfall_formats::open::OpenOptions;
use windfall_identify::fit::problem::{FitOptions, Known};
use windfall_identify::rig::bench::{BenchQuantity, BenchSd};
use windfall_identify::rig::kind::{Pendulum, Rig};
use windfall_signal::ExtractOptions;
use windfall_signal::recording::Quantity;

/// What the directory of a campaign of any kind says.
#[derive(Clone, Debug)]
pub struct Campaign {
    /// The campaign directory.
    pub directory: PathBuf,
    /// What it measures.
    pub kind: CampaignKind,
    /// Title of tables and reports.
    pub title: String,
    /// Label shown with every result when the recordings are simulated.
    pub simulated: Option<String>,
    /// Remark on the campaign.
    pub note: Option<String>,
    /// Why nothing is to be calculated with the rig, where it is still that of a template.
    pub rig_asked: Option<RigAsked>,
    /// How recordings are read.
    pub files: FilePlan,
    /// Column of specimens.csv or impacts.csv by which results are grouped.
    pub group: Option<String>,
    /// Specimens, in the order of specimens.csv; none where there is no such file.
    pub specimens: Vec<Specimen>,
    /// Rows of impacts.csv, one for each recording or part of one.
    pub entries: Vec<ImpactEntry>,
}

impl Campaign {
    /// Refuses to calculate with the rig of a template.
    ///
    /// # Errors
    /// Nobody has said what the rig is.
    pub fn check_rig_given(&self) -> Result<(), Error> {
        self.rig_asked
            .as_ref()
            .map_or(Ok(()), |asked| Err(asked.error()))
    }

    /// The specimen of an entry, where specimens.csv has it.
    pub fn specimen_of(&self, entry: &ImpactEntry) -> Option<&Specimen> {
        let mut specimens = self.specimens.iter();
        specimens.find(|specimen| specimen.id == entry.specimen)
    }

    /// The group of an entry, where the campaign has groups.
    pub fn group_of(&self, entry: &ImpactEntry) -> Option<String> {
        let column = self.group.as_ref()?;
        let specimen = self.specimen_of(entry);
        let specimen = specimen.map_or(&[][..], |specimen| &specimen.cells);
        let mut cells = specimen.iter().chain(&entry.cells);
        let (_, cell) = cells.find(|(name, _)| name == column.as_str())?;
        Some(cell.clone())
    }
}

/// A campaign of single impacts.
#[derive(Clone, Debug)]
pub struct ImpactCampaign {
    /// What all kinds share.
    pub shared: Campaign,
    /// The rig.
    pub rig: RigPlan,
    /// What of the bench is uncertain, and what is estimated.
    pub bench: BenchPlan,
    /// How impacts are cut out; mass and time range of an impact are filled in later.
    pub contact: ExtractOptions,
    /// What is fitted.
    pub fit: FitPlan,
    /// Covariates of the population: columns, or their logarithms.
    pub covariates: Vec<String>,
}

/// What is known of the bench beyond its values.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BenchPlan {
    /// Standard uncertainties, which all impacts share.
    pub sd: BenchSd,
    /// Quantities that are to be estimated over all impacts.
    pub estimate: Vec<BenchQuantity>,
    /// Those that have been.
    pub found: Vec<BenchFound>,
}

/// A quantity of the bench as the impacts tell it; SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BenchFound {
    /// The quantity.
    pub quantity: BenchQuantity,
    /// Its value.
    pub value: f64,
    /// Its standard uncertainty.
    pub sd: f64,
    /// What campaign.toml says, where it says something.
    pub told: Option<f64>,
    /// Impacts that it comes from.
    pub impacts: usize,
}

/// The rig, as far as the campaign knows it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RigPlan {
    /// A pendulum.
    Pendulum(Pendulum),
    /// A carriage.
    Carriage {
        /// Its mass.
        mass: MassPlan,
        /// Acceleration towards the fruit without contact; m/s².
        driving_acceleration: f64,
        /// Standard uncertainty of the acceleration; m/s².
        driving_acceleration_sd: f64,
    },
}

impl RigPlan {
    /// Mass that the contact feels, where campaign.toml says it; kg.
    pub fn given_mass(&self) -> Option<f64> {
        match self {
            Self::Pendulum(pendulum) => Some(Rig::Pendulum(*pendulum).effective_mass()),
            Self::Carriage {
                mass: MassPlan::Given { value, .. },
                ..
            } => Some(*value),
            Self::Carriage { .. } => None,
        }
    }
}

/// Where the mass of a carriage comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MassPlan {
    /// Weighed.
    Given {
        /// Mass; kg.
        value: f64,
        /// Standard uncertainty; kg.
        sd: f64,
    },
    /// From impulse and change of velocity, over all impacts.
    FromImpulse,
}

/// How recordings are read.
#[derive(Clone, Debug, PartialEq)]
pub struct FilePlan {
    /// Directory of the recordings.
    pub directory: PathBuf,
    /// Where recordings must lie, behind any links; anywhere, where the user named the
    /// recording itself.
    pub within: Option<PathBuf>,
    /// The bytes of the recording where it is in memory and its file is only a name.
    pub held: Option<Arc<[u8]>>,
    /// How files are read that do not say it themselves.
    pub open: OpenOptions,
    /// How samples are timed where a channel does not say otherwise.
    pub time: TimePlan,
    /// Seconds per unit of the time columns.
    pub time_scale: f64,
    /// Channels.
    pub channels: Vec<ChannelPlan>,
}

/// How samples are timed.
#[derive(Clone, Debug, PartialEq)]
pub enum TimePlan {
    /// A column of times.
    Column(String),
    /// A sampling rate; Hz.
    Rate(f64),
    /// Every channel has a column of times of its own.
    OfChannels,
    /// The file itself says when samples were taken.
    OfFile,
}

/// One channel: value = scale · (cell − offset).
#[derive(Clone, Debug, PartialEq)]
pub struct ChannelPlan {
    /// Name of its table in campaign.toml, with brackets.
    pub table: &'static str,
    /// Line of its column in campaign.toml; 0 where the command line gave it.
    pub line: usize,
    /// What it holds.
    pub quantity: Quantity,
    /// Column in the file; `{name}` is filled from impacts.csv.
    pub column: String,
    /// Column of times of this channel alone; may have placeholders too.
    pub time: Option<String>,
    /// SI units per unit of the column.
    pub scale: f64,
    /// What the column shows at zero; unit of the column.
    pub offset: f64,
    /// Taken off the recorded times: filters, and averages that are stamped with
    /// the end of their interval, show an event late; s.
    pub delay: f64,
    /// Standard uncertainty of the scale, as a part of it; 1.
    pub scale_sd: f64,
    /// Standard uncertainty of the delay; s.
    pub delay_sd: f64,
    /// Standard deviation of the noise of a sample, where it is given; SI.
    pub noise_sd: Option<f64>,
}

/// What is fitted.
#[derive(Clone, Debug)]
pub struct FitPlan {
    /// The laws, each fitted to every impact.
    pub laws: Vec<LawExpression>,
    /// Names of parameters that are estimated although they have a value.
    pub free: Vec<String>,
    /// Priors and bounds, as they were written.
    pub known_texts: Vec<KnownText>,
    /// What they say of the parameters and nuisances of each law.
    pub known: Vec<(LawKind, Known)>,
    /// The user's own laws, by which laws can be named.
    pub user: Vec<LawKind>,
    /// Cost function and treatment of the nuisance parameters.
    pub options: FitOptions,
}

/// Which of the two things can be known of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum KnownKind {
    /// "2.4e5 ± 0.3e5 N/m^1.5"
    Prior,
    /// "0 … 50 N s/m"
    Bounds,
}

impl KnownKind {
    /// Its key below `[fit]`, and its option without dashes.
    pub fn name(self) -> &'static str {
        match self {
            Self::Prior => "prior",
            Self::Bounds => "bounds",
        }
    }
}

/// What is known of a parameter, as it was written.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct KnownText {
    /// Which of the two.
    pub kind: KnownKind,
    /// The parameter.
    pub name: String,
    /// The quantity.
    pub text: String,
}

impl FitPlan {
    /// Takes out priors, which are of fits of single impacts; a finding that says so, if there
    /// were any.
    pub fn without_priors(&mut self) -> Option<FindingOutcome> {
        let is_prior = |own: &KnownText| own.kind == KnownKind::Prior;
        let (priors, bounds) = std::mem::take(&mut self.known_texts)
            .into_iter()
            .partition(is_prior);
        self.known_texts = bounds;
        self.known
            .iter_mut()
            .for_each(|(_, known)| known.prior = None);
        let priors: Vec<String> = priors.into_iter().map(|own: KnownText| own.name).collect();
        (!priors.is_empty()).then(|| {
            let told = format!(
                "the priors of {} take no part: they are of fits of single impacts, and here each \
                 would count as often as there are impacts",
                priors.join(", ")
            );
            FindingOutcome::new("priors-not-used", told)
        })
    }
}

/// One row of specimens.csv.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Specimen {
    /// Its id.
    pub id: String,
    /// Line in specimens.csv.
    pub line: usize,
    /// All columns: name and cell.
    pub cells: Vec<(Name, String)>,
}

/// One row of impacts.csv.
#[derive(Clone, Debug, PartialEq)]
pub struct ImpactEntry {
    /// Its id.
    pub id: String,
    /// The specimen.
    pub specimen: String,
    /// The recording, relative to the directory of recordings.
    pub file: String,
    /// Line in impacts.csv.
    pub line: usize,
    /// Start of the part of the recording to use; s.
    pub from: Option<f64>,
    /// End of the part of the recording to use; s.
    pub to: Option<f64>,
    /// All columns: name and cell.
    pub cells: Vec<(Name, String)>,
}
