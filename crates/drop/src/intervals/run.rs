//! `windfall bounces`: intervals → restitution of impacts, of drops, and of all of them.

use crate::intervals::estimate::{TimedImpact, Timing};
use crate::intervals::findings::{findings_of_drops, findings_of_mean};
use crate::intervals::outcome::{
    BouncesOutcome, MeanOutcome, TimedDropOutcome, TimedImpactOutcome,
};
use crate::intervals::read::{Written, WrittenDrop, read_drops};
use crate::intervals::request::{BouncesRequest, positive_option};
use crate::intervals::speed::line_over_speed;
use crate::intervals::usable::{Estimated, estimated};
use windfall_files::error::Error;
use windfall_files::found::robust_spread;
use windfall_files::option_value::unusable;
use windfall_files::text::number::plain;
use windfall_statistics::compare::group_summary::{Group, summarize};

/// Restitution from the intervals between impacts.
///
/// # Errors
/// A table cannot be read, a cell or option is no time, or no drop has two intervals.
pub fn bounces(request: &BouncesRequest) -> Result<BouncesOutcome, Error> {
    let mut written = read_drops(request)?;
    let timing = request.timing(written.step)?;
    let height = positive_option("--height", request.height.as_deref(), "m")?;
    for own in &mut written.drops {
        own.drop.height = own.drop.height.or(height);
        check_contact(own, &timing)?;
    }
    let estimated = written
        .drops
        .iter()
        .filter_map(|own| estimated(own, &timing));
    let estimated: Vec<Estimated> = estimated.collect();
    if estimated.is_empty() {
        return Err(nothing_told(request, &written));
    }
    let counted = || estimated.iter().filter(|own| own.left_out.is_none());
    let mean = mean_of(&counted().collect::<Vec<_>>(), request.confidence)?;
    let impacts: Vec<&[TimedImpact]> = counted().map(|own| &own.estimate.impacts[..]).collect();
    let line = line_over_speed(&impacts, request.confidence);
    let mut findings = findings_of_drops(request, &written, &estimated, &timing);
    findings.extend(findings_of_mean(mean.as_ref(), &line));
    Ok(BouncesOutcome {
        gravity: timing.gravity,
        resolution: timing.resolution,
        resolution_from_digits: request.resolution.is_none(),
        trigger_sd: timing.trigger_sd,
        contact: timing.contact,
        drops: estimated.iter().map(drop_outcome).collect(),
        mean,
        by_speed: line.ok(),
        findings,
    })
}

/// Every interval must be longer than the contact.
fn check_contact(own: &WrittenDrop, timing: &Timing) -> Result<(), Error> {
    let shortest = own.drop.intervals.iter().flatten();
    let shortest = shortest.fold(f64::INFINITY, |least, own| least.min(*own));
    match shortest > timing.contact {
        true => Ok(()),
        false => Err(unusable(
            "--contact",
            format!(
                "{}, drop {}: the interval of {} s is not longer than the contact of {} s",
                own.place,
                own.drop.name,
                plain(shortest),
                plain(timing.contact)
            ),
        )),
    }
}

fn nothing_told(request: &BouncesRequest, written: &Written) -> Error {
    let longest = written.drops.iter().map(|own| own.drop.intervals.len());
    let one = longest.max().unwrap_or(0) <= 1;
    let tables = request.tables.first();
    let advice = match (request.each_column, tables) {
        (false, Some(_)) if one => {
            "; if a column holds the intervals of one drop below each other, add --each-column"
        }
        _ => "",
    };
    let option = match tables {
        Some(path) => path.display().to_string(),
        None => "--intervals".to_owned(),
    };
    let problem = format!(
        "no drop has two successive intervals: restitution takes two of them, or one and the drop \
         height (--height, or a column drop_height_cm){advice}"
    );
    unusable(option, problem)
}

fn drop_outcome(own: &Estimated) -> TimedDropOutcome {
    let drop = &own.written.drop;
    let height = own.estimate.height.filter(|_| drop.height.is_none());
    let impacts = own.estimate.impacts.iter();
    TimedDropOutcome {
        drop: drop.name.clone(),
        intervals: drop.intervals.clone(),
        height: drop.height,
        restitution: own.estimate.restitution,
        restitution_sd: own.estimate.sd,
        height_estimate: height.map(|own| own.0),
        height_estimate_sd: height.map(|own| own.1),
        impacts: impacts
            .map(|impact| TimedImpactOutcome {
                impact: impact.number,
                speed: impact.speed,
                restitution: impact.restitution,
                restitution_sd: impact.sd,
                rebound_height: impact.rebound_height,
            })
            .collect(),
        left_out: own.left_out.clone(),
        unused_from: own.cut,
        labels: own.written.labels.clone(),
    }
}

/// Mean over drops; of a single drop over its impacts.
fn mean_of(counted: &[&Estimated], confidence: f64) -> Result<Option<MeanOutcome>, Error> {
    let (over, values, sds): (_, Vec<f64>, Vec<f64>) = match counted {
        [] => return Ok(None),
        [one] => {
            let impacts = || one.estimate.impacts.iter();
            let values = impacts().map(|own| own.restitution).collect();
            ("impacts", values, impacts().map(|own| own.sd).collect())
        }
        _ => {
            let values = counted.iter().map(|own| own.estimate.restitution);
            let sds = counted.iter().map(|own| own.estimate.sd);
            ("drops", values.collect(), sds.collect())
        }
    };
    let group = Group {
        levels: Vec::new(),
        rows: Vec::new(),
        values,
        missing: 0,
    };
    let summary = summarize(&group, confidence).map_err(Error::Statistics)?;
    let robust = robust_spread(&group.values).filter(|_| summary.n > 1);
    let finite = |value: f64| value.is_finite().then_some(value);
    let squares: f64 = sds.iter().map(|own| own * own).sum();
    Ok(Some(MeanOutcome {
        over,
        n: summary.n,
        restitution: summary.mean,
        sd: finite(summary.sd),
        low: finite(summary.low),
        high: finite(summary.high),
        confidence,
        median: summary.median,
        robust_sd: robust.map(|own| own.1),
        timing_sd: (squares / sds.len() as f64).sqrt(),
    }))
}
