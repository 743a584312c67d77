//! A drop as far as its intervals can be.

use crate::intervals::estimate::{DropEstimate, TimedImpact, Timing, estimate_drop};
use crate::intervals::read::WrittenDrop;
use windfall_files::text::number::plain;

/// An impact from which a body comes back faster by this many standard uncertainties is none.
const IMPOSSIBLE: f64 = 3.0;

/// A drop with what it says.
pub(crate) struct Estimated<'a> {
    pub(crate) written: &'a WrittenDrop,
    pub(crate) estimate: DropEstimate,
    pub(crate) left_out: Option<String>,
    /// First impact that is not used.
    pub(crate) cut: Option<usize>,
}

/// A drop up to what cannot be; `None` where it says nothing.
///
/// Where an interval is longer than the one before, an impact before it was missed or a sound
/// before it was none: neither of the two is used, nor what follows them.
pub(crate) fn estimated<'a>(own: &'a WrittenDrop, timing: &Timing) -> Option<Estimated<'a>> {
    let whole = estimate_drop(&own.drop, timing)?;
    let told = |estimate, left_out, cut| {
        Some(Estimated {
            written: own,
            estimate,
            left_out,
            cut,
        })
    };
    if own.excluded {
        return told(whole, Some("the column exclude says so".to_owned()), None);
    }
    let impossible = |impact: &&TimedImpact| impact.restitution > 1.0 + IMPOSSIBLE * impact.sd;
    let Some(found) = whole.impacts.iter().find(impossible).copied() else {
        return told(whole, None, None);
    };
    let mut shorter = own.drop.clone();
    shorter.intervals.truncate(found.number.saturating_sub(2));
    match estimate_drop(&shorter, timing).filter(|_| found.number > 2) {
        Some(estimate) => told(estimate, None, Some(found.number - 1)),
        None => {
            let reason = format!(
                "impact {} would have a restitution of {}: an impact was missed, or the drop was \
                 not from rest at its height",
                found.number,
                plain(found.restitution)
            );
            told(whole, Some(reason), None)
        }
    }
}
