//! `windfall simulate`: arguments.

use crate::args::format::{Format, Shown};
use clap::{Args, Subcommand, ValueHint};
use std::path::PathBuf;
use windfall_draw::width::Width;
use windfall_simulate::compression::SimulateCompressionRequest;
use windfall_simulate::drops::SimulateDropsRequest;
use windfall_simulate::repeats::SimulateRepeatsRequest;
use windfall_simulate::request::drop::{DropRequest, PLATE};
use windfall_simulate::request::eccentric::EccentricRequest;
use windfall_simulate::request::impact::{CarriageRequest, ImpactRequest, PendulumRequest};
use windfall_simulate::taps::SimulateTapsRequest;

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
    #[command(flatten)]
    pub request: SimulateTapsRequest,
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
    #[command(flatten)]
    pub request: SimulateCompressionRequest,
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
    #[command(flatten)]
    pub request: SimulateRepeatsRequest,
    /// How the result is shown
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
}

/// `windfall simulate impact`
#[derive(Debug, Args)]
#[command(after_help = "Example:
  windfall simulate impact --law 'kuwabara-kono(k=753599, c=1524)' --mass '0.2 kg' --velocity '0.5 m/s'
  windfall simulate impact --law 'hertz(k=753599)' --mass '0.2 kg' --velocity '0.5 m/s' --plot hertz.svg
  windfall simulate impact --law 'kuwabara-kono(k=753599, c=1524)' --mass '0.2 kg' --height '0.1 m'
  windfall simulate impact --law 'adams-impact(k=\"0.868 N/mm^1.91\", e=1.91, c=\"5.56e-4 N s/mm\", d=\"0.001 mm\")' \\
      --mass '4.8 g' --velocity '3.13 m/s' --format json")]
pub struct SimulateImpactArguments {
    #[command(flatten)]
    pub request: ImpactRequest,
    /// Write a figure of the impact, loop and force over time (SVG, PNG or PDF, by its ending), and its
    /// data (CSV, same name)
    #[arg(long, value_name = "FILE.svg|FILE.png|FILE.pdf", value_hint = ValueHint::FilePath)]
    pub plot: Option<PathBuf>,
    /// Width of the figure in print, as a journal asks for it: 84mm, 174mm; letters are 8 pt at that size
    #[arg(long, value_name = "LENGTH", requires = "plot")]
    pub width: Option<Width>,
    #[command(flatten)]
    pub shown: Shown,
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
    #[command(flatten)]
    pub request: PendulumRequest,
    #[command(flatten)]
    pub shown: Shown,
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
    #[command(flatten)]
    pub request: CarriageRequest,
    #[command(flatten)]
    pub shown: Shown,
}

/// `windfall simulate drop`
#[derive(Debug, Args)]
#[command(
    after_help = "Examples, with the rig and the law of the Cerasus humilis study (2023):
  windfall simulate drop --law 'adams-impact(k=\"0.868 N/mm^1.91\", e=1.91, c=\"5.56e-4 N s/mm\", d=\"0.001 mm\")' \\
      --mass '4.8 g' --height '500 mm' --plate-mass '0.2 kg' --plate-stiffness '645.8 N/mm' \\
      --plate-damping '0.05247 N s/mm'
      peaks of contact and support force, separations, intervals of the first two impacts
  windfall simulate drop --law 'hertz(k=170000)' --mass '4.8 g' --height '500 mm' \\
      --sampling-rate '100 kHz' --format csv
      the motion on a rigid plate
  windfall simulate drop --law 'hertz(k=170000)' --mass '4.8 g' --height '500 mm' \\
      --offset '3.8 mm' --radius '10 mm' --friction 0.3
      a ball whose centre of mass is beside its centre: it turns
  windfall simulate drop my-campaign --law 'adams-impact(…)' --mass '4.8 g' --height '100 mm' \\
      --height '300 mm' --height '500 mm' --plate-mass '0.2 kg' --plate-stiffness '645.8 N/mm' \\
      --plate-damping '0.05247 N s/mm'
      a campaign of recordings in volts, five drops from each height"
)]
pub struct SimulateDropArguments {
    /// Directory of a campaign of recordings to make; it must not exist or be empty. Without it,
    /// one drop is simulated and shown
    #[arg(value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub directory: Option<PathBuf>,
    #[command(flatten)]
    pub drop: DropRequest,
    /// Sampling rate: of the motion, which is shown then in csv and json; of the recordings of a
    /// campaign, 10 kHz if left out
    #[arg(long, help_heading = PLATE)]
    pub sampling_rate: Option<String>,
    /// Length of the motion, to a little after the last impact if left out; of each recording of a
    /// campaign, 1.5 s if left out
    #[arg(long, help_heading = PLATE)]
    pub duration: Option<String>,
    #[command(flatten)]
    pub eccentric: EccentricRequest,
    #[command(flatten)]
    pub recordings: SimulateDropsRequest,
    #[command(flatten)]
    pub shown: Shown,
}
