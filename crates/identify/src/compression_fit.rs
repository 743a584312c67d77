//! A law fitted to slow compressions, with the first touch as a nuisance.
//!
//! One law is fitted to one loading curve or to several together, such as
//! compressions of one fruit at several rates; every curve has a first touch of
//! its own.

use crate::compare::correlated_scores::{
    add_product, add_scores, at_least, correlation_lag, inverse_of_free, quadratic, sandwich,
    student,
};
use windfall_contact::expression::LawExpression;
use windfall_contact::law::{ContactLaw, SMALLEST_DISPLACEMENT};
use windfall_contact::laws::any_law::{AnyLaw, LARGEST_PARAMETERS};
use windfall_contact::laws::kind::{Law, LawKind};
use windfall_numerics::cholesky;
use windfall_numerics::least_squares::{
    Bounds, LeastSquares, Minimum, NormalEquations, Options, Stop, minimise,
};

/// The part of a loading curve that is fitted.
///
/// It should begin a little after the first touch: at the touch itself the force
/// of some laws has an infinite slope.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadingCurve {
    /// Deformation from any zero; m.
    pub deformation: Vec<f64>,
    /// Rate of deformation; m/s.
    pub rate: Vec<f64>,
    /// Force; N.
    pub force: Vec<f64>,
}

/// One estimate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CompressionEstimate {
    /// Value; SI.
    pub value: f64,
    /// Standard deviation, with residuals as correlated as they are; SI.
    /// Infinite where the curves do not tell the value.
    pub sd: f64,
    /// Lower end of the 95 % interval; SI.
    pub low: f64,
    /// Upper end of the 95 % interval; SI.
    pub high: f64,
}

/// A law fitted to loading curves.
#[derive(Clone, Debug, PartialEq)]
pub struct CompressionFit {
    /// The law.
    pub law: Law,
    /// One per parameter of the law; `None` where it was held.
    pub parameters: Vec<Option<CompressionEstimate>>,
    /// First touch of each curve, on its axis of deformation; m.
    pub touches: Vec<CompressionEstimate>,
    /// Root mean square residual; N.
    pub rms: f64,
    /// Samples over which the residuals stay correlated; 1 for white noise.
    pub correlation_length: f64,
    /// Samples, of all curves.
    pub samples: usize,
    /// Whether the minimum was found.
    pub converged: bool,
}

/// Why there is no fit.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CompressionFitError {
    /// A law that a loading curve cannot tell.
    #[error(
        "a loading curve does not tell the parameters of {law}; choose hertz, kelvin-voigt, \
         kuwabara-kono or power-law"
    )]
    LawUnsuited {
        /// The law.
        law: &'static str,
    },
    /// Fewer samples than are needed.
    #[error(
        "{samples} samples in the fitted range cannot determine {parameters} free parameters; \
         widen the range with `fit_to` in [compression]"
    )]
    TooFewSamples {
        /// Samples.
        samples: usize,
        /// Free parameters.
        parameters: usize,
    },
    /// The minimiser could not begin.
    #[error("{law} cannot be fitted to this curve: the force does not rise with deformation")]
    NoStart {
        /// The law.
        law: &'static str,
    },
}

/// Parameters at most, with one first touch.
const SIZE: usize = LARGEST_PARAMETERS + 1;

/// Steps of the search for a first touch.
const TOUCH_STEPS: usize = 60;

/// Parts of the force at the end of the fastest curve that damping is taken to
/// have at the start: with two terms of the force the cost has several minima.
const DAMPED_PARTS: [f64; 3] = [0.01, 0.3, 0.7];

/// Turns between touches and parameters before the minimiser begins.
const TURNS: usize = 12;

/// Distance that a touch keeps from the first sample, as a part of the curve's
/// deformation: nearer, the slope of some laws is without bound.
const CLEARANCE: f64 = 1e-3;

