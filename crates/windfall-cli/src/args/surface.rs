//! `windfall surface`: arguments.

use crate::args::figures::FigureArguments;
use crate::args::format::Format;
use clap::{Args, ValueHint};
use std::path::PathBuf;

/// `windfall surface`
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  windfall surface runs.csv --response force_N --factor k --factor e --factor C --model linear
  windfall surface runs.csv --factor k --factor e --factor C \\
      --response force_N --model 'A + B + C' \\
      --response interval_ms --model 'A + B + C + AB + AC + BC + B^2' \\
      --goal 'force_N = target 11.3' --goal 'interval_ms = target 299' --hold k=0.868
  windfall surface runs.csv --response force_N --factor k --factor e --model quadratic \\
      --grid k,e --grid-points 41 --format csv > surface.csv
  windfall surface runs.csv --response force_N --factor k --factor e --figures figures

Models: linear, 2fi, quadratic, cubic, or terms: A, B, C … stand for the factors in the order
given, AB for a product, B^2 for a square; names work too (k + e + k:e + e^2). Terms are
estimated and tested in coded units; a design's file tells its coding, a central composite
design is recognised by its points, else the ends of each range are coded -1 and 1.

Goals: RESPONSE = target X | maximum | minimum | range, then low X, high X, weight X,
importance X, separated by commas; low and high are the observed ends unless given.")]
pub struct SurfaceArguments {
    /// Table of runs with a header line (CSV)
    #[arg(value_hint = ValueHint::FilePath)]
    pub table: PathBuf,
    /// A response: a column, or a function of columns; may be repeated, each with its --model
    #[arg(long = "response", value_name = "COLUMN", required = true)]
    pub responses: Vec<String>,
    /// Its model; one for all responses, or one for each in their order
    #[arg(long = "model", value_name = "MODEL", default_value = "quadratic")]
    pub models: Vec<String>,
    /// A factor; repeated in the order of the letters A, B, C …
    #[arg(long = "factor", value_name = "COLUMN")]
    pub factors: Vec<String>,
    /// Actual values of coded -1 and 1 of a factor: k=0.44..0.86; may be repeated
    #[arg(long = "range", value_name = "FACTOR=LOW..HIGH")]
    pub ranges: Vec<String>,
    /// Type of the analysis of variance, in coded units
    #[arg(long, default_value_t = 3, value_name = "TYPE", value_parser = clap::value_parser!(u8).range(1..=3))]
    pub anova: u8,
    /// Level of the intervals
    #[arg(long, default_value_t = 0.95, value_name = "LEVEL")]
    pub confidence: f64,
    /// What is wanted of a response; may be repeated
    #[arg(long = "goal", value_name = "GOAL")]
    pub goals: Vec<String>,
    /// Hold a factor at a value: k=0.868; may be repeated
    #[arg(long = "hold", value_name = "FACTOR=VALUE")]
    pub hold: Vec<String>,
    /// Factor at whose values settings as good as the best are listed
    #[arg(long, value_name = "FACTOR")]
    pub along: Option<String>,
    /// How many of these values
    #[arg(long, default_value_t = 15, value_name = "N", value_parser = clap::value_parser!(u16).range(2..=1000))]
    pub members: u16,
    /// Two factors for a grid of predictions: k,e (in --format json and csv)
    #[arg(long, value_name = "FACTOR,FACTOR")]
    pub grid: Option<String>,
    /// Points of the grid along each factor
    #[arg(long, default_value_t = 41, value_name = "N")]
    pub grid_points: usize,
    /// Contours, surfaces, effects, perturbation, desirability, and model against runs
    #[command(flatten)]
    pub drawn: FigureArguments,
    /// How the result is shown
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
}
