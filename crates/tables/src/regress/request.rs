//! What `windfall regress` is asked.

#[cfg(feature = "clap")]
use crate::option_words::{anova_type, contrast, direction, likelihood};
use crate::reading::ReadingOptions;
use crate::regress::means::request::MeansRequest;
use std::path::PathBuf;
use windfall_draw::files::FigureFolder;
use windfall_files::error::Error;
use windfall_files::option_value::plain_name;
use windfall_files::table::data::Data;

pub use windfall_mixed::fit::MixedMethod;
pub use windfall_statistics::model::anova::AnovaType;
pub use windfall_statistics::model::contrast::Contrast;
pub use windfall_statistics::model::selection::{Criterion, Direction, SelectionOptions};

/// What `windfall regress` is asked.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct RegressRequest {
    /// Table with a header line (CSV, Parquet or Arrow), or a folder of Parquet files
    #[cfg_attr(feature = "clap", arg(value_hint = clap::ValueHint::FilePath))]
    pub table: PathBuf,
    /// What is modelled: a column, or a function of one
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "COLUMN", required_unless_present = "formula")
    )]
    pub response: Option<String>,
    /// What it is modelled by
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "TERMS", required_unless_present = "formula")
    )]
    pub terms: Option<String>,
    /// Both at once: 'response ~ terms'
    #[cfg_attr(feature = "clap", arg(long, conflicts_with_all = ["response", "terms"]))]
    pub formula: Option<String>,
    /// What varies between groups: 'specimen' (its mean), '1 + V | specimen' (its mean and its
    /// slope), 'variety/fruit' (fruit within variety); makes the model a mixed one; may be repeated
    #[cfg_attr(feature = "clap", arg(long = "random", value_name = "GROUPS"))]
    pub random: Vec<String>,
    /// What is maximised where there are random effects, or variances by level
    #[cfg_attr(feature = "clap", arg(long, default_value = "reml", value_parser = likelihood()))]
    pub likelihood: MixedMethod,
    /// How degrees of freedom are found where there are random effects; intervals of predictions
    /// are always Satterthwaite's
    #[cfg_attr(
        feature = "clap",
        arg(long, value_enum, default_value_t, value_name = "METHOD")
    )]
    pub df: FreedomMethod,
    /// Column of weights of the rows, such as the number of impacts behind each mean: the variance
    /// of a row is σ² over its weight
    #[cfg_attr(feature = "clap", arg(long, value_name = "COLUMN"))]
    pub weights: Option<String>,
    /// Category whose levels have residual variances of their own; estimated by --likelihood
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "COLUMN", conflicts_with = "weights")
    )]
    pub variance: Option<String>,
    /// Select terms
    #[cfg_attr(feature = "clap", arg(long, value_name = "HOW", value_parser = direction()))]
    pub select: Option<Direction>,
    /// What decides on a term
    #[cfg_attr(
        feature = "clap",
        arg(long, value_enum, default_value_t, requires = "select")
    )]
    pub criterion: SelectBy,
    /// A term leaves at this probability or above
    #[cfg_attr(
        feature = "clap",
        arg(long, default_value_t = 0.1, value_name = "P", requires = "select")
    )]
    pub p_remove: f64,
    /// A term enters below this probability
    #[cfg_attr(
        feature = "clap",
        arg(long, default_value_t = 0.05, value_name = "P", requires = "select")
    )]
    pub p_enter: f64,
    /// Keep a term while one that contains it is in the model (SPSS does not)
    #[cfg_attr(feature = "clap", arg(long, requires = "select"))]
    pub hierarchy: bool,
    /// Type of the analysis of variance: 1 in order, 2 after all that do not contain the term,
    /// 3 after all others (categories by sum contrasts); with random effects always 3
    #[cfg_attr(feature = "clap", arg(long, default_value = "2", value_name = "TYPE", value_parser = anova_type()))]
    pub anova: AnovaType,
    /// Contrasts of categories
    #[cfg_attr(feature = "clap", arg(long, default_value = "treatment", value_parser = contrast()))]
    pub contrasts: Contrast,
    /// Questions after the model
    #[cfg_attr(feature = "clap", command(flatten))]
    pub after: MeansRequest,
    /// Standard errors that hold for unequal variances (HC3)
    #[cfg_attr(feature = "clap", arg(long))]
    pub robust: bool,
    /// Parts for cross-validation, without random effects; 0 for none
    #[cfg_attr(
        feature = "clap",
        arg(long, default_value_t = 10, value_name = "PARTS")
    )]
    pub folds: usize,
    /// Column of fruit (or lots, days) whose rows stay together in cross-validation: how well
    /// another fruit is predicted
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "COLUMN", conflicts_with = "random")
    )]
    pub fold_by: Option<String>,
    /// Seed of the division into parts
    #[cfg_attr(feature = "clap", arg(long, default_value_t = 1))]
    pub seed: u64,
    /// Level of the intervals
    #[cfg_attr(
        feature = "clap",
        arg(long, default_value_t = 0.95, value_name = "LEVEL")
    )]
    pub confidence: f64,
    /// Table with the columns of the model, to be predicted
    #[cfg_attr(feature = "clap", arg(long, value_name = "TABLE", value_hint = clap::ValueHint::FilePath))]
    pub predict: Option<PathBuf>,
    /// Residuals with their influence, effects, and random effects with their profiles
    #[cfg_attr(feature = "clap", command(flatten))]
    pub figures: Option<FigureFolder>,
    /// How the table is read
    #[cfg_attr(feature = "clap", command(flatten))]
    pub reading: ReadingOptions,
}

