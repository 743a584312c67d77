//! `windfall simulate`: what may be asked for.

use crate::args::end::End;
use crate::args::format::Format;
use crate::args::simulate_drop::SimulateDropArguments;
use clap::{Args, Subcommand, ValueHint};
use std::path::PathBuf;

/// `windfall simulate`
#[derive(Debug, Args)]
pub struct SimulateArguments {
    /// The event
    #[command(subcommand)]
    pub event: SimulateEvent,
}

/// Events that can be simulated.
#[derive(Debug, Subcommand)]
pub enum SimulateEvent {
    /// A free body strikes once: peaks, duration, restitution, energy
    Impact(SimulateImpactArguments),
    /// A pendulum strikes: motion, or a campaign of recordings
    Pendulum(Box<SimulatePendulumArguments>),
    /// A body on a line strikes: motion, or a campaign of recordings
    Carriage(Box<SimulateCarriageArguments>),
    /// Slow compressions: a campaign of recordings
    Compression(SimulateCompressionArguments),
    /// Taps on fruit: a campaign of sound recordings
    Tap(SimulateTapArguments),
    /// Drops repeated on one spot of fruit with a critical energy: a campaign of recordings
    Repeats(SimulateRepeatsArguments),
    /// A fruit falls on a plate and bounces: impacts, motion, or a campaign of recordings
    Drop(Box<SimulateDropArguments>),
}

/// `windfall simulate tap`
#[derive(Debug, Args)]
#[command(after_help = "Example:
  windfall simulate tap my-campaign --frequency '800 Hz' --quality 20
  windfall fit my-campaign
  windfall fit my-campaign --format csv")]
pub struct SimulateTapArguments {
    /// Directory of the campaign to make; it must not exist or be empty
    #[arg(value_hint = ValueHint::DirPath)]
    pub directory: PathBuf,
    /// Frequency of the first mode
    #[arg(long, default_value = "800 Hz")]
    pub frequency: String,
    /// Its quality: frequency over width of the peak
    #[arg(long, default_value_t = 20.0)]
    pub quality: f64,
    /// Mass of a fruit
    #[arg(long, default_value = "0.2 kg")]
    pub mass: String,
    /// Number of fruit
    #[arg(long, default_value_t = 6)]
    pub fruit: usize,
    /// Taps in a recording; each fruit has a recording at each of two places
    #[arg(long, default_value_t = 2)]
    pub taps: usize,
    /// Spread of frequency and mass between fruit, as a part
    #[arg(long, default_value_t = 0.08)]
    pub spread: f64,
    /// Distance of the two frequencies of a split mode, as a part; 0 for spheres
    #[arg(long, default_value_t = 0.0)]
    pub split: f64,
    /// Signal over noise, in power over the first 50 ms of a tap; dB
    #[arg(long, default_value_t = 30.0, allow_hyphen_values = true)]
    pub signal_to_noise: f64,
    /// Format of the recordings: wav or csv
    #[arg(long, default_value = "wav")]
    pub file: String,
    /// Sampling rate
    #[arg(long, default_value = "44100 Hz")]
    pub sampling_rate: String,
    /// Seed of noise and spread
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
}

/// `windfall simulate compression`
#[derive(Debug, Args)]
#[command(after_help = "Example:
  windfall simulate compression my-campaign --law 'kuwabara-kono(k=300000, c=20000)' \\
      --rate '1 mm/s' --rate '20 mm/s' --yield-force '30 N'
  windfall fit my-campaign")]
pub struct SimulateCompressionArguments {
    /// Directory of the campaign to make; it must not exist or be empty
    #[arg(value_hint = ValueHint::DirPath)]
    pub directory: PathBuf,
    /// Force law of the crosshead's travel, with its parameters
    #[arg(long)]
    pub law: String,
    /// File of own laws ([laws.NAME] tables, as in campaign.toml) that --law can name
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub laws: Option<PathBuf>,
    /// Rate of deformation; may be repeated: every fruit is compressed at each
    #[arg(long = "rate", default_value = "1 mm/s")]
    pub rates: Vec<String>,
    /// Largest deformation
    #[arg(long, default_value = "2 mm")]
    pub deformation: String,
    /// Radius of the fruit
    #[arg(long, default_value = "38 mm")]
    pub radius: String,
    /// Plates that deform the fruit: 1 or 2
    #[arg(long, default_value_t = 2)]
    pub plates: u32,
    /// Force at which the tissue yields; never if left out
    #[arg(long)]
    pub yield_force: Option<String>,
    /// Number of fruit
    #[arg(long, default_value_t = 3)]
    pub fruit: usize,
    /// Spread of stiffness and damping between fruit, as a part
    #[arg(long, default_value_t = 0.0)]
    pub spread: f64,
    /// Standard deviation of the noise of force
    #[arg(long, default_value = "0.02 N")]
    pub force_noise: String,
    /// Sampling rate
    #[arg(long, default_value = "1 kHz")]
    pub sampling_rate: String,
    /// Seed of noise and spread
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
}

