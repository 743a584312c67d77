//! Factors of a design as the command line gives them: `k=0.44..0.86 N/mm`.

use windfall_design::error::DesignError;
use windfall_design::kind::Factor;
use windfall_files::error::Error;
use windfall_files::option_value::unusable;

/// A factor, and the levels that were listed for it.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignFactor {
    /// The factor.
    pub factor: Factor,
    /// Coded levels, where they were listed or are categories.
    pub levels: Option<Vec<f64>>,
}

/// Names of columns that a design has beside its factors.
pub const OWN_COLUMNS: [&str; 4] = ["run", "standard_order", "block", "point"];

/// End of the names of columns with coded values.
pub const CODED: &str = "_coded";

/// Factors of the command line.
///
/// # Errors
/// As [`parse_factor`].
pub fn factors_of(texts: &[String]) -> Result<Vec<DesignFactor>, Error> {
    texts.iter().map(|text| parse_factor(text)).collect()
}

/// Reads a factor.
///
/// * `k=0.44..0.86 N/mm`: a range, with a unit if there is one
/// * `k=0.3, 0.5, 1 N/mm`: levels
/// * `variety=Fuji, Gala`: categories
///
/// # Errors
/// The text is none of these, or names something that cannot be a column.
pub fn parse_factor(text: &str) -> Result<DesignFactor, Error> {
    let wrong = |problem: String| unusable(format!("--factor '{text}'"), problem);
    let form = "expected NAME=LOW..HIGH UNIT, such as 'k=0.44..0.86 N/mm', or NAME=A,B,C";
    let (name, values) = text.split_once('=').ok_or_else(|| wrong(form.to_owned()))?;
    let (name, values) = (name.trim(), values.trim());
    check_name(name).map_err(&wrong)?;
    let found = match values.split_once("..") {
        Some((low, high)) => range(name, low, high),
        None if values.contains(',') => listed(name, values),
        None => return Err(wrong(form.to_owned())),
    };
    found.map_err(wrong)
}

/// A number in the 15 decimal digits that a double always holds.
pub fn fifteen_digits(value: f64) -> f64 {
    format!("{value:.14e}").parse().unwrap_or(value)
}

/// A name that can head a column and stand in the file's header.
fn check_name(name: &str) -> Result<(), String> {
    let unfit = |c: char| matches!(c, ',' | ';' | '"' | '#' | '=' | '|') || c.is_control();
    if name.is_empty() || name.contains(unfit) || name.contains(": ") {
        return Err(format!(
            "\"{name}\" cannot name a column; leave out commas, quotes, '#', '=' and '|'"
        ));
    }
    match OWN_COLUMNS.contains(&name) || name.ends_with(CODED) {
        true => Err(format!(
            "a column \"{name}\" is written beside the factors; choose another name"
        )),
        false => Ok(()),
    }
}

fn range(name: &str, low: &str, high: &str) -> Result<DesignFactor, String> {
    let (low, low_unit) = number_and_unit(low)?;
    let (high, unit) = number_and_unit(high)?;
    if !low_unit.is_empty() && low_unit != unit {
        return Err(format!(
            "the ends have different units (\"{low_unit}\" and \"{unit}\"); write both in one"
        ));
    }
    check_unit(unit)?;
    let factor = decimal_factor(name, unit, low, high)?;
    Ok(DesignFactor {
        factor,
        levels: None,
    })
}

/// A factor with the centre and half-range of the decimal numbers, without rounding.
fn decimal_factor(name: &str, unit: &str, low: f64, high: f64) -> Result<Factor, String> {
    let mut factor = Factor::between(name, unit, low, high).map_err(said)?;
    factor.centre = fifteen_digits(factor.centre);
    factor.half = fifteen_digits(factor.half);
    Ok(factor)
}