/// Fits a law to loading curves.
///
/// * `expression`: parameters with a value are held there, and defaults unless
///   they are named in `free`
///
/// # Numerics
/// Least squares of the force. Each curve's first touch is eliminated: found
/// for every set of parameters, and its row and column taken out of the normal
/// equations. Standard deviations come from the sandwich of the normal matrix
/// with the covariance of the scores, summed over lags with Bartlett weights,
/// since the residuals of a smooth curve are not independent.
///
/// # Source
/// Golub and Pereyra (1973), SIAM J. Numer. Anal. 10:413, for elimination;
/// Newey and West (1987), Econometrica 55:703, for the covariance.
///
/// # Errors
/// See [`CompressionFitError`].
pub fn fit_compression(
    curves: &[LoadingCurve],
    expression: &LawExpression,
    free: &[String],
) -> Result<CompressionFit, CompressionFitError> {
    let kind = expression.kind;
    if !kind.describe().from_compression {
        return Err(CompressionFitError::LawUnsuited { law: kind.name() });
    }
    let held = held_values(expression, free);
    let parameters = held.iter().filter(|value| value.is_none()).count() + curves.len();
    let samples = curves.iter().map(|curve| curve.force.len()).sum();
    if samples <= 2 * parameters {
        return Err(CompressionFitError::TooFewSamples {
            samples,
            parameters,
        });
    }
    let mut problem = Problem::new(kind, curves, &held);
    let no_start = CompressionFitError::NoStart { law: kind.name() };
    let start = problem.start(&held).ok_or(no_start)?;
    let bounds = bounds(kind, &held);
    let touches = problem.touches.clone();
    let minima = DAMPED_PARTS.map(|part| {
        problem.touches.clone_from(&touches);
        let start = problem.refined(problem.damped(&start, part), &held);
        minimise(&mut problem, &start, &bounds, &Options::default())
    });
    let cost = |minimum: &Minimum<LARGEST_PARAMETERS>| match minimum.stop {
        Stop::BadStart => f64::INFINITY,
        _ => minimum.equations.cost,
    };
    let best = minima.iter().min_by(|a, b| cost(a).total_cmp(&cost(b)));
    let minimum = *best.unwrap_or(&minima[0]);
    problem.touches = touches;
    problem.evaluate(&minimum.parameters);
    problem.evaluate(&minimum.parameters);
    let law = kind
        .from_values(&minimum.parameters[..kind.describe().parameters.len()])
        .ok_or(CompressionFitError::NoStart { law: kind.name() })?;
    Ok(report(&problem, law, minimum.stop))
}

/// The values that are held; `None` for those that are estimated.
fn held_values(expression: &LawExpression, free: &[String]) -> Vec<Option<f64>> {
    let parameters = expression.kind.describe().parameters.iter();
    parameters
        .enumerate()
        .map(|(i, parameter)| {
            let given = expression.values.get(i).copied().flatten();
            let default = given.or(parameter.default);
            default.filter(|_| !free.iter().any(|name| name == parameter.name))
        })
        .collect()
}

fn bounds(kind: LawKind, held: &[Option<f64>]) -> Bounds<LARGEST_PARAMETERS> {
    let mut bounds = Bounds::NONE;
    for (i, parameter) in kind.describe().parameters.iter().enumerate() {
        (bounds.lower[i], bounds.upper[i]) = match held[i] {
            Some(value) => (value, value),
            None => (parameter.lower, parameter.upper),
        };
    }
    bounds
}

struct Problem<'a> {
    kind: LawKind,
    curves: &'a [LoadingCurve],
    estimated: Vec<bool>,
    touches: Vec<f64>,
}

impl<'a> Problem<'a> {
    fn new(kind: LawKind, curves: &'a [LoadingCurve], held: &[Option<f64>]) -> Self {
        Self {
            kind,
            curves,
            estimated: held.iter().map(Option::is_none).collect(),
            touches: Vec::new(),
        }
    }

