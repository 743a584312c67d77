//! Taps of one fruit → its first mode and its stiffness.

use crate::measured::{MeasuredItem, plain_value, value_with_sd};
use crate::taps::document::{TapDocument, TapsDocument};
use crate::taps::read::{AcousticCampaign, Common, density_of};
use itertools::Itertools;
use windfall_campaign::settings::model::{ImpactEntry, Specimen};
use windfall_files::error::{Error, Place};
use windfall_files::found::FindingOutcome;
use windfall_files::named::{Named, grouped};
use windfall_files::text::cell_quantity::cell_quantity;
use windfall_files::text::number::plain;
use windfall_signal::tap::acoustic_stiffness::{
    acoustic_stiffness, acoustic_stiffness_with_density,
};
use windfall_signal::tap::first_mode::{
    Decision, FirstMode, Persistent, Rejection, TapModes, first_mode, persistent,
    shared_frequencies,
};
use windfall_signal::tap::resonance::Resonance;
use windfall_signal::uncertain::Uncertain;

/// Name of the method, where other campaigns have that of a law.
pub const METHOD: &str = "first spheroidal mode";

/// Unit of the stiffness factor.
pub const STIFFNESS_UNIT: &str = "kg^(2/3)/s^2";

/// One recording with its result.
pub struct TapsOfEntry<'a> {
    /// The row of impacts.csv.
    pub entry: &'a ImpactEntry,
    /// The result.
    pub taps: &'a TapsDocument,
}

/// Taps and specimens of a campaign.
pub struct AcousticResults {
    /// One for each tap.
    pub taps: Vec<MeasuredItem>,
    /// One for each fruit, in the order of impacts.csv.
    pub specimens: Vec<MeasuredItem>,
}

/// Decides on every fruit, and then says of every tap what it shows.
///
/// # Errors
/// A mass or density is no positive number.
pub fn acoustic_results(
    campaign: &AcousticCampaign,
    entries: &[TapsOfEntry],
) -> Result<AcousticResults, Error> {
    let fruit = grouped(entries.iter().map(|own| (own.entry.specimen.as_str(), own)));
    let modes: Vec<Vec<TapModes>> = fruit.iter().map(|(_, list)| tap_modes(list)).collect();
    let agreement = campaign.first_mode.agreement;
    let found: Vec<Vec<Persistent>> = modes.iter().map(|m| persistent(m, agreement)).collect();
    let shared = match campaign.common {
        Common::Reject => shared_frequencies(&found, agreement),
        Common::Keep => Vec::new(),
    };
    let mut results = AcousticResults {
        taps: Vec::new(),
        specimens: Vec::new(),
    };
    for (((id, list), modes), found) in fruit.iter().zip(&modes).zip(&found) {
        let places = modes.iter().map(|tap| &tap.orientation).unique().count();
        let options = &campaign.first_mode;
        let decision = first_mode(found, modes.len(), places, &shared, options);
        let item = specimen_item(campaign, id, list, (&decision, modes.len(), places))?;
        results.specimens.push(item);
        for entry in list {
            results.taps.extend(tap_items(campaign, entry, &decision));
        }
    }
    Ok(results)
}

fn tap_modes(entries: &[&TapsOfEntry]) -> Vec<TapModes> {
    let of_entry = |entry: &&TapsOfEntry| {
        let cells = entry.entry.cells.iter();
        let place = cells.clone().find(|(name, _)| name == "orientation");
        let orientation = place.map_or_else(String::new, |(_, cell)| cell.clone());
        let modes = entry.taps.taps.iter().map(move |tap| TapModes {
            orientation: orientation.clone(),
            resonances: tap.resonances.clone(),
        });
        modes.collect::<Vec<_>>()
    };
    entries.iter().flat_map(of_entry).collect()
}

