//! `windfall design`: arguments.

use crate::args::format::Format;
use clap::{Args, Subcommand, ValueHint};
use std::path::PathBuf;
use windfall_tables::design::request::{
    BoxBehnkenRequest, CompositeRequest, DesignRequest, FactorialRequest, OptimalRequest,
    PlackettBurmanRequest, SpaceRequest, SplitPlotRequest,
};

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

/// Examples of optimal designs.
const OPTIMAL: &str = "Examples:
  windfall design d-optimal --factor 'v=0.3..0.6 m/s' --factor 'R=25..40 mm' --model quadratic --runs 10
  windfall design i-optimal --factor 'v=0.3..0.6 m/s' --factor 'R=25..40 mm' --model 'v*R + I(v^2)' \\
      --runs 8 --candidates possible.csv
  windfall design d-optimal --augment done.csv --model quadratic --runs 4
      four runs more; the factors are those of the header of done.csv";

/// Kinds of designs.
#[derive(Debug, Subcommand)]
pub enum DesignCommand {
    /// All combinations of levels, or a two-level fraction of them
    #[command(after_help = "Examples:
  windfall design factorial --factor 'v=0.3..0.6 m/s' --factor 'R=25, 32, 40 mm'
  windfall design factorial --factor 'a=0..1' --factor 'b=0..1' --factor 'c=0..1' --factor 'd=0..1' \\
      --fraction 'D=ABC' --centre 3 --format text")]
    Factorial(KindArguments<FactorialRequest>),
    /// Main effects of many factors in few runs
    PlackettBurman(KindArguments<PlackettBurmanRequest>),
    /// Central composite: cube, axial points, centre; for a quadratic model
    #[command(after_help = "Example, the drop study of 2023:
  windfall design ccd --factor 'k=0.3..1 N/mm^1.91' --factor 'e=1.5..3' \\
      --factor 'c=1e-4..6e-4 N s/mm' --levels axial --centre 1 --decimals k=2 --decimals e=2")]
    Ccd(KindArguments<CompositeRequest>),
    /// Three levels without corners, 3 to 7 factors; for a quadratic model
    BoxBehnken(KindArguments<BoxBehnkenRequest>),
    /// Levels each used once, points far apart; for computer experiments
    LatinHypercube(KindArguments<SpaceRequest>),
    /// Sobol points: fill the space evenly, more can be added
    Sobol(KindArguments<SpaceRequest>),
    /// Best for the coefficients of a given model
    #[command(after_help = OPTIMAL)]
    DOptimal(KindArguments<OptimalRequest>),
    /// Best for the predictions of a given model
    #[command(after_help = OPTIMAL)]
    IOptimal(KindArguments<OptimalRequest>),
    /// Whole plots of runs for factors that are hard to change; best for a given model
    #[command(
        after_help = "Example, fruit taken from cold rooms of different temperatures and dropped from \
several heights:
  windfall design split-plot --factor 'T=2..20 degC' --factor 'h=10..40 cm' --factor 'm=120..240 g' \\
      --hard T --whole-plots 8 --runs 32 --out design.csv

The column whole_plot says which runs share a setting of the hard-to-change factors; \
`windfall surface` estimates the scatter between whole plots from it."
    )]
    SplitPlot(KindArguments<SplitPlotRequest>),
}

/// What one kind of design takes.
#[derive(Debug, Args)]
pub struct KindArguments<Kind: Args> {
    #[command(flatten)]
    pub all: DesignOptions,
    #[command(flatten)]
    pub kind: Kind,
}

/// What all kinds take.
#[derive(Debug, Args)]
#[command(next_help_heading = "All designs")]
pub struct DesignOptions {
    #[command(flatten)]
    pub request: DesignRequest,
    /// Write the design to this file (CSV), and show it as text
    #[arg(long, value_name = "FILE.csv", value_hint = ValueHint::FilePath)]
    pub out: Option<PathBuf>,
    /// How the design is shown; CSV if left out, text with --out
    #[arg(long, value_enum)]
    pub format: Option<Format>,
}
