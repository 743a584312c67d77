//! Fitted response surfaces as JSON shows them.

use crate::regress::mixed_outcome::VarianceOutcome;
use crate::regress::outcome::{RowOutcome, RowOutcomes};
use serde::Serialize;
use windfall_files::found::FindingOutcome;
use windfall_statistics::model::anova::{LackOfFit, SumOfSquares};
use windfall_statistics::model::linear_model::{Quality, WholeModel};

/// A term of a surface.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct SurfaceTerm {
    /// As it was written: `AB`, `k:e`; `(Intercept)`.
    pub term: String,
    /// With the names of the factors.
    pub name: String,
    /// Coefficient in coded units.
    #[schema(value_type = Option<f64>)]
    pub coded: f64,
    /// Its standard error.
    #[schema(value_type = Option<f64>)]
    pub se: f64,
    /// Lower end of its interval.
    #[schema(value_type = Option<f64>)]
    pub low: f64,
    /// Upper end.
    #[schema(value_type = Option<f64>)]
    pub high: f64,
    /// Coefficient of the same term when the polynomial is written in actual units.
    #[schema(value_type = Option<f64>)]
    pub actual: f64,
    /// Sum of squares of the term, in coded units.
    pub ss: Option<f64>,
    /// Degrees of freedom.
    pub df: Option<f64>,
    /// Degrees of freedom of the denominator of F: those of the residuals, or those of Kenward and
    /// Roger where groups are random.
    pub df_denominator: Option<f64>,
    /// Mean square over that of the residuals; with random groups Kenward and Roger's F.
    pub f: Option<f64>,
    /// Probability of F or more without the term.
    pub p: Option<f64>,
    /// Variance inflation.
    pub vif: Option<f64>,
}

/// A term of the polynomial in actual units.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct ActualTerm {
    /// With the names of the factors.
    pub name: String,
    /// Its coefficient.
    pub coefficient: f64,
}

/// Coding of a factor.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct FactorOutcome {
    /// A, B, C …
    pub letter: String,
    /// Its name.
    pub name: String,
    /// Actual value of coded 0.
    pub centre: f64,
    /// Actual step of coded 1.
    pub half_range: f64,
    /// Lowest actual value in the table.
    pub lowest: f64,
    /// Highest.
    pub highest: f64,
}

/// The stationary point of a quadratic surface.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct CanonicalOutcome {
    /// "maximum", "minimum", "saddle" or "ridge".
    pub shape: &'static str,
    /// Where, in coded units.
    pub coded: Vec<f64>,
    /// Where, in actual units.
    pub actual: Vec<f64>,
    /// Distance from the centre in coded units.
    pub distance: f64,
    /// Whether it lies within the range of the runs.
    pub inside: bool,
    /// The response there.
    pub value: f64,
    /// Curvatures.
    pub eigenvalues: Vec<f64>,
    /// Directions of these in coded units.
    pub directions: Vec<Vec<f64>>,
}

/// A point of a ridge.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct RidgeOutcome {
    /// "maximum" or "minimum".
    pub of: &'static str,
    /// Distance from the centre in coded units.
    pub radius: f64,
    /// Actual settings.
    pub actual: Vec<f64>,
    /// The response there.
    pub value: f64,
}

/// Blocks of runs.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct BlockOutcome {
    /// What they take up before the model.
    #[serde(flatten)]
    pub sum: SumOfSquares,
    /// How far each lies from the mean of the blocks.
    pub effects: Vec<BlockEffect>,
}

/// A block of runs.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct BlockEffect {
    /// Its level.
    pub block: String,
    /// How far it lies from the mean of the blocks.
    pub effect: f64,
}

/// Random groups of runs: days, operators, whole plots.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct RandomOutcome {
    /// Groups of each random term.
    pub groups: Vec<(String, usize)>,
    /// How variances and coefficients are estimated: "REML".
    pub method: &'static str,
    /// How errors and degrees of freedom are found: "Kenward-Roger".
    pub df_method: &'static str,
    /// Degrees of freedom of the denominator of the test of the model.
    #[schema(value_type = Option<f64>)]
    pub model_df_denominator: f64,
    /// Standard deviations between the groups and of the residuals.
    pub variances: Vec<VarianceOutcome>,
    /// Part of the variance that surface and groups describe.
    pub r2_conditional: f64,
    /// Share of each random term in what the surface leaves.
    pub intraclass: Vec<f64>,
}