/// One item for each tap: the accepted mode as this tap shows it.
fn tap_items(
    campaign: &AcousticCampaign,
    entry: &TapsOfEntry,
    decision: &Decision,
) -> Vec<MeasuredItem> {
    let agreement = campaign.first_mode.agreement;
    let several = entry.taps.taps.len() > 1;
    let item = |(number, tap): (usize, &TapDocument)| {
        let nearest = decision.accepted.as_ref().and_then(|mode| {
            let frequency = mode.frequency.value;
            let (low, high) = mode.doublet.unwrap_or((frequency, frequency));
            let reach = (1.0 - 2.0 * agreement) * low..=(1.0 + 2.0 * agreement) * high;
            let all = tap.resonances.iter();
            let near = all.filter(|resonance| reach.contains(&resonance.mode.frequency));
            near.max_by(|a, b| a.level.total_cmp(&b.level))
        });
        let all = tap.resonances.iter();
        let list = all.map(|r| format!("{:.0}", r.mode.frequency)).join(" ");
        let mut item = MeasuredItem {
            id: match several {
                true => format!("{} tap {}", entry.entry.id, number + 1),
                false => entry.entry.id.clone(),
            },
            words: Named::of([("resonances (Hz)", list)]),
            derived: Named::of([("onset", plain_value(tap.onset, "s"))]),
            ..MeasuredItem::of(&campaign.shared, entry.entry, METHOD)
        };
        if let Some(Resonance { mode, level, .. }) = nearest {
            let frequency = value_with_sd(mode.frequency, mode.frequency_sd, "Hz");
            item.parameters.push("acoustic_frequency", frequency);
            let quality = value_with_sd(mode.quality, mode.quality_sd, "1");
            item.derived.push("quality", quality);
            item.derived.push("level", plain_value(*level, "1"));
        }
        if number == 0 {
            item.findings.clone_from(&entry.taps.findings);
        }
        item
    };
    entry.taps.taps.iter().enumerate().map(item).collect()
}

fn specimen_item(
    campaign: &AcousticCampaign,
    id: &str,
    entries: &[&TapsOfEntry],
    (decision, taps, places): (&Decision, usize, usize),
) -> Result<MeasuredItem, Error> {
    let specimen = campaign.shared.specimens.iter().find(|s| s.id == id);
    let mass = cell(campaign, specimen, "mass", "kg")?;
    let density = density_of(campaign, cell(campaign, specimen, "density", "kg/m^3")?);
    let mut values = Named::default();
    let mut push = |name: &str, value: Uncertain, unit: &str| {
        values.push(name, value_with_sd(value.value, value.sd, unit));
    };
    let shown = decision.accepted.as_ref().map_or(0, |mode| mode.taps);
    if let Some(mode) = &decision.accepted {
        push("acoustic_frequency", mode.frequency, "Hz");
        if let Some(mass) = mass {
            let mass = Uncertain::new(mass, campaign.mass_sd);
            let stiffness = acoustic_stiffness(mode.frequency, mass);
            push("acoustic_stiffness", stiffness, STIFFNESS_UNIT);
            if let Some(density) = density {
                let with = acoustic_stiffness_with_density(stiffness, density);
                push("acoustic_stiffness_with_density", with, "Pa");
            }
            push("mass", mass, "kg");
        }
        values.push("quality", plain_value(mode.quality, "1"));
        values.push("level", plain_value(mode.level, "1"));
    }
    let group = entries.first();
    Ok(MeasuredItem {
        group: group.and_then(|own| campaign.shared.group_of(own.entry)),
        file: format!("{} recordings", entries.len()),
        words: Named::of([
            ("taps", format!("{shown}/{taps}")),
            ("confidence", decision.confidence.word().to_owned()),
        ]),
        derived: values,
        findings: findings(decision, mass.is_some(), taps, places),
        ..MeasuredItem::named(id, METHOD)
    })
}

