//! Sizes of the studies that are looked at.

use crate::asked::{Asked, cost};
use crate::parse::Fruit;
use crate::question::{Question, Size};
use crate::search::Goal;
use crate::text::impacts_text;
use windfall_files::error::Error;
use windfall_files::option_value::unusable;
use windfall_files::text::number::plain;

/// Rows for a range.
const RANGE_ROWS: usize = 7;

/// Sizes of studies with one number of impacts on each fruit.
pub(crate) enum Sizes {
    /// These.
    Listed(Vec<usize>),
    /// The smallest between two that tells enough.
    Searched(usize, usize),
}

/// What is looked at with a number of impacts on each fruit.
///
/// # Errors
/// So few fruit tell nothing; the budget pays for none.
pub(crate) fn sizes(
    question: &dyn Question,
    asked: &Asked,
    impacts: usize,
) -> Result<Sizes, Error> {
    let step = question.step();
    let fewest = question.fewest(impacts)?.next_multiple_of(step);
    let least = match &asked.fruit {
        Fruit::Listed(numbers) => numbers.first().copied().unwrap_or_default(),
        Fruit::Range(_, most) | Fruit::Open(most) => *most,
    };
    if least < fewest {
        return Err(too_few(question, least, fewest));
    }
    let (low, high) = match &asked.fruit {
        Fruit::Listed(numbers) => {
            check_multiples(numbers, step)?;
            return Ok(Sizes::Listed(numbers.clone()));
        }
        Fruit::Range(low, high) => (
            (*low).max(fewest).next_multiple_of(step),
            high - high % step,
        ),
        Fruit::Open(most) => (fewest, most - most % step),
    };
    if low > high {
        return Err(no_multiple(high + 1, step));
    }
    let searched = match asked.goal {
        Goal::Open => false,
        Goal::Power(_) => question.has_effect(),
        Goal::HalfWidth(_) => true,
    };
    Ok(match (&asked.fruit, searched) {
        (_, true) => Sizes::Searched(low, high),
        (Fruit::Open(_), false) => {
            Sizes::Listed(vec![affordable(question, asked, impacts, (low, high))?])
        }
        (_, false) => Sizes::Listed(stepped_over(low, high, RANGE_ROWS, step)),
    })
}

/// Fruit that every value of x cannot have equally often are refused.
fn check_multiples(numbers: &[usize], step: usize) -> Result<(), Error> {
    match numbers.iter().find(|fruit| !fruit.is_multiple_of(step)) {
        None => Ok(()),
        Some(fruit) => Err(no_multiple(*fruit, step)),
    }
}

fn no_multiple(fruit: usize, step: usize) -> Error {
    let (below, above) = (fruit - fruit % step, fruit.next_multiple_of(step));
    let near = match below {
        0 => format!("{above} is the nearest number that can"),
        _ => format!("{below} and {above} are the nearest numbers that can"),
    };
    let problem =
        format!("{fruit} fruit cannot have the {step} values of --x equally often: {near}");
    unusable("--fruit", problem)
}

fn too_few(question: &dyn Question, found: usize, fewest: usize) -> Error {
    let problem = format!(
        "{found} {} cannot tell how much fruit differ: at least {fewest} are needed",
        question.counted()
    );
    unusable("--fruit", problem)
}

/// The most fruit that a budget pays.
fn affordable(
    question: &dyn Question,
    asked: &Asked,
    impacts: usize,
    (fewest, most): (usize, usize),
) -> Result<usize, Error> {
    let pays = |fruit: usize| {
        let cost = cost(question, asked, Size { fruit, impacts });
        let budget = asked.costs.and_then(|costs| costs.budget);
        cost.zip(budget).is_none_or(|(cost, budget)| cost <= budget)
    };
    if !pays(fewest) {
        let size = Size {
            fruit: fewest,
            impacts,
        };
        let needed = cost(question, asked, size).unwrap_or_default();
        let problem = format!(
            "the smallest study, {fewest} {} with {} each, costs {}",
            question.counted(),
            impacts_text(impacts),
            plain(needed)
        );
        return Err(unusable("--budget", problem));
    }
    let step = question.step();
    let (mut low, mut high) = (fewest / step, most.max(fewest) / step + 1);
    while high - low > 1 {
        let middle = low.midpoint(high);
        match pays(middle * step) {
            true => low = middle,
            false => high = middle,
        }
    }
    Ok(low * step)
}

/// Multiples of a step from low to high, which are two of them, at most so many, evenly spread.
pub(crate) fn stepped_over(low: usize, high: usize, most: usize, step: usize) -> Vec<usize> {
    let steps = spread_over(low / step, high / step, most);
    steps.into_iter().map(|steps| steps * step).collect()
}

/// Whole numbers from low to high, at most so many, evenly spread.
fn spread_over(low: usize, high: usize, most: usize) -> Vec<usize> {
    let span = high - low;
    let points = (span + 1).min(most);
    let place = |k: usize| low + (k * span + (points - 1) / 2) / (points - 1).max(1);
    (0..points).map(place).collect()
}
