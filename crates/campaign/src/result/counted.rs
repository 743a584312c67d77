//! Which impacts count: the one rule for tables, cards, populations, comparisons of laws,
//! figures, reports and the page. An impact that does not count stays in the results, with
//! the reasons.

use crate::result::outcome::ImpactOutcome;
use crate::settings::model::{Campaign, ImpactEntry};
use itertools::Itertools;
use std::collections::HashMap;
use windfall_files::found::{FailureOutcome, FindingOutcome, robust_spread};
use windfall_files::named::grouped;
use windfall_files::severity::Severity;
use windfall_files::table::data::{EXCLUDE_COLUMN, excludes};
use windfall_files::text::number::{percent, plain, unit_text, value_and_sd, with_digits};
use windfall_identify::rig::kind::Rig;

/// Column of impacts.csv that says why.
pub const NOTE_COLUMN: &str = "note";

/// Deviations by which a quantity must pass its limit.
pub(crate) const DEVIATIONS: f64 = 3.0;
/// Part of a quantity that it may pass its limit by, whatever its deviation; 1.
const SLACK: f64 = 0.05;
/// Largest ratio of impulse to change of momentum, or its inverse, that a bench whose
/// sensitivity or inertia is somewhat wrong may have; 1.
const IMPULSE_RATIO: f64 = 1.25;
/// Logarithm by which a delay between force and displacement shifts the stiffness, for each
/// part of the contact's duration; 1.
const SHIFT_OF_DELAY: f64 = 10.0;
/// Largest shift of the stiffness, as a logarithm, that delay and gain of the force may cause;
/// 1.
const SHIFT: f64 = 0.15;
/// The same where delay and gain both differ beyond three deviations, as after lost rows; 1.
const SHIFT_OF_BOTH: f64 = 0.10;
/// Largest root mean square between the displacement and the twice integrated force, as a
/// part of the largest displacement; 1.
const MOTION: f64 = 0.04;
/// Fewest impacts of a group with which each is compared.
pub(crate) const FEWEST: usize = 8;
/// Robust deviations from the median of its group at which an impact contradicts it.
pub(crate) const FAR: f64 = 10.0;
/// Smallest difference from the other impacts on a fruit that matters, as a logarithm; 1.
pub(crate) const NEAR: f64 = 0.18;
/// The same from those on other fruit, which differ by nature: a factor of 2.7.
const SOFT: f64 = 1.0;

impl ImpactOutcome {
    /// Whether the impact counts in means, cards and figures.
    pub fn counts(&self) -> bool {
        self.left_out.is_empty()
    }
}

/// Sets for each result why it does not count, if so.
///
/// Reasons are: what the user wrote in the column `exclude` of impacts.csv; findings that call
/// the numbers [wrong](Severity::Wrong); physics (a restitution above 1, an energy that is not
/// absorbed but gained, an impulse that is not the change of momentum, a velocity that the
/// rig cannot have), each beyond three deviations; a stiffness that is not determined; and a
/// stiffness far from the others (ten robust deviations of its logarithm, and 20 % among
/// impacts on one fruit or a factor of 2.7 among fruit: a soft fruit among hard ones counts, a
/// failed fit does not).
pub fn mark_left_out(campaign: &Campaign, rig: &Rig, impacts: &mut [ImpactOutcome]) {
    let entries = campaign.entries.iter();
    let entries: HashMap<&str, &ImpactEntry> = entries.map(|own| (own.id.as_str(), own)).collect();
    for impact in impacts.iter_mut() {
        let entry = entries.get(impact.id.as_str());
        mark_alone(entry.copied(), rig, impact);
    }
    // Impacts on one fruit lie closer together than those of a group.
    let fruit = |own: &ImpactOutcome| format!("fruit {}", own.specimen);
    let group = |own: &ImpactOutcome| own.group.clone().unwrap_or_default();
    for (index, reason) in strangers(impacts, fruit, ("fruit", NEAR)) {
        impacts[index].left_out.push(reason);
    }
    for (index, reason) in strangers(impacts, group, ("group", SOFT)) {
        impacts[index].left_out.push(reason);
    }
}

