//! Taps of one fruit → its first mode and its stiffness.

use crate::measure::measured::{MeasuredItem, MeasuredValue, plain_value, value_with_sd};
use crate::settings::model::{ImpactEntry, Specimen};
use crate::taps::document::{TapsDocument, resonance_of};
use crate::taps::read::{AcousticCampaign, Common, density_of};
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::named::Named;
use windfall_files::text::cell_quantity::cell_quantity;
use windfall_files::text::number::plain;
use windfall_signal::tap::acoustic_stiffness::{
    acoustic_stiffness, acoustic_stiffness_with_density,
};
use windfall_signal::tap::first_mode::{
    Decision, FirstMode, Persistent, Rejection, TapModes, first_mode, persistent,
    shared_frequencies,
};
use windfall_signal::uncertain::Uncertain;

/// Name of the method, where other campaigns have that of a law.
pub const METHOD: &str = "first spheroidal mode";

/// Unit of the stiffness factor.
pub const STIFFNESS_UNIT: &str = "kg^(2/3)/s^2";

/// One recording with its result.
pub struct TapsOfEntry<'a> {
    /// The row of impacts.csv.
    pub entry: &'a ImpactEntry,
    /// Group of the entry, where the campaign has groups.
    pub group: Option<String>,
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
    let mut fruit: Vec<(&str, Vec<&TapsOfEntry>)> = Vec::new();
    for entry in entries {
        let specimen = entry.entry.specimen.as_str();
        match fruit.iter_mut().find(|(id, _)| *id == specimen) {
            Some((_, list)) => list.push(entry),
            None => fruit.push((specimen, vec![entry])),
        }
    }
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
        let mut places: Vec<&str> = modes.iter().map(|tap| tap.orientation.as_str()).collect();
        places.sort_unstable();
        places.dedup();
        let options = &campaign.first_mode;
        let decision = first_mode(found, modes.len(), places.len(), &shared, options);
        let item = specimen_item(campaign, id, list, (&decision, modes.len(), places.len()))?;
        results.specimens.push(item);
        for entry in list {
            results.taps.extend(tap_items(entry, &decision, agreement));
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
            resonances: tap.resonances.iter().map(resonance_of).collect(),
        });
        modes.collect::<Vec<_>>()
    };
    entries.iter().flat_map(of_entry).collect()
}

