//! A design of experiments: factors with their exact coding, and runs.
//!
//! Every constructor (`design_*`) gives its runs in standard order;
//! [`randomised`] puts them into the order in which they are to be run.

use crate::error::DesignError;
use crate::finding::DesignFinding;
use crate::random::{generator, shuffle};
use crate::word::Fraction;

/// Most runs of a design.
pub const MOST_RUNS: usize = 1_000_000;

/// Most factors of any design.
pub const MOST_FACTORS: usize = 256;

/// Stream of the seed that the run order is drawn from.
const ORDER_STREAM: u64 = 1;

/// A factor with its coding: actual = centre + half · coded.
#[derive(Clone, Debug, PartialEq, serde::Serialize, utoipa::ToSchema)]
pub struct Factor {
    /// Its name.
    pub name: String,
    /// Its unit as the user writes it; "" where there is none.
    pub unit: String,
    /// Actual value at coded 0; unit of the factor.
    pub centre: f64,
    /// Exact half-range: actual step from coded 0 to 1; unit of the factor.
    pub half: f64,
    /// Decimals of printed settings, `None` for all; coded values stay exact.
    pub decimals: Option<usize>,
    /// Categories, coded evenly from −1 to 1; empty for a number.
    pub categories: Vec<String>,
}

impl Factor {
    /// A factor whose coded values −1 and 1 are `low` and `high`, finite and in order.
    pub fn between(name: &str, unit: &str, low: f64, high: f64) -> Result<Self, DesignError> {
        let name = name.to_owned();
        if let Some(&value) = [low, high, high - low].iter().find(|v| !v.is_finite()) {
            return Err(DesignError::LevelNotFinite { name, value });
        }
        if low >= high {
            return Err(DesignError::RangeEmpty { name, low, high });
        }
        Ok(Self {
            name,
            unit: unit.to_owned(),
            centre: 0.5 * (low + high),
            half: 0.5 * (high - low),
            decimals: None,
            categories: Vec::new(),
        })
    }

    /// A factor of at least two different categories.
    pub fn of_categories(name: &str, categories: &[String]) -> Result<Self, DesignError> {
        let mut different = categories.to_vec();
        different.sort_unstable();
        different.dedup();
        if different.len() < 2 || different.len() < categories.len() {
            let (name, found) = (name.to_owned(), different.len());
            return Err(DesignError::LevelsTooFew { name, found });
        }
        Ok(Self {
            name: name.to_owned(),
            unit: String::new(),
            centre: 0.0,
            half: 1.0,
            decimals: None,
            categories: categories.to_vec(),
        })
    }

    /// Actual value of a coded one, exact; unit of the factor.
    pub fn actual(&self, coded: f64) -> f64 {
        self.centre + self.half * coded
    }

    /// Coded value of an actual one.
    pub fn coded(&self, actual: f64) -> f64 {
        (actual - self.centre) / self.half
    }

    /// The actual value rounded to the printed decimals; unit of the factor.
    pub fn setting(&self, coded: f64) -> f64 {
        let actual = self.actual(coded);
        match self.decimals {
            // Through the text, so that the number is the printed one.
            Some(decimals) => format!("{actual:.decimals$}").parse().unwrap_or(actual),
            None => actual,
        }
    }

    /// Category of a coded value; `None` for a number.
    pub fn category(&self, coded: f64) -> Option<&str> {
        let place = self.category_place(coded)?;
        self.categories.get(place).map(String::as_str)
    }

    /// Place of the category of a coded value; `None` for a number.
    pub fn category_place(&self, coded: f64) -> Option<usize> {
        let last = self.categories.len().checked_sub(1)?;
        Some((0.5 * (coded + 1.0) * last as f64).round() as usize)
    }

    /// Coded values of the categories, or −1 and 1 for a number.
    pub fn ends(&self) -> Vec<f64> {
        evenly(self.categories.len().max(2))
    }
}

/// `count` coded values evenly from −1 to 1.
pub fn evenly(count: usize) -> Vec<f64> {
    let last = count.saturating_sub(1).max(1) as f64;
    (0..count).map(|i| 2.0 * i as f64 / last - 1.0).collect()
}

/// Where a run lies in the design.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Point {
    /// Corner or inner level of a factorial.
    Factorial,
    /// On the axis of one factor.
    Axial,
    /// In the centre.
    Centre,
    /// Middle of an edge or face (Box-Behnken).
    Edge,
    /// A point that fills the space.
    Space,
    /// Chosen by exchange.
    Optimal,
    /// Already run, kept by an augmented design.
    Existing,
}

impl Point {
    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Factorial => "factorial",
            Self::Axial => "axial",
            Self::Centre => "centre",
            Self::Edge => "edge",
            Self::Space => "space",
            Self::Optimal => "optimal",
            Self::Existing => "existing",
        }
    }
}

