//! A term of a mixed model as a question.

use crate::model::simulate::{Layout, Tested, layout};
use crate::options::SimulationOptions;
use crate::outcome::simulated;
use crate::question::{Count, Levels, Question, Size, Told};
use crate::replicates::told_of;
use crate::study::Study;
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::option_value::unusable;
use windfall_files::progress::{for_each, quiet};

/// A term of a mixed model.
pub(crate) struct ModelQuestion {
    pub study: Study,
    /// True coefficients.
    pub coefficients: Vec<f64>,
    pub tested: Tested,
    /// Fruit keep the rows that they have in the table.
    pub own_rows: bool,
    pub simulation: SimulationOptions,
    pub about: Vec<String>,
    pub findings: Vec<FindingOutcome>,
}

impl ModelQuestion {
    fn layout(&self, size: Size) -> Layout {
        let resized = self.study.resized(size, self.own_rows);
        layout(&self.study, &resized, &self.coefficients)
    }
}

impl Question for ModelQuestion {
    fn name(&self) -> &'static str {
        "model"
    }

    fn about(&self) -> Vec<String> {
        self.about.clone()
    }

    fn counted(&self) -> &'static str {
        "fruit"
    }

    fn usual_impacts(&self) -> usize {
        self.study.usual_impacts()
    }

    fn fewest(&self, impacts: usize) -> Result<usize, Error> {
        if !self.own_rows {
            self.study.check_impacts(impacts)?;
        }
        let all = self.study.fruit.len();
        let enough = |fruit: &usize| {
            let size = Size {
                fruit: *fruit,
                impacts,
            };
            self.layout(size).is_estimable()
        };
        (2..=all.max(2)).find(enough).ok_or_else(|| {
            let problem = format!(
                "{impacts} on each fruit cannot tell the variances of the model apart: more \
                 impacts are needed"
            );
            unusable("--impacts", problem)
        })
    }

    fn count(&self, size: Size) -> Count {
        Count {
            fruit: size.fruit,
            impacts: self.study.resized(size, self.own_rows).rows.len(),
        }
    }

    fn told(&self, size: Size, levels: &Levels) -> Result<Told, Error> {
        let SimulationOptions {
            simulations, seed, ..
        } = self.simulation;
        let layout = self.layout(size);
        let found = for_each(&quiet, simulations, |replicate| {
            layout.simulate(&self.tested, levels, (seed, replicate as u64))
        })?;
        let (good, told) = told_of(found, |own| own.interval);
        let rejected = good.iter().filter(|own| own.rejected).count();
        Ok(Told {
            power: Some(simulated(rejected, simulations)),
            singular: good.iter().filter(|own| own.singular).count(),
            ..told
        })
    }

    fn has_effect(&self) -> bool {
        true
    }

    fn has_assurance(&self) -> bool {
        false
    }

    fn effect_option(&self) -> &'static str {
        "--effect"
    }

    fn half_width_of(&self) -> &'static str {
        "half-width of the coefficient"
    }

    fn is_closed_form(&self) -> bool {
        false
    }

    fn findings(&self) -> Vec<FindingOutcome> {
        self.findings.clone()
    }
}
