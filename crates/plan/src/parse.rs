//! Numbers of options: sizes of studies, standard deviations, probabilities.

use windfall_files::error::Error;
use windfall_files::option_value::unusable;

/// Most fruit, and most impacts on a fruit, that are planned.
const LARGEST: usize = 1_000_000;

/// Most numbers in a list.
const MOST_LISTED: usize = 100;

/// Numbers of fruit that are to be tried.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Fruit {
    /// From the fewest up to a number.
    Open(usize),
    /// Between two numbers.
    Range(usize, usize),
    /// These.
    Listed(Vec<usize>),
}

/// Reads `--fruit`.
pub(crate) fn fruit(text: Option<&str>, most: usize) -> Result<Fruit, Error> {
    let Some(text) = text else {
        if most == 0 || most > LARGEST {
            let problem = format!("{most} is not between 1 and {LARGEST}");
            return Err(unusable("--most-fruit", problem));
        }
        return Ok(Fruit::Open(most));
    };
    let Some((low, high)) = text.split_once("..") else {
        return Ok(Fruit::Listed(listed("--fruit", text)?));
    };
    let (low, high) = (count("--fruit", low)?, count("--fruit", high)?);
    if low >= high {
        let problem = format!("\"{text}\" runs backwards: the smaller number comes first");
        return Err(unusable("--fruit", problem));
    }
    Ok(Fruit::Range(low, high))
}

/// Reads `--impacts`.
///
/// * `usual`: where it is left out
pub(crate) fn impacts(text: Option<&str>, usual: usize) -> Result<Vec<usize>, Error> {
    text.map_or_else(|| Ok(vec![usual]), |text| listed("--impacts", text))
}

/// Numbers between commas, each once, rising.
fn listed(option: &str, text: &str) -> Result<Vec<usize>, Error> {
    let numbers = text.split(',').map(|part| count(option, part));
    let mut numbers = numbers.collect::<Result<Vec<_>, _>>()?;
    numbers.sort_unstable();
    numbers.dedup();
    match numbers.len() <= MOST_LISTED {
        true => Ok(numbers),
        false => Err(unusable(
            option,
            format!("{} numbers; at most {MOST_LISTED} are tried", numbers.len()),
        )),
    }
}

fn count(option: &str, text: &str) -> Result<usize, Error> {
    let text = text.trim();
    match text.parse::<usize>() {
        Ok(number) if (1..=LARGEST).contains(&number) => Ok(number),
        _ => Err(unusable(
            option,
            format!("\"{text}\" is no whole number from 1 to {LARGEST}"),
        )),
    }
}

/// A finite number.
pub(crate) fn finite(option: &str, value: f64) -> Result<f64, Error> {
    match value.is_finite() {
        true => Ok(value),
        false => Err(unusable(option, format!("{value} is no finite number"))),
    }
}

/// A finite number above zero.
pub(crate) fn positive(option: &str, value: f64) -> Result<f64, Error> {
    match finite(option, value)? > 0.0 {
        true => Ok(value),
        false => Err(unusable(option, format!("{value} must be above zero"))),
    }
}

/// A finite number that is not below zero.
pub(crate) fn at_least_zero(option: &str, value: f64) -> Result<f64, Error> {
    match finite(option, value)? >= 0.0 {
        true => Ok(value),
        false => Err(unusable(option, format!("{value} must not be below zero"))),
    }
}

/// Finite numbers between commas.
pub(crate) fn numbers(option: &str, text: &str) -> Result<Vec<f64>, Error> {
    let parts = text.split(',').map(|part| {
        let part = part.trim();
        let value = part
            .parse::<f64>()
            .map_err(|_| unusable(option, format!("\"{part}\" is no number")))?;
        finite(option, value)
    });
    parts.collect()
}

/// A probability strictly between 0 and 1.
pub(crate) fn part(option: &str, value: f64) -> Result<f64, Error> {
    match value > 0.0 && value < 1.0 {
        true => Ok(value),
        false => Err(unusable(option, format!("{value} is not between 0 and 1"))),
    }
}

/// A number of simulated studies.
pub(crate) fn simulations(number: usize) -> Result<(), Error> {
    /// So few tell nothing, so many take days.
    const RANGE: std::ops::RangeInclusive<usize> = 50..=1_000_000;
    match RANGE.contains(&number) {
        true => Ok(()),
        false => Err(unusable(
            "--simulations",
            format!(
                "{number} is not between {} and {}: 1000 give a power of 0.8 with an error of 0.013",
                RANGE.start(),
                RANGE.end()
            ),
        )),
    }
}
