//! What `windfall design` is asked: texts of the command line.

#[cfg(feature = "clap")]
use crate::option_words::optimality;
use std::path::PathBuf;
pub use windfall_design::exchange::Criterion;

/// What all designs are asked.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct DesignRequest {
    /// 'NAME=LOW..HIGH UNIT', 'NAME=1, 2, 5 UNIT' or 'NAME=category, category'; A, B, C … in
    /// this order
    #[cfg_attr(feature = "clap", arg(long = "factor", value_name = "FACTOR"))]
    pub factors: Vec<String>,
    /// Print the settings of a factor with so many decimals; coded values stay exact
    #[cfg_attr(feature = "clap", arg(long = "decimals", value_name = "NAME=N"))]
    pub decimals: Vec<String>,
    /// Seed of the run order and of all that is drawn
    #[cfg_attr(feature = "clap", arg(long, default_value_t = 1))]
    pub seed: u64,
    /// Order of the runs, within blocks
    #[cfg_attr(feature = "clap", arg(long, value_enum, default_value_t))]
    pub order: Order,
}

/// How runs are ordered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum Order {
    /// At random
    #[default]
    Random,
    /// As in tables of designs
    Standard,
}

/// A kind of design with its options.
#[derive(Clone, Debug, PartialEq)]
pub enum DesignKind {
    /// All combinations, or a fraction.
    Factorial(FactorialRequest),
    /// Plackett-Burman.
    PlackettBurman(PlackettBurmanRequest),
    /// Central composite.
    Composite(CompositeRequest),
    /// Box-Behnken.
    BoxBehnken(BoxBehnkenRequest),
    /// Latin hypercube.
    LatinHypercube(SpaceRequest),
    /// Sobol points.
    Sobol(SpaceRequest),
    /// The best for a model, by some criterion.
    Optimal(Criterion, OptimalRequest),
    /// With factors that are set for whole plots of runs.
    SplitPlot(SplitPlotRequest),
}

/// What is asked of a factorial design.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct FactorialRequest {
    /// Levels of each range
    #[cfg_attr(feature = "clap", arg(long, default_value_t = 2, value_name = "N"))]
    pub points: usize,
    /// Generators 'D=AB, E=AC', or 1/2, 1/4 … for the fraction of least aberration
    #[cfg_attr(feature = "clap", arg(long, value_name = "FRACTION"))]
    pub fraction: Option<String>,
    /// Runs of the fraction of least aberration, instead of --fraction
    #[cfg_attr(feature = "clap", arg(long, value_name = "N"))]
    pub runs: Option<usize>,
    /// Runs of every combination
    #[cfg_attr(feature = "clap", arg(long, default_value_t = 1, value_name = "N"))]
    pub replicates: usize,
    /// Centre points in each block, at each combination of categories
    #[cfg_attr(feature = "clap", arg(long, default_value_t = 0, value_name = "N"))]
    pub centre: usize,
    /// Blocks of a two-level design: 2, 4, 8 …
    #[cfg_attr(feature = "clap", arg(long, default_value_t = 1, value_name = "N"))]
    pub blocks: usize,
}

/// What is asked of a Plackett-Burman design.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct PlackettBurmanRequest {
    /// Runs, a multiple of 4; the smallest number if left out
    #[cfg_attr(feature = "clap", arg(long, value_name = "N"))]
    pub runs: Option<usize>,
    /// Centre points at each combination of categories
    #[cfg_attr(feature = "clap", arg(long, default_value_t = 0, value_name = "N"))]
    pub centre: usize,
}

