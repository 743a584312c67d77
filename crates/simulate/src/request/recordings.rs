//! A campaign of simulated recordings: options with units → SI.

use crate::campaign::{Batch, write_simulated_campaign};
use crate::files::{SimulatedCampaign, Weighed};
use crate::request::event::Event;
use clap::Args;
use std::path::Path;
use windfall_contact::expression::LawExpression;
use windfall_contact::laws::kind::Law;
use windfall_files::error::Error;
use windfall_files::option_value::quantity;
use windfall_files::text::toml_source::suggestion;
use windfall_identify::rig::kind::Rig;
use windfall_signal::instrument::Instrument;

/// Specimens of a simulated campaign.
#[derive(Clone, Debug, Args)]
pub struct SpecimenRequest {
    /// Number of specimens of the campaign
    #[arg(long, default_value_t = 20)]
    pub specimens: usize,
    /// Impacts on each specimen
    #[arg(long, default_value_t = 1)]
    pub repeats: usize,
    /// Standard deviation of a parameter between specimens, such as k=133165
    #[arg(long, value_name = "NAME=SD")]
    pub spread: Vec<String>,
}

/// Writes a campaign of simulated recordings; returns how many.
///
/// # Errors
/// An option cannot be read, or the directory cannot be written.
pub fn simulate_recordings(
    event: &Event,
    instrument: Instrument,
    request: &SpecimenRequest,
    (weighed, seed): (Weighed, u64),
    directory: &Path,
) -> Result<usize, Error> {
    let rig = match event.rig {
        Rig::Pendulum(_) => "pendulum",
        Rig::Carriage(_) => "carriage",
    };
    let law = LawExpression::from(event.law);
    let campaign = SimulatedCampaign {
        title: format!("Simulated {rig} campaign"),
        label: format!("windfall simulate {rig}, {law}, seed {seed}"),
        rig: event.rig,
        weighed,
        velocity: event.velocity,
        end: event.end,
        instrument,
        seed,
    };
    let batch = Batch {
        variety: "specimen".to_owned(),
        law: event.law,
        spread: spread(&event.law, &request.spread)?,
        specimens: request.specimens,
        repeats: request.repeats,
    };
    write_simulated_campaign(directory, &campaign, &[batch])
}

/// "k=133165" and "c=\"263 N s/m^1.5\"" → one standard deviation per parameter.
///
/// # Errors
/// A name is no parameter of the law, or a value no quantity of its unit.
pub fn spread(law: &Law, texts: &[String]) -> Result<Vec<f64>, Error> {
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