/// The surface of one response.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct SurfaceModel {
    /// The response.
    pub response: String,
    /// Its terms, the intercept first.
    pub terms: Vec<SurfaceTerm>,
    /// The polynomial in actual units, whole.
    pub actual_terms: Vec<ActualTerm>,
    /// What blocks take up, where runs were made in blocks; R² and the model are of what is left.
    pub blocks: Option<BlockOutcome>,
    /// Random groups of runs, where there are any; there are no sums of squares of terms, model
    /// and residuals then, no lack of fit and no influence of runs.
    pub random: Option<RandomOutcome>,
    /// The model against none.
    pub model: WholeModel,
    /// Residuals.
    pub residual: SumOfSquares,
    /// The response.
    pub total: SumOfSquares,
    /// How good it is.
    #[serde(flatten)]
    pub quality: Quality,
    /// Residual standard deviation in percent of the mean.
    #[schema(value_type = Option<f64>)]
    pub cv_percent: f64,
    /// "I", "II" or "III".
    pub anova_type: &'static str,
    /// Lack of fit, where runs are repeated.
    pub lack_of_fit: Option<LackOfFit>,
    /// Stationary point of a quadratic surface.
    pub canonical: Option<CanonicalOutcome>,
    /// Best points at distances from the centre.
    pub ridge: Vec<RidgeOutcome>,
    /// Runs with their influence.
    #[schema(value_type = Vec<RowOutcome>)]
    pub influence: RowOutcomes,
}

/// Settings with what they give.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct SettingOutcome {
    /// Actual settings of the factors.
    pub actual: Vec<f64>,
    /// The same in coded units.
    pub coded: Vec<f64>,
    /// Responses.
    pub responses: Vec<PredictedResponse>,
    /// Desirability.
    #[schema(value_type = Option<f64>)]
    pub desirability: f64,
}

/// A response at some settings.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct PredictedResponse {
    /// The response.
    pub response: String,
    /// Its mean there.
    pub predicted: f64,
    /// Interval of one further observation.
    #[schema(value_type = Option<f64>)]
    pub low: f64,
    /// Its upper end.
    #[schema(value_type = Option<f64>)]
    pub high: f64,
    /// Desirability of this response alone.
    #[schema(value_type = Option<f64>)]
    pub desirability: f64,
}

/// Settings that are as good as the best.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct FamilyOutcome {
    /// Directions in which settings can change and stay as good.
    pub dimension: usize,
    /// Factor at whose values the members are given.
    pub along: String,
    /// Least actual value of that factor with such settings.
    pub from: f64,
    /// Largest.
    pub to: f64,
    /// Members.
    pub members: Vec<SettingOutcome>,
}

/// What `windfall surface` found.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct SurfaceOutcome {
    /// Coding of the factors.
    pub factors: Vec<FactorOutcome>,
    /// Where the coding came from.
    pub coding: String,
    /// The first response.
    #[serde(flatten)]
    pub first: SurfaceModel,
    /// All responses.
    pub responses: Vec<SurfaceModel>,
    /// The most desirable settings, where goals were given.
    pub optimum: Option<SettingOutcome>,
    /// All settings that are as good, where the best is not alone.
    pub family: Option<FamilyOutcome>,
    /// What a reader must know.
    pub findings: Vec<FindingOutcome>,
    /// Predictions over two factors.
    pub grid: Option<GridOutcome>,
}

/// Predictions over two factors, for contours and surfaces.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct GridOutcome {
    /// Names of all factors, then of the responses, each with its standard error.
    pub columns: Vec<String>,
    /// One for each point, the first factor varying fastest.
    pub rows: Vec<Vec<f64>>,
}
