//! Several means and their F test.

use crate::outcome::exact;
use crate::power::t_test::f_power;
use crate::question::{Count, Levels, Question, Size, Told};
use crate::scatter::KnownScatter;
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;

/// Means of groups of fruit, or of treatments of the same fruit.
pub(crate) struct GroupsQuestion {
    /// The means.
    pub means: Vec<f64>,
    /// Every fruit gets every treatment.
    pub same_fruit: bool,
    pub scatter: KnownScatter,
    pub about: Vec<String>,
}

impl GroupsQuestion {
    /// Standard deviation of a fruit's mean within a group, and the denominator's degrees of
    /// freedom: of k groups of n fruit, k (n - 1); of k treatments with m impacts on each of
    /// n fruit, k m n - n - k + 1.
    fn error(&self, size: Size) -> (f64, f64) {
        let (k, n, m) = (
            self.means.len() as f64,
            size.fruit as f64,
            size.impacts as f64,
        );
        let scatter = &self.scatter.scatter;
        match (self.same_fruit, scatter.within()) {
            (true, Some(within)) => (within / m.sqrt(), k * m * n - n - k + 1.0),
            _ => (scatter.of_fruit_mean(0, size.impacts), k * (n - 1.0)),
        }
    }
}

impl Question for GroupsQuestion {
    fn name(&self) -> &'static str {
        "groups"
    }

    fn about(&self) -> Vec<String> {
        self.about.clone()
    }

    fn counted(&self) -> &'static str {
        match self.same_fruit {
            true => "fruit",
            false => "fruit in each group",
        }
    }

    fn fewest(&self, impacts: usize) -> Result<usize, Error> {
        self.scatter.scatter.check_impacts(impacts)?;
        Ok(2)
    }

    fn count(&self, size: Size) -> Count {
        let all = self.means.len() * size.fruit;
        Count {
            fruit: if self.same_fruit { size.fruit } else { all },
            impacts: all * size.impacts,
        }
    }

    fn told(&self, size: Size, levels: &Levels) -> Result<Told, Error> {
        let (sd, df) = self.error(size);
        let n = size.fruit as f64;
        let k = self.means.len() as f64;
        let mean = self.means.iter().sum::<f64>() / k;
        let squares: f64 = self
            .means
            .iter()
            .map(|own| ((own - mean) / sd).powi(2))
            .sum();
        let power = f_power(n * squares, k - 1.0, df, 1.0 - levels.confidence);
        let error = sd * (2.0 / n).sqrt();
        let half_width = levels.half_width(error, df);
        Ok(Told {
            power: Some(exact(power)),
            half_width: Some(half_width),
            df: Some(df),
            ..Told::default()
        })
    }

    fn has_effect(&self) -> bool {
        true
    }

    fn has_assurance(&self) -> bool {
        true
    }

    fn effect_option(&self) -> &'static str {
        "--means"
    }

    fn half_width_of(&self) -> &'static str {
        "half-width of a difference of two means"
    }

    fn is_closed_form(&self) -> bool {
        true
    }

    fn findings(&self) -> Vec<FindingOutcome> {
        self.scatter.findings.clone()
    }
}
