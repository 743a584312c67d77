//! `windfall regress`: arguments.

use crate::args::format::Format;
use clap::{Args, ValueEnum, ValueHint};
use std::path::PathBuf;

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
    /// Table with a header line (CSV)
    #[arg(value_hint = ValueHint::FilePath)]
    pub table: PathBuf,
    /// What is modelled: a column, or a function of one
    #[arg(long, value_name = "COLUMN", required_unless_present = "formula")]
    pub response: Option<String>,
    /// What it is modelled by
    #[arg(long, value_name = "TERMS", required_unless_present = "formula")]
    pub terms: Option<String>,
    /// Both at once: 'response ~ terms'
    #[arg(long, conflicts_with_all = ["response", "terms"])]
    pub formula: Option<String>,
    /// What varies between groups: 'specimen' (its mean), '1 + V | specimen' (its mean and its
    /// slope), 'variety/fruit' (fruit within variety); makes the model a mixed one; may be repeated
    #[arg(long = "random", value_name = "GROUPS")]
    pub random: Vec<String>,
    /// What is maximised where there are random effects
    #[arg(long, value_enum, default_value_t)]
    pub likelihood: Likelihood,
    /// How degrees of freedom are found where there are random effects
    #[arg(long, value_enum, default_value_t, value_name = "METHOD")]
    pub df: Freedom,
    /// Select terms
    #[arg(long, value_enum, value_name = "HOW")]
    pub select: Option<Select>,
    /// What decides on a term
    #[arg(long, value_enum, default_value_t, requires = "select")]
    pub criterion: SelectBy,
    /// A term leaves at this probability or above
    #[arg(long, default_value_t = 0.1, value_name = "P", requires = "select")]
    pub p_remove: f64,
    /// A term enters below this probability
    #[arg(long, default_value_t = 0.05, value_name = "P", requires = "select")]
    pub p_enter: f64,
    /// Keep a term while one that contains it is in the model (SPSS does not)
    #[arg(long, requires = "select")]
    pub hierarchy: bool,
    /// Type of the analysis of variance: 1 in order, 2 after all that do not contain the term,
    /// 3 after all others (categories by sum contrasts); with random effects always 3
    #[arg(long, default_value_t = 2, value_name = "TYPE", value_parser = clap::value_parser!(u8).range(1..=3))]
    pub anova: u8,
    /// Contrasts of categories
    #[arg(long, value_enum, default_value_t)]
    pub contrasts: Contrasts,
    /// Standard errors that hold for unequal variances (HC3)
    #[arg(long)]
    pub robust: bool,
    /// Parts for cross-validation, without random effects; 0 for none
    #[arg(long, default_value_t = 10, value_name = "PARTS")]
    pub folds: usize,
    /// Seed of the division into parts
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Level of the intervals
    #[arg(long, default_value_t = 0.95, value_name = "LEVEL")]
    pub confidence: f64,
    /// Table with the columns of the model, to be predicted
    #[arg(long, value_name = "TABLE", value_hint = ValueHint::FilePath)]
    pub predict: Option<PathBuf>,
    /// How the result is shown
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
}

/// What is maximised.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Likelihood {
    /// Restricted likelihood: variances without bias from the fixed effects
    #[default]
    Reml,
    /// Plain likelihood: for comparing models with different fixed effects
    Ml,
}

/// How degrees of freedom are found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Freedom {
    /// Satterthwaite's
    #[default]
    Satterthwaite,
    /// Kenward and Roger's, with their standard errors
    KenwardRoger,
}

/// How terms are selected.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Select {
    /// From all terms, taking out
    Backward,
    /// From none, putting in
    Forward,
    /// From none, putting in and taking out
    Stepwise,
}

/// What decides on a term.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum SelectBy {
    /// Probability of its F test
    #[default]
    P,
    /// Akaike's criterion for small samples
    Aicc,
    /// Schwarz' criterion
    Bic,
}

/// Contrasts of categories.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Contrasts {
    /// Each level against the first
    #[default]
    Treatment,
    /// Each level against the mean of all
    Sum,
    /// Each level against the mean of those before it
    Helmert,
    /// Polynomials over the order of the levels
    Poly,
}
