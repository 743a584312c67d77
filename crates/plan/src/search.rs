//! The smallest study that tells enough.

use crate::question::{Levels, Question, Size, Told};
use windfall_files::error::Error;
use windfall_files::option_value::unusable;

/// What is wanted of a study.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Goal {
    /// Nothing: tell what studies of given sizes are worth.
    Open,
    /// A probability of finding the effect.
    Power(f64),
    /// A half-width of the interval.
    HalfWidth(f64),
}

impl Goal {
    /// Whether a study tells enough; none where nothing is wanted or it has no such number.
    /// Intervals that miss the truth too often tell nothing.
    pub fn reached(self, told: &Told, levels: &Levels) -> Option<bool> {
        if self != Self::Open && levels.is_missed(told) {
            return Some(false);
        }
        match self {
            Self::Open => None,
            Self::Power(wanted) => told.power.map(|power| power.value >= wanted),
            Self::HalfWidth(wanted) => Some(told.half_width.is_some_and(|half| half <= wanted)),
        }
    }
}

/// What a study tells, in finite numbers.
///
/// # Errors
/// Those of [`Question::told`]; numbers beyond what can be calculated with.
pub(crate) fn told(question: &dyn Question, size: Size, levels: &Levels) -> Result<Told, Error> {
    let told = question.told(size, levels)?;
    let power = told.power.map(|power| power.value);
    match power.into_iter().chain(told.half_width).all(f64::is_finite) {
        true => Ok(told),
        false => {
            let problem = "the numbers are too large or too small to calculate with: give effects, \
                           widths and standard deviations in a unit that brings them near 1";
            Err(unusable(question.effect_option(), problem))
        }
    }
}

/// Studies that were looked at, in the order of their fruit.
pub(crate) type Studies = Vec<(Size, Told)>;

/// The smallest study that tells enough with so many impacts on each fruit, by doubling and
/// bisection; the largest where none does. More fruit are taken to tell more.
///
/// * `fewest`, `most`: fruit between which it is looked for, multiples of the question's step
///
/// Returns it, and all that were looked at.
///
/// # Errors
/// Those of [`Question::told`].
pub(crate) fn smallest(
    question: &dyn Question,
    (impacts, levels, goal): (usize, &Levels, Goal),
    (fewest, most): (usize, usize),
) -> Result<((Size, Told), Studies), Error> {
    let mut studies = Studies::new();
    let step = question.step();
    let (fewest, most) = (fewest / step, most / step);
    let mut enough = |steps: usize| -> Result<bool, Error> {
        let fruit = steps * step;
        let size = Size { fruit, impacts };
        let told = told(question, size, levels)?;
        let reached = goal.reached(&told, levels) == Some(true);
        studies.push((size, told));
        Ok(reached)
    };
    // too few, and enough
    let (mut low, mut high) = (fewest, fewest);
    let mut found = enough(fewest)?;
    while !found && high < most {
        low = high;
        high = (2 * high).min(most);
        found = enough(high)?;
    }
    while found && high > fewest && high - low > 1 {
        let middle = low.midpoint(high);
        match enough(middle)? {
            true => high = middle,
            false => low = middle,
        }
    }
    studies.sort_by_key(|(size, _)| size.fruit);
    let chosen = studies.iter().find(|(size, _)| size.fruit == high * step);
    let chosen = chosen.or(studies.last()).cloned().unwrap_or_default();
    Ok((chosen, studies))
}
