//! What plans with an exact answer are asked.

use crate::options::{PlanOptions, ScatterOptions};
use windfall_tables::reading::ReadingOptions;

/// A mean.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct MeanRequest {
    /// Difference from a reference that the mean is tested against
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "DIFFERENCE", allow_negative_numbers = true)
    )]
    pub difference: Option<f64>,
    /// How much measurements scatter.
    #[cfg_attr(feature = "clap", command(flatten))]
    pub scatter: ScatterOptions,
    /// Sizes and what is wanted.
    #[cfg_attr(feature = "clap", command(flatten))]
    pub plan: PlanOptions,
    /// How the table of --from is read
    #[cfg_attr(feature = "clap", command(flatten))]
    pub reading: ReadingOptions,
}

/// A difference between two groups, or two treatments of the same fruit.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct DifferenceRequest {
    /// Difference of the means that is to be found
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "DIFFERENCE", allow_negative_numbers = true)
    )]
    pub difference: Option<f64>,
    /// Fruit in the second group for each in the first
    #[cfg_attr(
        feature = "clap",
        arg(
            long,
            default_value_t = 1.0,
            value_name = "NUMBER",
            conflicts_with = "same_fruit"
        )
    )]
    pub ratio: f64,
    /// One variance for both groups with --sd (Student's t test), in place of Welch's
    #[cfg_attr(
        feature = "clap",
        arg(long, requires = "sd", conflicts_with = "same_fruit")
    )]
    pub pooled: bool,
    /// Every fruit gets both treatments, --impacts of each; --sd is then that of the differences
    #[cfg_attr(feature = "clap", arg(long))]
    pub same_fruit: bool,
    /// Standard deviation between fruit of the difference itself, with --same-fruit
    #[cfg_attr(
        feature = "clap",
        arg(
            long,
            value_name = "SD",
            allow_negative_numbers = true,
            requires = "same_fruit"
        )
    )]
    pub effect_sd: Option<f64>,
    /// How much measurements scatter.
    #[cfg_attr(feature = "clap", command(flatten))]
    pub scatter: ScatterOptions,
    /// Sizes and what is wanted.
    #[cfg_attr(feature = "clap", command(flatten))]
    pub plan: PlanOptions,
    /// How the table of --from is read
    #[cfg_attr(feature = "clap", command(flatten))]
    pub reading: ReadingOptions,
}

/// Means of several groups.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct GroupsRequest {
    /// Means of the groups, whose differences are to be found: 10,12,15
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "MEAN,MEAN,…", allow_hyphen_values = true)
    )]
    pub means: String,
    /// Every fruit gets every treatment, --impacts of each
    #[cfg_attr(feature = "clap", arg(long))]
    pub same_fruit: bool,
    /// How much measurements scatter.
    #[cfg_attr(feature = "clap", command(flatten))]
    pub scatter: ScatterOptions,
    /// Sizes and what is wanted.
    #[cfg_attr(feature = "clap", command(flatten))]
    pub plan: PlanOptions,
    /// How the table of --from is read
    #[cfg_attr(feature = "clap", command(flatten))]
    pub reading: ReadingOptions,
}

/// A slope on a column of numbers.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct SlopeRequest {
    /// Slope that is to be found
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "SLOPE", allow_hyphen_values = true)
    )]
    pub slope: Option<f64>,
    /// Values of x, each as often as the others: 0.1,0.3,0.5
    #[cfg_attr(
        feature = "clap",
        arg(
            long,
            value_name = "X,X,…",
            conflicts_with = "spread_x",
            allow_hyphen_values = true
        )
    )]
    pub x: Option<String>,
    /// Standard deviation of x, where its values are not chosen: x as they fall, normal with this
    /// standard deviation; with --same-fruit that of the x of every fruit
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "SD", allow_negative_numbers = true)
    )]
    pub spread_x: Option<f64>,
    /// x changes from impact to impact of every fruit (velocity), not from fruit to fruit
    /// (firmness)
    #[cfg_attr(feature = "clap", arg(long))]
    pub same_fruit: bool,
    /// Standard deviation between fruit of the slope itself, with --same-fruit
    #[cfg_attr(
        feature = "clap",
        arg(
            long,
            value_name = "SD",
            allow_negative_numbers = true,
            requires = "same_fruit"
        )
    )]
    pub effect_sd: Option<f64>,
    /// How much measurements scatter.
    #[cfg_attr(feature = "clap", command(flatten))]
    pub scatter: ScatterOptions,
    /// Sizes and what is wanted.
    #[cfg_attr(feature = "clap", command(flatten))]
    pub plan: PlanOptions,
    /// How the table of --from is read
    #[cfg_attr(feature = "clap", command(flatten))]
    pub reading: ReadingOptions,
}