impl RegressRequest {
    /// What is usual beside table, response and terms.
    pub fn usual(table: PathBuf, response: String, terms: String) -> Self {
        Self {
            table,
            response: Some(response),
            terms: Some(terms),
            formula: None,
            random: Vec::new(),
            likelihood: MixedMethod::Reml,
            df: FreedomMethod::Satterthwaite,
            weights: None,
            variance: None,
            select: None,
            criterion: SelectBy::P,
            p_remove: 0.1,
            p_enter: 0.05,
            hierarchy: false,
            anova: AnovaType::Hierarchical,
            contrasts: Contrast::Treatment,
            after: MeansRequest::default(),
            robust: false,
            folds: 10,
            fold_by: None,
            seed: 1,
            confidence: 0.95,
            predict: None,
            figures: None,
            reading: ReadingOptions::default(),
        }
    }

    /// The same with columns named without backticks.
    pub(crate) fn with_plain_names(&self) -> Self {
        let plain = |own: &Option<String>| own.as_deref().map(plain_name);
        Self {
            weights: plain(&self.weights),
            variance: plain(&self.variance),
            fold_by: plain(&self.fold_by),
            ..self.clone()
        }
    }

    /// Columns beside those of the formula whose cells must not be missing.
    pub(crate) fn also(&self) -> Vec<String> {
        let also = self.fold_by.iter().chain(&self.weights);
        also.chain(&self.variance).cloned().collect()
    }

    /// The table that is to be predicted, if there is one.
    ///
    /// # Errors
    /// It cannot be read.
    pub(crate) fn asked(&self) -> Result<Option<Data>, Error> {
        let path = self.predict.as_deref();
        path.map(|path| self.reading.read(path)).transpose()
    }

    /// How terms are selected, if they are.
    pub fn selection(&self) -> Option<SelectionOptions> {
        Some(SelectionOptions {
            direction: self.select?,
            criterion: match self.criterion {
                SelectBy::P => Criterion::Probability {
                    enter: self.p_enter,
                    remove: self.p_remove,
                },
                SelectBy::Aicc => Criterion::Aicc,
                SelectBy::Bic => Criterion::Bic,
            },
            hierarchy: self.hierarchy,
        })
    }

    /// `response ~ terms`; a response that is the name of one of the `columns` is taken as it is.
    pub fn formula(&self, columns: &[String]) -> String {
        let terms = self.terms.as_deref().unwrap_or_default();
        match (&self.formula, &self.response) {
            (Some(text), _) => text.clone(),
            (None, Some(response)) if columns.contains(response) => {
                format!("`{response}` ~ {terms}")
            }
            (None, response) => format!("{} ~ {terms}", response.as_deref().unwrap_or_default()),
        }
    }
}

/// How degrees of freedom are found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum FreedomMethod {
    /// Satterthwaite's
    #[default]
    Satterthwaite,
    /// Kenward and Roger's, with their standard errors
    KenwardRoger,
}

/// What decides on a term.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum SelectBy {
    /// Probability of its F test
    #[default]
    P,
    /// Akaike's criterion for small samples
    Aicc,
    /// Schwarz' criterion
    Bic,
}