    /// Where a straight line through F^(1/n) meets zero, and the stiffness that
    /// its slope tells.
    fn start(&mut self, held: &[Option<f64>]) -> Option<[f64; LARGEST_PARAMETERS]> {
        let description = self.kind.describe();
        let exponent = description.elastic_exponent(held).unwrap_or(1.5);
        let mut stiffness = Vec::new();
        for curve in self.curves {
            let from = curve.force.len() / 3;
            let roots: Vec<f64> = curve
                .force
                .iter()
                .map(|f| f.max(0.0).powf(1.0 / exponent))
                .collect();
            let line = line_through(&curve.deformation[from..], &roots[from..])?;
            let (touch, slope) = (line.0, line.1);
            self.touches.push(touch.min(curve.deformation[from]));
            stiffness.push(slope.max(0.0).powf(exponent));
        }
        let mean = stiffness.iter().sum::<f64>() / stiffness.len() as f64;
        let mut start = [0.0; LARGEST_PARAMETERS];
        for (i, parameter) in description.parameters.iter().enumerate() {
            start[i] = held[i].unwrap_or(match parameter.name {
                "k" => mean,
                "n" => exponent,
                "c" => 0.0,
                _ => parameter.typical,
            });
        }
        (mean > 0.0 && mean.is_finite()).then_some(start)
    }

    /// A start where damping has some part of the force.
    fn damped(&self, start: &[f64; LARGEST_PARAMETERS], part: f64) -> [f64; LARGEST_PARAMETERS] {
        let mut damped = *start;
        let description = self.kind.describe();
        let (Some(k), Some(c)) = (description.index_of("k"), description.index_of("c")) else {
            return damped;
        };
        if !(self.estimated[k] && self.estimated[c]) {
            return damped;
        }
        let end = |curve: &LoadingCurve| {
            let last = curve.force.len() - 1;
            (curve.deformation[last], curve.rate[last], curve.force[last])
        };
        let ends = self.curves.iter().zip(&self.touches).map(|(curve, touch)| {
            let (d, v, force) = end(curve);
            (d - touch, v, force)
        });
        let fastest = ends.max_by(|a, b| a.1.total_cmp(&b.1));
        let unit =
            |law: Law, i: usize, d: f64, v: f64| AnyLaw(law).evaluate(d, v, d).by_parameter[i];
        let law = self
            .kind
            .from_values(&start[..description.parameters.len()]);
        if let (Some((d, v, force)), Some(law)) = (fastest, law)
            && v > 0.0
            && d > 0.0
        {
            damped[k] = (1.0 - part) * start[k];
            damped[c] = part * force / unit(law, c, d, v);
        }
        damped
    }

    /// A start from which the minimiser converges: the parameters that the force
    /// is linear in and the touches, each found with the other held.
    fn refined(
        &mut self,
        mut start: [f64; LARGEST_PARAMETERS],
        held: &[Option<f64>],
    ) -> [f64; LARGEST_PARAMETERS] {
        let description = self.kind.describe();
        let count = description.parameters.len();
        let linear =
            |i: usize| held[i].is_none() && ["k", "c"].contains(&description.parameters[i].name);
        for _ in 0..TURNS {
            let Some(law) = self.kind.from_values(&start[..count]).map(AnyLaw) else {
                break;
            };
            let mut sum = NormalEquations::<SIZE>::ZERO;
            for (index, curve) in self.curves.iter().enumerate() {
                let (touch, equations) = self.best_touch(&law, curve, self.touches[index]);
                self.touches[index] = touch;
                for i in 0..SIZE {
                    sum.gradient[i] += equations.gradient[i];
                    for j in 0..SIZE {
                        sum.normal[i][j] += equations.normal[i][j];
                    }
                }
            }
            for i in 0..SIZE {
                if i >= count || !linear(i) {
                    sum.normal[i] = [0.0; SIZE];
                    sum.normal.iter_mut().for_each(|row| row[i] = 0.0);
                    (sum.normal[i][i], sum.gradient[i]) = (1.0, 0.0);
                }
            }
            let Some(step) = cholesky::solve(&sum.normal, &sum.gradient) else {
                break;
            };
            for i in 0..count {
                let floor = match description.parameters[i].name {
                    "c" => 0.0,
                    _ => 0.1 * start[i],
                };
                start[i] = (start[i] - step[i]).max(floor);
            }
        }
        start
    }

