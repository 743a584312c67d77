//! Least squares of a law against slow loading curves, each with a first touch of its own.

use windfall_contact::law::{ContactLaw, SMALLEST_DISPLACEMENT};
use windfall_contact::laws::any_law::{AnyLaw, LARGEST_PARAMETERS};
use windfall_contact::laws::kind::LawKind;
use windfall_numerics::cholesky;
use windfall_numerics::least_squares::{LeastSquares, NormalEquations};

/// Parameters at most, with one first touch.
pub(crate) const SIZE: usize = LARGEST_PARAMETERS + 1;

/// Steps of the search for a first touch.
const TOUCH_STEPS: usize = 60;

/// Turns between touches and parameters before the minimiser begins.
const TURNS: usize = 12;

/// Distance that a touch keeps from the first sample, as a part of the curve's
/// deformation: nearer, the slope of some laws is without bound.
const CLEARANCE: f64 = 1e-3;

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

/// A law against loading curves, as a function of the law's parameters.
pub(crate) struct Problem<'a> {
    kind: LawKind,
    pub curves: &'a [LoadingCurve],
    /// Which parameters are estimated.
    pub estimated: Vec<bool>,
    /// First touch of each curve under the parameters last evaluated; m.
    pub touches: Vec<f64>,
}

impl<'a> Problem<'a> {
    pub fn new(kind: LawKind, curves: &'a [LoadingCurve], held: &[Option<f64>]) -> Self {
        Self {
            kind,
            curves,
            estimated: held.iter().map(Option::is_none).collect(),
            touches: Vec::new(),
        }
    }

    /// Start from a straight line through F^(1/n): its zero is the touch, its slope the
    /// stiffness.
    pub(crate) fn start(&mut self, held: &[Option<f64>]) -> Option<[f64; LARGEST_PARAMETERS]> {
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
            let (touch, slope) = line_through(&curve.deformation[from..], &roots[from..])?;
            self.touches.push(touch.min(curve.deformation[from]));
            stiffness.push(slope.max(0.0).powf(exponent));
        }
        let mean = stiffness.iter().sum::<f64>() / stiffness.len() as f64;
        let mut start = [0.0; LARGEST_PARAMETERS];
        let damping = description.damping.map(|(name, _)| name);
        for (i, parameter) in description.parameters.iter().enumerate() {
            start[i] = held[i].unwrap_or(match Some(parameter.name) {
                name if name == description.linear.first().copied() => mean,
                name if name == description.exponent_name() => exponent,
                name if name == damping => 0.0,
                _ => parameter.typical,
            });
        }
        (mean > 0.0 && mean.is_finite()).then_some(start)
    }

    /// A start where damping has some part of the force.
    pub(crate) fn damped(
        &self,
        start: &[f64; LARGEST_PARAMETERS],
        part: f64,
    ) -> [f64; LARGEST_PARAMETERS] {
        let mut damped = *start;
        let description = self.kind.describe();
        let &[stiffness, damping] = description.linear else {
            return damped;
        };
        let indices = (
            description.index_of(stiffness),
            description.index_of(damping),
        );
        let (Some(k), Some(c)) = indices else {
            return damped;
        };
        if !(self.estimated[k] && self.estimated[c]) {
            return damped;
        }
        let ends = self.curves.iter().zip(&self.touches).map(|(curve, touch)| {
            let last = curve.force.len() - 1;
            let d = curve.deformation[last] - touch;
            (d, curve.rate[last], curve.force[last])
        });
        let fastest = ends.max_by(|a, b| a.1.total_cmp(&b.1));
        let law = self
            .kind
            .from_values(&start[..description.parameters.len()]);
        if let (Some((d, v, force)), Some(law)) = (fastest, law)
            && v > 0.0
            && d > 0.0
        {
            damped[k] = (1.0 - part) * start[k];
            damped[c] = part * force / AnyLaw(law).evaluate(d, v, d).by_parameter[c];
        }
        damped
    }

    /// A start from which the minimiser converges: the parameters that the force
    /// is linear in and the touches, each found with the other held.
    pub(crate) fn refined(
        &mut self,
        mut start: [f64; LARGEST_PARAMETERS],
        held: &[Option<f64>],
    ) -> [f64; LARGEST_PARAMETERS] {
        let description = self.kind.describe();
        let count = description.parameters.len();
        let linear = |i: usize| {
            held[i].is_none() && description.linear.contains(&description.parameters[i].name)
        };
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
                let damping = description.linear.get(1) == Some(&description.parameters[i].name);
                let floor = if damping { 0.0 } else { 0.1 * start[i] };
                start[i] = (start[i] - step[i]).max(floor);
            }
        }
        start
    }

    /// Adds a sample's residual and derivatives by the parameters and the touch.
    pub(crate) fn row(
        &self,
        law: &AnyLaw,
        curve: &LoadingCurve,
        i: usize,
        touch: f64,
    ) -> (f64, [f64; SIZE]) {
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
