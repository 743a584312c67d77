//! The example campaign: the materials of the 2003 pendulum study, simulated.

use crate::campaign::{Batch, write_simulated_campaign};
use crate::files::{SimulatedCampaign, Weighed};
use std::path::Path;
use windfall_campaign::settings::rig::STANDARD_GRAVITY;
use windfall_contact::law::EndRule;
use windfall_contact::laws::kind::LawKind;
use windfall_files::error::Error;
use windfall_files::option_value::unusable;
use windfall_identify::rig::kind::{Pendulum, Rig};
use windfall_signal::instrument::pendulum_instrument;

/// Impacts of each material.
const IMPACTS: usize = 20;

/// Kuwabara-Kono parameters, mean ± standard deviation, of the 2003 pendulum
/// study: variety, k and its SD (N/m^1.5), c and its SD (N s/m^1.5). The rubber
/// half-ball is one specimen, struck again and again.
const MATERIALS: [(&str, f64, f64, f64, f64); 4] = [
    ("rubber half-ball", 394_931.0, 0.0, 681.0, 0.0),
    ("apple", 753_599.0, 133_165.0, 1524.0, 263.0),
    ("tomato", 141_326.0, 45_970.0, 680.0, 200.0),
    ("potato", 654_324.0, 207_983.0, 1587.0, 320.0),
];

/// Rig of the example. The study gives the arm; inertia, mass, centre of mass
/// and impact velocity are inferred from its contact durations and 10° of swing;
/// mass and centre of mass, which hardly matter during contact, are assumed.
pub const EXAMPLE_RIG: Pendulum = Pendulum {
    inertia: 0.01435,
    arm: 0.505,
    mass: 0.11,
    centre_of_mass: 0.3,
    gravity: STANDARD_GRAVITY,
};

/// Impact velocity of the example; m/s.
pub const EXAMPLE_VELOCITY: f64 = 0.388;

/// Writes the example campaign; returns the number of recordings.
///
/// # Errors
/// The directory is not empty or cannot be written.
pub fn write_example(directory: &Path, seed: u64) -> Result<usize, Error> {
    let campaign = SimulatedCampaign {
        title: "Example: rubber half-ball, apple, tomato and potato on a pendulum".to_owned(),
        label: "published means and spreads of k and c (2003 pendulum study); \
                inertia, mass, centre of mass and impact velocity of the rig are inferred"
            .to_owned(),
        rig: Rig::Pendulum(EXAMPLE_RIG),
        weighed: Weighed::Given,
        velocity: EXAMPLE_VELOCITY,
        end: EndRule::ForceZero,
        instrument: pendulum_instrument(),
        seed,
    };
    let batches = MATERIALS.map(|(variety, k, k_sd, c, c_sd)| batch(variety, [k, c], [k_sd, c_sd]));
    let batches: Vec<Batch> = batches.into_iter().collect::<Result<_, _>>()?;
    write_simulated_campaign(directory, &campaign, &batches)
}

fn batch(variety: &str, means: [f64; 2], spread: [f64; 2]) -> Result<Batch, Error> {
    let law = LawKind::KuwabaraKono
        .with_parameters(&means)
        .map_err(|error| unusable(variety, error.to_string()))?;
    let one = spread == [0.0, 0.0];
    Ok(Batch {
        variety: variety.to_owned(),
        law,
        spread: spread.to_vec(),
        specimens: if one { 1 } else { IMPACTS },
        repeats: if one { IMPACTS } else { 1 },
    })
}
