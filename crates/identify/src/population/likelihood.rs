//! An impact's likelihood of the law's parameters, everything else about the
//! impact at its best.

use crate::error::{Error, Unusable};
use crate::fit::estimator::{Estimator, FreeLaw, FreeParameter, Setting};
use crate::fit::plan::{Plan, plan};
use crate::fit::problem::{FitOptions, LawProblem};
use crate::fit::solve::{LARGEST_FREE, Solution, Start, values};
use crate::population::model::Expansion;
use crate::rig::kind::Rig;
use crate::samples::SampleGroup;
use nalgebra::{DMatrix, DVector};
use windfall_contact::laws::any_law::{AnyLaw, LARGEST_PARAMETERS};
use windfall_contact::laws::kind::Law;
use windfall_numerics::least_squares::{LeastSquares, NormalEquations, Stop};
use windfall_signal::impact::Impact;

/// Standard errors around a fit in which it counts as a normal observation.
pub const NORMAL_REACH: f64 = 2.0;
/// The same while a posterior is drawn: draws of one impact in a hundred lie
/// beyond, and what lies there takes most of the time.
pub const DRAWN_REACH: f64 = 3.0;
/// Evaluations in which the nuisances follow the law's parameters.
const MOST: usize = 30;
/// Gain of the cost, in the units of a log-likelihood, below which the nuisances
/// are at their best.
const SETTLED: f64 = 1e-6;

/// One impact's log-likelihood of φ, the free parameters of the law on the axes
/// of the fit (the logarithm of a scale, an exponent as it is):
///
/// ```text
/// ℓ(φ) = −½ [C(φ̃) − C(φ̃₀)],   C(φ) = min over the nuisances of the cost,
/// φ̃ = φ̃₀ + A (φ − φ̂),        Aᵀ (½ C'')(φ̃₀) A = Σ⁻¹
/// ```
///
/// φ̂ and Σ are estimate and covariance of the fit, φ̃₀ the minimum of the smooth
/// cost of averaged samples. The shape of the likelihood is that of the cost;
/// its place and its curvature there are those of the fit, whose covariance
/// knows of correlated noise and of uncertain zeros, which the sum of squares
/// does not.
///
/// # Source
/// Chandler and Bate (2007), Biometrika 94:167, for the adjustment of a
/// likelihood that takes correlated data as independent.
#[derive(Clone, Debug)]
pub struct ImpactLikelihood {
    law: Law,
    setting: Setting,
    groups: Vec<SampleGroup>,
    free: Vec<FreeParameter>,
    base: Start,
    law_count: usize,
    /// φ̂.
    estimate: DVector<f64>,
    /// φ̃₀ and the nuisances there.
    smooth: DVector<f64>,
    lowest: f64,
    /// A.
    adjustment: DMatrix<f64>,
    /// Σ.
    covariance: DMatrix<f64>,
}

/// Cost, half its gradient and half its Gauss-Newton second derivatives.
struct Equations {
    cost: f64,
    gradient: DVector<f64>,
    normal: DMatrix<f64>,
}

/// Fits `problem` to `impact` and returns its likelihood around the fit.
///
/// # Errors
/// As [`fit_impact`](crate::fit::result::fit_impact); [`Error::NotAMember`] where the
/// fit does not determine a likelihood.
pub fn impact_likelihood(
    impact: &Impact,
    rig: &Rig,
    problem: &LawProblem,
    options: &FitOptions,
) -> Result<ImpactLikelihood, Error> {
    rig.check()?;
    let mut plan = plan(impact, rig, problem, options)?;
    let solution = plan.solve(rig)?;
    likelihood_of(plan, &solution, rig).map_err(Error::NotAMember)
}