    /// Adds a sample's residual and derivatives by the parameters and the touch.
    fn row(&self, law: &AnyLaw, curve: &LoadingCurve, i: usize, touch: f64) -> (f64, [f64; SIZE]) {
        let d = curve.deformation[i] - touch;
        let mut row = [0.0; SIZE];
        if d <= SMALLEST_DISPLACEMENT {
            return (-curve.force[i], row);
        }
        let force = law.evaluate(d, curve.rate[i], d);
        for (k, estimated) in self.estimated.iter().enumerate() {
            if *estimated {
                row[k] = force.by_parameter[k];
            }
        }
        row[SIZE - 1] = -force.by_displacement;
        (force.force - curve.force[i], row)
    }

    fn equations(&self, law: &AnyLaw, curve: &LoadingCurve, touch: f64) -> NormalEquations<SIZE> {
        let mut equations = NormalEquations::ZERO;
        for i in 0..curve.force.len() {
            let (residual, row) = self.row(law, curve, i, touch);
            equations.add(1.0, residual, &row);
        }
        equations
    }

    /// The best first touch of a curve under a law: Gauss-Newton steps, halved
    /// until they help.
    fn best_touch(
        &self,
        law: &AnyLaw,
        curve: &LoadingCurve,
        begin: f64,
    ) -> (f64, NormalEquations<SIZE>) {
        let last = SIZE - 1;
        let span = curve.deformation[curve.deformation.len() - 1] - curve.deformation[0];
        let latest = curve.deformation[0] - CLEARANCE * span;
        let mut touch = begin.min(latest);
        let mut here = self.equations(law, curve, touch);
        for _ in 0..TOUCH_STEPS {
            let mut step = -here.gradient[last] / here.normal[last][last];
            step = step.clamp(-0.25 * span, 0.25 * span).min(latest - touch);
            let mut next = self.equations(law, curve, touch + step);
            let mut halvings = 0;
            while (next.cost.is_nan() || next.cost > here.cost) && halvings < 30 {
                step *= 0.5;
                halvings += 1;
                next = self.equations(law, curve, touch + step);
            }
            if next.cost.is_nan() || next.cost > here.cost || !step.is_finite() {
                break;
            }
            touch += step;
            let gained = here.cost - next.cost;
            here = next;
            if step.abs() < 1e-12 * span || gained <= 1e-15 * here.cost {
                break;
            }
        }
        (touch, here)
    }
}

/// Where the straight line through the points meets zero, and its slope.
fn line_through(x: &[f64], y: &[f64]) -> Option<(f64, f64)> {
    let n = x.len() as f64;
    let (mean_x, mean_y) = (x.iter().sum::<f64>() / n, y.iter().sum::<f64>() / n);
    let xx: f64 = x.iter().map(|x| (x - mean_x).powi(2)).sum();
    let xy: f64 = x
        .iter()
        .zip(y)
        .map(|(x, y)| (x - mean_x) * (y - mean_y))
        .sum();
    let slope = xy / xx;
    (slope > 0.0).then(|| (mean_x - mean_y / slope, slope))
}

impl LeastSquares<LARGEST_PARAMETERS> for Problem<'_> {
    fn evaluate(
        &mut self,
        parameters: &[f64; LARGEST_PARAMETERS],
    ) -> Option<NormalEquations<LARGEST_PARAMETERS>> {
        let count = self.kind.describe().parameters.len();
        let law = AnyLaw(self.kind.from_values(&parameters[..count])?);
        let mut sum = NormalEquations::ZERO;
        for (index, curve) in self.curves.iter().enumerate() {
            let (touch, equations) = self.best_touch(&law, curve, self.touches[index]);
            self.touches[index] = touch;
            let pivot = equations.normal[SIZE - 1][SIZE - 1];
            sum.cost += equations.cost;
            for i in 0..LARGEST_PARAMETERS {
                let part = equations.normal[i][SIZE - 1] / pivot;
                sum.gradient[i] += equations.gradient[i] - part * equations.gradient[SIZE - 1];
                for j in 0..LARGEST_PARAMETERS {
                    sum.normal[i][j] +=
                        equations.normal[i][j] - part * equations.normal[SIZE - 1][j];
                }
            }
        }
        sum.cost.is_finite().then_some(sum)
    }
}

