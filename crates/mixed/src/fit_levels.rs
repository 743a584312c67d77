//! Mixed models whose residual variance differs by level.

use crate::basis::dot;
use crate::error::MixedError;
use crate::evaluate::evaluate;
use crate::finding::MixedFinding;
use crate::fit::{MixedFit, MixedMethod, MixedOptions, fit_from, fit_mixed_model};
use crate::levels::level_slopes;
use crate::model::{MixedModel, prepare_mixed, prepare_weighted};
use crate::residual_levels::{LevelVariances, ResidualLevels};
use crate::slope::slopes;
use crate::term::RandomTerm;
use crate::weights::Weights;
use nalgebra::DMatrix;

/// Degrees of freedom of a level's residuals below which they tell no variance.
const NO_FREEDOM: f64 = 1e-8;

/// Curvature of the deviance, by the logarithm of a level's variance, below which the level does
/// not scatter: a row of its own has about 1.
const NO_CURVATURE: f64 = 0.05;

/// Share of the residual variance at which a search may begin.
const LEAST_START: f64 = 1e-6;

/// Most rows, and most levels, where the search begins with each level's variance small, too.
const SMALL_TABLE: (usize, usize) = (200, 8);

/// Log-likelihoods nearer than this belong to one maximum.
const SAME: f64 = 1e-4;

/// Another maximum this far below the highest is as good as not there.
const FAR_BELOW: f64 = 3.0;

/// Fits a mixed model whose residual variance differs by level.
///
/// # Errors
/// As [`crate::fit::fit_mixed`]; [`MixedError::LevelVariance`] for a level with one row, with
/// coefficients of its own for all of its rows, or without scatter about the model.
///
/// # Numerics
/// Logarithms of ratios of variances are further coordinates of the criterion, with exact
/// derivatives. The likelihood may have several maxima: the search begins from the mean squares
/// of the levels' residuals with and without the random effects; in small tables also from equal
/// variances, from each level's variance near zero, and from small random effects. The highest maximum is taken at which
/// every level scatters.
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
    let starts = starts(&plain, levels, &equal)?;
    let small = plain.rows() <= SMALL_TABLE.0;
    let sizes: &[f64] = if small { &[1.0, 0.1] } else { &[1.0] };
    let starts_and_sizes = starts
        .iter()
        .flat_map(|own| sizes.iter().map(move |size| (own, *size)));
    let fits = starts_and_sizes.map(|(start, size)| {
        let mean = start.iter().sum::<f64>() / start.len() as f64;
        let weights = levels.level.iter().map(|own| mean / start[*own]);
        let mut model = prepare_weighted((y, &Weights::of(weights)), x, x_names, terms)?;
        model.levels = Some(levels.clone());
        fit_from(model, options, &[size])
    });
    let fits: Vec<Result<MixedFit, MixedError>> = fits.collect();
    let mut fit = highest(fits, levels, &starts[0])?;
    let ratios = fit.level_ratios().into_iter();
    fit.levels = Some(LevelVariances {
        sds: ratios.map(|own| fit.residual_sd * own.sqrt()).collect(),
        rows: levels.sizes(),
        equal_log_likelihood: equal.log_likelihood,
    });
    Ok(fit)
}

/// Variances of levels at which searches begin.
fn starts(
    plain: &MixedModel,
    levels: &ResidualLevels,
    equal: &MixedFit,
) -> Result<Vec<Vec<f64>>, MixedError> {
    let (_, projections) = slopes(plain, &equal.state);
    let slopes = level_slopes(plain, &equal.state, &projections);
    let slopes = slopes.ok_or(MixedError::NoCriterion)?;
    let variance = equal.residual_sd.powi(2);
    let sizes = levels.sizes();
    let mut within = Vec::new();
    for (level, size) in sizes.iter().enumerate() {
        let left = *size as f64 + slopes.log_v[level] + slopes.log_fixed[level];
        if left <= NO_FREEDOM {
            let what = "has coefficients of its own for all of its rows";
            return Err(levels.refused(level, what));
        }
        within.push((-slopes.squares[level] / left).max(LEAST_START * variance));
    }
    let mut all = vec![0.0; sizes.len()];
    for (residual, level) in plain.residual.iter().zip(&levels.level) {
        all[*level] += residual * residual / sizes[*level] as f64;
    }
    let least = LEAST_START * dot(&plain.residual, &plain.residual) / plain.rows() as f64;
    let all = all.iter().map(|own| own.max(least)).collect();
    let mut starts = vec![within.clone(), all];
    if plain.rows() <= SMALL_TABLE.0 && sizes.len() <= SMALL_TABLE.1 {
        starts.push(vec![variance; sizes.len()]);
        for level in 0..sizes.len() {
            for share in [1e-2, 1e-4] {
                let mut small = within.clone();
                small[level] *= share;
                starts.push(small);
            }
        }
    }
    Ok(starts)
}

