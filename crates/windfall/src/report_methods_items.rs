//! What was done to recordings that are no single impacts, in the words of a methods
//! section.

use crate::read_acoustic::{AcousticCampaign, Common};
use crate::read_compression::CompressionCampaign;
use crate::read_drop::{DropCampaign, PlatePlan};
use crate::read_repeats::{Margin, RepeatsCampaign};
use crate::report_methods::{filters_text, laws_text, threshold_text};
use windfall_signal::bounce::train::StaticLevel;
use windfall_signal::compression::FitRange;
use windfall_signal::repeat::align::Alignment;

/// Intervals of whatever was measured once per recording.
const SPREAD: &str = "Values are given ± their standard uncertainty; means ± the standard deviation between \
     recordings or fruit (n − 1).";

/// A setting as it was given, without what binary numbers add to it.
fn plain(value: f64) -> String {
    format!("{}", (value * 1e9).round() / 1e9)
}

fn percent(part: f64) -> String {
    format!("{} %", plain(100.0 * part))
}

/// Slow compressions.
#[must_use]
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

/// Taps.
#[must_use]
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

/// Impacts repeated on one spot.
#[must_use]
pub fn methods_of_repeats(campaign: &RepeatsCampaign) -> Vec<String> {
    let align = &campaign.align;
    let laid = match align.alignment {
        Alignment::Crossing => format!(
            "where both cross {} of the first peak (eight standard deviations of the noise where \
             that is more)",
            percent(align.crossing)
        ),
        Alignment::Rise => format!(
            "where their rises between {} and {} of the first peak differ least",
            percent(align.rise.0),
            percent(align.rise.1)
        ),
    };
    let margin = match campaign.margin {
        Margin::Given(part) => format!("{} (given beforehand)", percent(part)),
        Margin::Deviations(count) => {
            format!(
                "{} standard deviations of the changes of the reference",
                plain(count)
            )
        }
    };
    let (column, value) = &campaign.reference;
    let test = &campaign.test;
    vec![
        format!(
            "Bodies fell repeatedly on one spot of a fruit (acceleration of gravity {} m/s²). {}",
            plain(campaign.gravity),
            filters_text(&campaign.conditioning)
        ),
        format!(
            "Two successive impacts were laid over each other {laid} and compared at {} instants \
             over {} contact durations of the first; a difference is a part of the first peak.",
            align.points,
            plain(align.until)
        ),
        format!(
            "Of each fruit: an elastic reference ({column} = {value}) tells how well the rig \
             repeats an impact. A fruit has changed where the mean of one of the parts of its \
             difference exceeds what the scatter of the reference lets expect of any of them \
             (Student's t, Šidák's correction). It is unchanged where peak, duration and rise \
             slope, each with its uncertainty, stay within {margin}. Otherwise it is undecided."
        ),
        format!(
            "Of all fruit together: the largest studentised mean difference over all instants and \
             energies was held against that under flipped signs of whole fruit (all patterns up to \
             {}, else {} drawn ones, seed {}), at a level of {} for all tests together.",
            test.most_patterns,
            test.draws,
            test.seed,
            percent(test.level)
        ),
        format!(
            "The critical energies of single fruit are intervals; their distribution is Turnbull's \
             estimate, and {} by maximum likelihood with intervals from the profile.",
            campaign.family.name()
        ),
    ]
}

/// Drops on a plate.
#[must_use]
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
