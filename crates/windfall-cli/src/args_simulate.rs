//! `windfall simulate`: what may be asked for.

use crate::args_format::Format;
use clap::{Args, Subcommand, ValueEnum, ValueHint};
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
    /// A body on a line strikes: motion
    Carriage(SimulateCarriageArguments),
}

/// When a simulated contact is over.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum End {
    /// When the law's force returns to zero: no adhesion
    #[default]
    ForceZero,
    /// When the displacement is back at zero
    GapZero,
}

/// `windfall simulate impact`
#[derive(Debug, Args)]
#[command(after_help = "Example:
  windfall simulate impact --law 'kuwabara-kono(k=753599, c=1524)' --mass '0.2 kg' --velocity '0.5 m/s'
  windfall simulate impact --law 'adams-impact(k=\"0.868 N/mm^1.91\", e=1.91, c=\"5.56e-4 N s/mm\", d=\"0.001 mm\")' \\
      --mass '4.8 g' --velocity '3.13 m/s' --format json")]
pub struct SimulateImpactArguments {
    /// Force law with its parameters
    #[arg(long)]
    pub law: String,
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
      a campaign with specimens drawn from a normal distribution")]
pub struct SimulatePendulumArguments {
    /// Force law with its parameters
    #[arg(long, required_unless_present = "example")]
    pub law: Option<String>,
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
    /// Standard deviation of the force noise of the recordings
    #[arg(long, default_value = "1 N")]
    pub noise: String,
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
      --velocity '0.4 m/s' --driving-acceleration '0.3 m/s^2' --rate '10 kHz' --format csv")]
pub struct SimulateCarriageArguments {
    /// Force law with its parameters
    #[arg(long)]
    pub law: String,
    /// Mass of the body
    #[arg(long)]
    pub mass: String,
    /// Impact velocity
    #[arg(long)]
    pub velocity: String,
    /// Acceleration towards the fruit
    #[arg(long, default_value = "0 m/s^2")]
    pub driving_acceleration: String,
    /// Sampling rate of the motion
    #[arg(long, default_value = "200 kHz")]
    pub rate: String,
    /// When the contact is over
    #[arg(long, value_enum, default_value_t)]
    pub end: End,
    /// How the result is shown
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
}
