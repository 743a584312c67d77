//! Median and spread of a parameter over fruit as a question.

use crate::outcome::PrecisionOutcome;
use crate::question::{Levels, Question, Size, Told};
use windfall_distribution::tail::f_upper;
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;

/// A parameter of a population.
pub(crate) struct PopulationQuestion {
    /// Standard deviation between fruit.
    pub between: f64,
    /// Standard deviation between the impacts of a fruit.
    pub within: f64,
    pub about: Vec<String>,
    pub findings: Vec<FindingOutcome>,
}

impl PopulationQuestion {
    /// Relative standard error of the standard deviation between fruit, and the probability
    /// that its estimate is zero.
    ///
    /// With mean squares between and within fruit, σ_b² = (B - W)/m, and
    ///
    /// ```text
    /// var = 2/m² [(m σ_b² + σ_w²)²/(n - 1) + σ_w⁴/(n (m - 1))]
    /// ```
    ///
    /// halved for the standard deviation. None with one impact on each fruit, which does not
    /// tell fruit and impacts apart.
    ///
    /// # Source
    /// Searle, Casella and McCulloch (1992), Variance components, eqs. 3.47 and 3.60.
    fn spread(&self, size: Size) -> Option<(f64, f64)> {
        if size.impacts < 2 {
            return None;
        }
        let (n, m) = (size.fruit as f64, size.impacts as f64);
        let (b, w) = (self.between.powi(2), self.within.powi(2));
        let whole = m * b + w;
        let of_within = w * w / (n * (m - 1.0));
        let variance = 2.0 / (m * m) * (whole * whole / (n - 1.0) + of_within);
        // B/W below 1, times its expected value F
        let zero = 1.0 - f_upper(w / whole, n - 1.0, n * (m - 1.0));
        Some((0.5 * variance.sqrt() / b, zero))
    }
}

impl Question for PopulationQuestion {
    fn name(&self) -> &'static str {
        "population"
    }

    fn about(&self) -> Vec<String> {
        self.about.clone()
    }

    fn counted(&self) -> &'static str {
        "fruit"
    }

    fn fewest(&self, _impacts: usize) -> Result<usize, Error> {
        Ok(2)
    }

    fn told(&self, size: Size, levels: &Levels) -> Result<Told, Error> {
        let (n, m) = (size.fruit as f64, size.impacts as f64);
        let error = self.between.hypot(self.within / m.sqrt()) / n.sqrt();
        let df = n - 1.0;
        let half_width = levels.half_width(error, df);
        let also = |of: &str, value: f64| PrecisionOutcome {
            of: of.to_owned(),
            value,
            se: None,
        };
        Ok(Told {
            half_width: Some(half_width),
            df: Some(df),
            also: match self.spread(size) {
                Some((spread, zero)) => vec![also("SD's error", spread), also("SD of zero", zero)],
                None => Vec::new(),
            },
            ..Told::default()
        })
    }

    fn has_effect(&self) -> bool {
        false
    }

    fn has_assurance(&self) -> bool {
        true
    }

    fn effect_option(&self) -> &'static str {
        "--half-width"
    }

    fn half_width_of(&self) -> &'static str {
        "half-width of the median"
    }

    fn is_closed_form(&self) -> bool {
        true
    }

    fn findings(&self) -> Vec<FindingOutcome> {
        self.findings.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Expected: R 4.2.2, `pf`, and the formula of the variance.
    #[test]
    fn reference_spread_of_a_population() {
        let question = PopulationQuestion {
            between: 0.2,
            within: 0.1,
            about: Vec::new(),
            findings: Vec::new(),
        };
        let of = |impacts| question.spread(Size { fruit: 12, impacts });
        let (error, zero) = of(4).unwrap_or_default();
        assert_eq!(of(1), None);
        assert!((error - 0.226_645_480_711_105).abs() < 1e-12, "{error}");
        assert!((zero / 9.250_322_937_49e-6 - 1.0).abs() < 1e-6, "{zero}");
    }
}