/// Sets why a result does not count, as far as it can be told without the others.
pub(crate) fn mark_alone(entry: Option<&ImpactEntry>, rig: &Rig, impact: &mut ImpactOutcome) {
    impact.left_out = entry.and_then(excluded).into_iter().collect();
    let reasons = own_reasons(impact, rig);
    impact.left_out.extend(reasons);
}

/// Sets why results do not count ([`mark_left_out`]); the entries of which no result counts,
/// under none of the laws, as failures.
pub fn left_out_under_all_laws(
    campaign: &Campaign,
    rig: &Rig,
    impacts: &mut [ImpactOutcome],
) -> Vec<FailureOutcome> {
    mark_left_out(campaign, rig, impacts);
    let by_entry = grouped(impacts.iter().map(|impact| (impact.id.as_str(), impact)));
    let out = by_entry
        .into_iter()
        .filter(|(_, own)| own.iter().all(|i| !i.counts()));
    let failure = |impact: &ImpactOutcome| FailureOutcome {
        id: impact.id.clone(),
        specimen: impact.specimen.clone(),
        file: impact.file.clone(),
        law: None,
        message: format!(
            "does not count: {}",
            impact
                .left_out
                .iter()
                .map(|reason| &reason.message)
                .join("; ")
        ),
        findings: impact.findings.clone(),
    };
    out.map(|(_, own)| failure(own[0])).collect()
}

/// "3 no-convergence, 1 excluded": how many impacts each reason leaves out.
pub fn reasons_counted<'a>(impacts: impl IntoIterator<Item = &'a ImpactOutcome>) -> String {
    let codes = |impact: &'a ImpactOutcome| impact.left_out.iter().map(|own| own.code.as_str());
    let reasons = impacts
        .into_iter()
        .flat_map(|impact| codes(impact).unique());
    let counted = grouped(reasons.map(|code| (code, ())));
    let counted = counted.into_iter();
    let mut told = counted.map(|(code, all)| format!("{} {code}", all.len()));
    told.join(", ")
}

/// Entries without notes that no result shows: of an entry that is excluded the note is the
/// reason.
pub fn without_notes(entries: &[ImpactEntry]) -> Vec<ImpactEntry> {
    let mut entries = entries.to_vec();
    for entry in &mut entries {
        if excluded(entry).is_none() {
            entry.cells.retain(|(column, _)| column != NOTE_COLUMN);
        }
    }
    entries
}

/// Why the user leaves an entry out, if so.
pub fn excluded(entry: &ImpactEntry) -> Option<FindingOutcome> {
    let cell = |name: &str| {
        let mut cells = entry.cells.iter();
        cells
            .find(|(column, _)| column == name)
            .map(|own| own.1.trim())
    };
    if !excludes(cell(EXCLUDE_COLUMN)?) {
        return None;
    }
    let note = cell(NOTE_COLUMN).filter(|note| !note.is_empty());
    let note = note.map_or_else(String::new, |note| format!(": {note}"));
    let told = format!("impacts.csv, line {}, excludes it{note}", entry.line);
    Some(FindingOutcome::new("excluded", told))
}

/// What the impact itself says against it.
fn own_reasons(impact: &ImpactOutcome, rig: &Rig) -> Vec<FindingOutcome> {
    let wrong = |own: &&FindingOutcome| own.severity == Severity::Wrong;
    let grave = impact.findings.iter().filter(wrong);
    let mut reasons: Vec<_> = grave.unique_by(|own| &own.code).cloned().collect();
    reasons.extend(impossible(impact, rig));
    reasons.extend(undetermined(impact));
    // A finding that is to be doubted where it is small is wrong where it keeps the impact out.
    for reason in &mut reasons {
        reason.severity = Severity::Wrong;
    }
    reasons
}

