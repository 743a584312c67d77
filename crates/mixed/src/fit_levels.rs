//! Mixed models whose residual variance differs by level.

use crate::error::MixedError;
use crate::fit::{MixedFit, MixedOptions, fit_mixed_model};
use crate::levels::level_slopes;
use crate::model::{prepare_mixed, prepare_weighted};
use crate::residual_levels::{LevelVariances, ResidualLevels};
use crate::slope::slopes;
use crate::term::RandomTerm;
use crate::weights::Weights;
use nalgebra::DMatrix;

/// Degrees of freedom of a level's residuals below which they tell no variance.
const NO_FREEDOM: f64 = 1e-8;

/// A level's standard deviation below this share of the residual one of all rows is rounding.
const NO_SCATTER: f64 = 1e-6;

/// Fits a mixed model whose residual variance differs by level.
///
/// # Errors
/// As [`crate::fit::fit_mixed`]; [`MixedError::LevelVariance`] for a level with one row, with
/// coefficients of its own for all of its rows, or without scatter about the model.
///
/// # Numerics
/// Logarithms of ratios of variances are further coordinates of the criterion, with exact
/// derivatives. The search begins at the mean squares of the levels' residuals from the model
/// with one variance.
///
/// # Source
/// Pinheiro and Bates (2000), Mixed-Effects Models in S and S-PLUS, §5.1 (`varIdent`), §5.2.
pub fn fit_mixed_levels(
    (y, levels): (&[f64], &ResidualLevels),
    x: &DMatrix<f64>,
    x_names: &[String],
    terms: &[RandomTerm],
    options: &MixedOptions,
) -> Result<MixedFit, MixedError> {
    levels.check(y.len())?;
    let mut plain = prepare_mixed(y, x, x_names, terms)?;
    let equal = fit_mixed_model(plain.clone(), options)?;
    plain.levels = Some(levels.clone());
    let (_, projections) = slopes(&plain, &equal.state);
    let slopes = level_slopes(&plain, &equal.state, &projections);
    let slopes = slopes.ok_or(MixedError::NoCriterion)?;
    let mut starts = Vec::new();
    for (level, size) in levels.sizes().into_iter().enumerate() {
        let left = size as f64 + slopes.log_v[level] + slopes.log_fixed[level];
        if left <= NO_FREEDOM {
            let what = "has coefficients of its own for all of its rows";
            return Err(levels.refused(level, what));
        }
        starts.push(-slopes.squares[level] / left);
    }
    let least = (NO_SCATTER * equal.residual_sd).powi(2);
    let without = |variance: &f64| *variance < least || variance.is_nan();
    let no_scatter = |level| levels.refused(level, "has no scatter about the model");
    if let Some(level) = starts.iter().position(without) {
        return Err(no_scatter(level));
    }
    let weights = levels.level.iter().map(|own| starts[0] / starts[*own]);
    let weights = Weights::of(weights);
    let mut model = prepare_weighted((y, &weights), x, x_names, terms)?;
    model.levels = Some(levels.clone());
    let mut fit = fit_mixed_model(model, options)?;
    let ratios = fit.level_ratios();
    let sds: Vec<f64> = ratios
        .iter()
        .map(|own| fit.residual_sd * own.sqrt())
        .collect();
    if let Some(level) = sds.iter().position(|own| without(&own.powi(2))) {
        return Err(no_scatter(level));
    }
    fit.levels = Some(LevelVariances {
        sds,
        rows: levels.sizes(),
        equal_log_likelihood: equal.log_likelihood,
    });
    Ok(fit)
}
