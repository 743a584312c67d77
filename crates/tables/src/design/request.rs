//! What `windfall design` is asked: texts of the command line.

use std::path::PathBuf;
pub use windfall_design::exchange::Criterion;

/// A design that is wanted.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignRequest {
    /// Its kind.
    pub kind: DesignKind,
    /// Factors: "k=0.3..1 N/mm".
    pub factors: Vec<String>,
    /// Decimals of printed settings: "k=2".
    pub decimals: Vec<String>,
    /// Seed of the run order and of all that is drawn.
    pub seed: u64,
    /// How runs are ordered.
    pub order: Order,
}

/// How runs are ordered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Order {
    /// At random within each block.
    #[default]
    Random,
    /// In standard order.
    Standard,
}

/// A kind of design with its options.
#[derive(Clone, Debug, PartialEq)]
pub enum DesignKind {
    /// All combinations, or a fraction.
    Factorial {
        /// Levels of each range.
        points: usize,
        /// Generators "D=AB, E=AC", or "1/2" for the catalogue.
        fraction: Option<String>,
        /// Runs of a fraction of the catalogue.
        runs: Option<usize>,
        /// How often each combination is run.
        replicates: usize,
        /// Centre points in each block.
        centre: usize,
        /// Blocks.
        blocks: usize,
    },
    /// Plackett-Burman.
    PlackettBurman {
        /// Runs; the smallest number if left out.
        runs: Option<usize>,
        /// Centre points.
        centre: usize,
    },
    /// Central composite.
    Composite {
        /// "rotatable", "face", "spherical", "orthogonal", "blocks" or a number; by default
        /// rotatable, or blocks where there are any.
        alpha: Option<String>,
        /// What the ends of the ranges are: "factorial" or "axial".
        levels: String,
        /// Fraction of the cube, as for factorials.
        fraction: Option<String>,
        /// Centre points: "5", or "4,2" for each part of the cube and the axial block.
        centre: Option<String>,
        /// Blocks.
        blocks: usize,
    },
    /// Box-Behnken.
    BoxBehnken {
        /// Centre points in each block; 5, or 2 with blocks, if left out.
        centre: Option<usize>,
        /// Blocks.
        blocks: usize,
    },
    /// Latin hypercube.
    LatinHypercube {
        /// Runs.
        runs: usize,
    },
    /// Sobol points.
    Sobol {
        /// Runs.
        runs: usize,
    },
    /// D- or I-optimal.
    Optimal(OptimalRequest),
}

/// What is asked of an optimal design.
#[derive(Clone, Debug, PartialEq)]
pub struct OptimalRequest {
    /// What is made good.
    pub criterion: Criterion,
    /// New runs.
    pub runs: usize,
    /// "linear", "2fi", "quadratic" or a formula in letters or names, coded.
    pub model: String,
    /// Levels of each range; found from the model if left out.
    pub points: Option<usize>,
    /// Table of points that runs are chosen from.
    pub candidates: Option<PathBuf>,
    /// Table of runs already made.
    pub augment: Option<PathBuf>,
    /// Random starts.
    pub starts: Option<usize>,
}
