//! `windfall fit`: arguments.

use crate::args::figures::FigureArguments;
use crate::args::format::Format;
use clap::{Args, ValueHint};
use std::path::PathBuf;

/// `windfall fit`
#[derive(Debug, Args)]
#[command(
    after_help = "Results of a campaign go to standard output and to DIR/results.sqlite; impacts whose \
recording and options have not changed are answered from there.

Exit status: 0 when at least one impact was fitted (what failed is reported), 1 when none was, \
2 when the request or the campaign is wrong.

Examples:
  windfall fit my-campaign
  windfall fit my-campaign --law hertz --law kuwabara-kono --format json
  windfall fit my-campaign --law 'power-law' --free n
  windfall fit my-campaign --law kuwabara-kono --card law.toml
      the median fruit as a law card: `windfall simulate impact --law law.toml …`
  windfall fit my-campaign/raw/apple-7.csv
      one recording of a campaign
  windfall fit my-campaign --quantities displacement,rate,force --weights inverse-mean
      the cost function and the weights of the 2003 pendulum study
  windfall fit my-campaign --intervals profile
      intervals that follow the likelihood, in place of estimate ± t × deviation
  windfall fit impact.csv --rig pendulum --inertia '0.01435 kg m^2' --arm '0.505 m' \\
      --mass '0.11 kg' --centre-of-mass '0.3 m' --time t --channel force=F:N \\
      --channel position=x:mm --law kuwabara-kono
      one recording without a campaign; nothing is written"
)]
pub struct FitArguments {
    /// The campaign directory, one recording of a campaign, or any recording with --rig
    #[arg(value_name = "DIR|FILE", value_hint = ValueHint::AnyPath)]
    pub directory: PathBuf,
    /// Law to fit in place of those of the campaign; may be repeated
    #[arg(long = "law", value_name = "LAW")]
    pub laws: Vec<String>,
    /// File of own laws ([laws.NAME] tables) that --law can name, besides those of the campaign
    #[arg(long = "laws", value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub laws_file: Option<PathBuf>,
    /// Parameter to estimate although it has a value, such as an exponent; may be repeated
    #[arg(long, value_name = "NAME")]
    pub free: Vec<String>,
    /// Quantities of the cost function: displacement, rate, force, acceleration
    #[arg(long, value_delimiter = ',', value_name = "NAME,…")]
    pub quantities: Vec<String>,
    /// Weights of the cost function: by each channel's noise, or 1/mean as in the 2003 study
    #[arg(long, value_parser = ["inverse-variance", "inverse-mean"], value_name = "WEIGHTS")]
    pub weights: Option<String>,
    /// Noise of the channels: as the recording shows it, or white sample by sample
    #[arg(long, value_parser = ["automatic", "white"], value_name = "NOISE")]
    pub noise: Option<String>,
    /// How the 95 % intervals are made
    #[arg(long, value_parser = ["asymptotic", "profile", "bootstrap", "posterior"], value_name = "HOW")]
    pub intervals: Option<String>,
    /// Resampled recordings of each impact for --intervals bootstrap (1000)
    #[arg(long, value_name = "N")]
    pub replicates: Option<usize>,
    /// Draws of each of four chains for --intervals posterior (1000)
    #[arg(long, value_name = "N")]
    pub draws: Option<usize>,
    /// Seed of bootstrap and posterior (1)
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
    /// Time of first touch: fixed where the force passes its threshold, free, or as the data can tell
    #[arg(long, value_parser = ["auto", "free", "fixed"], value_name = "HOW")]
    pub onset: Option<String>,
    /// Velocity at first touch: auto, free, fixed (as measured), or held at a value ("0.35 m/s")
    #[arg(long, value_name = "HOW")]
    pub initial_velocity: Option<String>,
    /// Zero of the displacement
    #[arg(long, value_parser = ["auto", "free", "fixed"], value_name = "HOW")]
    pub displacement_offset: Option<String>,
    /// When the contact is over
    #[arg(long, value_parser = ["force-zero", "gap-zero"], value_name = "END")]
    pub end: Option<String>,
    /// Column of specimens.csv or impacts.csv by which results are grouped
    #[arg(long, value_name = "COLUMN")]
    pub group: Option<String>,
    /// Fit every impact again, even where nothing has changed
    #[arg(long)]
    pub refit: bool,
    /// A figure of each recording
    #[command(flatten)]
    pub drawn: FigureArguments,
    /// Write the law as a law card: the median fruit, how fruit differ, and in what it was seen
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, conflicts_with = "rig")]
    pub card: Option<PathBuf>,
    /// Number of threads; all cores if left out. It never changes a result
    #[arg(long, value_name = "N")]
    pub threads: Option<usize>,
    /// How the result is shown
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
    /// Rig and channels of a recording without a campaign
    #[command(flatten)]
    pub recording: RecordingArguments,
}