/// A quantity read off the signals, with its deviation.
fn signal(impact: &ImpactOutcome, name: &str) -> Option<(f64, f64)> {
    let source = impact.derived_from.get(name)?;
    let sd = impact.derived_sd.get(name).copied().unwrap_or(0.0);
    (source == "signal").then(|| impact.derived(name).map(|value| (value, sd)))?
}

/// What physics excludes.
fn impossible(impact: &ImpactOutcome, rig: &Rig) -> impl Iterator<Item = FindingOutcome> {
    [
        restitution_outside(impact),
        energy_gained(impact),
        impulse_unbalanced(impact, rig),
        force_late_or_scaled(impact),
        two_motions(impact),
        velocity_beyond(impact, rig),
    ]
    .into_iter()
    .flatten()
}

fn restitution_outside(impact: &ImpactOutcome) -> Option<FindingOutcome> {
    let (e, sd) = signal(impact, "restitution")?;
    let room = (DEVIATIONS * sd).max(SLACK);
    (e > 1.0 + room || e < -room).then(|| {
        let told = format!(
            "the restitution is {}, and it lies between 0 and 1: the velocity before or after \
             contact is wrong, as by a drift, a glitch or a false trigger",
            value_and_sd(e, Some(sd))
        );
        FindingOutcome::new("impossible-restitution", told)
    })
}

fn energy_gained(impact: &ImpactOutcome) -> Option<FindingOutcome> {
    let (lost, sd) = signal(impact, "absorbed_energy")?;
    let (before, _) = signal(impact, "impact_energy")?;
    (lost < -(DEVIATIONS * sd).max(SLACK * before)).then(|| {
        let told = format!(
            "the absorbed energy is {} mJ: fruit give no energy",
            value_and_sd(1e3 * lost, Some(1e3 * sd))
        );
        FindingOutcome::new("negative-absorbed-energy", told)
    })
}

/// ∫F dt = m (v₁ + v₂ + a T), with the driving acceleration a during the contact.
fn impulse_unbalanced(impact: &ImpactOutcome, rig: &Rig) -> Option<FindingOutcome> {
    let (v1, s1) = signal(impact, "impact_velocity")?;
    let (v2, s2) = signal(impact, "rebound_velocity")?;
    let (impulse, sd) = signal(impact, "impulse")?;
    let mass = rig.effective_mass();
    let driven = signal(impact, "contact_duration")
        .map_or(0.0, |(duration, _)| rig.driving_acceleration() * duration);
    let change = mass * (v1 + v2 + driven);
    let room = DEVIATIONS * (sd * sd + mass * mass * (s1 * s1 + s2 * s2)).sqrt();
    let ratio = impulse / change;
    let off = !(1.0 / IMPULSE_RATIO..=IMPULSE_RATIO).contains(&ratio);
    (off && (impulse - change).abs() > room).then(|| {
        let told = format!(
            "the force has the impulse {} N s where the momentum changes by {} N s: the zero of \
             the force, a false trigger, clipping, or a unit",
            plain(impulse),
            plain(change)
        );
        FindingOutcome::new("impulse-contradicts-momentum", told)
    })
}

fn force_late_or_scaled(impact: &ImpactOutcome) -> Option<FindingOutcome> {
    // With too few samples for a misfit, impacts say something together only.
    signal(impact, "motion_misfit")?;
    let (gain, gain_sd) = signal(impact, "force_gain")?;
    let (delay, delay_sd) = signal(impact, "force_delay")?;
    let (duration, _) = signal(impact, "contact_duration")?;
    let by_delay = SHIFT_OF_DELAY * delay.abs() / duration;
    let by_gain = gain.ln().abs();
    let sd = (SHIFT_OF_DELAY * delay_sd / duration).hypot(gain_sd / gain);
    let both = delay.abs() > DEVIATIONS * delay_sd && (gain - 1.0).abs() > DEVIATIONS * gain_sd;
    let limit = if both { SHIFT_OF_BOTH } else { SHIFT };
    (by_delay + by_gain > (DEVIATIONS * sd).max(limit)).then(|| {
        let told = format!(
            "by Newton's law the force is {} µs off the displacement ({} of the contact) and {} \
             times mass × acceleration: the stiffness may be {} off",
            value_and_sd(1e6 * delay, Some(1e6 * delay_sd)),
            percent(delay.abs() / duration),
            value_and_sd(gain, Some(gain_sd)),
            percent((by_delay + by_gain).exp_m1())
        );
        let code = match by_delay > by_gain {
            true => "late-channel",
            false => "impulse-contradicts-momentum",
        };
        FindingOutcome::new(code, told)
    })
}