fn listed(name: &str, values: &str) -> Result<DesignFactor, String> {
    let items: Vec<&str> = values.split(',').map(str::trim).collect();
    if items.iter().any(|item| item.is_empty()) {
        return Err("a level is blank".to_owned());
    }
    let Some((numbers, unit)) = numbers_of(&items) else {
        let categories: Vec<String> = items.iter().map(|item| (*item).to_owned()).collect();
        if let Some(unfit) = categories
            .iter()
            .find(|c| c.contains(['|', '"', ';', '#']) || c.contains(char::is_control))
        {
            return Err(format!(
                "the category \"{unfit}\" holds '|', ';', '#', a quote or a control character"
            ));
        }
        let factor = Factor::of_categories(name, &categories).map_err(said)?;
        let levels = Some(factor.ends());
        return Ok(DesignFactor { factor, levels });
    };
    check_unit(unit)?;
    let mut sorted = numbers.clone();
    sorted.sort_by(f64::total_cmp);
    sorted.dedup();
    if sorted.len() < numbers.len() || sorted.len() < 2 {
        return Err("expected at least two levels that differ".to_owned());
    }
    let (low, high) = (sorted[0], sorted[sorted.len() - 1]);
    let factor = decimal_factor(name, unit, low, high)?;
    // The ends exactly: coding them would leave rounding.
    let coded = |level: &f64| match *level {
        level if level == low => -1.0,
        level if level == high => 1.0,
        level => factor.coded(level),
    };
    let levels = Some(sorted.iter().map(coded).collect());
    Ok(DesignFactor { factor, levels })
}

/// Numbers with a unit behind the last; `None` if any is no number.
fn numbers_of<'a>(items: &[&'a str]) -> Option<(Vec<f64>, &'a str)> {
    let (last, others) = items.split_last()?;
    let plain: Option<Vec<f64>> = others.iter().map(|item| item.parse().ok()).collect();
    let mut numbers = plain?;
    let (number, unit) = match last.split_once(char::is_whitespace) {
        Some((number, unit)) => (number, unit.trim()),
        None => (*last, ""),
    };
    numbers.push(number.parse().ok()?);
    numbers
        .iter()
        .all(|n| n.is_finite())
        .then_some((numbers, unit))
}

/// "0.86 N/mm" or "0.86N/mm": the longest number, and the rest.
fn number_and_unit(text: &str) -> Result<(f64, &str), String> {
    let text = text.trim();
    let ends = text.char_indices().map(|(at, c)| at + c.len_utf8()).rev();
    let number = ends
        .filter_map(|end| Some((text[..end].parse::<f64>().ok()?, end)))
        .next();
    match number.filter(|(number, _)| number.is_finite()) {
        Some((number, end)) if !text[end..].starts_with([',', '.']) => {
            Ok((number, text[end..].trim()))
        }
        _ => Err(format!(
            "\"{text}\" does not begin with a number; decimals have a point"
        )),
    }
}

fn check_unit(unit: &str) -> Result<(), String> {
    match unit.contains(['[', ']', ',', ';', '"']) || unit.contains("..") {
        true => Err(format!("\"{unit}\" cannot be a unit")),
        false => Ok(()),
    }
}

fn said(error: DesignError) -> String {
    error.to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_ranges_levels_and_categories() {
        let found = parse_factor("k = 0.44..0.86 N/mm^1.91").unwrap();
        assert_eq!(found.factor.unit, "N/mm^1.91");
        assert_eq!((found.factor.centre, found.levels), (0.65, None));
        for text in ["c=1e-4..6e-4N s/mm", "c=1e-4N s/mm..6e-4 N s/mm"] {
            let factor = parse_factor(text).unwrap().factor;
            assert_eq!((factor.half, &factor.unit[..]), (2.5e-4, "N s/mm"));
        }
        let found = parse_factor("v=-5..5").unwrap().factor;
        assert_eq!((found.centre, found.half), (0.0, 5.0));
        let found = parse_factor("height=100, 300, 200 mm").unwrap();
        assert_eq!(found.levels, Some(vec![-1.0, 0.0, 1.0]));
        assert_eq!(found.factor.unit, "mm");
        let found = parse_factor("variety=Fuji, Gala").unwrap();
        assert_eq!(found.factor.categories, ["Fuji", "Gala"]);
    }

    #[test]
    fn rejects_what_is_no_factor() {
        let cases = [
            ("k", "NAME=LOW..HIGH"),
            ("k=3", "NAME=LOW..HIGH"),
            ("k=1..0.3", "low end 1 must be below"),
            ("k=1..1", "low end 1 must be below"),
            ("k=0,3..1", "decimals have a point"),
            ("k=a..b", "does not begin with a number"),
            ("k=1 mm..2 cm", "different units"),
            ("k=inf..2", "does not begin with a number"),
            ("run=1..2", "choose another name"),
            ("k_coded=1..2", "choose another name"),
            ("=1..2", "cannot name a column"),
            ("v=Fuji,Fuji", "1 different levels"),
            ("v=1,1", "at least two levels"),
            ("v=1,,2", "blank"),
        ];
        for (text, expected) in cases {
            let message = parse_factor(text).unwrap_err().to_string();
            assert!(message.contains(expected), "{text}: {message}");
            assert!(message.contains(text), "{message}");
        }
    }
}