/// `windfall simulate repeats`
#[derive(Debug, Args)]
#[command(after_help = "Example:
  windfall simulate repeats my-campaign --fruit 12 --seed 1
  windfall fit my-campaign")]
pub struct SimulateRepeatsArguments {
    /// Directory of the campaign to make; it must not exist or be empty
    #[arg(value_hint = ValueHint::DirPath)]
    pub directory: PathBuf,
    /// Number of fruit; an elastic ball is added as reference
    #[arg(long, default_value_t = 12)]
    pub fruit: usize,
    /// Impact energy; may be repeated
    #[arg(long = "energy", default_values = ["0.04 J", "0.056 J", "0.08 J", "0.11 J", "0.16 J", "0.22 J", "0.31 J"])]
    pub energies: Vec<String>,
    /// Impacts on the spot at each energy
    #[arg(long, default_value_t = 2)]
    pub repeats: usize,
    /// Where the impacts of the next energy fall: on the same spot, or on a fresh one
    #[arg(long, default_value = "same", value_parser = ["same", "fresh"])]
    pub spots: String,
    /// Median critical energy of the fruit
    #[arg(long, default_value = "0.12 J")]
    pub critical_energy: String,
    /// Standard deviation of the logarithm of the critical energy between fruit
    #[arg(long, default_value_t = 0.3)]
    pub spread: f64,
    /// Mass that falls
    #[arg(long, default_value = "200 g")]
    pub mass: String,
    /// Standard deviation of the noise of force
    #[arg(long, default_value = "0.3 N")]
    pub force_noise: String,
    /// Relative standard deviation of the impact velocity from drop to drop
    #[arg(long, default_value_t = 0.003)]
    pub velocity_scatter: f64,
    /// Sampling rate
    #[arg(long, default_value = "50 kHz")]
    pub sampling_rate: String,
    /// Seed of fruit and noise
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// How the result is shown
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
}

/// `windfall simulate impact`
#[derive(Debug, Args)]
#[command(after_help = "Example:
  windfall simulate impact --law 'kuwabara-kono(k=753599, c=1524)' --mass '0.2 kg' --velocity '0.5 m/s'
  windfall simulate impact --law 'hertz(k=753599)' --mass '0.2 kg' --velocity '0.5 m/s' --plot hertz.svg
  windfall simulate impact --law 'adams-impact(k=\"0.868 N/mm^1.91\", e=1.91, c=\"5.56e-4 N s/mm\", d=\"0.001 mm\")' \\
      --mass '4.8 g' --velocity '3.13 m/s' --format json")]
pub struct SimulateImpactArguments {
    /// Force law with its parameters, or a law card (FILE.toml)
    #[arg(long)]
    pub law: String,
    /// File of own laws ([laws.NAME] tables, as in campaign.toml) that --law can name
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub laws: Option<PathBuf>,
    /// Effective mass, such as "0.2 kg"
    #[arg(long)]
    pub mass: String,
    /// Impact velocity, such as "0.5 m/s"
    #[arg(long)]
    pub velocity: String,
    /// Acceleration towards the fruit during contact, such as "9.81 m/s^2"
    #[arg(long, default_value = "0 m/s^2")]
    pub driving_acceleration: String,
    /// When the contact is over
    #[arg(long, value_enum, default_value_t)]
    pub end: End,
    /// Write a figure of the impact, loop and force over time (SVG or PNG, by its ending), and its
    /// data (CSV, same name)
    #[arg(long, value_name = "FILE.svg|FILE.png", value_hint = ValueHint::FilePath)]
    pub plot: Option<PathBuf>,
    /// How the result is shown
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
}

/// `windfall simulate pendulum`
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  windfall simulate pendulum --example DIR
      a campaign of 80 simulated recordings: rubber half-ball, apple, tomato, potato
  windfall simulate pendulum --law 'kuwabara-kono(k=394931, c=681)' --format csv
      motion of one impact at 200 kHz
  windfall simulate pendulum --law 'kuwabara-kono(k=753599, c=1524)' \\
      --recordings DIR --specimens 30 --spread k=133165 --spread c=263 --seed 7
      a campaign with specimens drawn from a normal distribution
  windfall simulate pendulum --law 'kuwabara-kono(k=753599, c=1524)' --recordings DIR \\
      --encoder counts --counts-per-revolution 20000 --rate '50 kHz' --bits 12 --range '5 V'
      a coarser instrument: decoded counts of 0.018°, force through a 12-bit converter of ±5 V")]