/// Covariance of parameters and touches, and the fit as it is told.
fn report(problem: &Problem, law: Law, stop: Stop) -> CompressionFit {
    let any = AnyLaw(law);
    let free: Vec<usize> = (0..problem.estimated.len())
        .filter(|&i| problem.estimated[i])
        .collect();
    let curves = problem.curves;
    let samples: usize = curves.iter().map(|curve| curve.force.len()).sum();
    let freedom = samples.saturating_sub(free.len() + curves.len()).max(1);
    let mut bread = [[0.0; LARGEST_PARAMETERS]; LARGEST_PARAMETERS];
    let mut meat = bread;
    let (mut cost, mut longest) = (0.0, 1.0_f64);
    let mut touch_parts = Vec::new();
    for (index, curve) in curves.iter().enumerate() {
        let rows: Vec<(f64, [f64; SIZE])> = (0..curve.force.len())
            .map(|i| problem.row(&any, curve, i, problem.touches[index]))
            .collect();
        let residuals: Vec<f64> = rows.iter().map(|(residual, _)| *residual).collect();
        let lag = correlation_lag(&residuals);
        longest = longest.max(lag as f64);
        cost += residuals.iter().map(|r| r * r).sum::<f64>();
        // Derivatives by the parameters with the touch following them.
        let touch: f64 = rows.iter().map(|(_, row)| row[SIZE - 1].powi(2)).sum();
        let mut following = [0.0; LARGEST_PARAMETERS];
        for (i, cell) in following.iter_mut().enumerate() {
            let cross: f64 = rows.iter().map(|(_, row)| row[i] * row[SIZE - 1]).sum();
            *cell = cross / touch;
        }
        let scores: Vec<[f64; LARGEST_PARAMETERS]> = rows
            .iter()
            .map(|(residual, row)| {
                std::array::from_fn(|i| (row[i] - following[i] * row[SIZE - 1]) * residual)
            })
            .collect();
        for (_, row) in &rows {
            let own: [f64; LARGEST_PARAMETERS] =
                std::array::from_fn(|i| row[i] - following[i] * row[SIZE - 1]);
            add_product(&mut bread, &own, &own, 1.0);
        }
        add_scores(&mut meat, &scores, lag);
        let own: Vec<[f64; 1]> = rows.iter().map(|(r, row)| [r * row[SIZE - 1]]).collect();
        let mut spread = [[0.0; 1]; 1];
        add_scores(&mut spread, &own, lag);
        touch_parts.push((following, spread[0][0] / (touch * touch)));
    }
    let scale = samples as f64 / freedom as f64;
    let variance = cost / freedom as f64;
    let independent = inverse_of_free(&bread, &free);
    let covariance = sandwich(&bread, &meat, &free, scale).zip(independent);
    let covariance = covariance
        .map(|(correlated, independent)| at_least(correlated, |i| variance * independent[i][i]));
    let quantile = student(freedom as f64 / longest);
    let estimate = |value: f64, variance: Option<f64>| {
        let sd = variance
            .filter(|v| *v >= 0.0)
            .map_or(f64::INFINITY, f64::sqrt);
        CompressionEstimate {
            value,
            sd,
            low: value - quantile * sd,
            high: value + quantile * sd,
        }
    };
    let values = law.parameters();
    let parameters = values.iter().enumerate().map(|(i, value)| {
        let free = problem.estimated[i];
        free.then(|| estimate(*value, covariance.map(|c| c[i][i])))
    });
    let touches = problem
        .touches
        .iter()
        .zip(&touch_parts)
        .map(|(touch, (following, own))| {
            let carried = covariance.map(|c| quadratic(&c, following));
            estimate(*touch, carried.map(|carried| carried + scale * own))
        });
    CompressionFit {
        law,
        parameters: parameters.collect(),
        touches: touches.collect(),
        rms: (cost / samples as f64).sqrt(),
        correlation_length: longest,
        samples,
        converged: stop == Stop::Converged,
    }
}