fn two_motions(impact: &ImpactOutcome) -> Option<FindingOutcome> {
    let (misfit, _) = signal(impact, "motion_misfit")?;
    let (noise, _) = signal(impact, "motion_noise")?;
    let (largest, _) = signal(impact, "max_displacement")?;
    (misfit > (DEVIATIONS * noise).max(MOTION * largest)).then(|| {
        let told = format!(
            "the force, integrated twice, departs from the displacement by {} µm, {} of the \
             largest: they are not of one motion",
            with_digits(1e6 * misfit, 2),
            percent(misfit / largest)
        );
        FindingOutcome::new("motion-mismatch", told)
    })
}

fn velocity_beyond(impact: &ImpactOutcome, rig: &Rig) -> Option<FindingOutcome> {
    let most = rig.largest_velocity()?;
    let (v1, sd) = signal(impact, "impact_velocity")?;
    (v1 > most + (DEVIATIONS * sd).max(SLACK * most)).then(|| {
        let told = format!(
            "the velocity is {} m/s, and this pendulum reaches {} m/s",
            plain(v1),
            plain(most)
        );
        FindingOutcome::new("impossible-velocity", told)
    })
}

/// A stiffness that the data do not tell from zero.
fn undetermined(impact: &ImpactOutcome) -> Option<FindingOutcome> {
    let (name, estimate) = impact.parameters.0.iter().find(|(_, own)| !own.held)?;
    let sd = estimate.sd?;
    (DEVIATIONS * sd > estimate.value.abs()).then(|| {
        let told = format!(
            "{name} is {} {}: the signals do not determine it",
            value_and_sd(estimate.value, Some(sd)),
            unit_text(&estimate.unit)
        );
        FindingOutcome::new("undetermined", told)
    })
}

/// Results that the others of their fruit or group contradict, by their place.
fn strangers(
    impacts: &[ImpactOutcome],
    of: impl Fn(&ImpactOutcome) -> String,
    (what, least): (&str, f64),
) -> Vec<(usize, FindingOutcome)> {
    let counted = impacts.iter().enumerate().filter(|(_, own)| own.counts());
    let stiffness = counted.filter_map(|(index, impact)| {
        let (name, estimate) = impact.parameters.0.iter().find(|(_, own)| !own.held)?;
        let own = (index, name.as_str(), estimate.value.ln());
        let group = (impact.law.as_str(), of(impact));
        (estimate.value > 0.0).then_some((group, own))
    });
    let mut strange = Vec::new();
    for (_, members) in grouped(stiffness) {
        let values: Vec<f64> = members.iter().map(|own| own.2).collect();
        let Some((median, deviation)) = robust_spread(&values) else {
            continue;
        };
        let far = (FAR * deviation).max(least);
        for (index, name, value) in members {
            if values.len() < FEWEST || (value - median).abs() <= far {
                continue;
            }
            let told = format!(
                "{name} is {} times the median of its {what}, in which {name} spreads by a factor of \
                 {} (one robust deviation): look at its signals",
                plain((value - median).exp()),
                plain(deviation.exp())
            );
            strange.push((index, FindingOutcome::new("contradicts-others", told)));
        }
    }
    strange
}
