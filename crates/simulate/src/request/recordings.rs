//! A campaign of simulated recordings as it is asked for: texts with units → SI.

use crate::campaign::{Batch, SimulatedCampaign, Weighed, write_simulated_campaign};
use crate::request::event::Event;
use std::path::Path;
use windfall_contact::expression::LawExpression;
use windfall_contact::laws::kind::Law;
use windfall_files::error::Error;
use windfall_files::option_value::quantity;
use windfall_files::text::toml_source::suggestion;
use windfall_identify::rig::kind::Rig;
use windfall_signal::instrument::Instrument;

/// Specimens of a simulated campaign.
#[derive(Clone, Debug)]
pub struct RecordingsRequest {
    /// Standard deviations between specimens: "k=133165".
    pub spread: Vec<String>,
    /// Number of specimens.
    pub specimens: usize,
    /// Impacts on each specimen.
    pub repeats: usize,
    /// Whether campaign.toml gives the mass of a carriage.
    pub weighed: Weighed,
    /// Seed of specimens and noise.
    pub seed: u64,
}

/// Writes a campaign of simulated recordings; returns how many.
///
/// # Errors
/// An option cannot be read, or the directory cannot be written.
pub fn simulate_recordings(
    event: &Event,
    instrument: Instrument,
    request: &RecordingsRequest,
    directory: &Path,
) -> Result<usize, Error> {
    let rig = match event.rig {
        Rig::Pendulum(_) => "pendulum",
        Rig::Carriage(_) => "carriage",
    };
    // A quote would end the text in campaign.toml.
    let law = LawExpression::from(event.law).to_string().replace('"', "'");
    let campaign = SimulatedCampaign {
        title: format!("Simulated {rig} campaign"),
        label: format!("windfall simulate {rig}, {law}, seed {}", request.seed),
        rig: event.rig,
        weighed: request.weighed,
        velocity: event.velocity,
        end: event.end,
        instrument,
        seed: request.seed,
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
