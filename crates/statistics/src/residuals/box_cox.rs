//! The power of the response that makes residuals normal and of equal variance.

use crate::orthonormal::{dot, orthonormal_basis, take_out};
use crate::sample::{check_probability, check_sample};
use crate::sample_error::SampleError;
use nalgebra::DMatrix;
use windfall_distribution::tail::chi_squared_upper_quantile;
use windfall_mixed::weights::Weights;

/// Where to look for the power.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoxCoxOptions {
    /// Smallest power.
    pub lowest: f64,
    /// Largest power.
    pub highest: f64,
    /// Confidence of the interval.
    pub confidence: f64,
    /// Steps of the profile that is returned, and of the search.
    pub steps: usize,
}

impl Default for BoxCoxOptions {
    fn default() -> Self {
        Self {
            lowest: -3.0,
            highest: 3.0,
            confidence: 0.95,
            steps: 120,
        }
    }
}

/// The profile of the power λ.
#[derive(Clone, Debug, PartialEq, serde::Serialize, utoipa::ToSchema)]
#[schema(as = BoxCoxOutcome)]
pub struct BoxCox {
    /// The most likely power: 1 no transform, 0.5 root, 0 logarithm, -1 inverse.
    pub lambda: f64,
    /// Lower end of its interval; `None` if below the lowest power searched.
    pub low: Option<f64>,
    /// Upper end; `None` where it goes on above the highest.
    pub high: Option<f64>,
    /// Log-likelihood at the most likely power, up to a constant.
    #[serde(skip)]
    pub log_likelihood: f64,
    /// Log-likelihood at equal steps of the power.
    #[serde(skip)]
    pub profile: Vec<(f64, f64)>,
}

/// Box and Cox's profile for a linear model.
///
/// * `design`: n × p, with the intercept as a column if the model has one
///
/// # Errors
/// A response that is not positive, missing values, lengths that differ, fewer
/// responses than terms, or a fit without residuals.
///
/// # Source
/// Box and Cox (1964), An analysis of transformations, J. R. Stat. Soc. B 26.
pub fn box_cox(
    response: &[f64],
    design: &DMatrix<f64>,
    options: &BoxCoxOptions,
) -> Result<BoxCox, SampleError> {
    box_cox_weighted(response, design, &Weights::default(), options)
}

/// [`box_cox`] of rows that weigh differently.
///
/// * `design`: times the roots of the weights
///
/// # Errors
/// As [`box_cox`].
pub fn box_cox_weighted(
    response: &[f64],
    design: &DMatrix<f64>,
    weights: &Weights,
    options: &BoxCoxOptions,
) -> Result<BoxCox, SampleError> {
    if design.nrows() != response.len() {
        return Err(SampleError::lengths(
            "responses and rows of the design",
            response.len(),
            design.nrows(),
        ));
    }
    let basis = orthonormal_basis(design);
    check_sample("the response", response, (basis.len() + 1).max(2))?;
    let residual_squares = |transformed: &[f64]| {
        let mut rest = weights.weigh(transformed).into_owned();
        take_out(&basis, &mut rest);
        dot(&rest, &rest)
    };
    check_probability("the confidence", options.confidence)?;
    if let Some(place) = response.iter().position(|y| *y <= 0.0) {
        return Err(SampleError::NotPositive {
            what: "a response with powers of it".to_owned(),
            place: place + 1,
            value: response[place],
        });
    }
    let n = response.len() as f64;
    let logarithms: Vec<f64> = response.iter().map(|y| y.ln()).collect();
    let centre = logarithms.iter().sum::<f64>() / n;
    let likelihood = |lambda: f64| {
        let transformed: Vec<f64> = logarithms
            .iter()
            .map(|log| scaled_power(log - centre, lambda))
            .collect();
        -0.5 * n * residual_squares(&transformed).ln()
    };
    let steps = options.steps.max(2);
    let width = (options.highest - options.lowest) / steps as f64;
    let profile: Vec<(f64, f64)> = (0..=steps)
        .map(|i| options.lowest + i as f64 * width)
        .map(|lambda| (lambda, likelihood(lambda)))
        .collect();
    if let Some((lambda, _)) = profile.iter().find(|(_, l)| !l.is_finite()) {
        return Err(SampleError::OutOfRange {
            quantity: "the power at which the residuals vanish or overflow",
            value: *lambda,
            expected: "residuals above zero",
        });
    }
    let best = (0..=steps).fold(0, |best, i| match profile[i].1 > profile[best].1 {
        true => i,
        false => best,
    });
    let lambda = highest_within(
        profile[best.saturating_sub(1)].0,
        profile[(best + 1).min(steps)].0,
        likelihood,
    );
    let log_likelihood = likelihood(lambda);
    let drop = 0.5 * chi_squared_upper_quantile(1.0 - options.confidence, 1.0);
    let below = |lambda: f64| likelihood(lambda) - (log_likelihood - drop);
    Ok(BoxCox {
        lambda,
        low: crossing(lambda, profile.iter().rev(), |at| *at < lambda, below),
        high: crossing(lambda, profile.iter(), |at| *at > lambda, below),
        log_likelihood,
        profile,
    })
}

/// (y^λ - 1)/λ of a response in units of its geometric mean, from its logarithm.
fn scaled_power(log: f64, lambda: f64) -> f64 {
    match (lambda * log).abs() < 1e-8 {
        // (e^x - 1)/x = 1 + x/2 + … at x = 0
        true => log * (1.0 + 0.5 * lambda * log),
        false => (lambda * log).exp_m1() / lambda,
    }
}

/// Golden sections between two powers.
fn highest_within(low: f64, high: f64, function: impl Fn(f64) -> f64) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let (mut low, mut high) = (low, high);
    let inner = |low: f64, high: f64| high - GOLDEN * (high - low);
    let outer = |low: f64, high: f64| low + GOLDEN * (high - low);
    let (mut a, mut b) = (inner(low, high), outer(low, high));
    let (mut at_a, mut at_b) = (function(a), function(b));
    while high - low > 1e-9 {
        if at_a > at_b {
            (high, b, at_b) = (b, a, at_a);
            a = inner(low, high);
            at_a = function(a);
        } else {
            (low, a, at_a) = (a, b, at_b);
            b = outer(low, high);
            at_b = function(b);
        }
    }
    0.5 * (low + high)
}

/// Where the likelihood has dropped enough, on one side of the best power.
fn crossing<'a>(
    best: f64,
    profile: impl Iterator<Item = &'a (f64, f64)>,
    on_side: impl Fn(&f64) -> bool,
    excess: impl Fn(f64) -> f64,
) -> Option<f64> {
    let mut inside = best;
    for (lambda, _) in profile {
        if !on_side(lambda) {
            continue;
        }
        if excess(*lambda) < 0.0 {
            let share = windfall_numerics::root::bracketed_root(0.0, 1.0, 1e-12, |share| {
                excess(inside + share * (lambda - inside))
            });
            return Some(inside + share * (lambda - inside));
        }
        inside = *lambda;
    }
    None
}