/// One run.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// Place in the standard order, from 1.
    pub standard_order: usize,
    /// Block, from 1.
    pub block: usize,
    /// Whole plot of a split-plot design, from 1 in the order of the runs; `None` without.
    pub whole_plot: Option<usize>,
    /// Where it lies.
    pub point: Point,
    /// Coded values, one per factor, exact.
    pub coded: Vec<f64>,
}

/// A design.
#[derive(Clone, Debug, PartialEq)]
pub struct Design {
    /// Its kind, for people: "central composite, rotatable".
    pub kind: String,
    /// The factors; A, B, C … in this order.
    pub factors: Vec<Factor>,
    /// The runs, in the order in which they are to be run.
    pub runs: Vec<Run>,
    /// Axial distance of a composite design, in half-ranges.
    pub alpha: Option<f64>,
    /// Generators, defining relation and resolution of a two-level design.
    pub fraction: Option<Fraction>,
    /// Seed of the run order; `None` in standard order.
    pub order_seed: Option<u64>,
    /// What the user should know.
    pub findings: Vec<DesignFinding>,
}

impl Design {
    /// Number of blocks.
    pub fn blocks(&self) -> usize {
        self.runs.iter().map(|run| run.block).max().unwrap_or(0)
    }

    /// Number of whole plots; `None` unless it is a split-plot design.
    pub fn whole_plots(&self) -> Option<usize> {
        self.runs.iter().filter_map(|run| run.whole_plot).max()
    }
}

/// A design of coded points in standard order, all in block 1.
pub fn design_of(kind: String, factors: Vec<Factor>, points: Vec<(Point, Vec<f64>)>) -> Design {
    let runs = points.into_iter().enumerate();
    let runs = runs.map(|(index, (point, coded))| Run {
        standard_order: index + 1,
        block: 1,
        whole_plot: None,
        point,
        coded,
    });
    Design {
        kind,
        factors,
        runs: runs.collect(),
        alpha: None,
        fraction: None,
        order_seed: None,
        findings: Vec::new(),
    }
}

/// Centre points of factors: numbers at 0, categories in all combinations.
pub fn centres_of(factors: &[Factor]) -> Vec<Vec<f64>> {
    factors.iter().fold(vec![Vec::new()], |points, factor| {
        let levels = match factor.categories.is_empty() {
            true => vec![0.0],
            false => factor.ends(),
        };
        let longer = points.iter().flat_map(|point| {
            let point = point.clone();
            levels
                .iter()
                .map(move |level| [&point[..], &[*level]].concat())
        });
        longer.collect()
    })
}

/// Adds `count` centre points to a block at each combination of categories, at the end of the
/// standard order.
pub fn add_centres(design: &mut Design, block: usize, count: usize) {
    if count == 0 {
        return;
    }
    for coded in centres_of(&design.factors) {
        for _ in 0..count {
            design.runs.push(Run {
                standard_order: design.runs.len() + 1,
                block,
                whole_plot: None,
                point: Point::Centre,
                coded: coded.clone(),
            });
        }
    }
}

/// Sorts runs by block and numbers the standard order anew.
pub fn number_by_block(design: &mut Design) {
    design.runs.sort_by_key(|run| run.block);
    for (index, run) in design.runs.iter_mut().enumerate() {
        run.standard_order = index + 1;
    }
}

/// The design with its runs in random order within each block, or with its whole plots in random
/// order and the runs of each in theirs.
pub fn randomised(mut design: Design, seed: u64) -> Design {
    let mut generator = generator(seed, ORDER_STREAM);
    design
        .runs
        .sort_by_key(|run| (run.block, run.standard_order));
    let mut plots: Vec<usize> = design
        .runs
        .iter()
        .filter_map(|run| run.whole_plot)
        .collect();
    plots.dedup();
    for block in design.runs.chunk_by_mut(|a, b| a.block == b.block) {
        // What has been run has its order.
        if block.iter().any(|run| run.point != Point::Existing) {
            shuffle(&mut generator, block);
        }
    }
    shuffle(&mut generator, &mut plots);
    let place = |plot: usize| plots.iter().position(|own| *own == plot).map(|own| own + 1);
    for run in &mut design.runs {
        run.whole_plot = run.whole_plot.and_then(place);
    }
    design.runs.sort_by_key(|run| (run.block, run.whole_plot));
    design.order_seed = Some(seed);
    design
}