/// One item for each tap: the accepted mode as this tap shows it.
fn tap_items(entry: &TapsOfEntry, decision: &Decision, agreement: f64) -> Vec<MeasuredItem> {
    let several = entry.taps.taps.len() > 1;
    let item = |(number, tap): (usize, &crate::taps::document::TapDocument)| {
        let nearest = decision.accepted.as_ref().and_then(|mode| {
            let (low, high) = mode
                .doublet
                .unwrap_or((mode.frequency.value, mode.frequency.value));
            let reach = (1.0 - 2.0 * agreement) * low..=(1.0 + 2.0 * agreement) * high;
            let near = tap
                .resonances
                .iter()
                .filter(|r| reach.contains(&r.frequency));
            near.max_by(|a, b| a.level.total_cmp(&b.level))
        });
        let mut derived = vec![("onset".to_owned(), plain_value(tap.onset, "s"))];
        let mut parameters = Vec::new();
        if let Some(mode) = nearest {
            let sd = |sd: Option<f64>| sd.unwrap_or(f64::INFINITY);
            let frequency = value_with_sd(mode.frequency, sd(mode.frequency_sd), "Hz");
            parameters.push(("acoustic_frequency".to_owned(), frequency));
            let quality = value_with_sd(mode.quality, sd(mode.quality_sd), "1");
            derived.push(("quality".to_owned(), quality));
            derived.push(("level".to_owned(), plain_value(mode.level, "1")));
        }
        let list = tap.resonances.iter().map(|r| format!("{:.0}", r.frequency));
        let list: Vec<String> = list.collect();
        let first = number == 0;
        MeasuredItem {
            id: match several {
                true => format!("{} tap {}", entry.entry.id, number + 1),
                false => entry.entry.id.clone(),
            },
            specimen: entry.entry.specimen.clone(),
            group: entry.group.clone(),
            file: entry.entry.file.clone(),
            law: METHOD.to_owned(),
            words: Named(vec![("resonances (Hz)".to_owned(), list.join(" "))]),
            parameters: Named(parameters),
            derived: Named(derived),
            findings: if first {
                entry.taps.findings.clone()
            } else {
                Vec::new()
            },
        }
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
    let mut values: Vec<(String, MeasuredValue)> = Vec::new();
    let mut push = |name: &str, value: Uncertain, unit: &str| {
        values.push((name.to_owned(), value_with_sd(value.value, value.sd, unit)));
    };
    let shown = decision.accepted.as_ref().map_or(0, |mode| mode.taps);
    if let Some(mode) = &decision.accepted {
        push("acoustic_frequency", mode.frequency, "Hz");
        if let Some(mass) = mass {
            let mass = Uncertain {
                value: mass,
                sd: campaign.mass_sd,
            };
            let stiffness = acoustic_stiffness(mode.frequency, mass);
            push("acoustic_stiffness", stiffness, STIFFNESS_UNIT);
            if let Some(density) = density {
                let with = acoustic_stiffness_with_density(stiffness, density);
                push("acoustic_stiffness_with_density", with, "Pa");
            }
            push("mass", mass, "kg");
        }
        values.push(("quality".to_owned(), plain_value(mode.quality, "1")));
        values.push(("level".to_owned(), plain_value(mode.level, "1")));
    }
    Ok(MeasuredItem {
        id: id.to_owned(),
        specimen: id.to_owned(),
        group: entries.first().and_then(|entry| entry.group.clone()),
        file: format!("{} recordings", entries.len()),
        law: METHOD.to_owned(),
        words: Named(vec![
            ("taps".to_owned(), format!("{shown}/{taps}")),
            (
                "confidence".to_owned(),
                decision.confidence.word().to_owned(),
            ),
        ]),
        parameters: Named(Vec::new()),
        derived: Named(values),
        findings: findings(decision, mass.is_some(), taps, places),
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
    cell_quantity(&specimen.cells, name, unit, &file)
}

fn finding(code: &str, message: String) -> FindingOutcome {
    FindingOutcome {
        code: code.to_owned(),
        message,
    }
}

fn findings(decision: &Decision, weighed: bool, taps: usize, places: usize) -> Vec<FindingOutcome> {
    let Some(mode) = &decision.accepted else {
        let seen = decision.rejected.iter().map(|(mode, why)| {
            let hertz = mode.frequency.value;
            format!(
                "{hertz:.0} Hz in {} of {taps} taps ({})",
                mode.taps,
                why.reason()
            )
        });
        let seen: Vec<String> = seen.collect();
        let seen = match seen.is_empty() {
            true => "no tap shows a peak".to_owned(),
            false => seen.join("; "),
        };
        return vec![finding(
            "no_first_mode",
            format!(
                "no resonance can be accepted as the first mode of the fruit: {seen}. A soft fruit may not ring at all"
            ),
        )];
    };
    let mut findings = findings_of_peaks(decision, mode);
    findings.extend(findings_of_taps(mode, taps, places));
    if !weighed {
        findings.push(finding(
            "mass_unknown",
            "no stiffness: specimens.csv has no mass_g or mass_kg for this fruit".to_owned(),
        ));
    }
    findings
}

/// What the other peaks say of the mode.
fn findings_of_peaks(decision: &Decision, mode: &FirstMode) -> Vec<FindingOutcome> {
    let mut findings = Vec::new();
    let mut tell = |code: &str, message| findings.push(finding(code, message));
    if let Some((low, high)) = mode.doublet {
        tell(
            "doublet",
            format!(
                "the mode is split into {low:.1} Hz and {high:.1} Hz, as by a fruit that is no sphere; its mean is given, with an uncertainty that covers both"
            ),
        );
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
        tell(
            code,
            format!(
                "{hertz:.1} Hz is not taken for the first mode: {}",
                why.reason()
            ),
        );
    }
    findings
}

/// How well taps agree on the mode.
fn findings_of_taps(mode: &FirstMode, taps: usize, places: usize) -> Vec<FindingOutcome> {
    let mut findings = Vec::new();
    let mut tell = |code: &str, message| findings.push(finding(code, message));
    if mode.taps < 3 {
        let what = if mode.taps == 1 {
            "one tap"
        } else {
            "two taps"
        };
        tell(
            "few_taps",
            format!(
                "only {what} show the mode; three or more, at two places of the fruit, would show whether it lasts"
            ),
        );
    } else if mode.taps < taps {
        tell(
            "taps_disagree",
            format!("{} of {taps} taps show the mode", mode.taps),
        );
    }
    if places < 2 && mode.taps > 1 {
        tell("one_orientation", "all taps were at one place, as far as impacts.csv tells (column orientation): a split of the mode may not show".to_owned());
    }
    let relative = mode.frequency.sd / mode.frequency.value;
    if mode.doublet.is_none() && relative > 0.01 {
        tell(
            "taps_scatter",
            format!(
                "the frequency is uncertain by {} %",
                plain(100.0 * relative)
            ),
        );
    }
    if mode.level < 0.2 {
        tell(
            "faint_mode",
            format!(
                "a higher peak is {} times stronger: the hit, or the place of the microphone, does not suit the first mode, or it is another resonance",
                plain(1.0 / mode.level)
            ),
        );
    }
    findings
}
