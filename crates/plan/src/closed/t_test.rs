//! One number and its t test: a mean, a difference, a slope.

use crate::outcome::exact;
use crate::power::drawn_slope::{
    drawn_slope_assured_half_width, drawn_slope_detectable, drawn_slope_half_width,
    drawn_slope_power,
};
use crate::power::t_test::{detectable_effect, t_power};
use crate::power::welch::{
    TwoGroups, true_error, welch_assured_half_width, welch_df, welch_half_width, welch_power,
};
use crate::question::{Count, Levels, Question, Size, Told};
use crate::scatter::{KnownScatter, Scatter};
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::option_value::unusable;

/// What is estimated, and how the study is laid out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Estimate {
    /// Mean over fruit.
    Mean,
    /// Difference of two groups of fruit; the second has `ratio` times as many.
    Groups {
        /// Fruit in the second group for each in the first.
        ratio: f64,
        /// One variance for both.
        pooled: bool,
    },
    /// Difference of two treatments of every fruit.
    SameFruit {
        /// Standard deviation of the difference between fruit, where it differs.
        effect_sd: Option<f64>,
    },
    /// Slope on a property of the fruit.
    Slope {
        /// Standard deviation of x: of its values (denominator n), or of the normal distribution
        /// that they come from.
        spread: f64,
        /// Number of values of x, each on as many fruit as the others; drawn where there are none.
        values: Option<usize>,
    },
    /// Slope on what changes between the impacts of every fruit.
    SlopeOnFruit {
        /// Standard deviation of x on every fruit (denominator n).
        spread: f64,
        /// Number of values of x that are repeated, where they are stated.
        values: Option<usize>,
        /// Standard deviation of the slope between fruit, where it differs.
        effect_sd: Option<f64>,
    },
}

/// A question with a t test.
pub(crate) struct TQuestion {
    pub name: &'static str,
    pub estimate: Estimate,
    /// What is to be found.
    pub effect: Option<f64>,
    pub scatter: KnownScatter,
    pub about: Vec<String>,
}

impl TQuestion {
    fn scatter(&self) -> &Scatter {
        &self.scatter.scatter
    }

    /// The two groups, where Welch's test compares them.
    fn welch(&self, size: Size) -> Option<TwoGroups> {
        match self.estimate {
            Estimate::Groups {
                ratio,
                pooled: false,
            } => Some(TwoGroups {
                sds: [0, 1].map(|group| self.scatter().of_fruit_mean(group, size.impacts)),
                sizes: [size.fruit, second(size.fruit, ratio)],
            }),
            _ => None,
        }
    }

    /// Standard deviation of the means of fruit over that of x, where x is drawn with the fruit.
    fn drawn(&self, size: Size) -> Option<f64> {
        match self.estimate {
            Estimate::Slope {
                spread,
                values: None,
            } => Some(self.scatter().of_fruit_mean(0, size.impacts) / spread),
            _ => None,
        }
    }

    /// What a slope on values of x that are drawn tells.
    fn told_of_drawn(&self, scale: f64, size: Size, levels: &Levels) -> Told {
        let (n, confidence) = (size.fruit, levels.confidence);
        let power = |slope: f64| drawn_slope_power(slope.abs() / scale, n, levels.test());
        Told {
            power: self.effect.map(power).map(exact),
            half_width: Some(match levels.assurance {
                None => drawn_slope_half_width(scale, n, confidence),
                Some(assurance) => drawn_slope_assured_half_width(scale, n, confidence, assurance),
            }),
            df: Some(n as f64 - 2.0),
            ..Told::default()
        }
    }

    /// Standard error and degrees of freedom.
    ///
    /// With n fruit, m impacts on each (of each treatment), σ² = σ_b² + σ_w²/m:
    ///
    /// | estimate | squared standard error | df |
    /// |---|---|---|
    /// | mean | σ²/n | n - 1 |
    /// | difference of groups | σ² (1/n₁ + 1/n₂) | n₁ + n₂ - 2 |
    /// | difference on the same fruit | 2 σ_w²/(m n) | 2 m n - n - 1 |
    /// | the same, if it differs between fruit | (σ_d² + 2 σ_w²/m)/n | n - 1 |
    /// | slope on fruit, values of x stated | σ²/(n s²) | n - 2 |
    /// | slope on every fruit | σ_w²/(m n s²) | m n - n - 1 |
    /// | the same, if it differs between fruit | (σ_d² + σ_w²/(m s²))/n | n - 1 |
    ///
    /// # Source
    /// Searle, Casella and McCulloch (1992), Variance components, ch. 3: in balanced data
    /// the tests of a mixed model are these.
    fn error(&self, size: Size) -> (f64, f64) {
        let (n, m) = (size.fruit as f64, size.impacts as f64);
        let own = self.scatter().of_fruit_mean(0, size.impacts);
        let within = self.scatter().within();
        match self.estimate {
            Estimate::Mean => (own / n.sqrt(), n - 1.0),
            Estimate::Groups { ratio, .. } => {
                let other = second(size.fruit, ratio) as f64;
                (own * (1.0 / n + 1.0 / other).sqrt(), n + other - 2.0)
            }
            Estimate::SameFruit { effect_sd } => match (within, effect_sd) {
                (None, _) => (own / n.sqrt(), n - 1.0),
                (Some(w), None) => (w * (2.0 / (m * n)).sqrt(), 2.0 * m * n - n - 1.0),
                (Some(w), Some(sd)) => (sd.hypot(w * (2.0 / m).sqrt()) / n.sqrt(), n - 1.0),
            },
            Estimate::Slope { spread, .. } => (own / (n.sqrt() * spread), n - 2.0),
            Estimate::SlopeOnFruit {
                spread, effect_sd, ..
            } => {
                let w = within.unwrap_or(f64::NAN) / spread;
                match effect_sd {
                    None => (w / (m * n).sqrt(), m * n - n - 1.0),
                    Some(sd) => (sd.hypot(w / m.sqrt()) / n.sqrt(), n - 1.0),
                }
            }
        }
    }
}

