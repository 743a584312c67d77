//! Designs as CSV, with the exact coding of their factors in the header.
//!
//! Lines that begin with `#` say what the design is; one for each factor gives
//! its coding as a formula with all digits:
//!
//! ```text
//! # windfall 0.2.0 design: central composite - rotatable
//! # runs 15 - blocks 1 - order of seed 1
//! # factor A: k = 0.65 + 0.2081112450948766 A [N/mm^1.91] to 2 decimals
//! # factor B: variety = one of Fuji | Gala
//! ```
//!
//! These lines hold no comma, semicolon or quote, so that spreadsheets preserve them but
//! for separators at their ends. The columns are `run`, `standard_order`, `block`, in a
//! split-plot design `whole_plot`, `point`, the setting of each factor, and the exact coded
//! value of each number (`k_coded`).

use crate::design::factor::{CODED, fifteen_digits};
use std::path::Path;
use windfall_design::kind::{Design, Factor};
use windfall_design::word::letter;
use windfall_files::error::Error;
use windfall_files::option_value::unusable;
use windfall_files::table::write::csv_text;
use windfall_files::write_file::write_new;

/// The column of whole plots of a split-plot design.
pub const WHOLE_PLOT: &str = "whole_plot";

/// Beginning of the line of a factor.
const FACTOR: &str = "factor ";

/// What a category's line has in place of a formula.
const ONE_OF: &str = "one of ";

/// A design as CSV.
///
/// * `about`: lines of the header beside those of the design itself
pub fn write_design(design: &Design, about: &[String]) -> Result<String, Error> {
    let mut header: Vec<String> = ["run", "standard_order", "block"]
        .map(str::to_owned)
        .to_vec();
    header.extend(design.whole_plots().map(|_| WHOLE_PLOT.to_owned()));
    header.push("point".to_owned());
    header.extend(design.factors.iter().map(|factor| factor.name.clone()));
    let numbers = || design.factors.iter().filter(|f| f.categories.is_empty());
    header.extend(numbers().map(|factor| format!("{}{CODED}", factor.name)));
    let rows = design.runs.iter().enumerate().map(|(index, run)| {
        let mut row = vec![
            (index + 1).to_string(),
            run.standard_order.to_string(),
            run.block.to_string(),
        ];
        row.extend(run.whole_plot.map(|plot| plot.to_string()));
        row.push(run.point.name().to_owned());
        let pairs = || design.factors.iter().zip(&run.coded);
        row.extend(pairs().map(|(factor, coded)| setting_text(factor, *coded)));
        let coded = pairs().filter(|(factor, _)| factor.categories.is_empty());
        row.extend(coded.map(|(_, coded)| coded.to_string()));
        row
    });
    let mut text = String::new();
    for line in header_lines(design).iter().chain(about) {
        text += &format!("# {}\n", unseparated(line));
    }
    Ok(text + &csv_text(&header, rows)?)
}

/// Writes a design to a file that does not exist.
///
/// # Errors
/// The file exists or cannot be written.
pub fn save_design(path: &Path, design: &Design, about: &[String]) -> Result<(), Error> {
    let text = write_design(design, about)?;
    write_new(path, text.as_bytes())
}

/// The setting of a factor: its category, or the number to its decimals or to 15 digits.
pub fn setting_text(factor: &Factor, coded: f64) -> String {
    if let Some(category) = factor.category(coded) {
        return category.to_owned();
    }
    match factor.decimals {
        Some(decimals) => format!("{:.decimals$}", factor.actual(coded)),
        None => fifteen_digits(factor.actual(coded)).to_string(),
    }
}

fn header_lines(design: &Design) -> Vec<String> {
    let version = env!("CARGO_PKG_VERSION");
    let order = match design.order_seed {
        Some(seed) => format!("order of seed {seed}"),
        None => "standard order".to_owned(),
    };
    let mut lines = vec![
        format!("windfall {version} design: {}", design.kind),
        format!(
            "runs {} - blocks {} - {order}",
            design.runs.len(),
            design.blocks()
        ),
    ];
    let factors = design.factors.iter().enumerate();
    lines.extend(factors.map(|(place, factor)| coding_line(place, factor)));
    if let Some(alpha) = design.alpha {
        lines.push(format!("alpha {alpha}"));
    }
    if let Some(fraction) = design
        .fraction
        .as_ref()
        .filter(|f| !f.generators.is_empty())
    {
        let generators: Vec<String> = fraction.generators.iter().map(|g| g.to_string()).collect();
        lines.push(format!("generators {}", generators.join(" ")));
    }
    lines
}

