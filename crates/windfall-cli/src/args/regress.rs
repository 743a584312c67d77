//! `windfall regress`: arguments.

use crate::args::format::Shown;
use clap::Args;
use windfall_tables::regress::request::RegressRequest;

/// `windfall regress`
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  windfall regress impacts.csv --response k --terms 'V + R + t + V:R'
  windfall regress impacts.csv --formula 'log(k) ~ V*R + t + V^2' --anova 3
  windfall regress impacts.csv --response k --terms 'V*R + t' --random specimen
  windfall regress impacts.csv --response k --terms '(V + R + t + S)^2' --select backward --p-remove 0.05

Terms: a + b (both), a:b (their product), a*b (both and the product), (a + b + c)^2 (all and
their pairs), a^2 (the square), I(a / b) (a calculation), log(a), poly(a, 2), C(a, sum) (a
category with its contrasts), a - b (without), 0 (no intercept). Columns with other characters
in their names stand in backticks. Columns of text are categories.")]
pub struct RegressArguments {
    #[command(flatten)]
    pub request: RegressRequest,
    #[command(flatten)]
    pub shown: Shown,
}