/// Fruit in the second group.
fn second(fruit: usize, ratio: f64) -> usize {
    (fruit as f64 * ratio).ceil() as usize
}

impl Question for TQuestion {
    fn name(&self) -> &'static str {
        self.name
    }

    fn about(&self) -> Vec<String> {
        self.about.clone()
    }

    fn counted(&self) -> &'static str {
        match self.estimate {
            Estimate::Groups { ratio: 1.0, .. } => "fruit in each group",
            Estimate::Groups { .. } => "fruit in the first group",
            _ => "fruit",
        }
    }

    fn fewest(&self, impacts: usize) -> Result<usize, Error> {
        self.scatter().check_impacts(impacts)?;
        Ok(match self.estimate {
            // as many in a smaller second group
            Estimate::Groups { ratio, .. } => (2..).find(|n| second(*n, ratio) >= 2).unwrap_or(2),
            Estimate::Slope { .. } => 3,
            Estimate::SlopeOnFruit {
                values, effect_sd, ..
            } => {
                check_values(values, impacts)?;
                match (impacts, effect_sd) {
                    (2, None) => 2,
                    (1, _) => 3,
                    _ => 2,
                }
            }
            _ => 2,
        })
    }

    fn step(&self) -> usize {
        match self.estimate {
            Estimate::Slope { values, .. } => values.unwrap_or(1),
            _ => 1,
        }
    }

    fn count(&self, size: Size) -> Count {
        let Size { fruit, impacts } = size;
        match self.estimate {
            Estimate::Groups { ratio, .. } => {
                let fruit = fruit + second(fruit, ratio);
                Count {
                    fruit,
                    impacts: fruit * impacts,
                }
            }
            Estimate::SameFruit { .. } => Count {
                fruit,
                impacts: 2 * fruit * impacts,
            },
            _ => Count {
                fruit,
                impacts: fruit * impacts,
            },
        }
    }

    fn told(&self, size: Size, levels: &Levels) -> Result<Told, Error> {
        if let Some(scale) = self.drawn(size) {
            return Ok(self.told_of_drawn(scale, size, levels));
        }
        let (test, confidence) = (levels.test(), levels.confidence);
        let effect = self.effect.map(f64::abs);
        let (power, half_width, df) = match self.welch(size) {
            Some(groups) => (
                effect.map(|effect| welch_power(&groups, effect, test)),
                match levels.assurance {
                    None => welch_half_width(&groups, confidence),
                    Some(assurance) => welch_assured_half_width(&groups, confidence, assurance),
                },
                welch_df(&groups),
            ),
            None => {
                let (error, df) = self.error(size);
                (
                    effect.map(|effect| t_power(effect / error, df, test)),
                    levels.half_width(error, df),
                    df,
                )
            }
        };
        Ok(Told {
            power: power.map(exact),
            half_width: Some(half_width),
            df: Some(df),
            ..Told::default()
        })
    }

    fn detectable(&self, size: Size, levels: &Levels, power: f64) -> Option<f64> {
        let test = levels.test();
        if let Some(scale) = self.drawn(size) {
            return Some(scale * drawn_slope_detectable(power, size.fruit, test));
        }
        match self.welch(size) {
            None => {
                let (error, df) = self.error(size);
                Some(error * detectable_effect(power, df, test))
            }
            Some(groups) => {
                // the t test with the true variances is near, and bisection does the rest
                let error = true_error(&groups);
                let (mut low, mut high) = (0.0, error);
                while welch_power(&groups, high, test) < power {
                    (low, high) = (high, 2.0 * high);
                    if high > 1e6 * error {
                        return None;
                    }
                }
                for _ in 0..40 {
                    let middle = f64::midpoint(low, high);
                    match welch_power(&groups, middle, test) < power {
                        true => low = middle,
                        false => high = middle,
                    }
                }
                Some(high)
            }
        }
    }

    fn has_effect(&self) -> bool {
        self.effect.is_some()
    }

    fn has_assurance(&self) -> bool {
        true
    }

    fn effect_option(&self) -> &'static str {
        match self.estimate {
            Estimate::Slope { .. } | Estimate::SlopeOnFruit { .. } => "--slope",
            _ => "--difference",
        }
    }

    fn half_width_of(&self) -> &'static str {
        match self.estimate {
            Estimate::Mean => "half-width of the mean",
            Estimate::Slope { .. } | Estimate::SlopeOnFruit { .. } => "half-width of the slope",
            _ => "half-width of the difference",
        }
    }

    fn is_closed_form(&self) -> bool {
        true
    }

    fn findings(&self) -> Vec<FindingOutcome> {
        self.scatter.findings.clone()
    }
}

/// Several values of x on a fruit need several impacts.
fn check_values(values: Option<usize>, impacts: usize) -> Result<(), Error> {
    let problem = match values {
        Some(values) if !impacts.is_multiple_of(values) => format!(
            "{impacts} impacts on each fruit cannot have the {values} values of --x equally often: \
             give a multiple of {values}"
        ),
        None if impacts < 2 => {
            "with --same-fruit x changes between the impacts of a fruit: at least 2 are needed"
                .to_owned()
        }
        _ => return Ok(()),
    };
    Err(unusable("--impacts", problem))
}
