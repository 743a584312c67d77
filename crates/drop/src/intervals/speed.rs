//! How restitution depends on the speed of impact.

use crate::intervals::estimate::TimedImpact;
use nalgebra::DMatrix;
use serde::Serialize;
use windfall_mixed::coefficient::Coefficient;
use windfall_mixed::fit::{MixedOptions, fit_mixed};
use windfall_mixed::inference::{coefficient_tests, variance_uncertainty};
use windfall_mixed::term::random_intercept;
use windfall_statistics::model::straight_line::fit_straight_line;

/// Fewest impacts through which a line is laid.
const FEWEST_IMPACTS: usize = 4;

/// Fewest drops that tell a spread between drops.
const FEWEST_DROPS: usize = 3;

/// Largest part of the variance of the speeds that may be errors of timing. A speed and its
/// restitution share an interval, which alone gives a slope of −e/v times this part.
const LARGEST_ERROR_PART: f64 = 1e-3;

/// A straight line of restitution over speed.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct SpeedOutcome {
    /// Restitution at the mean speed; 1.
    pub restitution: f64,
    /// Mean speed; m/s.
    pub speed: f64,
    /// Lowest speed; m/s.
    pub speed_low: f64,
    /// Highest speed; m/s.
    pub speed_high: f64,
    /// Change of restitution by speed; s/m.
    pub slope: f64,
    /// Its standard error; s/m.
    pub slope_se: f64,
    /// Lower end of its interval; s/m.
    pub slope_low: f64,
    /// Upper end; s/m.
    pub slope_high: f64,
    /// Probability of a slope as large where there is none.
    pub p: f64,
    /// Degrees of freedom of the interval.
    pub df: f64,
    /// How it was estimated.
    pub method: &'static str,
}

/// Why there is no line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoLine {
    /// There are too few impacts.
    TooFew,
    /// The speeds hardly differ; the part of their variance that is error.
    SpeedsAlike(f64),
    /// The restitutions are all the same, or cannot be fitted.
    NoSpread,
}

/// The line through the impacts of all drops that count.
///
/// With several drops that have several impacts, drops differ by a random intercept (REML, degrees of
/// freedom by Satterthwaite), as fruit and spots differ; else ordinary least squares.
///
/// * `drops`: impacts of each drop
/// * `confidence`: level of the interval
///
/// # Errors
/// [`NoLine`], where the impacts cannot tell.
pub fn line_over_speed(drops: &[&[TimedImpact]], confidence: f64) -> Result<SpeedOutcome, NoLine> {
    let all: Vec<TimedImpact> = drops.iter().flat_map(|own| own.iter().copied()).collect();
    if all.len() < FEWEST_IMPACTS {
        return Err(NoLine::TooFew);
    }
    let count = all.len() as f64;
    let centre = all.iter().map(|own| own.speed).sum::<f64>() / count;
    let speeds: Vec<f64> = all.iter().map(|own| own.speed - centre).collect();
    let values: Vec<f64> = all.iter().map(|own| own.restitution).collect();
    let spread: f64 = speeds.iter().map(|own| own * own).sum();
    let errors: f64 = all.iter().map(|own| own.speed_sd * own.speed_sd).sum();
    if errors > LARGEST_ERROR_PART * spread {
        return Err(NoLine::SpeedsAlike((errors / spread).min(1.0)));
    }
    let repeated = drops.len() >= FEWEST_DROPS && all.len() > drops.len();
    let mixed = || {
        let found = mixed_line(drops, &speeds, &values, confidence)?;
        Some((
            found,
            "drops differ by a random intercept; REML, Satterthwaite",
        ))
    };
    let plain = || {
        let line = fit_straight_line(&speeds, &values, confidence).ok()?;
        Some((line.coefficients, "least squares over all impacts"))
    };
    let found = match repeated {
        true => mixed().or_else(plain),
        false => plain(),
    };
    let (coefficients, method) = found.ok_or(NoLine::NoSpread)?;
    let [level, slope] = &coefficients[..] else {
        return Err(NoLine::NoSpread);
    };
    let speeds = || all.iter().map(|own| own.speed);
    match slope.se.is_finite() && slope.low.is_finite() {
        true => Ok(SpeedOutcome {
            restitution: level.estimate,
            speed: centre,
            speed_low: speeds().fold(f64::INFINITY, f64::min),
            speed_high: speeds().fold(0.0, f64::max),
            slope: slope.estimate,
            slope_se: slope.se,
            slope_low: slope.low,
            slope_high: slope.high,
            p: slope.p,
            df: slope.df,
            method,
        }),
        false => Err(NoLine::NoSpread),
    }
}

/// Level and slope with a random intercept of each drop.
fn mixed_line(
    drops: &[&[TimedImpact]],
    speeds: &[f64],
    values: &[f64],
    confidence: f64,
) -> Option<Vec<Coefficient>> {
    let groups = drops.iter().enumerate();
    let groups: Vec<usize> = groups
        .flat_map(|(place, own)| own.iter().map(move |_| place))
        .collect();
    let names: Vec<String> = (0..drops.len()).map(|place| place.to_string()).collect();
    let columns = DMatrix::from_fn(speeds.len(), 2, |row, column| match column {
        0 => 1.0,
        _ => speeds[row],
    });
    let fixed = ["restitution".to_owned(), "speed".to_owned()];
    let term = random_intercept("drop", &groups, &names);
    let fit = fit_mixed(values, &columns, &fixed, &[term], &MixedOptions::default()).ok()?;
    let uncertainty = variance_uncertainty(&fit).ok()?;
    Some(coefficient_tests(&fit, &uncertainty, confidence))
}