fn likelihood_of(plan: Plan, solution: &Solution, rig: &Rig) -> Result<ImpactLikelihood, Unusable> {
    let law_count = plan.problem.free_positions().count();
    if solution.stop != Stop::Converged {
        return Err(Unusable::NoConvergence);
    }
    if solution.at_bound[..law_count].iter().any(|side| *side != 0) {
        return Err(Unusable::AtBound);
    }
    if solution.covariance.is_empty() {
        return Err(Unusable::Singular);
    }
    let coordinates = plan.free.iter().zip(&solution.free);
    let coordinates = coordinates.map(|(p, value)| p.coordinate.of(*value));
    let estimate = DVector::from_vec(coordinates.collect());
    let slope = |i: usize| plan.free[i].coordinate.slope(solution.free[i]);
    let covariance = DMatrix::from_fn(law_count, law_count, |i, j| {
        solution.covariance[i][j] / (slope(i) * slope(j))
    });
    let law = plan.problem.kind.with_parameters(&solution.law);
    let mut out = ImpactLikelihood {
        law: law.map_err(|_| Unusable::NoConvergence)?,
        setting: plan.setting(),
        base: (
            solution.law.clone(),
            [
                solution.velocity,
                rig.effective_mass(),
                solution.onset,
                solution.offset,
            ],
        ),
        free: plan.free.clone(),
        law_count,
        smooth: estimate.clone(),
        estimate,
        lowest: 0.0,
        adjustment: DMatrix::identity(law_count, law_count),
        covariance,
        groups: plan.noise.groups,
    };
    out.anchor().ok_or(Unusable::Singular)?;
    Ok(out)
}

impl ImpactLikelihood {
    /// φ̂, the fit.
    pub fn estimate(&self) -> Vec<f64> {
        self.estimate.as_slice()[..self.law_count].to_vec()
    }

    /// Σ, the covariance of φ̂.
    pub fn covariance(&self) -> Vec<Vec<f64>> {
        let row = |i: usize| self.covariance.row(i).iter().copied().collect();
        (0..self.law_count).map(row).collect()
    }

    /// Velocity at first touch of the fit; m/s.
    pub fn velocity(&self) -> f64 {
        self.base.1[0]
    }

    /// Finds the smooth minimum and the adjustment there.
    fn anchor(&mut self) -> Option<()> {
        let (at, equations) = self.settle(self.smooth.clone(), 0)?;
        let (_, curvature) = self.profiled(&equations)?;
        // Half the second derivatives of C are those of −ℓ.
        let shape = curvature.cholesky()?;
        let information = self.covariance.clone().cholesky()?.inverse().cholesky()?;
        self.adjustment = shape
            .l()
            .tr_solve_lower_triangular(&information.l().transpose())?;
        self.lowest = equations.cost;
        self.smooth = at;
        Some(())
    }

    /// The log-likelihood at φ with its gradient and curvature; `None` where the
    /// model cannot be evaluated or is not determined.
    pub fn expand(&self, at: &[f64]) -> Option<Expansion> {
        let law = self.law_count;
        let way = DVector::from_fn(law, |i, _| at[i] - self.estimate[i]);
        let mut u = self.smooth.clone();
        let moved = &self.adjustment * way;
        for i in 0..law {
            u[i] += moved[i];
            let value = self.free[i].coordinate.value(u[i]);
            if !(self.free[i].lower..=self.free[i].upper).contains(&value) {
                return None;
            }
        }
        let (_, equations) = self.settle(u, law)?;
        let (gradient, curvature) = self.profiled(&equations)?;
        let gradient = -self.adjustment.tr_mul(&gradient);
        let curvature = self.adjustment.tr_mul(&curvature) * &self.adjustment;
        let row = |i: usize| curvature.row(i).iter().copied().collect();
        Some(Expansion {
            value: -0.5 * (equations.cost - self.lowest),
            gradient: gradient.as_slice().to_vec(),
            curvature: (0..law).map(row).collect(),
        })
    }

