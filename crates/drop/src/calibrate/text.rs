//! A calibration as text and CSV.

use crate::calibrate::outcome::{CalibrateOutcome, FeaturesOutcome, TargetOutcome};
use crate::calibrate::tables_text::{tables_of, text_of_table};
use crate::calibrate::waveform_text::{shown_value, text_of_waveform};
use std::fmt::Write;
use windfall_files::error::Error;
use windfall_files::table::write::{csv_text, number_cell};
use windfall_files::text::number::{beside_sd, plain, unit_text, value_and_sd};
use windfall_files::text::statistic::chi_square;
use windfall_files::text::table::{
    failures_list, findings_list, header_of, page_tables, paragraph, title_lines,
};
use windfall_measure::measured::MeasuredValue;

/// Features of the fit that are listed each.
const LISTED: usize = 24;

/// A calibration for people.
pub fn text_of_calibration(outcome: &CalibrateOutcome) -> String {
    let mut text = title_lines(&outcome.campaign, outcome.simulated.as_deref(), None);
    let line = format!("law: {}, free: {}", outcome.law, outcome.free.join(", "));
    let _ = writeln!(text, "{}", paragraph(&line, 2));
    let start = match outcome.start.rule.is_empty() {
        true => format!("start: {}", outcome.start.law),
        false => format!("start: {} ({})", outcome.start.law, outcome.start.rule),
    };
    let _ = writeln!(text, "{}", paragraph(&start, 2));
    if let Some(hertz) = outcome.start.hertz_stiffness {
        let millimetres = hertz / 1000f64.powf(1.5);
        let _ = writeln!(text, "Hertz's stiffness: {} N/mm^1.5", plain(millimetres));
    }
    let _ = writeln!(text, "{}", target_text(&outcome.target));
    if let Some(waveform) = &outcome.waveform {
        text += &text_of_waveform(waveform);
    }
    if let Some(features) = &outcome.features {
        text += &features_text(features);
    }
    if let Some(family) = &outcome.family {
        let _ = writeln!(text, "\n{}", paragraph(&family.words, 0));
    }
    for table in tables_of(outcome) {
        let _ = write!(text, "\n{}", text_of_table(&table));
    }
    text += &failures_list("not used", &outcome.failed, 2);
    text + &findings_list(&outcome.findings)
}

fn target_text(target: &TargetOutcome) -> String {
    let features = target.features.0.iter().map(|(name, value)| {
        let (shown, _, unit) = in_milliseconds(value);
        format!("{name} {shown} {unit}")
    });
    let line = format!(
        "target: {} ({}, fruit of {} g): {}",
        target.of,
        match target.drops {
            1 => "1 drop".to_owned(),
            drops => format!("mean of {drops} drops"),
        },
        plain(1e3 * target.mass),
        features.collect::<Vec<_>>().join(", ")
    );
    paragraph(&line, 2)
}

/// A value with its uncertainty, the scale and the unit; times in milliseconds.
fn in_milliseconds(value: &MeasuredValue) -> (String, f64, &str) {
    let (scale, unit) = match value.unit.as_str() {
        "s" => (1e3, "ms"),
        unit => (1.0, unit),
    };
    let text = value_and_sd(scale * value.value, value.sd.map(|sd| scale * sd));
    (text, scale, unit)
}

fn features_text(features: &FeaturesOutcome) -> String {
    let mut text = format!("\nBy features: {}\n", features.law);
    let rows = features.parameters.iter().map(|parameter| {
        let written = &parameter.written;
        let own = |value: f64| beside_sd(value, written.sd.unwrap_or(f64::INFINITY));
        let end = |value: Option<f64>| value.map_or_else(|| "open".to_owned(), own);
        let unit = if written.unit == "1" {
            ""
        } else {
            &written.unit
        };
        let sd = written.sd.map_or("not determined".to_owned(), plain);
        vec![
            parameter.name.clone(),
            own(written.value),
            sd,
            end(written.low),
            end(written.high),
            unit_text(unit),
        ]
    });
    let header = header_of(&["parameter", "value", "sd", "95 % from", "to", "unit"]);
    text += &page_tables(&header, &rows.collect::<Vec<_>>(), &[0, 5]);
    let misfit = chi_square(features.chi_square, features.freedom as f64, features.p);
    let _ = writeln!(
        text,
        "\n{misfit}; directions determined: {} of {}",
        features.rank,
        features.parameters.len()
    );
    for direction in &features.directions {
        let _ = writeln!(text, "  {}", direction.words);
    }
    if features.fitted.len() <= LISTED {
        let header = header_of(&["drop", "feature", "measured", "fitted", "difference / sd"]);
        let rows = features.fitted.iter().map(|fitted| {
            let (measured, scale, unit) = in_milliseconds(&fitted.measured);
            vec![
                fitted.drop.clone(),
                format!("{} ({unit})", fitted.feature),
                measured,
                plain(scale * fitted.fitted),
                format!("{:+.2}", fitted.standardised),
            ]
        });
        let table = page_tables(&header, &rows.collect::<Vec<_>>(), &[0, 1]);
        let _ = writeln!(text, "\n{table}");
    }
    text
}

/// The estimates as CSV: a row per way and parameter.
pub fn csv_of_calibration(outcome: &CalibrateOutcome) -> Result<String, Error> {
    let header = [
        "way",
        "parameter",
        "value_SI",
        "sd_SI",
        "unit_SI",
        "value",
        "sd",
        "low",
        "high",
        "unit",
        "determined",
    ];
    let mut rows = Vec::new();
    for parameter in outcome.waveform.iter().flat_map(|w| &w.parameters) {
        let (own, shown) = (&parameter.value, shown_value(parameter));
        let mut row = vec!["waveform".to_owned(), parameter.name.clone()];
        row.extend([own.value.to_string(), number_cell(own.sd), own.unit.clone()]);
        row.extend([Some(shown.value), shown.sd, shown.low, shown.high].map(number_cell));
        row.extend([shown.unit.clone(), true.to_string()]);
        rows.push(row);
    }
    for own in outcome.features.iter().flat_map(|f| &f.parameters) {
        let shown = &own.written;
        let mut row = vec!["features".to_owned(), own.name.clone()];
        row.extend([own.value.to_string(), number_cell(own.sd), own.unit.clone()]);
        row.extend([Some(shown.value), shown.sd, shown.low, shown.high].map(number_cell));
        row.extend([shown.unit.clone(), own.sd.is_some().to_string()]);
        rows.push(row);
    }
    if let Some(design) = &outcome.design {
        for (factor, level) in design.factors.iter().zip(&design.optimum.levels) {
            let mut row = vec![String::new(); header.len()];
            row[0] = "design".to_owned();
            row[1] = factor.name.clone();
            row[5] = level.to_string();
            row[9] = factor.unit.clone();
            row[10] = design.family.is_empty().to_string();
            rows.push(row);
        }
    }
    csv_text(&header.map(str::to_owned), rows)
}