/// The highest maximum at which every level scatters.
///
/// * `start`: variances of levels in the model with one variance
fn highest(
    fits: Vec<Result<MixedFit, MixedError>>,
    levels: &ResidualLevels,
    start: &[f64],
) -> Result<MixedFit, MixedError> {
    let least = |values: &[f64]| {
        let places = values.iter().enumerate();
        places
            .min_by(|a, b| a.1.total_cmp(b.1))
            .map_or(0, |own| own.0)
    };
    let (mut inside, mut edge): (Vec<MixedFit>, Option<(f64, usize)>) = (Vec::new(), None);
    let mut failed = None;
    for fit in fits {
        match fit {
            Ok(fit) => {
                let curvatures = level_curvatures(&fit);
                let converged = fit
                    .findings
                    .iter()
                    .all(|own| own.code() != "no_convergence");
                if converged && curvatures.iter().all(|own| *own >= NO_CURVATURE) {
                    inside.push(fit);
                } else if edge.is_none_or(|(value, _)| fit.log_likelihood > value) {
                    edge = Some((fit.log_likelihood, least(&curvatures)));
                }
            }
            Err(error) => failed = Some(error),
        }
    }
    inside.sort_by(|a, b| b.log_likelihood.total_cmp(&a.log_likelihood));
    let mut inside = inside.into_iter();
    let Some(mut best) = inside.next() else {
        return Err(match (edge, failed) {
            (Some((_, level)), _) => levels.refused(level, "has no scatter about the model"),
            (None, Some(MixedError::NoResidual { .. })) => {
                let what = "is reproduced by fixed and random effects";
                levels.refused(least(start), what)
            }
            (None, failed) => failed.unwrap_or(MixedError::NoCriterion),
        });
    };
    let top = best.log_likelihood;
    let other = inside.find(|own| own.log_likelihood < top - SAME);
    if let Some(other) = other.filter(|own| own.log_likelihood > top - FAR_BELOW) {
        best.findings.push(MixedFinding::SeveralMaxima {
            below: top - other.log_likelihood,
        });
    }
    if let Some((value, level)) = edge.filter(|(value, _)| *value > top + SAME) {
        best.findings.push(MixedFinding::HigherWithoutScatter {
            level: levels.names[level].clone(),
            rise: value - top,
        });
    }
    Ok(best)
}

/// Second derivative of -2 log likelihood by the logarithm of each level's residual variance,
/// all else held: of independent rows, their degrees of freedom. It vanishes where the level's
/// variance may as well be zero. NaN where numbers overflow.
fn level_curvatures(fit: &MixedFit) -> Vec<f64> {
    /// Step of the differences.
    const STEP: f64 = 0.05;
    let Some(levels) = &fit.model.levels else {
        return Vec::new();
    };
    let count = levels.names.len();
    let slope = |level: usize, by: f64| {
        let mut logs = vec![0.0; count];
        logs[level] = by;
        let model = fit.model.with_levels(levels, &logs);
        let state = evaluate(&model, &fit.state.blocks)?;
        let (_, projections) = slopes(&model, &state);
        let own = level_slopes(&model, &state, &projections)?;
        let restricted = fit.method == MixedMethod::Reml;
        Some(own.deviance_by(level, restricted, fit.residual_sd.powi(2)))
    };
    let of = |level| Some((slope(level, STEP)? - slope(level, -STEP)?) / (2.0 * STEP));
    let found = (0..count).map(|level| of(level).unwrap_or(f64::NAN));
    found.collect()
}
