//! What was done to recordings of slow compressions, in the words of a methods section.

use crate::compression::read::CompressionCampaign;
use crate::words::{SPREAD, laws_text, percent, plain};
use windfall_signal::compression::FitRange;

/// Slow compressions.
pub fn methods_of_compression(campaign: &CompressionCampaign) -> Vec<String> {
    let options = &campaign.options;
    let ends = match campaign.plates {
        1 => "one end of the fruit",
        _ => "both ends of the fruit, each by half of the deformation",
    };
    let touch = match options.touch_force {
        Some(force) => format!("{} N", plain(force)),
        None => "a threshold from the noise of the force".to_owned(),
    };
    let machine = match options.machine_stiffness.is_finite() {
        true => format!(
            " The give of the machine ({} N/m) was subtracted from the deformation.",
            plain(options.machine_stiffness)
        ),
        false => String::new(),
    };
    let range = match campaign.fit_to {
        Some(FitRange::LargestStiffness) => "the largest local stiffness".to_owned(),
        Some(FitRange::PartOfYield(part)) => format!("{} of the bioyield force", percent(part)),
        Some(FitRange::Deformation(length)) => {
            format!("a deformation of {} mm", plain(1e3 * length))
        }
        None => "the largest local stiffness for laws without damping, and half of the bioyield \
                 force for those with damping"
            .to_owned(),
    };
    let mut words = vec![
        format!(
            "Fruit were compressed slowly; the displacement deformed {ends}. Loading began where \
             five successive samples of the force exceeded {touch}.{machine}"
        ),
        format!(
            "Each curve was read forwards, once. The bioyield is the largest force before the \
             local slope of force over deformation, taken over the last {} of the way, was zero \
             or less (ASAE S368). The tissue had softened where the slope over {} of the force \
             had fallen to {} of the largest before, and ruptured where the force fell below {} \
             of the largest before.",
            percent(options.yield_window),
            percent(options.stiffness_window),
            percent(options.softening),
            percent(options.rupture)
        ),
    ];
    words.extend(laws_text(&campaign.laws, &campaign.free));
    words.push(format!(
        "Laws were fitted by least squares of the force over deformation and its measured rate, \
         from 2 % of the force to {range}; the deformation of first touch was estimated with the \
         law. Standard deviations allow for the correlation of residuals (Newey and West) and are \
         never less than for independent ones; intervals are of 95 %. Curves of one fruit were \
         also fitted together, each with a touch of its own."
    ));
    words.push(format!(
        "The apparent modulus follows from k by Hertz's theory for the principal radii of the \
         fruit, with complete elliptic integrals and a Poisson's ratio of {}. {SPREAD}",
        plain(campaign.poisson_ratio)
    ));
    words
}
