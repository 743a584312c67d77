//! What `windfall regress` is asked.

use std::path::PathBuf;

pub use windfall_statistics::model::anova::AnovaType;
pub use windfall_statistics::model::contrast::Contrast;
pub use windfall_statistics::model::selection::{Criterion, Direction, SelectionOptions};

/// What `windfall regress` is asked.
#[derive(Clone, Debug)]
pub struct RegressRequest {
    /// The table.
    pub table: PathBuf,
    /// What is modelled, and by what.
    pub model: ModelText,
    /// What varies between groups: `specimen`, `1 + V | specimen`.
    pub random: Vec<String>,
    /// How a model with random effects is fitted.
    pub mixed: MixedChoice,
    /// Contrasts of categories.
    pub contrast: Contrast,
    /// Models that terms are tested between.
    pub anova: AnovaType,
    /// How terms are selected, if they are.
    pub selection: Option<SelectionOptions>,
    /// Level of intervals.
    pub confidence: f64,
    /// Whether standard errors hold for unequal variances.
    pub robust: bool,
    /// Parts for cross-validation; none if zero.
    pub folds: usize,
    /// Seed of the division into parts.
    pub seed: u64,
    /// A table to predict.
    pub predict: Option<PathBuf>,
}

impl RegressRequest {
    /// What is usual beside table and model.
    #[must_use]
    pub fn usual(table: PathBuf, model: ModelText) -> Self {
        Self {
            table,
            model,
            random: Vec::new(),
            mixed: MixedChoice::default(),
            contrast: Contrast::Treatment,
            anova: AnovaType::Hierarchical,
            selection: None,
            confidence: 0.95,
            robust: false,
            folds: 10,
            seed: 1,
            predict: None,
        }
    }

    /// The usual selection: terms are removed while their probability is above 0.1.
    #[must_use]
    pub fn usual_selection() -> SelectionOptions {
        SelectionOptions {
            direction: Direction::Backward,
            criterion: Criterion::Probability {
                enter: 0.05,
                remove: 0.1,
            },
            hierarchy: false,
        }
    }
}

/// A model as it is written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ModelText {
    /// `response ~ terms`.
    Formula(String),
    /// The two apart.
    Parts {
        /// A column, or a function of one.
        response: String,
        /// What it is modelled by.
        terms: String,
    },
}

impl ModelText {
    /// `response ~ terms`; the name of one of the `columns` is taken as it is.
    #[must_use]
    pub fn formula(&self, columns: &[String]) -> String {
        match self {
            Self::Formula(text) => text.clone(),
            Self::Parts { response, terms } if columns.contains(response) => {
                format!("`{response}` ~ {terms}")
            }
            Self::Parts { response, terms } => format!("{response} ~ {terms}"),
        }
    }
}

/// How degrees of freedom are found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FreedomMethod {
    /// Satterthwaite's.
    #[default]
    Satterthwaite,
    /// Kenward and Roger's, with their standard errors.
    KenwardRoger,
}

/// What is asked of a mixed model.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MixedChoice {
    /// Whether plain maximum likelihood is wanted, not restricted.
    pub maximum_likelihood: bool,
    /// How degrees of freedom are found.
    pub freedom: FreedomMethod,
}
