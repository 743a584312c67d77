//! Results of taps as CSV: columns for the specimens.csv of another campaign.

use crate::measured::{MeasuredItem, MeasuredOutcome};
use windfall_files::error::Error;
use windfall_files::table::write::{csv_text, number_cell};
use windfall_signal::tap::acoustic_stiffness::MEGAHERTZ_GRAM;

/// One row per fruit.
pub fn csv_of_acoustic(outcome: &MeasuredOutcome) -> Result<String, Error> {
    let with = "acoustic_stiffness_with_density";
    let dense = outcome
        .specimens
        .iter()
        .any(|item| item.derived.get(with).is_some());
    let mut header = vec![
        "specimen",
        "acoustic_frequency_Hz",
        "acoustic_frequency_sd_Hz",
        "acoustic_stiffness_Hz2_kg2_3",
        "acoustic_stiffness_sd_Hz2_kg2_3",
        "acoustic_stiffness_1e6_Hz2_g2_3",
    ];
    if dense {
        header.extend(["acoustic_stiffness_Pa", "acoustic_stiffness_sd_Pa"]);
    }
    header.extend(["taps", "confidence"]);
    if outcome.simulated.is_some() {
        header.push("simulated");
    }
    let header: Vec<String> = header.into_iter().map(str::to_owned).collect();
    let rows = outcome.specimens.iter().map(|item| {
        let mut row = vec![item.id.clone()];
        row.extend(value_and_sd(item, "acoustic_frequency"));
        row.extend(value_and_sd(item, "acoustic_stiffness"));
        let stiffness = item.derived.get("acoustic_stiffness");
        row.push(number_cell(
            stiffness.map(|value| value.value * MEGAHERTZ_GRAM),
        ));
        if dense {
            row.extend(value_and_sd(item, with));
        }
        let word = |name: &str| item.words.get(name).cloned().unwrap_or_default();
        // "3/4": of the taps that were evaluated, those that show the mode.
        row.extend(word("taps").split('/').next().map(str::to_owned));
        row.push(word("confidence"));
        row.extend(outcome.simulated.clone());
        row
    });
    csv_text(&header, rows.collect::<Vec<_>>())
}

fn value_and_sd(item: &MeasuredItem, name: &str) -> [String; 2] {
    let value = item.derived.get(name);
    [
        number_cell(value.map(|value| value.value)),
        number_cell(value.and_then(|value| value.sd)),
    ]
}
