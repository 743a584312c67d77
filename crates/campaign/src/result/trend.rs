//! Dependence of what should be constant: parameters on the impact velocity, which a law
//! forbids, and of parameters, restitution and the gain of the force on order and time of day.

use crate::result::outcome::{ImpactOutcome, TrendOutcome};
use crate::settings::model::{Campaign, ImpactEntry};
use std::collections::{BTreeMap, BTreeSet};
use windfall_contact::parameter::IMPACT_VELOCITY;
use windfall_distribution::tail::t_two_sided;
use windfall_files::found::FindingOutcome;
use windfall_files::named::grouped;
use windfall_statistics::residuals::trend::{Observation, trend};

/// Column of impacts.csv with the time of day.
pub const TIME_COLUMN: &str = "time_of_day";
/// Quantities that a drift of the fruit or the bench changes, read off the signals.
const DRIFTING: [&str; 2] = ["restitution", "force_gain"];
/// Fewest fruit whose impacts are taken together; with fewer, impacts count as independent.
const FEWEST_FRUIT: usize = 5;
/// Fewest degrees of freedom of a slope.
const LEAST_DF: f64 = 4.0;
/// Part of the scatter of ln v that must lie within fruit if slopes are to be found there; 1.
const WITHIN: f64 = 0.3;
/// Largest ratio of a deviation to its value that is still taken in logarithms; 1.
const LOOSE: f64 = 0.3;
/// Part of the impacts that may be determined less well than that.
const FEW_LOOSE: f64 = 0.1;

/// What a quantity may depend on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Over {
    /// ln of the impact velocity.
    Velocity,
    /// Place among the rows of impacts.csv, 0 to 1.
    Order,
    /// Hours since midnight.
    TimeOfDay,
}

impl Over {
    /// Name in JSON.
    pub fn name(self) -> &'static str {
        match self {
            Self::Velocity => IMPACT_VELOCITY,
            Self::Order => "order",
            Self::TimeOfDay => TIME_COLUMN,
        }
    }
}

/// When each impact was made.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Times {
    /// Place among the rows of impacts.csv, 0 to 1, and hours since midnight where they are known.
    pub of: BTreeMap<String, (f64, Option<f64>)>,
    /// A cell that is no time.
    pub unread: Option<FindingOutcome>,
}

/// Order and time of day of the entries of a campaign.
///
/// A time is "14:05" or "14:05:30", after a date or not. Where one cell is none, times of day
/// are left out.
pub fn times_of(campaign: &Campaign) -> Times {
    let last = campaign.entries.len().saturating_sub(1).max(1) as f64;
    let mut times = Times::default();
    for (place, entry) in campaign.entries.iter().enumerate() {
        let text = time_cell(entry);
        let hours = text.and_then(hours_of);
        if let (Some(text), None, None) = (text, hours, &times.unread) {
            let told = format!(
                "impacts.csv, line {}, column {TIME_COLUMN}: \"{text}\" is no time of day such as \
                 14:05, so that dependence on it is not tested; correct the cell or leave it empty",
                entry.line
            );
            times.unread = Some(FindingOutcome::new("time-of-day-unread", told));
        }
        let known = (place as f64 / last, hours);
        times.of.insert(entry.id.clone(), known);
    }
    if times.unread.is_some() {
        times.of.values_mut().for_each(|own| own.1 = None);
    }
    times
}

fn time_cell(entry: &ImpactEntry) -> Option<&str> {
    let mut cells = entry.cells.iter();
    let (_, cell) = cells.find(|(name, _)| name == TIME_COLUMN)?;
    Some(cell.trim()).filter(|cell| !cell.is_empty())
}

/// "2026-05-03 14:30:36" → 14.51.
fn hours_of(text: &str) -> Option<f64> {
    let clock = text.rsplit([' ', 'T']).next()?;
    let mut parts = clock.split(':');
    let (hour, minute) = (parts.next()?, parts.next()?);
    let second = parts.next().unwrap_or("0");
    let digits = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit());
    if !digits(hour) || !digits(minute) || parts.next().is_some() {
        return None;
    }
    let (hour, minute): (u32, u32) = (hour.parse().ok()?, minute.parse().ok()?);
    let second: f64 = second.parse().ok()?;
    let legal = hour < 24 && minute < 60 && (0.0..60.0).contains(&second);
    legal.then(|| f64::from(hour) + f64::from(minute) / 60.0 + second / 3600.0)
}

