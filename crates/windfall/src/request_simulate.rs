//! `windfall simulate` as it is asked for: texts with units → SI.

use crate::error::Error;
use crate::option_value::{chosen, positive, quantity};
use crate::read_fit::ENDS;
use crate::read_rig::STANDARD_GRAVITY;
use crate::simulate_campaign::{Batch, SimulatedCampaign, write_simulated_campaign};
use crate::toml_source::suggestion;
use crate::workflow_simulate::{
    SimulatedImpact, SimulatedMotion, complete_law, simulate_motion, simulate_one,
};
use std::path::Path;
use windfall_contact::law::EndRule;
use windfall_contact::law_kind::Law;
use windfall_identify::rig::{Carriage, Pendulum, Rig};
use windfall_signal::instrument::pendulum_instrument;

/// A free body, or one on a line, strikes once.
#[derive(Clone, Debug)]
pub struct CarriageRequest {
    /// Law expression with all parameters.
    pub law: String,
    /// Mass, with unit.
    pub mass: String,
    /// Impact velocity, with unit.
    pub velocity: String,
    /// Acceleration towards the fruit, with unit.
    pub driving_acceleration: String,
    /// "force-zero" or "gap-zero".
    pub end: String,
}

/// A pendulum strikes once.
#[derive(Clone, Debug)]
pub struct PendulumRequest {
    /// Law expression with all parameters.
    pub law: String,
    /// Moment of inertia about the pivot, with unit.
    pub inertia: String,
    /// Pivot to point of contact, with unit.
    pub arm: String,
    /// Mass of arm and impactor, with unit.
    pub mass: String,
    /// Pivot to centre of mass, with unit.
    pub centre_of_mass: String,
    /// Impact velocity, with unit.
    pub velocity: String,
    /// "force-zero" or "gap-zero".
    pub end: String,
}

/// A campaign of recordings of a pendulum.
#[derive(Clone, Debug)]
pub struct RecordingsRequest {
    /// Sampling rate, with unit.
    pub rate: String,
    /// Standard deviation of the force noise, with unit.
    pub noise: String,
    /// Standard deviations between specimens: "k=133165".
    pub spread: Vec<String>,
    /// Number of specimens.
    pub specimens: usize,
    /// Impacts on each specimen.
    pub repeats: usize,
    /// Seed of specimens and noise.
    pub seed: u64,
}

/// Simulates one impact of a body on a line.
///
/// # Errors
/// An option cannot be read, or the impact cannot be simulated.
pub fn simulate_carriage(request: &CarriageRequest) -> Result<SimulatedImpact, Error> {
    let (law, rig, velocity, end) = carriage_event(request)?;
    simulate_one(&law, &rig, velocity, end)
}

/// Simulates one impact of a body on a line with its motion.
///
/// # Errors
/// As [`simulate_carriage`].
pub fn simulate_carriage_motion(
    request: &CarriageRequest,
    rate: &str,
) -> Result<SimulatedMotion, Error> {
    let (law, rig, velocity, end) = carriage_event(request)?;
    simulate_motion(&law, &rig, velocity, positive("--rate", rate, "Hz")?, end)
}

/// Simulates one impact of a pendulum with its motion.
///
/// # Errors
/// As [`simulate_carriage`].
pub fn simulate_pendulum_motion(
    request: &PendulumRequest,
    rate: &str,
) -> Result<SimulatedMotion, Error> {
    let law = complete_law(&request.law)?;
    let rig = Rig::Pendulum(pendulum(request)?);
    let velocity = positive("--velocity", &request.velocity, "m/s")?;
    let rate = positive("--rate", rate, "Hz")?;
    simulate_motion(
        &law,
        &rig,
        velocity,
        rate,
        chosen("--end", &request.end, &ENDS)?,
    )
}

/// Writes a campaign of simulated recordings; returns how many.
///
/// # Errors
/// An option cannot be read, or the directory cannot be written.
pub fn simulate_pendulum_recordings(
    request: &PendulumRequest,
    recordings: &RecordingsRequest,
    directory: &Path,
) -> Result<usize, Error> {
    let law = complete_law(&request.law)?;
    let rate = positive("--rate", &recordings.rate, "Hz")?;
    let noise = quantity("--noise", &recordings.noise, "N")?;
    let rig = pendulum(request)?;
    let mut instrument = pendulum_instrument();
    if let Some(encoder) = &mut instrument.encoder {
        encoder.sampling_rate = rate;
        encoder.arm = rig.arm;
    }
    if let Some(force) = &mut instrument.force {
        force.sampling_rate = rate;
        force.noise = noise;
    }
    let campaign = SimulatedCampaign {
        title: "Simulated pendulum campaign".to_owned(),
        label: format!(
            "windfall simulate pendulum, {}, seed {}",
            law_text(&law),
            recordings.seed
        ),
        rig,
        velocity: positive("--velocity", &request.velocity, "m/s")?,
        end: chosen("--end", &request.end, &ENDS)?,
        instrument,
        seed: recordings.seed,
    };
    let batch = Batch {
        variety: "specimen".to_owned(),
        law,
        spread: spread(&law, &recordings.spread)?,
        specimens: recordings.specimens,
        repeats: recordings.repeats,
    };
    write_simulated_campaign(directory, &campaign, &[batch])
}

fn law_text(law: &Law) -> String {
    windfall_contact::expression::LawExpression::from(*law)
        .to_string()
        .replace('"', "'")
}

fn carriage_event(request: &CarriageRequest) -> Result<(Law, Rig, f64, EndRule), Error> {
    let driving = &request.driving_acceleration;
    let rig = Rig::Carriage(Carriage {
        mass: positive("--mass", &request.mass, "kg")?,
        mass_sd: 0.0,
        driving_acceleration: quantity("--driving-acceleration", driving, "m/s^2")?,
    });
    let velocity = positive("--velocity", &request.velocity, "m/s")?;
    Ok((
        complete_law(&request.law)?,
        rig,
        velocity,
        chosen("--end", &request.end, &ENDS)?,
    ))
}

fn pendulum(request: &PendulumRequest) -> Result<Pendulum, Error> {
    Ok(Pendulum {
        inertia: positive("--inertia", &request.inertia, "kg m^2")?,
        arm: positive("--arm", &request.arm, "m")?,
        mass: positive("--mass", &request.mass, "kg")?,
        centre_of_mass: quantity("--centre-of-mass", &request.centre_of_mass, "m")?,
        gravity: STANDARD_GRAVITY,
    })
}

/// "k=133165" and "c=\"263 N s/m^1.5\"" → one standard deviation per parameter.
fn spread(law: &Law, texts: &[String]) -> Result<Vec<f64>, Error> {
    let description = law.kind().describe();
    let mut spread = vec![0.0; description.parameters.len()];
    for text in texts {
        let option = format!("--spread {text}");
        let names = description.parameters.iter().map(|p| p.name);
        let (name, value) = text.split_once('=').unwrap_or((text, ""));
        let Some(index) = description
            .parameters
            .iter()
            .position(|p| p.name == name.trim())
        else {
            let known = names.clone().collect::<Vec<_>>().join(", ");
            let problem = format!(
                "expected NAME=SD with a parameter of {}{}: {known}",
                description.name,
                suggestion(name, names)
            );
            return Err(Error::OptionInvalid { option, problem });
        };
        let value = value.trim().trim_matches(['"', '\'']);
        spread[index] = quantity(&option, value, &law.unit_of(index))?;
    }
    Ok(spread)
}