/// What is asked of a central composite design.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct CompositeRequest {
    /// rotatable, face, spherical, orthogonal, blocks, or a number of half-ranges; rotatable if
    /// left out, with blocks the one that keeps them out of the model
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "ALPHA", allow_hyphen_values = true)
    )]
    pub alpha: Option<String>,
    /// What LOW and HIGH of the factors are: corners of the cube (factorial) or axial points
    /// (axial)
    #[cfg_attr(
        feature = "clap",
        arg(long, default_value = "factorial", value_name = "WHERE")
    )]
    pub levels: String,
    /// Fraction of the cube: 'E=ABCD', or 1/2
    #[cfg_attr(feature = "clap", arg(long, value_name = "FRACTION"))]
    pub fraction: Option<String>,
    /// Centre points; with blocks in each, or 'CUBE,AXIAL'; 5 if left out, 2 in each block
    #[cfg_attr(feature = "clap", arg(long, value_name = "N"))]
    pub centre: Option<String>,
    /// Blocks: 2 (cube, axial points), 3, 5 or 9 (the cube divided)
    #[cfg_attr(feature = "clap", arg(long, default_value_t = 1, value_name = "N"))]
    pub blocks: usize,
}

/// What is asked of a Box-Behnken design.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct BoxBehnkenRequest {
    /// Centre points in each block; 5 if left out, 2 with blocks
    #[cfg_attr(feature = "clap", arg(long, value_name = "N"))]
    pub centre: Option<usize>,
    /// Blocks: 3 for four factors, 2 for five to seven
    #[cfg_attr(feature = "clap", arg(long, default_value_t = 1, value_name = "N"))]
    pub blocks: usize,
}

/// What is asked of a design that fills the space.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct SpaceRequest {
    /// Runs
    #[cfg_attr(feature = "clap", arg(long, value_name = "N"))]
    pub runs: usize,
}

/// How an exchange of runs searches.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct SearchRequest {
    /// linear, 2fi, quadratic, or a formula in names or letters; factors stand for their coded
    /// values
    #[cfg_attr(
        feature = "clap",
        arg(long, default_value = "quadratic", value_name = "MODEL")
    )]
    pub model: String,
    /// Levels of each range to choose from; what the model needs if left out
    #[cfg_attr(feature = "clap", arg(long, value_name = "N"))]
    pub points: Option<usize>,
    /// Random starts; as many as take seconds if left out
    #[cfg_attr(feature = "clap", arg(long, value_name = "N"))]
    pub starts: Option<usize>,
}

/// What is asked of an optimal design.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct OptimalRequest {
    /// New runs
    #[cfg_attr(feature = "clap", arg(long, value_name = "N"))]
    pub runs: usize,
    /// Choose from the rows of this table, with a column for each factor
    #[cfg_attr(feature = "clap", arg(long, value_name = "FILE.csv", value_hint = clap::ValueHint::FilePath, conflicts_with = "points"))]
    pub candidates: Option<PathBuf>,
    /// Runs already made, which are kept; a column for each factor
    #[cfg_attr(feature = "clap", arg(long, value_name = "FILE.csv", value_hint = clap::ValueHint::FilePath))]
    pub augment: Option<PathBuf>,
    /// How it is searched
    #[cfg_attr(feature = "clap", command(flatten))]
    pub search: SearchRequest,
}

/// What is asked of a split-plot design.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct SplitPlotRequest {
    /// A factor that is hard to change, set once for each whole plot; may be repeated
    #[cfg_attr(feature = "clap", arg(long, value_name = "FACTOR", required = true))]
    pub hard: Vec<String>,
    /// Whole plots: how often the hard-to-change factors are set
    #[cfg_attr(feature = "clap", arg(long, value_name = "N"))]
    pub whole_plots: usize,
    /// Runs of all whole plots
    #[cfg_attr(feature = "clap", arg(long, value_name = "N"))]
    pub runs: usize,
    /// Expected variance between whole plots over that within
    #[cfg_attr(
        feature = "clap",
        arg(
            long,
            default_value_t = 1.0,
            allow_hyphen_values = true,
            value_name = "RATIO"
        )
    )]
    pub ratio: f64,
    /// What is made good: the coefficients (d), or the predictions (i)
    #[cfg_attr(feature = "clap", arg(long, default_value = "d", value_name = "CRITERION", value_parser = optimality()))]
    pub criterion: Criterion,
    /// How it is searched
    #[cfg_attr(feature = "clap", command(flatten))]
    pub search: SearchRequest,
}