/// Checks the number of factors, and that their names differ.
pub fn check_factors(
    kind: &'static str,
    factors: &[Factor],
    least: usize,
) -> Result<(), DesignError> {
    if factors.len() < least {
        return Err(DesignError::FactorCount {
            kind,
            expected: format!("at least {least}"),
            found: factors.len(),
        });
    }
    if factors.len() > MOST_FACTORS {
        let (most, found) = (MOST_FACTORS, factors.len());
        return Err(DesignError::FactorsTooMany { kind, most, found });
    }
    let repeated = |i: &usize| factors[..*i].iter().any(|f| f.name == factors[*i].name);
    match (1..factors.len()).find(repeated) {
        Some(i) => Err(DesignError::FactorRepeated {
            name: factors[i].name.clone(),
        }),
        None => Ok(()),
    }
}

/// Checks that all factors are numbers.
pub fn check_numbers(kind: &'static str, factors: &[Factor]) -> Result<(), DesignError> {
    match factors.iter().find(|factor| !factor.categories.is_empty()) {
        Some(factor) => Err(DesignError::Categories {
            name: factor.name.clone(),
            kind,
        }),
        None => Ok(()),
    }
}

/// Checks that there is a number among the factors, so that there is a centre.
pub fn check_centre(kind: &'static str, factors: &[Factor]) -> Result<(), DesignError> {
    match factors.iter().all(|factor| !factor.categories.is_empty()) {
        true => check_numbers(kind, factors),
        false => Ok(()),
    }
}

/// Checks that all factors have two levels.
pub fn check_two_levels(kind: &'static str, factors: &[Factor]) -> Result<(), DesignError> {
    match factors.iter().find(|factor| factor.categories.len() > 2) {
        Some(factor) => Err(DesignError::LevelsTooMany {
            name: factor.name.clone(),
            found: factor.categories.len(),
            kind,
        }),
        None => Ok(()),
    }
}

/// Checks the number of runs; given as `f64` so that no product overflows.
pub fn check_runs(runs: f64) -> Result<(), DesignError> {
    let most = MOST_RUNS;
    match runs <= most as f64 {
        true => Ok(()),
        false => Err(DesignError::RunsTooMany { runs, most }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn factor() -> Factor {
        Factor::between("k", "N/mm", 0.3, 1.0).unwrap()
    }

    #[test]
    fn closed_form_coding_there_and_back() {
        let factor = factor();
        assert_eq!((factor.centre, factor.half), (0.65, 0.35));
        for coded in [-1.0, -0.3, 0.0, 0.77, 1.0] {
            assert!((factor.coded(factor.actual(coded)) - coded).abs() < 1e-15);
        }
    }

    #[test]
    fn closed_form_settings_are_the_printed_numbers() {
        let mut factor = factor();
        factor.decimals = Some(2);
        assert_eq!(factor.setting(-0.594_603_557_501_360_5), 0.44);
        assert_eq!(factor.actual(0.5), 0.825);
    }

    #[test]
    fn closed_form_categories_lie_evenly() {
        let names = ["Fuji", "Gala", "Elstar"].map(str::to_owned);
        let factor = Factor::of_categories("variety", &names).unwrap();
        let found: Vec<_> = factor.ends().iter().map(|c| factor.category(*c)).collect();
        assert_eq!(found, [Some("Fuji"), Some("Gala"), Some("Elstar")]);
    }

    #[test]
    fn rejects_ranges_that_are_none() {
        for (low, high) in [(1.0, 1.0), (2.0, 1.0)] {
            let error = Factor::between("k", "", low, high).unwrap_err();
            assert_eq!(
                error,
                DesignError::RangeEmpty {
                    name: "k".into(),
                    low,
                    high
                }
            );
        }
        let infinite = Factor::between("k", "", 0.0, f64::INFINITY).unwrap_err();
        assert!(matches!(infinite, DesignError::LevelNotFinite { .. }));
    }

    #[test]
    fn repeats_the_order_of_a_seed_and_keeps_blocks() {
        let mut design = design_of(
            "any".into(),
            vec![factor()],
            (0..40)
                .map(|i| (Point::Space, vec![f64::from(i)]))
                .collect(),
        );
        for run in design.runs.iter_mut().skip(20) {
            run.block = 2;
        }
        let first = randomised(design.clone(), 5);
        assert_eq!(first, randomised(design.clone(), 5));
        assert_ne!(first.runs, randomised(design.clone(), 6).runs);
        // A second drawing does not depend on the first.
        assert_eq!(first, randomised(randomised(design, 6), 5));
        assert!(first.runs.is_sorted_by_key(|run| run.block));
        assert!(!first.runs[..20].is_sorted_by_key(|run| run.standard_order));
        let mut orders: Vec<usize> = first.runs.iter().map(|r| r.standard_order).collect();
        orders.sort_unstable();
        assert_eq!(orders, (1..=40).collect::<Vec<_>>());
    }
}