/// Slopes of what should be constant, law by law, over the impacts that count.
///
/// Logarithms of values over ln of the impact velocity, over order and over time of day; the
/// latter two beside ln v. Over velocity, slopes are those within fruit where these were struck
/// at several velocities; else, as over order, within groups. Impacts on one fruit are one
/// cluster ([`trend`]). `p` is that of Student's t times the number of slopes of the campaign.
pub fn trends(impacts: &[ImpactOutcome], times: &Times) -> Vec<TrendOutcome> {
    let counted = impacts.iter().filter(|own| own.counts());
    let by_law = grouped(counted.map(|impact| (impact.law.as_str(), impact)));
    let mut found = Vec::new();
    for (place, (law, own)) in by_law.iter().enumerate() {
        let estimated = own.first().map_or(&[][..], |first| &first.parameters.0);
        let free = estimated
            .iter()
            .filter(|(name, estimate)| !estimate.held && name != IMPACT_VELOCITY);
        let parameters: Vec<&str> = free.map(|(name, _)| name.as_str()).collect();
        let velocity = parameters.iter().map(|name| (*name, Over::Velocity));
        // What the signals say is the same under every law.
        let drifting = DRIFTING.iter().filter(|_| place == 0);
        let drifting: Vec<&str> = parameters.iter().chain(drifting).copied().collect();
        let order = drifting.iter().map(|name| (*name, Over::Order));
        let time = drifting.iter().map(|name| (*name, Over::TimeOfDay));
        for (quantity, over) in velocity.chain(order).chain(time) {
            found.extend(slope(law, own, times, quantity, over));
        }
    }
    let tests = found.len() as f64;
    for own in &mut found {
        own.p = (own.p * tests).min(1.0);
    }
    found
}

/// A value with its relative deviation.
pub fn value_of(impact: &ImpactOutcome, quantity: &str) -> Option<(f64, f64)> {
    let (value, sd) = match impact.parameters.get(quantity) {
        Some(own) => (own.value, own.sd?),
        None => {
            let sd = impact.derived_sd.get(quantity).copied().unwrap_or(0.0);
            (impact.derived(quantity)?, sd)
        }
    };
    (value > 0.0 && value.is_finite() && sd.is_finite()).then(|| (value, sd / value))
}

/// An impact with a quantity and its velocity, each with the relative deviation.
struct Known<'a> {
    impact: &'a ImpactOutcome,
    value: (f64, f64),
    speed: (f64, f64),
}

