//! Phrases that the methods sections of all kinds share.

use windfall_contact::expression::LawExpression;
use windfall_signal::conditioning::{ChannelFilter, Conditioning};
use windfall_signal::filter::butterworth::Band;
use windfall_signal::trigger::Threshold;

/// How values measured once per recording are given.
pub const SPREAD: &str = "Values are given ± their standard uncertainty; means ± the standard deviation between \
     recordings or fruit (n − 1).";

/// A setting as it was given, without what binary numbers add to it.
pub fn plain(value: f64) -> String {
    format!("{}", (value * 1e9).round() / 1e9)
}

/// A part as a percentage.
pub fn percent(part: f64) -> String {
    format!("{} %", plain(100.0 * part))
}

/// "exceeded 1 N".
pub fn threshold_text(threshold: &Threshold) -> String {
    match *threshold {
        Threshold::Fixed(force) => format!("exceeded {} N", force),
        Threshold::Automatic {
            deviations,
            least,
            share,
        } => format!(
            "exceeded the largest of {} standard deviations of its noise before contact, {} N \
             and {} of its peak",
            deviations, least, share
        ),
    }
}

/// Which channels were filtered, and how.
pub fn filters_text(conditioning: &Conditioning) -> String {
    let filters = [
        ("force", conditioning.force),
        ("position", conditioning.position),
        ("displacement rate", conditioning.rate),
        ("acceleration", conditioning.acceleration),
    ];
    let filters: Vec<String> = filters
        .iter()
        .filter_map(|(name, filter)| filter.map(|f| format!("{name} {}", filter_text(&f))))
        .collect();
    match filters.is_empty() {
        true => "No channel was filtered.".to_owned(),
        false => format!(
            "Filters (Butterworth, forwards and backwards): {}.",
            filters.join("; ")
        ),
    }
}

fn filter_text(filter: &ChannelFilter) -> String {
    let band = match filter.band {
        Band::LowPass(cutoff) => format!("low-pass {} Hz", cutoff),
        Band::HighPass(cutoff) => format!("high-pass {} Hz", cutoff),
        Band::BandPass(low, high) => format!("band-pass {} to {} Hz", low, high),
    };
    format!("{band}, order {}", filter.order)
}

/// A sentence on each law.
pub fn laws_text(laws: &[LawExpression], free: &[String]) -> Vec<String> {
    let of = |law: &LawExpression| {
        let about = law.kind.describe();
        let also: Vec<&str> = free
            .iter()
            .map(String::as_str)
            .filter(|name| about.parameters.iter().any(|p| p.name == *name))
            .collect();
        let also = match also.is_empty() {
            true => String::new(),
            false => format!(" Estimated too: {}.", listed(&also)),
        };
        format!("Law {law}: {} ({}).{also}", about.formula, about.source)
    };
    laws.iter().map(of).collect()
}

/// "a, b and c".
pub fn listed(names: &[&str]) -> String {
    match names {
        [] => String::new(),
        [one] => (*one).to_owned(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}
