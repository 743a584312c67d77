//! `windfall plan`: arguments.

use crate::args::format::Shown;
use clap::{Args, Subcommand};
use windfall_plan::achieved::request::AchievedRequest;
use windfall_plan::closed::request::{DifferenceRequest, GroupsRequest, MeanRequest, SlopeRequest};
use windfall_plan::critical::request::CriticalRequest;
use windfall_plan::model::request::ModelRequest;
use windfall_plan::population::request::PopulationPlanRequest;
use windfall_plan::surface::request::SurfacePlanRequest;

/// `windfall plan`
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  windfall plan mean --sd 12 --half-width 4
      fruit for a mean that is known to ± 4
  windfall plan difference --difference 0.15 --between 0.2 --within 0.1 --impacts 1,2,4,8 \\
      --power 0.8 --cost-fruit 2.5 --cost-impact 0.2 --figure plan.svg
      fruit in each of two groups, and the cheapest number of impacts on each
  windfall plan slope --slope -0.4 --x 0.1,0.3,0.5 --same-fruit --impacts 3,6 --between 0.2 --within 0.1 --power 0.9

Standard deviations, differences and widths are in the unit of what is measured. To plan in
parts of the mean, give all of them in per cent.")]
pub struct PlanArguments {
    /// What is to be known
    #[command(subcommand)]
    pub question: PlanCommand,
}

/// Questions.
#[derive(Debug, Subcommand)]
pub enum PlanCommand {
    /// A mean: half-width of its interval, or its difference from a reference
    #[command(after_help = "Examples:
  windfall plan mean --sd 12 --half-width 4 --assurance 0.9
  windfall plan mean --from impacts.csv --formula 'k ~ V + (1 | fruit)' --half-width 20 --impacts 1,3")]
    Mean(QuestionArguments<MeanRequest>),
    /// A difference between two groups of fruit, or between two treatments of the same fruit
    #[command(after_help = "Examples:
  windfall plan difference --difference 8 --sd 12,15 --ratio 2 --power 0.9
  windfall plan difference --difference 0.15 --between 0.2 --within 0.1 --impacts 1,2,4,8 --fruit 6..60 --power 0.8
  windfall plan difference --difference 0.05 --same-fruit --between 0.2 --within 0.1 --impacts 2 --fruit 12")]
    Difference(QuestionArguments<DifferenceRequest>),
    /// Differences between the means of several groups
    #[command(after_help = "Example:
  windfall plan groups --means 10,12,15 --sd 4 --power 0.8")]
    Groups(QuestionArguments<GroupsRequest>),
    /// A slope on a property of the fruit, or on what changes between the impacts of a fruit
    #[command(after_help = "Examples:
  windfall plan slope --slope 0.02 --spread-x 8 --sd 0.3 --power 0.8
  windfall plan slope --slope -0.4 --x 0.1,0.3,0.5 --same-fruit --impacts 3,6 --between 0.2 --within 0.1 --power 0.9")]
    Slope(QuestionArguments<SlopeRequest>),
    /// A term of a mixed model of earlier impacts, by simulation
    #[command(
        after_help = "Studies are drawn from the fitted model, with more or fewer fruit like those of the table, and
fitted again. Without --impacts every fruit keeps the rows that it has.

Examples:
  windfall plan model impacts.csv --formula 'k ~ V + (1 | fruit)' --fruit 10,20,40
  windfall plan model impacts.csv --formula 'k ~ V*variety + (1 + V | fruit)' --term variety --power 0.8
  windfall plan model impacts.csv --formula 'k ~ V + (1 | fruit)' --effect V=-0.3 --power 0.9 --simulations 4000"
    )]
    Model(QuestionArguments<ModelRequest>),
    /// The optimum of a response surface: the response there, and where it lies
    #[command(after_help = "Examples:
  windfall plan surface design.csv --coefficients 'A=1, A^2=-2, B^2=-1' --sd 0.5 --half-width 0.3
  windfall plan surface runs.csv --response y --model quadratic --fruit 1,2,4")]
    Surface(QuestionArguments<SurfacePlanRequest>),
    /// A parameter of a population of laws: its median, and its spread between fruit
    #[command(after_help = "Example:
  windfall plan population law.toml --parameter k --half-width 0.05 --impacts 1,2,4")]
    Population(QuestionArguments<PopulationPlanRequest>),
    /// The critical impact energy, by simulation
    #[command(after_help = "Example:
  windfall plan critical-energy --median 0.12 --spread 0.3 --energies 0.05,0.1,0.2,0.4 --half-width 0.15")]
    CriticalEnergy(QuestionArguments<CriticalRequest>),
    /// Look back: what a finished table has achieved, and what more or fewer fruit would have
    #[command(after_help = "Example:
  windfall plan achieved impacts.csv --formula 'k ~ V + variety + (1 | fruit)' --means variety")]
    Achieved(QuestionArguments<AchievedRequest>),
}

/// A question and how its answer is shown.
#[derive(Debug, Args)]
pub struct QuestionArguments<Question: Args> {
    #[command(flatten)]
    pub request: Question,
    #[command(flatten)]
    pub shown: Shown,
}
