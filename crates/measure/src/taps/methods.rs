//! What was done to recordings of taps, in the words of a methods section.

use crate::taps::read::{AcousticCampaign, Common};
use crate::words::{SPREAD, percent, plain};

/// Taps.
pub fn methods_of_taps(campaign: &AcousticCampaign) -> Vec<String> {
    let (taps, modes) = (&campaign.taps, &campaign.first_mode);
    let shared = match campaign.common {
        Common::Reject => ", and that not all fruit share at one frequency",
        Common::Keep => "; frequencies that all fruit share were kept",
    };
    let density = match campaign.density {
        Some(density) => format!(
            " Densities that specimens.csv does not give were taken as {} kg/m³.",
            plain(density)
        ),
        None => String::new(),
    };
    vec![
        format!(
            "Fruit were tapped and their sound recorded. A tap is where the energy between {} and \
             {} Hz rises by a factor of {} within milliseconds, if its amplitude is at least {} of \
             the strongest. The first {} ms, in which the hammer touches, were left out; {} to {} \
             ms after them were evaluated.",
            plain(taps.low),
            plain(taps.high),
            plain(taps.rise),
            percent(taps.least_level),
            plain(1e3 * taps.hit),
            plain(1e3 * taps.shortest),
            plain(1e3 * taps.longest)
        ),
        format!(
            "Resonances are damped sinusoids, fitted by least squares to the complex spectrum \
             around each peak of at least {} of the highest (at most {} of them).",
            percent(campaign.resonances.least_prominence),
            campaign.resonances.most
        ),
        format!(
            "The first spheroidal mode is the lowest resonance that at least {} of the taps show \
             to within {}, with a Q of {} or more, that the quiet before the taps does not \
             show{shared}. A second peak up to {} above belongs to the same mode; the mean of both \
             was taken with an uncertainty that covers them. Several taps were weighted by the \
             variance of each and that between them (DerSimonian and Laird 1986).",
            percent(modes.least_share),
            percent(modes.agreement),
            plain(modes.least_quality),
            percent(modes.doublet)
        ),
        format!(
            "The stiffness is f² m^(2/3), with the density ρ f² m^(2/3) ρ^(1/3). Masses have a \
             standard uncertainty of {} g.{density} {SPREAD}",
            plain(1e3 * campaign.mass_sd)
        ),
    ]
}