fn cell(
    campaign: &AcousticCampaign,
    specimen: Option<&Specimen>,
    name: &str,
    unit: &str,
) -> Result<Option<f64>, Error> {
    let Some(specimen) = specimen else {
        return Ok(None);
    };
    let file = campaign.shared.directory.join("specimens.csv");
    let place = Place::at(&file, specimen.line);
    cell_quantity(&specimen.cells, name, unit, &place)
}

fn findings(decision: &Decision, weighed: bool, taps: usize, places: usize) -> Vec<FindingOutcome> {
    let Some(mode) = &decision.accepted else {
        let seen = decision.rejected.iter().map(|(mode, why)| {
            let hertz = mode.frequency.value;
            let reason = why.reason();
            format!("{hertz:.0} Hz in {} of {taps} taps ({reason})", mode.taps)
        });
        let seen: Vec<String> = seen.collect();
        let seen = match seen.is_empty() {
            true => "no tap shows a peak".to_owned(),
            false => seen.join("; "),
        };
        let message = format!(
            "no resonance can be accepted as the first mode of the fruit: {seen}. A soft fruit may \
             not ring at all"
        );
        return vec![FindingOutcome::new("no_first_mode", message)];
    };
    let mut findings = findings_of_peaks(decision, mode);
    findings.extend(findings_of_taps(mode, taps, places));
    if !weighed {
        let message = "no stiffness: specimens.csv has no mass_g or mass_kg for this fruit";
        findings.push(FindingOutcome::new("mass_unknown", message));
    }
    findings
}

/// What the other peaks say of the mode.
fn findings_of_peaks(decision: &Decision, mode: &FirstMode) -> Vec<FindingOutcome> {
    let mut findings = Vec::new();
    if let Some((low, high)) = mode.doublet {
        let message = format!(
            "the mode is split into {low:.1} Hz and {high:.1} Hz, as by a fruit that is no sphere; \
             its mean is given, with an uncertainty that covers both"
        );
        findings.push(FindingOutcome::new("doublet", message));
    }
    for (other, why) in &decision.rejected {
        let hertz = other.frequency.value;
        let code = match why {
            Rejection::Shared => "shared_resonance",
            Rejection::InQuiet => "resonance_in_quiet",
            Rejection::Torsional => "torsional_mode",
            Rejection::Broad if hertz < mode.frequency.value => "broad_peak_below",
            Rejection::Inconstant if hertz < mode.frequency.value => "inconstant_peak_below",
            _ => continue,
        };
        let reason = why.reason();
        let message = format!("{hertz:.1} Hz is not taken for the first mode: {reason}");
        findings.push(FindingOutcome::new(code, message));
    }
    findings
}

/// How well taps agree on the mode.
fn findings_of_taps(mode: &FirstMode, taps: usize, places: usize) -> Vec<FindingOutcome> {
    let mut findings = Vec::new();
    let mut tell = |code, message: String| findings.push(FindingOutcome::new(code, message));
    if mode.taps < 3 {
        let what = if mode.taps == 1 {
            "one tap"
        } else {
            "two taps"
        };
        let message = format!(
            "only {what} show the mode; three or more, at two places of the fruit, would show \
             whether it lasts"
        );
        tell("few_taps", message);
    } else if mode.taps < taps {
        let message = format!("{} of {taps} taps show the mode", mode.taps);
        tell("taps_disagree", message);
    }
    if places < 2 && mode.taps > 1 {
        let message = "all taps were at one place, as far as impacts.csv tells (column \
                       orientation): a split of the mode may not show";
        tell("one_orientation", message.to_owned());
    }
    let relative = mode.frequency.sd / mode.frequency.value;
    if mode.doublet.is_none() && relative > 0.01 {
        let percent = plain(100.0 * relative);
        tell(
            "taps_scatter",
            format!("the frequency is uncertain by {percent} %"),
        );
    }
    if mode.level < 0.2 {
        let message = format!(
            "a higher peak is {} times stronger: the hit, or the place of the microphone, does not \
             suit the first mode, or it is another resonance",
            plain(1.0 / mode.level)
        );
        tell("faint_mode", message);
    }
    findings
}
