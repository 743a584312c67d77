//! What was done to recordings of impacts repeated on one spot, in the words of a methods section.

use crate::repeats::read::{Margin, RepeatsCampaign};
use crate::words::{filters_text, percent, plain};
use windfall_repeat::align::Alignment;

/// Impacts repeated on one spot.
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
