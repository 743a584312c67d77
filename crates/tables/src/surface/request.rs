//! What `windfall surface` is asked.

#[cfg(feature = "clap")]
use crate::option_words::{anova_type, members};
use crate::reading::ReadingOptions;
use std::path::PathBuf;
use windfall_draw::files::FigureFolder;
use windfall_files::error::Error;
use windfall_files::option_value::unusable;

pub use windfall_statistics::model::anova::AnovaType;

/// What `windfall surface` is asked.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct SurfaceRequest {
    /// Table of runs with a header line (CSV, Parquet or Arrow)
    #[cfg_attr(feature = "clap", arg(value_hint = clap::ValueHint::FilePath))]
    pub table: PathBuf,
    /// A response: a column, or a function of columns; may be repeated, each with its --model
    #[cfg_attr(
        feature = "clap",
        arg(long = "response", value_name = "COLUMN", required = true)
    )]
    pub responses: Vec<String>,
    /// Its model; one for all responses, or one for each in their order
    #[cfg_attr(
        feature = "clap",
        arg(long = "model", value_name = "MODEL", default_value = "quadratic")
    )]
    pub models: Vec<String>,
    /// A factor; repeated in the order of the letters A, B, C …
    #[cfg_attr(feature = "clap", arg(long = "factor", value_name = "COLUMN"))]
    pub factors: Vec<String>,
    /// Actual values of coded -1 and 1 of a factor: k=0.44..0.86; may be repeated
    #[cfg_attr(feature = "clap", arg(long = "range", value_name = "FACTOR=LOW..HIGH"))]
    pub ranges: Vec<String>,
    /// Column of the blocks that the runs were made in; "block" where there is such a column and
    /// this is left out; "none" for none
    #[cfg_attr(feature = "clap", arg(long, value_name = "COLUMN"))]
    pub block: Option<String>,
    /// Groups of runs whose means vary at random: 'day', 'day/whole_plot' (whole plots within
    /// days); "whole_plot" where there is such a column and this is left out; "none" for none; may
    /// be repeated
    #[cfg_attr(feature = "clap", arg(long, value_name = "GROUPS"))]
    pub random: Vec<String>,
    /// Type of the analysis of variance, in coded units: 1 in order, 2 after all that do not
    /// contain the term (AB and A^2 contain A), 3 after all others
    #[cfg_attr(feature = "clap", arg(long, default_value = "3", value_name = "TYPE", value_parser = anova_type()))]
    pub anova: AnovaType,
    /// Level of the intervals
    #[cfg_attr(
        feature = "clap",
        arg(long, default_value_t = 0.95, value_name = "LEVEL")
    )]
    pub confidence: f64,
    /// What is wanted of a response; may be repeated
    #[cfg_attr(feature = "clap", arg(long = "goal", value_name = "GOAL"))]
    pub goals: Vec<String>,
    /// Hold a factor at a value: k=0.868; may be repeated
    #[cfg_attr(feature = "clap", arg(long = "hold", value_name = "FACTOR=VALUE"))]
    pub hold: Vec<String>,
    /// Factor at whose values settings as good as the best are listed
    #[cfg_attr(feature = "clap", arg(long, value_name = "FACTOR"))]
    pub along: Option<String>,
    /// How many of these values
    #[cfg_attr(feature = "clap", arg(long, default_value_t = 15, value_name = "N", value_parser = members()))]
    pub members: usize,
    /// Two factors for a grid of predictions: k,e (in --format json and csv)
    #[cfg_attr(feature = "clap", arg(long, value_name = "FACTOR,FACTOR"))]
    pub grid: Option<String>,
    /// Points of the grid along each factor
    #[cfg_attr(feature = "clap", arg(long, default_value_t = 41, value_name = "N"))]
    pub grid_points: usize,
    /// Contours, surfaces, effects, perturbation, desirability, and model against runs
    #[cfg_attr(feature = "clap", command(flatten))]
    pub figures: Option<FigureFolder>,
    /// How the table is read
    #[cfg_attr(feature = "clap", command(flatten))]
    pub reading: ReadingOptions,
}

impl SurfaceRequest {
    /// What is usual beside table, responses and their models.
    pub fn usual(table: PathBuf, responses: Vec<String>, models: Vec<String>) -> Self {
        Self {
            table,
            responses,
            models,
            factors: Vec::new(),
            ranges: Vec::new(),
            block: None,
            random: Vec::new(),
            anova: AnovaType::Partial,
            confidence: 0.95,
            goals: Vec::new(),
            hold: Vec::new(),
            along: None,
            members: 15,
            grid: None,
            grid_points: 41,
            figures: None,
            reading: ReadingOptions::default(),
        }
    }

    /// Responses with the model of each.
    pub(crate) fn modelled(&self) -> Result<Vec<(&String, &String)>, Error> {
        let (responses, models) = (&self.responses, &self.models);
        if models.len() != 1 && models.len() != responses.len() {
            let problem = format!(
                "there are {} responses and {} models: give one model for all, or one for each",
                responses.len(),
                models.len()
            );
            return Err(unusable("--model", problem));
        }
        Ok(responses.iter().zip(models.iter().cycle()).collect())
    }
}
