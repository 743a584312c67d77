//! `windfall simulate drop`: what may be asked for.

use crate::args::end::End;
use crate::args::format::Format;
use crate::args::simulate_eccentric::EccentricArguments;
use clap::{Args, ValueHint};
use std::path::PathBuf;

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
    /// Force law with its parameters, or a law card (FILE.toml)
    #[arg(long)]
    pub law: String,
    /// File of own laws ([laws.NAME] tables, as in campaign.toml) that --law can name
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub laws: Option<PathBuf>,
    /// Mass of the fruit, such as "4.8 g"
    #[arg(long)]
    pub mass: String,
    /// Height of its lowest point above the plate, such as "500 mm"; for a campaign, repeated
    #[arg(long = "height", required = true)]
    pub heights: Vec<String>,
    /// Plate, its spring and damper
    #[command(flatten)]
    pub plate: PlateArguments,
    /// Part of its mass that the contact of the fruit feels; 1 for a central impact
    #[arg(long, default_value_t = 1.0, value_name = "PART")]
    pub effective_mass_factor: f64,
    /// Acceleration of gravity
    #[arg(long, default_value = "9.80665 m/s^2")]
    pub gravity: String,
    /// Impacts to follow
    #[arg(long, default_value_t = 2)]
    pub impacts: usize,
    /// When a contact is over
    #[arg(long, value_enum, default_value_t)]
    pub end: End,
    /// Sampling rate: of the motion, which is shown then in csv and json; of the recordings of a
    /// campaign, 10 kHz if left out
    #[arg(long)]
    pub sampling_rate: Option<String>,
    /// Length of the motion, to a little after the last impact if left out; of each recording of a
    /// campaign, 1.5 s if left out
    #[arg(long)]
    pub duration: Option<String>,
    /// A body that turns
    #[command(flatten)]
    pub eccentric: EccentricArguments,
    /// Recordings of a campaign
    #[command(flatten)]
    pub recordings: DropRecordingsArguments,
    /// How the result is shown
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
}

/// The plate; rigid where nothing is given.
#[derive(Debug, Args)]
#[command(next_help_heading = "Plate (rigid if left out)")]
pub struct PlateArguments {
    /// Mass of the plate and of what moves with it
    #[arg(long, value_name = "QUANTITY")]
    pub plate_mass: Option<String>,
    /// Stiffness under the plate
    #[arg(long, value_name = "QUANTITY")]
    pub plate_stiffness: Option<String>,
    /// Damping under the plate
    #[arg(long, value_name = "QUANTITY")]
    pub plate_damping: Option<String>,
}

/// Fruit and instrument of a campaign.
#[derive(Debug, Args)]
#[command(next_help_heading = "A campaign of recordings")]
pub struct DropRecordingsArguments {
    /// Drops from each height, of a fresh fruit each
    #[arg(long, default_value_t = 5, value_name = "NUMBER")]
    pub drops: usize,
    /// Spread of mass between fruit, as a part
    #[arg(long, default_value_t = 0.06, value_name = "PART")]
    pub mass_spread: f64,
    /// Standard deviation of the weighing
    #[arg(long, default_value = "0.02 g", value_name = "QUANTITY")]
    pub mass_sd: String,
    /// Standard deviation of the setting of a height
    #[arg(long, default_value = "1 mm", value_name = "QUANTITY")]
    pub height_sd: String,
    /// Standard deviation of a parameter between fruit, such as c=0.05; repeated
    #[arg(long, value_name = "NAME=SD")]
    pub spread: Vec<String>,
    /// Parameter that campaign.toml gives, so that it is not estimated; repeated. The depth d of
    /// adams-impact if left out
    #[arg(long, value_name = "NAME")]
    pub hold: Vec<String>,
    /// Sensitivity of load cell and transmitter
    #[arg(long, default_value = "0.1 V/N", value_name = "QUANTITY")]
    pub sensitivity: String,
    /// Standard deviation of the noise of force
    #[arg(long, default_value = "0.03 N", value_name = "QUANTITY")]
    pub noise: String,
    /// Resolution of the analogue-to-digital converter; 0 for no rounding
    #[arg(long, default_value_t = 12, value_name = "NUMBER")]
    pub bits: u32,
    /// Largest voltage of the converter
    #[arg(long, default_value = "5 V", value_name = "QUANTITY")]
    pub range: String,
    /// Its lowest voltage; minus the largest if left out. At "0 V" the downward swings of a
    /// ringing plate are cut off
    #[arg(long, value_name = "QUANTITY", allow_hyphen_values = true)]
    pub lowest: Option<String>,
    /// Seed of fruit, heights, trigger and noise
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
}