/// What campaign.toml would say.
#[derive(Debug, Args)]
#[command(next_help_heading = "One recording without a campaign")]
pub struct RecordingArguments {
    /// The rig that the recording comes from
    #[arg(long, value_parser = ["pendulum", "carriage"], value_name = "RIG", requires = "laws")]
    pub rig: Option<String>,
    /// Pendulum: moment of inertia about the pivot, such as "0.01435 kg m^2"
    #[arg(long, requires = "rig", value_name = "QUANTITY")]
    pub inertia: Option<String>,
    /// Pendulum: pivot to point of contact, such as "0.505 m"
    #[arg(long, requires = "rig", value_name = "QUANTITY")]
    pub arm: Option<String>,
    /// Mass of arm and impactor, or of the carriage: "0.11 kg", or "from impulse" for a carriage
    #[arg(long, requires = "rig", value_name = "QUANTITY")]
    pub mass: Option<String>,
    /// Pendulum: pivot to centre of mass, such as "0.3 m"
    #[arg(long, requires = "rig", value_name = "QUANTITY")]
    pub centre_of_mass: Option<String>,
    /// Pendulum: acceleration of gravity; 9.80665 m/s^2 if left out
    #[arg(long, requires = "rig", value_name = "QUANTITY")]
    pub gravity: Option<String>,
    /// Carriage: acceleration towards the fruit when nothing touches; 0 if left out
    #[arg(
        long,
        requires = "rig",
        value_name = "QUANTITY",
        allow_hyphen_values = true
    )]
    pub driving_acceleration: Option<String>,
    /// A channel: force, position, velocity, acceleration, angle, count, phase_a or phase_b, its
    /// column, and after a colon the unit of the column (SI if left out), what one unit of it
    /// stands for ("-1 N"), or the sensitivity of a sensor ("11 mV/N"); repeated
    #[arg(
        long = "channel",
        requires = "rig",
        value_name = "CHANNEL=COLUMN[:UNIT]"
    )]
    pub channels: Vec<String>,
    /// Column of times, in s unless a unit follows a colon
    #[arg(long, requires = "rig", value_name = "COLUMN[:UNIT]")]
    pub time: Option<String>,
    /// Sampling rate, where there is no column of times
    #[arg(
        long,
        requires = "rig",
        value_name = "QUANTITY",
        conflicts_with = "time"
    )]
    pub sampling_rate: Option<String>,
    /// Counts per revolution of a rotary encoder, after x4 decoding
    #[arg(long, requires = "rig", value_name = "NUMBER")]
    pub counts_per_revolution: Option<f64>,
    /// Displacement per count of a linear encoder, such as "0.17 mm"
    #[arg(long, requires = "rig", value_name = "QUANTITY")]
    pub count_length: Option<String>,
    /// Force above which there is contact: "1 N", or "auto" (from the noise before contact)
    #[arg(long, requires = "rig", value_name = "QUANTITY")]
    pub threshold: Option<String>,
}
