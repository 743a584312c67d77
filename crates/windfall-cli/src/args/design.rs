//! `windfall design`: arguments.

use crate::args::format::Format;
use clap::{Args, Subcommand, ValueEnum, ValueHint};
use std::path::PathBuf;

/// `windfall design`
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  windfall design ccd --factor 'k=0.3..1 N/mm^1.91' --factor 'e=1.5..3' \\
      --factor 'c=1e-4..6e-4 N s/mm' --levels axial --centre 1 --out design.csv
      central composite, rotatable; the ranges are those of the axial points
  windfall design factorial --factor 'v=0.3..0.6 m/s' --factor 'T=5..25 degC' --factor 'variety=Gala, Fuji'
  windfall design factorial --factor 'a=0..1' … --fraction 'D=AB, E=AC'
  windfall design d-optimal --factor 'v=0.3..0.6' --factor 'R=25..40' --model 'A*B + I(A^2)' --runs 8

The CSV carries the exact coding of the factors in its header, and coded columns beside the \
settings; `windfall surface` reads both. Add a column for each response.")]
pub struct DesignArguments {
    /// The kind of design
    #[command(subcommand)]
    pub kind: DesignCommand,
}

/// Kinds of designs.
#[derive(Debug, Subcommand)]
pub enum DesignCommand {
    /// All combinations of levels, or a two-level fraction of them
    Factorial(FactorialArguments),
    /// Main effects of many factors in few runs
    PlackettBurman(PlackettBurmanArguments),
    /// Central composite: cube, axial points, centre; for a quadratic model
    Ccd(CompositeArguments),
    /// Three levels without corners, 3 to 7 factors; for a quadratic model
    BoxBehnken(BoxBehnkenArguments),
    /// Levels each used once, points far apart; for computer experiments
    LatinHypercube(SpaceArguments),
    /// Sobol points: fill the space evenly, more can be added
    Sobol(SpaceArguments),
    /// Best for the coefficients of a given model
    DOptimal(OptimalArguments),
    /// Best for the predictions of a given model
    IOptimal(OptimalArguments),
}

/// What all kinds take.
#[derive(Debug, Args)]
#[command(next_help_heading = "All designs")]
pub struct DesignOptions {
    /// 'NAME=LOW..HIGH UNIT', 'NAME=1, 2, 5 UNIT' or 'NAME=category, category'; A, B, C … in
    /// this order
    #[arg(long = "factor", value_name = "FACTOR")]
    pub factors: Vec<String>,
    /// Print the settings of a factor with so many decimals; coded values stay exact
    #[arg(long = "decimals", value_name = "NAME=N")]
    pub decimals: Vec<String>,
    /// Seed of the run order and of all that is drawn
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Order of the runs, within blocks
    #[arg(long, value_enum, default_value_t)]
    pub order: RunOrder,
    /// Write the design to this file (CSV), and show it as text
    #[arg(long, value_name = "FILE.csv", value_hint = ValueHint::FilePath)]
    pub out: Option<PathBuf>,
    /// How the design is shown; CSV if left out, text with --out
    #[arg(long, value_enum)]
    pub format: Option<Format>,
}

/// Order of runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum RunOrder {
    /// At random
    #[default]
    Random,
    /// As in tables of designs
    Standard,
}

/// `windfall design factorial`
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  windfall design factorial --factor 'v=0.3..0.6 m/s' --factor 'R=25, 32, 40 mm'
  windfall design factorial --factor 'a=0..1' --factor 'b=0..1' --factor 'c=0..1' --factor 'd=0..1' \\
      --fraction 'D=ABC' --centre 3 --format text")]
pub struct FactorialArguments {
    /// What all designs take
    #[command(flatten)]
    pub all: DesignOptions,
    /// Levels of each range
    #[arg(long, default_value_t = 2, value_name = "N")]
    pub points: usize,
    /// Generators 'D=AB, E=AC', or 1/2, 1/4 … for the fraction of least aberration
    #[arg(long, value_name = "FRACTION")]
    pub fraction: Option<String>,
    /// Runs of the fraction of least aberration, instead of --fraction
    #[arg(long, value_name = "N")]
    pub runs: Option<usize>,
    /// Runs of every combination
    #[arg(long, default_value_t = 1, value_name = "N")]
    pub replicates: usize,
    /// Centre points in each block
    #[arg(long, default_value_t = 0, value_name = "N")]
    pub centre: usize,
    /// Blocks of a two-level design: 2, 4, 8 …
    #[arg(long, default_value_t = 1, value_name = "N")]
    pub blocks: usize,
}

