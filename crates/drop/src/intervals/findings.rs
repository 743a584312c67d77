//! What a reader of restitutions from intervals must know.

use crate::intervals::estimate::{TimedImpact, Timing};
use crate::intervals::outcome::MeanOutcome;
use crate::intervals::read::Written;
use crate::intervals::request::BouncesRequest;
use crate::intervals::speed::{NoLine, SpeedOutcome};
use crate::intervals::usable::Estimated;
use windfall_files::found::{FindingOutcome, robust_spread};
use windfall_files::text::number::plain;

/// An impact this many robust standard deviations from the median is odd.
const ODD: f64 = 6.0;

/// Fewest impacts among which one can be odd.
const FEWEST_FOR_ODD: usize = 8;

/// A stopwatch that writes finer steps than this has not counted them; s.
const FINEST_STEP: f64 = 1e-7;

/// Evidence below which the slope over speed is told as a finding.
const SMALL_P: f64 = 0.01;

/// So many drops are named in a finding.
const MOST_NAMES: usize = 5;

/// What is to be said of the drops and their intervals.
pub(crate) fn findings_of_drops(
    request: &BouncesRequest,
    written: &Written,
    estimated: &[Estimated],
    timing: &Timing,
) -> Vec<FindingOutcome> {
    let mut found = Vec::new();
    let mut tell = |code: &str, message: String| found.push(FindingOutcome::new(code, message));
    let alone = written.drops.len() - estimated.len();
    if alone > 0 {
        let told = "without two successive intervals, or one and a height, say nothing";
        tell(
            "too-few-intervals",
            format!("{alone} of {} drops {told}", written.drops.len()),
        );
    }
    let cut = estimated.iter().filter_map(|own| Some((own, own.cut?)));
    let cut = cut.map(|(own, from)| format!("{} from impact {from} on", own.written.drop.name));
    let cut: Vec<String> = cut.collect();
    if !cut.is_empty() {
        tell(
            "drop-cut-short",
            format!(
                "of {} drops the end is not used, as an interval is longer than the one before, \
                 where an impact was missed or a sound taken for one: {}",
                cut.len(),
                few(&cut)
            ),
        );
    }
    for own in estimated {
        if let Some(reason) = &own.left_out {
            let name = &own.written.drop.name;
            tell("drop-left-out", format!("{name} does not count: {reason}"));
        }
    }
    if written.zeros > 0 {
        tell(
            "zero-interval",
            format!(
                "{} intervals of 0 are read as impacts that were not noticed, as phyphox writes them",
                written.zeros
            ),
        );
    }
    if request.resolution.is_none() && timing.resolution < FINEST_STEP {
        tell(
            "step-unknown",
            "the intervals have more digits than a stopwatch counts: --resolution says its step; \
             without it uncertainties of single impacts are too small"
                .to_owned(),
        );
    }
    let odd = odd_impacts(estimated);
    let named = odd.iter().map(|(name, impact, _)| {
        format!(
            "{name}, impact {}: {}",
            impact.number,
            plain(impact.restitution)
        )
    });
    let named: Vec<String> = named.collect();
    if let Some((_, _, median)) = odd.first() {
        tell(
            "odd-impact",
            format!(
                "{} restitutions are far from the median of {}; was an impact missed, or a sound taken \
                 for one? {}",
                odd.len(),
                plain(*median),
                few(&named)
            ),
        );
    }
    found
}

/// What is to be said of their mean and of the line over speed.
pub(crate) fn findings_of_mean(
    mean: Option<&MeanOutcome>,
    line: &Result<SpeedOutcome, NoLine>,
) -> Vec<FindingOutcome> {
    let mut found = Vec::new();
    let mut tell = |code: &str, message: String| found.push(FindingOutcome::new(code, message));
    if let Some(mean) = mean
        && let Some(sd) = mean.sd
        && mean.timing_sd * mean.timing_sd > 0.5 * sd * sd
    {
        tell(
            "coarse-stopwatch",
            format!(
                "more than half of the variance between {} is the stopwatch's: a finer one, or \
                 higher drops, would make the spread smaller",
                mean.over
            ),
        );
    }
    match line {
        Ok(line) if line.p < SMALL_P => tell("depends-on-speed", speed_text(line)),
        Err(NoLine::SpeedsAlike(_)) => tell(
            "speeds-alike",
            "the speeds of impact differ too little to tell how restitution depends on them: time \
             more impacts of each drop, or drop from several heights"
                .to_owned(),
        ),
        _ => {}
    }
    found
}

/// The first of some names, and how many more there are.
fn few(names: &[String]) -> String {
    let shown = names[..names.len().min(MOST_NAMES)].join("; ");
    match names.len().saturating_sub(MOST_NAMES) {
        0 => shown,
        more => format!("{shown}; and {more} more"),
    }
}

fn speed_text(line: &SpeedOutcome) -> String {
    let change = line.slope * (line.speed_high - line.speed_low);
    format!(
        "restitution changes by {} from {} to {} m/s, so the mean depends on the drops that were \
         chosen: give it with its speed, {} at {} m/s",
        plain(change),
        plain(line.speed_low),
        plain(line.speed_high),
        plain(line.restitution),
        plain(line.speed)
    )
}

/// Impacts far from the others, with the name of their drop and the median.
fn odd_impacts<'a>(estimated: &'a [Estimated]) -> Vec<(&'a str, TimedImpact, f64)> {
    let counted = estimated.iter().filter(|own| own.left_out.is_none());
    let all = counted.flat_map(|own| {
        let name = own.written.drop.name.as_str();
        own.estimate
            .impacts
            .iter()
            .map(move |impact| (name, *impact))
    });
    let all: Vec<(&str, TimedImpact)> = all.collect();
    let values: Vec<f64> = all.iter().map(|own| own.1.restitution).collect();
    let Some((median, spread)) = robust_spread(&values) else {
        return Vec::new();
    };
    let odd = |own: &(&str, TimedImpact)| {
        let apart = (own.1.restitution - median).abs();
        all.len() >= FEWEST_FOR_ODD && apart > ODD * spread.hypot(own.1.sd)
    };
    let found = all.iter().filter(|own| odd(own));
    found
        .map(|(name, impact)| (*name, *impact, median))
        .collect()
}