/// "factor A: k = 0.65 + 0.2 A [N/mm] to 2 decimals".
fn coding_line(place: usize, factor: &Factor) -> String {
    let (letter, name) = (letter(place), &factor.name);
    if !factor.categories.is_empty() {
        let categories = factor.categories.join(" | ");
        return format!("{FACTOR}{letter}: {name} = {ONE_OF}{categories}");
    }
    let mut line = format!(
        "{FACTOR}{letter}: {name} = {} + {} {letter}",
        factor.centre, factor.half
    );
    if !factor.unit.is_empty() {
        line += &format!(" [{}]", factor.unit);
    }
    if let Some(decimals) = factor.decimals {
        line += &format!(" to {decimals} decimals");
    }
    line
}

/// A line without what separates cells.
fn unseparated(line: &str) -> String {
    line.replace(", ", " - ")
        .replace([',', ';'], " ")
        .replace(char::is_control, " ")
        .replace('"', "'")
}

/// The factors of a design from its header, with or without `#`; `None` without any.
///
/// # Errors
/// A factor's line that cannot be read, as the coding would then be wrong.
pub fn read_coding(comments: &[String]) -> Result<Option<Vec<Factor>>, Error> {
    let mut factors = Vec::new();
    for (index, comment) in comments.iter().enumerate() {
        // What spreadsheets add: quotes, and separators of cells that are blank.
        let line = comment.trim().trim_matches('"').trim_start_matches('#');
        let line = line
            .trim_end_matches([',', ';', '\t', '"', ' '])
            .trim_start();
        let Some(rest) = line.strip_prefix(FACTOR) else {
            continue;
        };
        let factor = parse_coding(rest).ok_or_else(|| {
            unusable(
                format!("line {} of the design's header, \"{line}\"", index + 1),
                "expected the coding as windfall design writes it, such as \
                 \"factor A: k = 0.65 + 0.35 A [N/mm]\"; restore the line, or take the header \
                 away and give the factors by hand",
            )
        })?;
        factors.push(factor);
    }
    Ok(Some(factors).filter(|factors| !factors.is_empty()))
}

