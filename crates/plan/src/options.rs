//! Options that all plans share.

use std::path::PathBuf;
use windfall_draw::theme::FigureTheme;
use windfall_draw::width::Width;

/// Sizes of the studies, and what is wanted of them.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[cfg_attr(feature = "clap", command(next_help_heading = "All plans"))]
pub struct PlanOptions {
    /// Fruit: 12, or 6,12,24, or 6..60; looked for from the smallest number up if left out. In
    /// each group, where there are groups
    #[cfg_attr(feature = "clap", arg(long, value_name = "NUMBERS"))]
    pub fruit: Option<String>,
    /// Impacts on each fruit: 1, or 1,2,4,8
    #[cfg_attr(feature = "clap", arg(long, value_name = "NUMBERS"))]
    pub impacts: Option<String>,
    /// Wanted probability of finding the effect
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "PART", allow_negative_numbers = true)
    )]
    pub power: Option<f64>,
    /// Wanted half-width of the interval, in the unit of what is measured
    #[cfg_attr(
        feature = "clap",
        arg(
            long,
            value_name = "WIDTH",
            allow_negative_numbers = true,
            conflicts_with = "power"
        )
    )]
    pub half_width: Option<f64>,
    /// Probability with which the interval is as narrow as wanted; its mean is, if left out
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "PART", allow_negative_numbers = true)
    )]
    pub assurance: Option<f64>,
    /// Level of the intervals; tests are made at 1 minus it
    #[cfg_attr(
        feature = "clap",
        arg(
            long,
            default_value_t = 0.95,
            value_name = "LEVEL",
            allow_negative_numbers = true
        )
    )]
    pub confidence: f64,
    /// Test for an effect in the expected direction alone
    #[cfg_attr(feature = "clap", arg(long))]
    pub one_sided: bool,
    /// Most fruit (in each group) that are tried
    #[cfg_attr(
        feature = "clap",
        arg(long, default_value_t = 1000, value_name = "NUMBER")
    )]
    pub most_fruit: usize,
    /// What a fruit costs before it is struck
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "COST", allow_negative_numbers = true)
    )]
    pub cost_fruit: Option<f64>,
    /// What an impact costs
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "COST", allow_negative_numbers = true)
    )]
    pub cost_impact: Option<f64>,
    /// What the study may cost
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "COST", allow_negative_numbers = true)
    )]
    pub budget: Option<f64>,
    /// Draw power or half-width against the number of fruit (SVG, PNG or PDF, by its ending), with
    /// its data (CSV, same name)
    #[cfg_attr(feature = "clap", arg(long, value_name = "FILE.svg|FILE.png|FILE.pdf", value_hint = clap::ValueHint::FilePath))]
    pub figure: Option<PathBuf>,
    /// Colours of the figure
    #[cfg_attr(
        feature = "clap",
        arg(long, value_enum, default_value_t, requires = "figure")
    )]
    pub theme: FigureTheme,
    /// Width in print, as a journal asks for it: 84mm, 174mm; letters are 8 pt at that size
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "LENGTH", requires = "figure")
    )]
    pub width: Option<Width>,
}

/// How a simulation is run.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct SimulationOptions {
    /// Simulated studies of each size
    #[cfg_attr(
        feature = "clap",
        arg(long, default_value_t = 1000, value_name = "NUMBER")
    )]
    pub simulations: usize,
    /// Seed of the simulations
    #[cfg_attr(feature = "clap", arg(long, default_value_t = 1))]
    pub seed: u64,
    /// Number of threads; all cores if left out. It never changes a result
    #[cfg_attr(feature = "clap", arg(long, value_name = "N"))]
    pub threads: Option<usize>,
}

impl Default for SimulationOptions {
    fn default() -> Self {
        Self {
            simulations: 1000,
            seed: 1,
            threads: None,
        }
    }
}

/// What the scatter of the measurements is.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[cfg_attr(feature = "clap", command(next_help_heading = "Scatter"))]
pub struct ScatterOptions {
    /// Standard deviation of one value for each fruit; two for groups that differ: 12,15
    #[cfg_attr(feature = "clap", arg(long, value_name = "SD[,SD]", allow_hyphen_values = true, conflicts_with_all = ["between", "within", "from"]))]
    pub sd: Option<String>,
    /// Standard deviation between fruit
    #[cfg_attr(
        feature = "clap",
        arg(
            long,
            value_name = "SD",
            allow_negative_numbers = true,
            conflicts_with = "from"
        )
    )]
    pub between: Option<String>,
    /// Standard deviation between the impacts of a fruit
    #[cfg_attr(
        feature = "clap",
        arg(
            long,
            value_name = "SD",
            allow_negative_numbers = true,
            conflicts_with = "from"
        )
    )]
    pub within: Option<String>,
    /// Table of earlier impacts (CSV) whose mixed model, --formula, tells both
    #[cfg_attr(feature = "clap", arg(long, value_name = "TABLE", requires = "formula", value_hint = clap::ValueHint::FilePath))]
    pub from: Option<PathBuf>,
    /// Mixed model of that table: 'k ~ V + (1 | fruit)'
    #[cfg_attr(feature = "clap", arg(long, requires = "from"))]
    pub formula: Option<String>,
}
