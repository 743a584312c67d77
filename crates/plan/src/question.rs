//! What is asked of a study: what one of a size would tell.

use crate::outcome::{PrecisionOutcome, ShareOutcome};
use crate::power::half_width::{assured_half_width, expected_half_width};
use crate::power::{Sides, Test};
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;

/// Name of the share of simulated intervals that hold the truth.
pub(crate) const COVERAGE: &str = "coverage";

/// Size of a study.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Size {
    /// Fruit, in each group where there are groups.
    pub fruit: usize,
    /// Impacts on each fruit.
    pub impacts: usize,
}

/// What a study takes in all.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Count {
    pub fruit: usize,
    pub impacts: usize,
}

/// Levels of tests and intervals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Levels {
    pub confidence: f64,
    pub sides: Sides,
    /// Probability that the half-width is kept; its mean where there is none.
    pub assurance: Option<f64>,
}

impl Levels {
    /// Whether simulated intervals miss the truth far more often than they should: more than one
    /// and a half times as often, and by more than three errors of the simulation.
    pub fn is_missed(&self, told: &Told) -> bool {
        let coverage = told.also.iter().find(|own| own.of == COVERAGE);
        coverage.zip(told.simulations).is_some_and(|(own, n)| {
            let (missed, meant) = (1.0 - own.value, 1.0 - self.confidence);
            let error = (meant * (1.0 - meant) / n.max(1) as f64).sqrt();
            missed > 1.5 * meant && missed > meant + 3.0 * error
        })
    }

    /// Half-width of an interval: its mean, or what it stays below with the assurance.
    ///
    /// * `error`: true standard error
    /// * `df`: degrees of freedom of its estimate
    pub fn half_width(&self, error: f64, df: f64) -> f64 {
        match self.assurance {
            None => expected_half_width(error, df, self.confidence),
            Some(assurance) => assured_half_width(error, df, self.confidence, assurance),
        }
    }

    /// The test at 1 - confidence.
    pub fn test(&self) -> Test {
        Test {
            alpha: 1.0 - self.confidence,
            sides: self.sides,
        }
    }
}

/// What a study of one size tells.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Told {
    /// Probability of finding the effect, where one is asked for.
    pub power: Option<ShareOutcome>,
    /// Half-width of the interval, where there is one.
    pub half_width: Option<f64>,
    /// Error of a simulated half-width.
    pub half_width_se: Option<f64>,
    /// Degrees of freedom, where a closed form has them.
    pub df: Option<f64>,
    /// Simulated studies, where there are any.
    pub simulations: Option<usize>,
    /// Those that could not be evaluated.
    pub failed: usize,
    /// Why, and how often.
    pub failures: Vec<(String, usize)>,
    /// Those in which a variance was estimated as zero.
    pub singular: usize,
    /// Further precisions.
    pub also: Vec<PrecisionOutcome>,
}

/// A question that a study is to answer.
pub(crate) trait Question: Sync {
    /// "mean", "difference" …
    fn name(&self) -> &'static str;
    /// What is asked, what is assumed and how it is calculated; a line each.
    fn about(&self) -> Vec<String>;
    /// What `Size::fruit` counts: "fruit", "fruit in each group".
    fn counted(&self) -> &'static str;
    /// Impacts on each fruit where none are asked for.
    fn usual_impacts(&self) -> usize {
        1
    }
    /// Fewest fruit that answer it at all with so many impacts on each.
    ///
    /// # Errors
    /// The number of impacts cannot be used.
    fn fewest(&self, impacts: usize) -> Result<usize, Error>;
    /// Fruit come in multiples of this number.
    fn step(&self) -> usize {
        1
    }
    /// What a study of a size takes in all.
    fn count(&self, size: Size) -> Count {
        Count {
            fruit: size.fruit,
            impacts: size.fruit * size.impacts,
        }
    }
    /// What a study of a size tells.
    ///
    /// # Errors
    /// Nothing can be told of this size.
    fn told(&self, size: Size, levels: &Levels) -> Result<Told, Error>;
    /// Smallest effect that is found with a power, where the question has one.
    fn detectable(&self, _size: Size, _levels: &Levels, _power: f64) -> Option<f64> {
        None
    }
    /// Whether an effect is stated, so that there is a power.
    fn has_effect(&self) -> bool;
    /// Whether intervals have a half-width with an assurance.
    fn has_assurance(&self) -> bool;
    /// The option that states the effect.
    fn effect_option(&self) -> &'static str;
    /// What half-widths are of.
    fn half_width_of(&self) -> &'static str;
    /// Whether it is cheap enough to be asked for every point of a curve.
    fn is_closed_form(&self) -> bool;
    /// What a reader must know whatever the size.
    fn findings(&self) -> Vec<FindingOutcome>;
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 95 % of 1000 intervals miss 50 ± 3 · 6.9, and 1.5 times as often is 75.
    #[test]
    fn closed_form_coverage_that_is_missed() {
        let levels = Levels {
            confidence: 0.95,
            sides: Sides::Two,
            assurance: None,
        };
        let told = |value: f64, simulations: usize| Told {
            simulations: Some(simulations),
            also: vec![PrecisionOutcome {
                of: COVERAGE.to_owned(),
                value,
                se: None,
            }],
            ..Told::default()
        };
        assert!(levels.is_missed(&told(0.76, 1000)));
        assert!(levels.is_missed(&told(0.92, 1000)));
        assert!(!levels.is_missed(&told(0.93, 1000)));
        // 50 studies miss 2.5 ± 3 · 1.5
        assert!(!levels.is_missed(&told(0.88, 50)));
        assert!(!levels.is_missed(&Told::default()));
    }
}