/// Reads what stands behind "factor ".
fn parse_coding(text: &str) -> Option<Factor> {
    let (letter, rest) = text.split_once(": ")?;
    let (name, coding) = rest.split_once(" = ")?;
    if let Some(categories) = coding.strip_prefix(ONE_OF) {
        let categories: Vec<String> = categories.split('|').map(|c| c.trim().to_owned()).collect();
        return Factor::of_categories(name, &categories).ok();
    }
    let (centre, rest) = coding.split_once(" + ")?;
    let (half, rest) = rest.split_once(' ')?;
    let mut rest = rest.strip_prefix(letter)?.trim();
    let mut unit = "";
    if let Some(inner) = rest.strip_prefix('[') {
        let (inside, after) = inner.split_once(']')?;
        (unit, rest) = (inside, after.trim());
    }
    let decimals = match rest {
        "" => None,
        _ => {
            let number = rest.strip_prefix("to ")?.strip_suffix(" decimals")?;
            Some(number.parse().ok()?)
        }
    };
    let (centre, half): (f64, f64) = (centre.parse().ok()?, half.parse().ok()?);
    (centre.is_finite() && half.is_finite() && half > 0.0).then(|| Factor {
        name: name.to_owned(),
        unit: unit.to_owned(),
        centre,
        half,
        decimals,
        categories: Vec::new(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use windfall_design::composite::{CompositeOptions, Ends, central_composite};
    use windfall_design::factorial::{FactorialOptions, two_level};
    use windfall_design::kind::randomised;
    use windfall_files::table::data::read_data;

    fn drop_study() -> Design {
        let mut factors = vec![
            Factor::between("k", "N/mm^1.91", 0.3, 1.0).unwrap(),
            Factor::between("e", "", 1.5, 3.0).unwrap(),
            Factor::between("c", "N s/mm", 1e-4, 6e-4).unwrap(),
        ];
        factors[0].decimals = Some(2);
        let options = CompositeOptions {
            ends: Ends::Axial,
            centre: 1,
            ..Default::default()
        };
        randomised(central_composite(factors, &options).unwrap(), 1)
    }

    fn written(design: &Design, change: impl Fn(String) -> String) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        let text = change(write_design(design, &["seed, or; not".to_owned()]).unwrap());
        std::fs::write(folder.path().join("design.csv"), text).unwrap();
        folder
    }

    #[test]
    fn recovers_coding_and_runs_from_the_file() {
        let design = drop_study();
        let folder = written(&design, |text| text);
        let path = folder.path().join("design.csv");
        let data = read_data(&path).unwrap();
        assert_eq!(
            read_coding(&data.comments).unwrap(),
            Some(design.factors.clone())
        );
        for (place, name) in ["k_coded", "e_coded", "c_coded"].iter().enumerate() {
            let coded: Vec<f64> = design.runs.iter().map(|run| run.coded[place]).collect();
            assert_eq!(*data.table.numbers(name).unwrap().values(), coded);
        }
        let e = data.table.numbers("e").unwrap();
        for (found, run) in e.iter().zip(&design.runs) {
            assert!((found / design.factors[1].actual(run.coded[1]) - 1.0).abs() < 1e-14);
        }
        // Printed settings are those of the paper's table.
        let mut k = data.table.numbers("k").unwrap().values().into_owned();
        k.sort_by(f64::total_cmp);
        k.dedup();
        assert_eq!(k, [0.3, 0.44, 0.65, 0.86, 1.0]);
    }

    /// A spreadsheet saves every line with as many separators as the table has.
    #[test]
    fn recovers_coding_after_a_spreadsheet() {
        let design = drop_study();
        for separator in [",", ";"] {
            let folder = written(&design, |text| {
                let line = |line: &str| match line.starts_with('#') {
                    true => format!("{line}{}\n", separator.repeat(9)),
                    false => format!("{}\n", line.replace(',', separator)),
                };
                text.lines().map(line).collect()
            });
            let path = folder.path().join("design.csv");
            let data = read_data(&path).unwrap();
            assert_eq!(
                read_coding(&data.comments).unwrap(),
                Some(design.factors.clone())
            );
        }
    }

    #[test]
    fn recovers_categories_and_odd_names() {
        let names = ["Golden Delicious", "Gala"].map(str::to_owned);
        let factors = vec![
            Factor::of_categories("variety", &names).unwrap(),
            Factor::between("plate stiffness", "kN/m", -2.5, 1e-9).unwrap(),
        ];
        let design = two_level(factors.clone(), &[], &FactorialOptions::default()).unwrap();
        let text = write_design(&design, &[]).unwrap();
        let comments: Vec<String> = text
            .lines()
            .filter(|l| l.starts_with('#'))
            .map(str::to_owned)
            .collect();
        assert_eq!(read_coding(&comments).unwrap(), Some(factors));
        assert!(
            text.contains("\n1,1,1,factorial,Golden Delicious,-2.5,-1\n"),
            "{text}"
        );
    }

    #[test]
    fn rejects_a_damaged_coding() {
        assert_eq!(read_coding(&["anything".to_owned()]).unwrap(), None);
        for line in [
            "factor A: k = 0.65 + A",
            "factor A: k = 0.65 + -0.35 A",
            "factor A: k = 0.65 + 0.35 B",
            "factor A: k = 0,65 + 0,35 A",
            "factor A: k = 0.65 + 0.35 A to few decimals",
            "factor A: k",
        ] {
            let error = read_coding(&["windfall".to_owned(), line.to_owned()]).unwrap_err();
            assert!(
                error
                    .to_string()
                    .starts_with("line 2 of the design's header"),
                "{error}"
            );
        }
    }
}
