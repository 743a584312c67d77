//! `windfall summary` and `windfall compare`: arguments.

use crate::args::format::Shown;
use clap::Args;
use windfall_tables::compare::agreement::AgreementRequest;
use windfall_tables::compare::run::CompareRequest;
use windfall_tables::compare::summary::SummaryRequest;

/// `windfall summary`
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  windfall summary impacts.csv --by variety --value k --value c
  windfall summary impacts.csv --by variety,V --value k --format csv")]
pub struct SummaryArguments {
    #[command(flatten)]
    pub request: SummaryRequest,
    #[command(flatten)]
    pub shown: Shown,
}

/// `windfall compare`
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  windfall compare fruit.csv --value firmness_N --by variety
      analysis of variance, Welch, Levene, Tukey and letters
  windfall compare impacts.csv --value k --by V --paired specimen
      the same fruit at every velocity
  windfall compare impacts.csv --value k --by variety --specimen fruit
      several impacts on each fruit: their means are compared
  windfall compare fitted.csv --measured k --predicted k_model --parameters 5
      how far predictions lie from what was measured")]
pub struct CompareArguments {
    #[command(flatten)]
    pub request: CompareRequest,
    #[command(flatten)]
    pub agreement: Option<AgreementRequest>,
    #[command(flatten)]
    pub shown: Shown,
}
