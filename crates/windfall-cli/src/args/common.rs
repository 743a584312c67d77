//! The command line and its help.

use crate::args::bounces::BouncesArguments;
use crate::args::bruise::BruiseArguments;
use crate::args::calibrate::CalibrateArguments;
use crate::args::compare::{CompareArguments, SummaryArguments};
use crate::args::design::DesignArguments;
use crate::args::fit::FitArguments;
use crate::args::format::{Format, Shown};
use crate::args::geometry::{RadiusArguments, TransferArguments};
use crate::args::kind::NewKind;
use crate::args::laws::LawsArguments;
use crate::args::plan::PlanArguments;
use crate::args::population::PopulationArguments;
use crate::args::regress::RegressArguments;
use crate::args::report::ReportArguments;
use crate::args::scene::SceneCommand;
use crate::args::schema::SchemaArguments;
use crate::args::serve::ServeArguments;
use crate::args::simulate::SimulateArguments;
use crate::args::surface::SurfaceArguments;
use crate::saying::Saying;
use clap::{Args, Parser, Subcommand, ValueHint};
use std::path::PathBuf;
use windfall_campaign::settings::open_options::OpenRequest;
use windfall_draw::width::Width;

/// From recordings of fruit impacts to contact-force laws.
#[derive(Debug, Parser)]
#[command(
    name = "windfall",
    version,
    propagate_version = true,
    arg_required_else_help = true
)]
#[command(after_help = "Examples:
  windfall new pendulum my-campaign       write a commented template
  windfall inspect my-campaign/raw/*.csv  see what the recordings hold
  windfall fit my-campaign                recordings → parameters, table, results.sqlite
  windfall report my-campaign             figures and a page with all of it
  windfall serve my-campaign              all of it in the browser
  windfall simulate impact --law 'kuwabara-kono(k=753599, c=1524)' --mass '0.2 kg' --velocity '0.5 m/s'
  windfall new scene my-scene; windfall scene run my-scene/scene.toml
  windfall design ccd --factor 'k=0.3..1' --factor 'e=1.5..3' --out design.csv
  windfall card show --laws               the force laws")]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
    /// Replace files that windfall did not write, or that were changed since; never an input
    #[arg(long, global = true)]
    pub force: bool,
    /// Directory in which campaigns, scenes, studies and laws may name files, besides their own
    /// (repeatable)
    #[arg(long, global = true, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub also_read: Vec<PathBuf>,
    /// Print only the result and what went wrong; no progress bar
    #[arg(long, short, global = true)]
    pub quiet: bool,
    /// Also print which files were read and written, and how long it took
    #[arg(long, short, global = true, conflicts_with = "quiet")]
    pub verbose: bool,
}

impl Arguments {
    /// How much the command says.
    pub fn saying(&self) -> Saying {
        match (self.quiet, self.verbose) {
            (true, _) => Saying::Little,
            (false, true) => Saying::Much,
            (false, false) => Saying::Usual,
        }
    }
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Write a commented template of a campaign or a scene
    New(NewArguments),
    /// List further recordings in a campaign
    Add(AddArguments),
    /// Show what recordings hold and what looks wrong
    Inspect(InspectArguments),
    /// Fit force laws to the impacts of a campaign
    Fit(Box<FitArguments>),
    /// Compare force laws: which one the impacts of a campaign obey, and how sure that is
    Laws(LawsArguments),
    /// Estimate how the law varies between fruit and with covariates
    Population(PopulationArguments),
    /// Write figures, tables and a page on a campaign: methods, results, findings, origin
    Report(Box<ReportArguments>),
    /// Work on campaigns in the browser: a server on this machine, for this machine
    Serve(ServeArguments),
    /// Calibrate a contact law to dropped fruit: by features, and by design and surface
    Calibrate(CalibrateArguments),
    /// Plan a study: how many fruit, and how many impacts on each
    Plan(Box<PlanArguments>),
    /// Make a design of experiments
    Design(Box<DesignArguments>),
    /// Simulate one event from a force law
    Simulate(SimulateArguments),
    /// Simulate many fruit in a machine: which contacts each fruit suffers
    #[command(subcommand)]
    Scene(SceneCommand),
    /// Describe the values of a table group by group: mean, SD, CV, interval, quartiles
    Summary(SummaryArguments),
    /// Compare groups of a table, or predictions with what was measured
    Compare(Box<CompareArguments>),
    /// Fit a linear model to a table
    Regress(Box<RegressArguments>),
    /// Fit response surfaces to a table of runs, and find the best settings
    Surface(Box<SurfaceArguments>),
    /// Radius of curvature from a chord gauge or three diameters
    Radius(RadiusArguments),
    /// Restitution from the times between successive impacts of a bouncing fruit
    Bounces(BouncesArguments),
    /// Volumes of bruises from their measured widths and depths
    Bruise(BruiseArguments),
    /// Show force laws, or take one to another geometry
    Card(CardArguments),
    /// Explain findings: what they mean and what to do
    Explain(ExplainArguments),
    /// Write the JSON Schema of a campaign.toml or scene.toml, for editors, or of the JSON that a
    /// command answers
    Schema(SchemaArguments),
    /// Write shell completions to standard output
    Completions {
        /// The shell
        shell: clap_complete::Shell,
    },
    /// Write the manual pages of all commands
    Man(ManArguments),
    /// Show what windfall is made of: crates and other parts with their licences
    Licences(LicencesArguments),
}

impl Command {
    /// Whether it lasts until it is interrupted.
    pub fn is_endless(&self) -> bool {
        match self {
            Self::Serve(_) => true,
            Self::Fit(own) => own.watch,
            _ => false,
        }
    }
}

/// `windfall new`
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  windfall new pendulum my-campaign
  windfall new pendulum my-campaign --from recordings --names '{variety}_f{fruit}_{height_mm}mm_{rep}.csv'
      a campaign of recordings that are named by a rule")]
pub struct NewArguments {
    /// Kind of rig
    pub kind: NewKind,
    /// Directory to make; it must not exist or be empty
    #[arg(value_hint = ValueHint::DirPath)]
    pub directory: PathBuf,
    /// Folder of recordings, which are copied into the campaign: both tables and the channels
    /// are filled from what they are called and hold
    #[arg(long, value_name = "FOLDER", value_hint = ValueHint::DirPath)]
    pub from: Option<PathBuf>,
    /// What the names of the recordings say, such as '{variety}_f{fruit}_{height_mm}mm_{rep}.csv'
    #[arg(long, value_name = "PATTERN", requires = "from")]
    pub names: Option<String>,
    /// Program that wrote the recordings, which says what their columns are called;
    /// `windfall inspect --presets` lists them
    #[arg(long, value_name = "NAME", requires = "from")]
    pub preset: Option<String>,
    /// How the list of written files is shown
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
}

/// `windfall add`
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  windfall add my-campaign /media/stick/*.csv    copy them into my-campaign/raw and list them
  windfall add my-campaign                       list what lies in my-campaign/raw already")]
pub struct AddArguments {
    /// The campaign directory
    #[arg(value_hint = ValueHint::DirPath)]
    pub directory: PathBuf,
    /// Recordings to copy into the campaign; those that lie in its raw/ if left out
    #[arg(value_hint = ValueHint::FilePath)]
    pub files: Vec<PathBuf>,
    /// What their names say, in place of [files] names of the campaign
    #[arg(long, value_name = "PATTERN")]
    pub names: Option<String>,
    /// How the result is shown
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
}

/// `windfall explain`
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  windfall explain clipped offset-removed
  windfall explain                        all of them")]
pub struct ExplainArguments {
    /// Codes of findings; all if left out
    pub codes: Vec<String>,
    #[command(flatten)]
    pub shown: Shown,
}

/// `windfall man`
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  windfall man --out man
      man/windfall.1, man/windfall-fit.1 and so on; `man man/windfall-fit.1` shows one")]
pub struct ManArguments {
    /// Folder of the pages, one for each command
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub out: PathBuf,
    /// How the list of written files is shown
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
}

/// `windfall licences`
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  windfall licences               names, versions and licences
  windfall licences --texts       with the texts

Where a part may be taken under MIT or another licence, MIT is chosen and its text shown.")]
pub struct LicencesArguments {
    /// Show the texts of the licences, too
    #[arg(long)]
    pub texts: bool,
    #[command(flatten)]
    pub shown: Shown,
}

/// `windfall inspect`
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  windfall inspect raw/*.tdms
  windfall inspect impact.lvm --plot impact.svg
      a figure of all channels, with its data in impact.csv beside it
  windfall inspect tap.wav --channel 'channel 1' --format json
  windfall inspect drop.tdms --export drop.csv
      every sample, with names and units; .npy for numpy.load

Formats: text (CSV and relatives), LVM, TDMS, MAT (4 to 7.3), HDF5, WAV, UFF58 and 58b, sigrok, \
xlsx, ods, npy and npz, zip of CSV; found out from the first bytes of the file.")]
pub struct InspectArguments {
    /// Recordings of any format
    #[arg(required_unless_present = "presets", value_hint = ValueHint::FilePath)]
    pub files: Vec<PathBuf>,
    /// Program that wrote the recordings, which says what their columns are called
    #[arg(long, value_name = "NAME")]
    pub preset: Option<String>,
    /// List the presets, with the exports that they were made from
    #[arg(long, conflicts_with_all = ["files", "preset"])]
    pub presets: bool,
    /// Show only this channel; may be repeated
    #[arg(long = "channel", value_name = "NAME")]
    pub channels: Vec<String>,
    /// Write a figure of the channels (SVG, PNG or PDF, by its ending) and its data (CSV, same name); one recording only
    #[arg(long, value_name = "FILE.svg|FILE.png|FILE.pdf", value_hint = ValueHint::FilePath)]
    pub plot: Option<PathBuf>,
    /// Width of the figure in print, as a journal asks for it: 84mm, 174mm; letters are 8 pt at that size
    #[arg(long, value_name = "LENGTH", requires = "plot")]
    pub width: Option<Width>,
    /// Write every sample as it was read, as CSV or NumPy array (by its ending); one recording only
    #[arg(long, value_name = "FILE.csv|FILE.npy", value_hint = ValueHint::FilePath)]
    pub export: Option<PathBuf>,
    #[command(flatten)]
    pub open: OpenRequest,
    #[command(flatten)]
    pub shown: Shown,
}

/// `windfall card`
#[derive(Debug, Args)]
pub struct CardArguments {
    /// What to do with cards
    #[command(subcommand)]
    pub action: CardAction,
}

/// Actions on law cards.
#[derive(Debug, Subcommand)]
pub enum CardAction {
    /// Show the force laws, or published values: parameters, units, source
    #[command(after_help = "Examples:
  windfall card show --laws
  windfall card show --laws my-campaign/campaign.toml
  windfall card show --file law.toml
  windfall card show --library --fruit apple
  windfall card show --library jonagold-2003
  windfall card show --library golden-delicious-regression --at 'V=0.34 m/s, R=50 mm, t=6 ms'")]
    Show {
        /// List all laws, or the own laws of a file ([laws.NAME] tables, as in campaign.toml)
        #[arg(long, value_name = "FILE", num_args = 0..=1, value_hint = ValueHint::FilePath, required_unless_present_any = ["law", "library", "file"])]
        laws: Option<Option<PathBuf>>,
        /// Show one law, with all its parameters
        #[arg(long, value_name = "LAW")]
        law: Option<String>,
        /// Show a law card: a calibrated law with its uncertainty, range and origin
        #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, conflicts_with_all = ["laws", "law", "library"])]
        file: Option<PathBuf>,
        /// Published values and models, or the entry of this name, with source and cautions
        #[arg(long, value_name = "NAME", num_args = 0..=1, conflicts_with_all = ["laws", "law"])]
        library: Option<Option<String>>,
        /// Of the library, only this fruit or variety
        #[arg(long, value_name = "FRUIT", requires = "library", conflicts_with_all = ["laws", "law"])]
        fruit: Option<String>,
        /// Evaluate regressions of the library: NAME=VALUE with units, separated by commas
        #[arg(long, value_name = "VALUES", requires = "library", conflicts_with_all = ["laws", "law"])]
        at: Option<String>,
        #[command(flatten)]
        shown: Shown,
    },
    /// Take a law from one geometry to another by R* and E*
    Transfer(TransferArguments),
}
