//! A calibration on waveforms for people.

use crate::calibrate::waveform_outcome::{WaveformOutcome, WaveformParameter};
use std::fmt::Write;
use windfall_files::text::number::{beside_sd, plain, unit_text, value_and_sd};
use windfall_files::text::table::{header_of, page_tables};
use windfall_measure::measured::MeasuredValue;

/// A stiffness with its exponent per millimetre, others in SI.
pub fn shown_value(parameter: &WaveformParameter) -> &MeasuredValue {
    let per_millimetre = parameter.per_millimetre.as_ref();
    per_millimetre.unwrap_or(&parameter.value)
}

/// Estimates, and what each drop tells.
pub fn text_of_waveform(waveform: &WaveformOutcome) -> String {
    let mut text = format!(
        "\nBy waveforms ({} impacts of {} drops): {}\n",
        waveform.impacts,
        waveform.drops.len(),
        waveform.law
    );
    let rows = waveform.parameters.iter().map(|parameter| {
        let shown = shown_value(parameter);
        let sd = shown.sd.unwrap_or(f64::INFINITY);
        let end = |value: Option<f64>| beside_sd(value.unwrap_or(f64::NAN), sd);
        let unit = if shown.unit == "1" { "" } else { &shown.unit };
        vec![
            parameter.name.clone(),
            value_and_sd(shown.value, shown.sd),
            end(shown.low),
            end(shown.high),
            unit_text(unit),
        ]
    });
    let header = header_of(&["parameter", "value ± sd", "95 % from", "to", "unit"]);
    text += &page_tables(&header, &rows.collect::<Vec<_>>(), &[0, 4]);
    let _ = writeln!(
        text,
        "\nχ² {} per sample, {} samples; uncertainties are those of {}",
        plain(waveform.misfit),
        waveform.samples,
        if waveform.by_scatter {
            "the scatter from drop to drop"
        } else {
            "noise"
        }
    );
    let rows = waveform.drops.iter().map(|drop| {
        vec![
            drop.id.clone(),
            plain(1e3 * drop.height),
            value_and_sd(drop.velocity.value, drop.velocity.sd),
            value_and_sd(1e3 * drop.mass.value, drop.mass.sd.map(|sd| 1e3 * sd)),
            plain(drop.misfit),
        ]
    });
    let header = header_of(&[
        "drop",
        "height (mm)",
        "velocity (m/s)",
        "mass (g)",
        "χ² per sample",
    ]);
    let _ = writeln!(
        text,
        "\n{}",
        page_tables(&header, &rows.collect::<Vec<_>>(), &[0])
    );
    text
}
