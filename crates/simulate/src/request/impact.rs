//! Impacts of a free body, a carriage and a pendulum: options → events.

use crate::request::event::{Event, ends, event};
use crate::request::instrument::PendulumInstrument;
use crate::request::recordings::SpecimenRequest;
use clap::{Args, ValueHint};
use std::path::PathBuf;
use windfall_campaign::settings::rig::STANDARD_GRAVITY;
use windfall_files::error::Error;
use windfall_files::option_value::{positive, quantity};
use windfall_identify::rig::kind::{Carriage, Pendulum, Rig};

/// A free body strikes once; texts with units.
#[derive(Clone, Debug, Args)]
pub struct ImpactRequest {
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
    #[arg(long, default_value = "force-zero", value_parser = ends())]
    pub end: String,
}

/// A body on a line strikes, once or in a campaign of recordings; texts with units.
#[derive(Clone, Debug, Args)]
pub struct CarriageRequest {
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
    /// Its specimens
    #[command(flatten)]
    pub specimens: SpecimenRequest,
    /// Seed of specimens and noise
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// When the contact is over
    #[arg(long, default_value = "force-zero", value_parser = ends())]
    pub end: String,
}

/// A pendulum strikes, once or in a campaign of recordings; texts with units.
#[derive(Clone, Debug, Args)]
pub struct PendulumRequest {
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
    /// Its specimens
    #[command(flatten)]
    pub specimens: SpecimenRequest,
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
    /// What records
    #[command(flatten)]
    pub instrument: PendulumInstrument,
    /// When the contact is over
    #[arg(long, default_value = "force-zero", value_parser = ends())]
    pub end: String,
    /// Seed of specimens and noise
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
}

/// Reads the request for one impact of a free body.
pub fn impact_event(request: &ImpactRequest) -> Result<Event, Error> {
    let carriage = carriage(&request.mass, &request.driving_acceleration)?;
    let law = (request.law.as_str(), request.laws.as_deref());
    event(law, carriage, &request.velocity, &request.end)
}

/// Reads the request for an impact of a body on a line.
pub fn carriage_event(request: &CarriageRequest) -> Result<Event, Error> {
    let carriage = carriage(&request.mass, &request.driving_acceleration)?;
    let law = (request.law.as_str(), request.laws.as_deref());
    event(law, carriage, &request.velocity, &request.end)
}

/// Reads the request for an impact of a pendulum.
pub fn pendulum_event(request: &PendulumRequest) -> Result<Event, Error> {
    let law = request.law.as_deref().unwrap_or_default();
    let rig = Rig::Pendulum(Pendulum {
        inertia: positive("--inertia", &request.inertia, "kg m^2")?,
        arm: positive("--arm", &request.arm, "m")?,
        mass: positive("--mass", &request.mass, "kg")?,
        centre_of_mass: quantity("--centre-of-mass", &request.centre_of_mass, "m")?,
        gravity: STANDARD_GRAVITY,
    });
    let law = (law, request.laws.as_deref());
    event(law, rig, &request.velocity, &request.end)
}

fn carriage(mass: &str, driving: &str) -> Result<Rig, Error> {
    Ok(Rig::Carriage(Carriage {
        mass: positive("--mass", mass, "kg")?,
        driving_acceleration: quantity("--driving-acceleration", driving, "m/s^2")?,
    }))
}