/// `windfall design plackett-burman`
#[derive(Debug, Args)]
pub struct PlackettBurmanArguments {
    /// What all designs take
    #[command(flatten)]
    pub all: DesignOptions,
    /// Runs, a multiple of 4; the smallest number if left out
    #[arg(long, value_name = "N")]
    pub runs: Option<usize>,
    /// Centre points
    #[arg(long, default_value_t = 0, value_name = "N")]
    pub centre: usize,
}

/// `windfall design ccd`
#[derive(Debug, Args)]
#[command(after_help = "Example, the drop study of 2023:
  windfall design ccd --factor 'k=0.3..1 N/mm^1.91' --factor 'e=1.5..3' \\
      --factor 'c=1e-4..6e-4 N s/mm' --levels axial --centre 1 --decimals k=2 --decimals e=2")]
pub struct CompositeArguments {
    /// What all designs take
    #[command(flatten)]
    pub all: DesignOptions,
    /// rotatable, face, spherical, orthogonal, blocks, or a number of half-ranges; rotatable if
    /// left out, with blocks the one that keeps them out of the model
    #[arg(long, value_name = "ALPHA", allow_hyphen_values = true)]
    pub alpha: Option<String>,
    /// What LOW and HIGH of the factors are: corners of the cube (factorial) or axial points
    /// (axial)
    #[arg(long, default_value = "factorial", value_name = "WHERE")]
    pub levels: String,
    /// Fraction of the cube: 'E=ABCD', or 1/2
    #[arg(long, value_name = "FRACTION")]
    pub fraction: Option<String>,
    /// Centre points; with blocks in each, or 'CUBE,AXIAL'; 5 if left out, 2 in each block
    #[arg(long, value_name = "N")]
    pub centre: Option<String>,
    /// Blocks: 2 (cube, axial points), 3, 5 or 9 (the cube divided)
    #[arg(long, default_value_t = 1, value_name = "N")]
    pub blocks: usize,
}

/// `windfall design box-behnken`
#[derive(Debug, Args)]
pub struct BoxBehnkenArguments {
    /// What all designs take
    #[command(flatten)]
    pub all: DesignOptions,
    /// Centre points in each block; 5 if left out, 2 with blocks
    #[arg(long, value_name = "N")]
    pub centre: Option<usize>,
    /// Blocks: 3 for four factors, 2 for five to seven
    #[arg(long, default_value_t = 1, value_name = "N")]
    pub blocks: usize,
}

/// `windfall design latin-hypercube` and `windfall design sobol`
#[derive(Debug, Args)]
pub struct SpaceArguments {
    /// What all designs take
    #[command(flatten)]
    pub all: DesignOptions,
    /// Runs
    #[arg(long, value_name = "N")]
    pub runs: usize,
}

/// `windfall design d-optimal` and `windfall design i-optimal`
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  windfall design d-optimal --factor 'v=0.3..0.6 m/s' --factor 'R=25..40 mm' --model quadratic --runs 10
  windfall design i-optimal --factor 'v=0.3..0.6 m/s' --factor 'R=25..40 mm' --model 'v*R + I(v^2)' \\
      --runs 8 --candidates possible.csv
  windfall design d-optimal --augment done.csv --model quadratic --runs 4
      four runs more; the factors are those of the header of done.csv")]
pub struct OptimalArguments {
    /// What all designs take
    #[command(flatten)]
    pub all: DesignOptions,
    /// linear, 2fi, quadratic, or a formula in names or letters; factors stand for their coded
    /// values
    #[arg(long, default_value = "quadratic", value_name = "MODEL")]
    pub model: String,
    /// New runs
    #[arg(long, value_name = "N")]
    pub runs: usize,
    /// Levels of each range to choose from; what the model needs if left out
    #[arg(long, value_name = "N")]
    pub points: Option<usize>,
    /// Choose from the rows of this table, with a column for each factor
    #[arg(long, value_name = "FILE.csv", value_hint = ValueHint::FilePath, conflicts_with = "points")]
    pub candidates: Option<PathBuf>,
    /// Runs already made, which are kept; a column for each factor
    #[arg(long, value_name = "FILE.csv", value_hint = ValueHint::FilePath)]
    pub augment: Option<PathBuf>,
    /// Random starts; as many as take seconds if left out
    #[arg(long, value_name = "N")]
    pub starts: Option<usize>,
}
