//! What was done to recordings of stress relaxation, in the words of a methods section.

use crate::relaxation::read::RelaxationCampaign;
use crate::words::{SPREAD, plain};
use windfall_compression::relaxation::maxwell::Elements;

/// Stress relaxation.
pub fn methods_of_relaxation(campaign: &RelaxationCampaign) -> Vec<String> {
    let number = match campaign.elements {
        Elements::Chosen => "one to three elements, as many as Akaike's criterion for small samples \
                             asked for in each recording (with as many samples as their correlation \
                             leaves independent)"
            .to_owned(),
        Elements::Given(1) => "one element".to_owned(),
        Elements::Given(number) => format!("{number} elements"),
    };
    vec![
        "Fruit were compressed to a deformation and held there. The hold begins where the position \
         reaches the place at which it stands at the largest force (without a position, at the \
         largest force), and ends where it leaves it."
            .to_owned(),
        format!(
            "A generalised Maxwell model with {number} and a force that stays was fitted to the force \
             of the hold by least squares. Fractions are those after a sudden step: what relaxes \
             during the ramp was corrected for by Boltzmann's superposition, with an elastic force \
             that grows as time to the power of {}. Peleg's constants (1980) were fitted by least \
             squares of the force, with the initial force as a third constant.",
            plain(campaign.exponent)
        ),
        format!(
            "Standard deviations allow for the correlation of residuals (Newey and West) and are \
             never less than for independent ones; intervals are of 95 %. {SPREAD}"
        ),
    ]
}