pub struct SimulatePendulumArguments {
    /// Force law with its parameters, or a law card (FILE.toml)
    #[arg(long, required_unless_present = "example")]
    pub law: Option<String>,
    /// File of own laws ([laws.NAME] tables, as in campaign.toml) that --law can name
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub laws: Option<PathBuf>,
    /// Write the example campaign into this directory
    #[arg(long, value_name = "DIR", conflicts_with_all = ["law", "recordings"], value_hint = ValueHint::DirPath)]
    pub example: Option<PathBuf>,
    /// Write a campaign of recordings into this directory
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub recordings: Option<PathBuf>,
    /// Number of specimens of the campaign
    #[arg(long, default_value_t = 20)]
    pub specimens: usize,
    /// Impacts on each specimen
    #[arg(long, default_value_t = 1)]
    pub repeats: usize,
    /// Standard deviation of a parameter between specimens, such as k=133165
    #[arg(long, value_name = "NAME=SD")]
    pub spread: Vec<String>,
    /// Moment of inertia about the pivot
    #[arg(long, default_value = "0.01435 kg m^2")]
    pub inertia: String,
    /// Pivot to point of contact
    #[arg(long, default_value = "0.505 m")]
    pub arm: String,
    /// Mass of arm and impactor
    #[arg(long, default_value = "0.11 kg")]
    pub mass: String,
    /// Pivot to centre of mass
    #[arg(long, default_value = "0.3 m")]
    pub centre_of_mass: String,
    /// Impact velocity
    #[arg(long, default_value = "0.388 m/s")]
    pub velocity: String,
    /// Sampling rate
    #[arg(long, default_value = "200 kHz")]
    pub rate: String,
    /// What the encoder writes into the recordings: phases A and B, or decoded counts
    #[arg(long, default_value = "phases", value_parser = ["phases", "counts"])]
    pub encoder: String,
    /// Resolution of the encoder after x4 decoding
    #[arg(long, default_value_t = 360_000.0, value_name = "NUMBER")]
    pub counts_per_revolution: f64,
    /// Sensitivity of the force sensor
    #[arg(long, default_value = "11 mV/N")]
    pub sensitivity: String,
    /// Standard deviation of the force noise of the recordings
    #[arg(long, default_value = "1 N")]
    pub noise: String,
    /// Resolution of the analogue-to-digital converter; no rounding if left out
    #[arg(long, value_name = "NUMBER")]
    pub bits: Option<u32>,
    /// Largest voltage of the converter, of either sign; beyond it the force is clipped
    #[arg(long, default_value = "10 V")]
    pub range: String,
    /// When the contact is over
    #[arg(long, value_enum, default_value_t)]
    pub end: End,
    /// Seed of specimens and noise
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// How the result is shown
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
}

/// `windfall simulate carriage`
#[derive(Debug, Args)]
#[command(after_help = "Example:
  windfall simulate carriage --law 'hunt-crossley(k=753599, lambda=678239)' --mass '0.5 kg' \\
      --velocity '0.4 m/s' --driving-acceleration '0.3 m/s^2' --rate '10 kHz' --format csv
      motion of one impact
  windfall simulate carriage --law 'kelvin-voigt(k=2000, c=3)' --mass '0.5 kg' --velocity '0.4 m/s' \\
      --recordings DIR --specimens 5 --sensor 'force: rate=1 kHz, noise=0.1 N' \\
      --sensor 'position: rate=100 Hz, noise=0.05 mm, bits=12, range=10 V' --unweighed
      a campaign of recordings, each sensor at its own rate; the mass is left to be found")]
pub struct SimulateCarriageArguments {
    /// Force law with its parameters, or a law card (FILE.toml)
    #[arg(long)]
    pub law: String,
    /// File of own laws ([laws.NAME] tables, as in campaign.toml) that --law can name
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub laws: Option<PathBuf>,
    /// Mass of the body
    #[arg(long)]
    pub mass: String,
    /// Impact velocity
    #[arg(long)]
    pub velocity: String,
    /// Acceleration towards the fruit
    #[arg(long, default_value = "0 m/s^2", allow_hyphen_values = true)]
    pub driving_acceleration: String,
    /// Sampling rate of the motion; recordings have the rates of their sensors
    #[arg(long, default_value = "200 kHz")]
    pub rate: String,
    /// Write a campaign of recordings into this directory
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub recordings: Option<PathBuf>,
    /// A sensor of the recordings: force, position, velocity or acceleration, then after a colon
    /// any of rate, noise, sensitivity, offset, bits, range; or an encoder, count or phases, with
    /// length and rate; repeated. Force and position at 10 kHz if left out
    #[arg(
        long = "sensor",
        value_name = "NAME[: KEY=VALUE, …]",
        requires = "recordings"
    )]
    pub sensors: Vec<String>,
    /// Leave the mass out of the campaign, so that fit finds it from impulse
    #[arg(long, requires = "recordings")]
    pub unweighed: bool,
    /// Number of specimens of the campaign
    #[arg(long, default_value_t = 20)]
    pub specimens: usize,
    /// Impacts on each specimen
    #[arg(long, default_value_t = 1)]
    pub repeats: usize,
    /// Standard deviation of a parameter between specimens, such as k=133165
    #[arg(long, value_name = "NAME=SD")]
    pub spread: Vec<String>,
    /// Seed of specimens and noise
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// When the contact is over
    #[arg(long, value_enum, default_value_t)]
    pub end: End,
    /// How the result is shown
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
}
