//! Coding of a table's factors, and where it came from.

use crate::design::coding::coding_of_design;
use crate::regress::findings::finding;
use crate::rows::lines_text;
use std::borrow::Cow;
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::option_value::unusable;
use windfall_files::table::data::Data;
use windfall_files::text::number::plain;
use windfall_statistics::surface::coding::{
    CodedFactors, FactorCoding, Recognised, code_by_levels, code_with,
};

/// Codes the factors by given ranges, by the header of a design, or by their levels.
///
/// # Errors
/// A factor is unknown, no number or constant; a range cannot be used.
pub fn coded_factors(
    data: &Data,
    factors: &[String],
    ranges: &[String],
) -> Result<CodedFactors, Error> {
    let mut columns: Vec<(String, Cow<[f64]>)> = Vec::new();
    for name in factors {
        let values = data.table.numbers(name).map_err(|error| data.told(error))?;
        let values = values.values();
        if values.iter().all(|value| *value == values[0]) {
            let name = name.clone();
            return Err(data.told(windfall_statistics::error::Error::Constant { name }));
        }
        columns.push((name.clone(), values));
    }
    let columns = columns.iter().map(|(name, own)| (name.clone(), &**own));
    let columns: Vec<(String, &[f64])> = columns.collect();
    let planned = coding_of_design(data, &columns)?;
    let mut coded = planned.unwrap_or_else(|| code_by_levels(&columns));
    if !ranges.is_empty() {
        let mut codings = coded.factors;
        for text in ranges {
            let given = range(text, factors)?;
            if let Some(place) = factors.iter().position(|name| *name == given.name) {
                codings[place] = given;
            }
        }
        coded = code_with(codings, &columns, Recognised::Given);
    }
    Ok(coded)
}

/// `k=0.44..0.86`
fn range(text: &str, factors: &[String]) -> Result<FactorCoding, Error> {
    let wrong = |problem: &str| unusable(format!("--range {text}"), problem);
    let expected = "expected FACTOR=LOW..HIGH, the actual values of coded -1 and 1";
    let (name, ends) = text.split_once('=').ok_or_else(|| wrong(expected))?;
    let (low, high) = ends.split_once("..").ok_or_else(|| wrong(expected))?;
    let number = |text: &str| text.trim().parse::<f64>().ok().filter(|n| n.is_finite());
    let (Some(low), Some(high)) = (number(low), number(high)) else {
        return Err(wrong(expected));
    };
    let name = name.trim().to_owned();
    if !factors.contains(&name) {
        return Err(wrong("this is none of the factors"));
    }
    if low >= high {
        return Err(wrong("the low end must be below the high end"));
    }
    Ok(FactorCoding {
        name,
        centre: 0.5 * (low + high),
        half: 0.5 * (high - low),
    })
}

/// Where the coding came from.
pub fn coding_text(coded: &CodedFactors) -> String {
    match &coded.recognised {
        Recognised::Given => "given".to_owned(),
        Recognised::Design { .. } => "that of the design, from its header".to_owned(),
        Recognised::Ranges => "coded -1 and 1 are the lowest and highest values".to_owned(),
        Recognised::CentralComposite { alpha, .. } => format!(
            "central composite design, axial points at ±{}",
            plain(*alpha)
        ),
    }
}

/// What a reader must know of the coding.
pub fn coding_findings(coded: &CodedFactors) -> Vec<FindingOutcome> {
    match &coded.recognised {
        Recognised::CentralComposite { alpha, rounded } if !rounded.is_empty() => {
            let factors: Vec<String> = rounded
                .iter()
                .map(|(name, off)| format!("{name} (by up to {} coded units)", plain(*off)))
                .collect();
            vec![finding(
                "rounded-levels",
                format!(
                    "the levels of {} are rounded: the exact ones of a central composite design \
                     with axial points at ±{} are taken; --range FACTOR=LOW..HIGH takes the levels \
                     as they are",
                    factors.join(", "),
                    plain(*alpha)
                ),
            )]
        }
        Recognised::Design { rounded, changed } => design_findings(rounded, changed),
        _ => Vec::new(),
    }
}

fn design_findings(
    rounded: &[(String, f64)],
    changed: &[(String, Vec<usize>)],
) -> Vec<FindingOutcome> {
    let rounded = rounded.iter().map(|(name, off)| {
        let message = format!(
            "the settings of {name} are rounded, by up to {} coded units: the exact levels of the \
             design are taken; --range {name}=LOW..HIGH takes the settings as they are",
            plain(*off)
        );
        finding("rounded-levels", message)
    });
    let changed = changed.iter().map(|(name, lines)| {
        let message = format!(
            "{name} is not the planned level in {}: what was set is taken",
            lines_text(lines)
        );
        finding("changed-settings", message)
    });
    rounded.chain(changed).collect()
}