    /// As [`expand`](Self::expand), but where φ is within `reach` standard errors
    /// of the fit, the impact is the normal observation that its fit and
    /// covariance say it is.
    ///
    /// Samples that the onset passes leave kinks in the likelihood, which shift
    /// what it says by some tenths of a standard error from one point to the
    /// next (docs/guide/src/compared/onset.md); near the fit the fit knows better.
    pub fn expand_beyond(&self, reach: f64, at: &[f64]) -> Option<Expansion> {
        let law = self.law_count;
        let way = DVector::from_fn(law, |i, _| at[i] - self.estimate[i]);
        let precision = self.covariance.clone().cholesky()?.inverse();
        let gradient = -&precision * &way;
        let square = -gradient.dot(&way);
        if square > reach * reach {
            return self.expand(at);
        }
        let row = |i: usize| precision.row(i).iter().copied().collect();
        Some(Expansion {
            value: -0.5 * square,
            gradient: gradient.as_slice().to_vec(),
            curvature: (0..law).map(row).collect(),
        })
    }

    /// Gradient and second derivatives by the law's parameters with the
    /// nuisances at their best.
    fn profiled(&self, equations: &Equations) -> Option<(DVector<f64>, DMatrix<f64>)> {
        let (law, all) = (self.law_count, self.free.len());
        let gradient = equations.gradient.rows(0, law).clone_owned();
        let normal = equations.normal.view((0, 0), (law, law)).clone_owned();
        if law == all {
            return Some((gradient, normal));
        }
        let rest = all - law;
        let own = equations
            .normal
            .view((law, law), (rest, rest))
            .clone_owned();
        let cross = equations.normal.view((law, 0), (rest, law)).clone_owned();
        let factor = own.cholesky()?;
        let gradient = gradient - cross.tr_mul(&factor.solve(&equations.gradient.rows(law, rest)));
        Some((gradient, normal - cross.tr_mul(&factor.solve(&cross))))
    }

    /// Minimum of the cost by the coordinates from `first` on.
    fn settle(&self, start: DVector<f64>, first: usize) -> Option<(DVector<f64>, Equations)> {
        let count = start.len() - first;
        let (mut at, mut equations) = (start.clone(), self.equations(&start)?);
        for _ in 0..MOST {
            let normal = equations.normal.view((first, first), (count, count));
            let gradient = equations.gradient.rows(first, count);
            let step = normal.clone_owned().cholesky()?.solve(&gradient);
            let gain = 0.5 * step.dot(&gradient);
            if gain < SETTLED {
                break;
            }
            let mut factor = 1.0;
            let next = loop {
                let mut next = at.clone();
                let mut moved = next.rows_mut(first, count);
                moved.axpy(-factor, &step, 1.0);
                match self.equations(&next) {
                    Some(found) if found.cost < equations.cost => break Some((next, found)),
                    _ if factor < 1e-3 => break None,
                    _ => factor *= 0.5,
                }
            };
            // Nothing lower: the cost is as low as its rounding lets it be.
            let Some(next) = next else { break };
            (at, equations) = next;
        }
        Some((at, equations))
    }

    fn equations(&self, u: &DVector<f64>) -> Option<Equations> {
        let lanes = self.free.iter().filter(|p| p.target.needs_lane()).count();
        match (&self.law, self.free.len(), lanes) {
            (Law::KuwabaraKono(law), ..=5, ..=3) => self.evaluate::<_, 2, 4, 5>(*law, u),
            (law, _, _) => self.evaluate::<_, LARGEST_PARAMETERS, 8, LARGEST_FREE>(AnyLaw(*law), u),
        }
    }

    fn evaluate<L, const N: usize, const W: usize, const P: usize>(
        &self,
        law: L,
        u: &DVector<f64>,
    ) -> Option<Equations>
    where
        L: FreeLaw<N>,
    {
        let base = values(&self.base);
        let mut estimator =
            Estimator::<L, N, W, P>::new(law, self.setting, &self.groups, &self.free, base);
        let mut at = [0.0; P];
        at[..u.len()].copy_from_slice(u.as_slice());
        let NormalEquations {
            cost,
            gradient,
            normal,
        } = estimator.evaluate(&at)?;
        cost.is_finite().then(|| Equations {
            cost,
            gradient: DVector::from_fn(u.len(), |i, _| gradient[i]),
            normal: DMatrix::from_fn(u.len(), u.len(), |i, j| normal[i][j]),
        })
    }
}