fn slope(
    law: &str,
    impacts: &[&ImpactOutcome],
    times: &Times,
    quantity: &str,
    over: Over,
) -> Option<TrendOutcome> {
    let known: Vec<Known> = impacts
        .iter()
        .filter_map(|impact| {
            let value = value_of(impact, quantity).filter(|(_, sd)| *sd <= LOOSE)?;
            let speed = value_of(impact, IMPACT_VELOCITY)?;
            Some(Known {
                impact,
                value,
                speed,
            })
        })
        .collect();
    if (known.len() as f64) < (1.0 - FEW_LOOSE) * impacts.len() as f64 {
        return None;
    }
    let fruit = numbered(known.iter().map(|own| own.impact.specimen.clone()));
    let groups = numbered(
        known
            .iter()
            .map(|own| own.impact.group.clone().unwrap_or_default()),
    );
    let speeds: Vec<f64> = known.iter().map(|own| own.speed.0.ln()).collect();
    let count = fruit.iter().max().map_or(0, |last| last + 1);
    let few = count < FEWEST_FRUIT;
    let within = few || (over == Over::Velocity && mostly_within(&speeds, &fruit, &groups));
    let blocks = if within { &fruit } else { &groups };
    let observations: Option<Vec<Observation>> = (0..known.len())
        .map(|i| {
            let (value, sd) = known[i].value;
            let (order, hours) = *times.of.get(&known[i].impact.id)?;
            let (x, x_sd, beside) = match over {
                Over::Velocity => (speeds[i], known[i].speed.1, 0.0),
                Over::Order => (order, 0.0, speeds[i]),
                Over::TimeOfDay => (hours?, 0.0, speeds[i]),
            };
            Some(Observation {
                x,
                x_sd,
                // The logarithm of a value that scatters is too small on the average.
                y: value.ln() + 0.5 * sd * sd,
                y_sd: sd,
                beside,
                block: blocks[i],
                cluster: if few { i } else { fruit[i] },
            })
        })
        .collect();
    let observations = observations?;
    let found = trend(&observations, LEAST_DF)?;
    let orders: Vec<f64> = known
        .iter()
        .filter_map(|own| Some(times.of.get(&own.impact.id)?.0))
        .collect();
    let x: Vec<f64> = observations.iter().map(|own| own.x).collect();
    let ends = |pick: fn(f64, f64) -> f64, start| {
        observations.iter().fold(start, |end, own| pick(end, own.x))
    };
    let range = ends(f64::max, f64::NEG_INFINITY) - ends(f64::min, f64::INFINITY);
    Some(TrendOutcome {
        law: law.to_owned(),
        quantity: quantity.to_owned(),
        over: over.name().to_owned(),
        slope: found.slope,
        sd: found.sd,
        range,
        p: t_two_sided((found.slope / found.sd).abs(), found.df),
        impacts: known.len(),
        specimens: count,
        within_specimens: within,
        order_correlation: correlation(&x, &orders, blocks),
    })
}

/// Whether enough of the scatter of x within groups is within fruit.
fn mostly_within(x: &[f64], fruit: &[usize], groups: &[usize]) -> bool {
    let of = |blocks: &[usize]| products(x, x, blocks);
    let struck_again = grouped(fruit.iter().map(|own| (*own, ())));
    let struck_again = struck_again.iter().filter(|(_, own)| own.len() > 1).count();
    struck_again >= FEWEST_FRUIT && of(fruit) >= WITHIN * of(groups)
}

/// Correlation within blocks; 0 where one of both does not vary.
fn correlation(a: &[f64], b: &[f64], blocks: &[usize]) -> f64 {
    let size = (products(a, a, blocks) * products(b, b, blocks)).sqrt();
    match size > 0.0 {
        true => products(a, b, blocks) / size,
        false => 0.0,
    }
}

/// Σ (a − ā) (b − b̄), with the means of each block.
fn products(a: &[f64], b: &[f64], blocks: &[usize]) -> f64 {
    let pairs = a.iter().copied().zip(b.iter().copied());
    let members = grouped(blocks.iter().copied().zip(pairs));
    let of_block = |own: &Vec<(f64, f64)>| {
        let count = own.len() as f64;
        let (a, b) = own
            .iter()
            .fold((0.0, 0.0), |sum, own| (sum.0 + own.0, sum.1 + own.1));
        let (a, b) = (a / count, b / count);
        own.iter().map(|own| (own.0 - a) * (own.1 - b)).sum::<f64>()
    };
    members.iter().map(|(_, own)| of_block(own)).sum()
}

/// Numbers of names, in their order.
fn numbered(names: impl Iterator<Item = String>) -> Vec<usize> {
    let names: Vec<String> = names.collect();
    let distinct: BTreeSet<&str> = names.iter().map(String::as_str).collect();
    let numbers: BTreeMap<&str, usize> = distinct.into_iter().zip(0..).collect();
    names.iter().map(|name| numbers[name.as_str()]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_times_of_day() {
        assert_eq!(hours_of("14:30"), Some(14.5));
        assert_eq!(hours_of("2026-05-03 09:00:36"), Some(9.01));
        assert_eq!(hours_of("2026-05-03T23:15"), Some(23.25));
        for wrong in [
            "",
            "14",
            "24:00",
            "9:60",
            "2:3:4:5",
            "-1:30",
            "noon",
            "14:05:inf",
        ] {
            assert_eq!(hours_of(wrong), None, "{wrong}");
        }
    }
}
