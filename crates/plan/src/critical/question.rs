//! The median critical energy as a question.

use crate::options::SimulationOptions;
use crate::question::{Count, Levels, Question, Size, Told};
use crate::replicates::told_of;
use windfall_distribution::tail::normal_lower;
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::progress::{for_each, quiet};
use windfall_repeat::interval::EnergyInterval;
use windfall_repeat::threshold::{Family, fit_median};
use windfall_signal::noise::gaussian::{noise_source, normal, uniform};

/// A distribution of critical energies and the energies at which fruit are struck.
pub(crate) struct CriticalQuestion {
    pub family: Family,
    /// Energy that half the fruit stand.
    pub median: f64,
    /// Spread of its logarithm.
    pub spread: f64,
    /// Energies, rising.
    pub energies: Vec<f64>,
    pub simulation: SimulationOptions,
    pub about: Vec<String>,
}

/// Half-width of the interval of ln median, and whether it holds the truth.
type Found = Result<(f64, bool), String>;

impl CriticalQuestion {
    /// Location of ln energy: the median of Z is 0, or ln ln 2 of the smallest extreme value.
    fn location(&self) -> f64 {
        let middle = match self.family {
            Family::LogNormal => 0.0,
            Family::Weibull => std::f64::consts::LN_2.ln(),
        };
        self.median.ln() - self.spread * middle
    }

    /// Part of the fruit that stand an energy.
    fn stand(&self, energy: f64) -> f64 {
        let z = (energy.ln() - self.location()) / self.spread;
        match self.family {
            Family::LogNormal => normal_lower(-z),
            Family::Weibull => (-z.exp()).exp(),
        }
    }

    /// Impacts on a fruit until it changes, on average.
    pub fn impacts(&self) -> f64 {
        let before = self.energies.iter().take(self.energies.len() - 1);
        1.0 + before.map(|energy| self.stand(*energy)).sum::<f64>()
    }

    /// One simulated study: each fruit is known between the energy that it stood last and that
    /// at which it changed.
    fn simulate(&self, fruit: usize, levels: &Levels, stream: u64) -> Found {
        let mut source = noise_source(self.simulation.seed, stream);
        let intervals: Vec<EnergyInterval> = (0..fruit)
            .map(|_| {
                let z = match self.family {
                    Family::LogNormal => normal(&mut source),
                    // 1 - u is never zero
                    Family::Weibull => (-(1.0 - uniform(&mut source)).ln()).ln(),
                };
                let critical = (self.location() + self.spread * z).exp();
                let changed = self.energies.iter().position(|energy| *energy >= critical);
                let place = changed.unwrap_or(self.energies.len());
                EnergyInterval {
                    low: if place == 0 {
                        0.0
                    } else {
                        self.energies[place - 1]
                    },
                    high: self.energies.get(place).copied().unwrap_or(f64::INFINITY),
                }
            })
            .collect();
        let fitted = fit_median(&intervals, self.family, 1.0 - levels.confidence);
        let median = fitted.map_err(|error| error.to_string())?;
        match median.low.zip(median.high) {
            Some((low, high)) => {
                let holds = low <= self.median && self.median <= high;
                Ok((0.5 * (high / low).ln(), holds))
            }
            None => Err("the interval of the median is open".to_owned()),
        }
    }
}

impl Question for CriticalQuestion {
    fn name(&self) -> &'static str {
        "critical-energy"
    }

    fn about(&self) -> Vec<String> {
        self.about.clone()
    }

    fn counted(&self) -> &'static str {
        "fruit"
    }

    fn usual_impacts(&self) -> usize {
        self.energies.len()
    }

    fn fewest(&self, _impacts: usize) -> Result<usize, Error> {
        Ok(3)
    }

    fn count(&self, size: Size) -> Count {
        Count {
            fruit: size.fruit,
            impacts: (size.fruit as f64 * self.impacts()).round() as usize,
        }
    }

    fn told(&self, size: Size, levels: &Levels) -> Result<Told, Error> {
        let simulations = self.simulation.simulations;
        let found = for_each(&quiet, simulations, |stream| {
            self.simulate(size.fruit, levels, stream as u64)
        })?;
        Ok(told_of(found, |interval| Some(*interval)).1)
    }

    fn detectable(&self, _size: Size, _levels: &Levels, _power: f64) -> Option<f64> {
        None
    }

    fn has_effect(&self) -> bool {
        false
    }

    fn has_assurance(&self) -> bool {
        false
    }

    fn effect_option(&self) -> &'static str {
        "--half-width"
    }

    fn half_width_of(&self) -> &'static str {
        "half-width of ln of the median"
    }

    fn is_closed_form(&self) -> bool {
        false
    }

    fn findings(&self) -> Vec<FindingOutcome> {
        Vec::new()
    }
}
