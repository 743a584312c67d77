//! What was done to recordings of drops on a plate, in the words of a methods section.

use crate::read::{DropCampaign, PlatePlan};
use windfall_measure::words::{SPREAD, percent, plain, threshold_text};
use windfall_signal::bounce::train::StaticLevel;

/// Drops on a plate.
pub fn methods_of_drops(campaign: &DropCampaign) -> Vec<String> {
    let options = &campaign.bounces.options;
    let level = match options.static_level {
        StaticLevel::BeforeFirst => "its mean before the first contact".to_owned(),
        StaticLevel::Given(force) => format!("a level of {} N", plain(force)),
        StaticLevel::Follow => "a line from quiet stretch to quiet stretch".to_owned(),
    };
    let plate = match campaign.rig.plate {
        PlatePlan::Rigid => {
            "The plate was taken as rigid: its force is the contact force.".to_owned()
        }
        PlatePlan::Sprung {
            mass,
            stiffness: Some(stiffness),
            damping: Some(damping),
        } => format!(
            "The plate ({} kg on {} N/m and {} N s/m) rings; its ringing was taken out.",
            plain(mass.value),
            plain(stiffness.value),
            plain(damping.value)
        ),
        PlatePlan::Sprung { mass, .. } => format!(
            "The plate ({} kg) rings: period and damping were found from the force after the \
             contacts, and the ringing was taken out. Stiffness and damping of the plate follow \
             from them.",
            plain(mass.value)
        ),
    };
    let gap = options.smallest_gap.map_or_else(
        || "a tenth of the longest contact".to_owned(),
        |gap| format!("{} ms", plain(1e3 * gap)),
    );
    let impulse = match campaign.bounces.least_impulse {
        Some(part) => format!("{} of the momentum of the drop", percent(part)),
        None => {
            "six of its standard deviations from noise and a fiftieth of the largest".to_owned()
        }
    };
    let cycles = match campaign.bounces.ringing_cycles {
        Some(cycles) => format!("over {cycles} cycles"),
        None => "over the number of cycles with the smallest uncertainty".to_owned(),
    };
    vec![
        format!(
            "Fruit fell on a plate over a load cell (acceleration of gravity {} m/s²). The force \
             was measured from {level}. A contact begins where the force {} and ends below {} of \
             that; contacts closer than {gap} are one, and bounces with an impulse below {impulse} \
             are none.",
            plain(campaign.rig.gravity),
            threshold_text(&options.threshold),
            percent(options.release)
        ),
        plate,
        "The restitution of each bounce follows from the flights before and after it, from the \
         drop height where it is the first, and by itself from impulse over momentum; the findings \
         say where these disagree."
            .to_owned(),
        format!(
            "Damping ratio and period of the plate are from the logarithmic decrement {cycles} and \
             from a damped sinusoid fitted to the ringing. {SPREAD}"
        ),
    ]
}
