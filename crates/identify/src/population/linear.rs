//! The linear mixed model of impacts that are each known as a normal
//! observation of the fruit's parameters: restricted or full likelihood with
//! exact gradient.

use nalgebra::{Const, DMatrix, DVector, Dyn, OMatrix, SMatrix, SVector};
use std::f64::consts::TAU;
use std::ops::Range;

/// Which likelihood of the variances is maximised.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Likelihood {
    /// Restricted: corrected for the estimated fixed effects, so that standard
    /// deviations between a few dozen fruit are not too small.
    #[default]
    Restricted,
    /// Full.
    Full,
}

/// Impacts in the order of their fruit: z_ij = X_ij β + b_i + e_ij + ε_ij with
/// b ~ N(0, Ω), e ~ N(0, Δ), ε ~ N(0, V_ij), V known.
#[derive(Clone, Debug)]
pub(crate) struct LinearProblem<const Q: usize> {
    /// Impacts of each fruit.
    pub fruit: Vec<Range<usize>>,
    /// Columns of the design, the same for every parameter.
    pub columns: usize,
    /// Rows of the design, one impact after the other.
    pub design: Vec<f64>,
    /// z.
    pub observed: Vec<SVector<f64, Q>>,
    /// V.
    pub noise: Vec<SMatrix<f64, Q, Q>>,
    /// Likelihood.
    pub likelihood: Likelihood,
}

/// The likelihood at some Ω and Δ, with the best fixed effects.
#[derive(Clone, Debug)]
pub(crate) struct LinearValue<const Q: usize> {
    /// −2 log likelihood.
    pub deviance: f64,
    /// G with d(deviance) = tr(G dΩ).
    pub by_between: SMatrix<f64, Q, Q>,
    /// G with d(deviance) = tr(G dΔ).
    pub by_within: SMatrix<f64, Q, Q>,
    /// Fixed effects, parameter by parameter.
    pub effects: DVector<f64>,
    /// Their covariance.
    pub covariance: DMatrix<f64>,
}

/// What is known of one impact's own parameters, given everything.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mode<const Q: usize> {
    /// X β + b + e.
    pub value: SVector<f64, Q>,
    /// X β + b.
    pub fruit: SVector<f64, Q>,
    /// Covariance of the value, β held.
    pub covariance: SMatrix<f64, Q, Q>,
}

/// Q rows, one column per fixed effect.
type Wide<const Q: usize> = OMatrix<f64, Const<Q>, Dyn>;

/// Weights of one fruit: Σ⁻¹ = W − W T W with blocks.
struct FruitWeights<const Q: usize> {
    each: Vec<SMatrix<f64, Q, Q>>,
    sum: SMatrix<f64, Q, Q>,
    shared: SMatrix<f64, Q, Q>,
    log_determinant: f64,
}

fn fruit_weights<const Q: usize>(
    noise: &[SMatrix<f64, Q, Q>],
    root: &SMatrix<f64, Q, Q>,
    within: &SMatrix<f64, Q, Q>,
) -> Option<FruitWeights<Q>> {
    let mut out = FruitWeights {
        each: Vec::with_capacity(noise.len()),
        sum: SMatrix::zeros(),
        shared: SMatrix::zeros(),
        log_determinant: 0.0,
    };
    for v in noise {
        let factor = (v + within).cholesky()?;
        out.log_determinant += 2.0 * (0..Q).map(|i| factor.l_dirty()[(i, i)].ln()).sum::<f64>();
        let weight = factor.inverse();
        out.sum += weight;
        out.each.push(weight);
    }
    // T = (Ω⁻¹ + W)⁻¹ = R (I + Rᵀ W R)⁻¹ Rᵀ with Ω = R Rᵀ, also where Ω is singular.
    let mixed = (SMatrix::identity() + root.transpose() * out.sum * root).cholesky()?;
    out.log_determinant += 2.0 * (0..Q).map(|i| mixed.l_dirty()[(i, i)].ln()).sum::<f64>();
    out.shared = root * mixed.inverse() * root.transpose();
    Some(out)
}

impl<const Q: usize> LinearProblem<Q> {
    fn row(&self, impact: usize) -> &[f64] {
        &self.design[impact * self.columns..(impact + 1) * self.columns]
    }

    /// X β of one impact.
    pub(crate) fn mean(&self, impact: usize, effects: &DVector<f64>) -> SVector<f64, Q> {
        let row = self.row(impact);
        SVector::from_fn(|a, _| {
            let own = row.iter().enumerate();
            own.map(|(c, x)| x * effects[a * self.columns + c]).sum()
        })
    }

    /// Likelihood, gradient and fixed effects at Ω = R Rᵀ and Δ; `None` where a
    /// matrix is not positive definite.
    pub(crate) fn evaluate(
        &self,
        root: &SMatrix<f64, Q, Q>,
        within: &SMatrix<f64, Q, Q>,
    ) -> Option<LinearValue<Q>> {
        let weights = self.weights(root, within)?;
        let (normal, right) = self.normal_equations(&weights);
        let factor = normal.cholesky()?;
        let effects = factor.solve(&right);
        let covariance = factor.inverse();
        let count = (self.observed.len() * Q) as f64;
        let mut deviance: f64 = weights.iter().map(|w| w.log_determinant).sum();
        deviance += count * TAU.ln();
        if self.likelihood == Likelihood::Restricted {
            let fixed = effects.len();
            let diagonal = (0..fixed).map(|i| factor.l_dirty()[(i, i)].ln());
            deviance += 2.0 * diagonal.sum::<f64>() - fixed as f64 * TAU.ln();
        }
        let mut value = LinearValue {
            deviance,
            by_between: SMatrix::zeros(),
            by_within: SMatrix::zeros(),
            effects,
            covariance,
        };
        for (range, weights) in self.fruit.iter().zip(&weights) {
            self.add_fruit(&mut value, range, weights);
        }
        value.deviance.is_finite().then_some(value)
    }

    fn weights(
        &self,
        root: &SMatrix<f64, Q, Q>,
        within: &SMatrix<f64, Q, Q>,
    ) -> Option<Vec<FruitWeights<Q>>> {
        let fruit = self.fruit.iter();
        fruit
            .map(|range| fruit_weights(&self.noise[range.clone()], root, within))
            .collect()
    }

    /// Σ W_j X_j of one fruit, Q rows.
    fn weighted_design(&self, range: &Range<usize>, weights: &FruitWeights<Q>) -> Wide<Q> {
        let p = self.columns;
        let mut out = Wide::<Q>::zeros(Q * p);
        for (impact, weight) in range.clone().zip(&weights.each) {
            self.add_weighted_row(&mut out, impact, weight);
        }
        out
    }

    fn add_weighted_row(&self, out: &mut Wide<Q>, impact: usize, weight: &SMatrix<f64, Q, Q>) {
        for (c, x) in self.row(impact).iter().enumerate() {
            for a in 0..Q {
                for b in 0..Q {
                    out[(a, b * self.columns + c)] += weight[(a, b)] * x;
                }
            }
        }
    }

    /// Xᵀ Σ⁻¹ X and Xᵀ Σ⁻¹ z.
    fn normal_equations(&self, weights: &[FruitWeights<Q>]) -> (DMatrix<f64>, DVector<f64>) {
        let p = self.columns;
        let mut normal = DMatrix::zeros(Q * p, Q * p);
        let mut right = DVector::zeros(Q * p);
        for (range, weights) in self.fruit.iter().zip(weights) {
            let mut weighted = SVector::<f64, Q>::zeros();
            for (impact, weight) in range.clone().zip(&weights.each) {
                let row = self.row(impact);
                let z = weight * self.observed[impact];
                weighted += z;
                for (c, x) in row.iter().enumerate() {
                    for a in 0..Q {
                        right[a * p + c] += x * z[a];
                        for (d, y) in row.iter().enumerate() {
                            for b in 0..Q {
                                normal[(a * p + c, b * p + d)] += weight[(a, b)] * x * y;
                            }
                        }
                    }
                }
            }
            let design = self.weighted_design(range, weights);
            let shared = weights.shared * &design;
            normal -= design.transpose() * &shared;
            right -= shared.transpose() * weighted;
        }
        (normal, right)
    }

    /// Residuals of one fruit and their gradient.
    fn add_fruit(
        &self,
        value: &mut LinearValue<Q>,
        range: &Range<usize>,
        weights: &FruitWeights<Q>,
    ) {
        let effects = &value.effects;
        let residual = |impact: usize| self.observed[impact] - self.mean(impact, effects);
        let mut total = SVector::<f64, Q>::zeros();
        for (impact, weight) in range.clone().zip(&weights.each) {
            total += weight * residual(impact);
        }
        let shift = weights.shared * total;
        let restricted = self.likelihood == Likelihood::Restricted;
        let (design, fruit_effect) = match restricted {
            true => {
                let design = self.weighted_design(range, weights);
                let shared = weights.shared * &design;
                (design, shared)
            }
            false => (Wide::zeros(0), Wide::zeros(0)),
        };
        let mut square = 0.0;
        let mut by_within = SMatrix::<f64, Q, Q>::zeros();
        for (impact, weight) in range.clone().zip(&weights.each) {
            let r = residual(impact);
            let u = weight * (r - shift);
            square += r.dot(&u);
            by_within += weight - weight * weights.shared * weight - u * u.transpose();
            if restricted {
                // Rows of Σ⁻¹ X.
                let mut own = Wide::<Q>::zeros(design.ncols());
                self.add_weighted_row(&mut own, impact, weight);
                own -= weight * &fruit_effect;
                by_within -= quadratic::<Q>(&own, &value.covariance);
            }
        }
        let u = total - weights.sum * shift;
        let mut by_between =
            weights.sum - weights.sum * weights.shared * weights.sum - u * u.transpose();
        if restricted {
            let own = &design - weights.sum * &fruit_effect;
            by_between -= quadratic::<Q>(&own, &value.covariance);
        }
        value.deviance += square;
        value.by_between += by_between;
        value.by_within += by_within;
    }

    /// Modes of every impact; `None` where a matrix is not positive definite.
    pub(crate) fn modes(
        &self,
        root: &SMatrix<f64, Q, Q>,
        within: &SMatrix<f64, Q, Q>,
        effects: &DVector<f64>,
    ) -> Option<Vec<Mode<Q>>> {
        let between = root * root.transpose();
        let mut out = Vec::with_capacity(self.observed.len());
        for range in &self.fruit {
            let weights = fruit_weights(&self.noise[range.clone()], root, within)?;
            let mut total = SVector::<f64, Q>::zeros();
            for (impact, weight) in range.clone().zip(&weights.each) {
                total += weight * (self.observed[impact] - self.mean(impact, effects));
            }
            let deviation = weights.shared * total;
            let all = weights.sum - weights.sum * weights.shared * weights.sum;
            for (impact, weight) in range.clone().zip(&weights.each) {
                let fruit = self.mean(impact, effects) + deviation;
                let value = fruit + within * weight * (self.observed[impact] - fruit);
                let column = weight - weights.sum * weights.shared * weight;
                let own = weight - weight * weights.shared * weight;
                let cross = between * column * within;
                let known =
                    between * all * between + cross + cross.transpose() + within * own * within;
                out.push(Mode {
                    value,
                    fruit,
                    covariance: between + within - known,
                });
            }
        }
        Some(out)
    }
}

fn quadratic<const Q: usize>(rows: &Wide<Q>, covariance: &DMatrix<f64>) -> SMatrix<f64, Q, Q> {
    rows * covariance * rows.transpose()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two parameters, four fruit with unequal numbers.
    fn problem(likelihood: Likelihood) -> LinearProblem<2> {
        let fruit = vec![0..3, 3..5, 5..6, 6..10];
        let value = |i: usize, a: f64| (a * (i as f64 + 1.0)).sin();
        let design = (0..10)
            .flat_map(|i| [1.0, value(i, 0.7)])
            .collect::<Vec<_>>();
        LinearProblem {
            fruit,
            columns: 2,
            design,
            observed: (0..10)
                .map(|i| SVector::<f64, 2>::new(value(i, 1.3), 2.0 + value(i, 2.1)))
                .collect(),
            noise: (0..10)
                .map(|i| {
                    let cross = 0.02 * value(i, 0.3);
                    SMatrix::<f64, 2, 2>::new(0.1, cross, cross, 0.2 + 0.1 * value(i, 0.9))
                })
                .collect(),
            likelihood,
        }
    }

    fn covariances() -> (SMatrix<f64, 2, 2>, SMatrix<f64, 2, 2>) {
        (
            SMatrix::<f64, 2, 2>::new(0.4, 0.1, 0.1, 0.3),
            SMatrix::<f64, 2, 2>::new(0.05, -0.02, -0.02, 0.08),
        )
    }

    fn root(covariance: &SMatrix<f64, 2, 2>) -> SMatrix<f64, 2, 2> {
        covariance.cholesky().unwrap().l()
    }

    /// The same likelihood from dense matrices: log det Σ, log det XᵀΣ⁻¹X and
    /// the residual form of generalised least squares.
    fn dense(
        problem: &LinearProblem<2>,
        covariances: (SMatrix<f64, 2, 2>, SMatrix<f64, 2, 2>),
    ) -> f64 {
        let n = problem.observed.len() * 2;
        let mut sigma = DMatrix::<f64>::zeros(n, n);
        let mut x = DMatrix::<f64>::zeros(n, 4);
        let z = DVector::from_fn(n, |i, _| problem.observed[i / 2][i % 2]);
        for range in &problem.fruit {
            for i in range.clone() {
                for j in range.clone() {
                    let own = match i == j {
                        true => covariances.1 + problem.noise[i],
                        false => SMatrix::zeros(),
                    };
                    let block = covariances.0 + own;
                    for a in 0..2 {
                        for b in 0..2 {
                            sigma[(2 * i + a, 2 * j + b)] = block[(a, b)];
                        }
                        x[(2 * i + a, 2 * a)] = 1.0;
                        x[(2 * i + a, 2 * a + 1)] = problem.design[2 * i + 1];
                    }
                }
            }
        }
        let inverse = sigma.clone().try_inverse().unwrap();
        let normal = x.transpose() * &inverse * &x;
        let beta = normal.clone().try_inverse().unwrap() * x.transpose() * &inverse * &z;
        let r = &z - &x * beta;
        let mut deviance = sigma.determinant().ln() + (r.transpose() * inverse * r)[(0, 0)];
        deviance += n as f64 * TAU.ln();
        if problem.likelihood == Likelihood::Restricted {
            deviance += normal.determinant().ln() - 4.0 * TAU.ln();
        }
        deviance
    }

    #[test]
    fn closed_form_deviance_of_dense_matrices() {
        for likelihood in [Likelihood::Restricted, Likelihood::Full] {
            let problem = problem(likelihood);
            let covariances = covariances();
            let found = problem
                .evaluate(&root(&covariances.0), &covariances.1)
                .unwrap();
            assert!((found.deviance - dense(&problem, covariances)).abs() < 1e-9);
        }
    }

    #[test]
    fn derivative_of_the_deviance() {
        for likelihood in [Likelihood::Restricted, Likelihood::Full] {
            let problem = problem(likelihood);
            let (between, within) = covariances();
            let found = problem.evaluate(&root(&between), &within).unwrap();
            for (a, b) in [(0, 0), (0, 1), (1, 1)] {
                let mut change = SMatrix::<f64, 2, 2>::zeros();
                change[(a, b)] = 1e-5;
                change[(b, a)] = 1e-5;
                let at = |one: f64, other: f64| {
                    let value = problem
                        .evaluate(&root(&(between + one * change)), &(within + other * change));
                    value.unwrap().deviance
                };
                let step = |up: f64, down: f64| (up - down) / 2.0;
                let expected = step(at(1.0, 0.0), at(-1.0, 0.0));
                let told = (found.by_between * change).trace();
                assert!((told - expected).abs() < 1e-9, "{told} {expected}");
                let expected = step(at(0.0, 1.0), at(0.0, -1.0));
                let told = (found.by_within * change).trace();
                assert!((told - expected).abs() < 1e-9, "{told} {expected}");
            }
        }
    }

    /// Conditional mean and covariance of a normal vector.
    #[test]
    fn closed_form_modes() {
        let problem = problem(Likelihood::Full);
        let (between, within) = covariances();
        let value = problem.evaluate(&root(&between), &within).unwrap();
        let modes = problem
            .modes(&root(&between), &within, &value.effects)
            .unwrap();
        let range = 6..10;
        let n = 2 * range.len();
        let own = |i: usize, j: usize, m: &SMatrix<f64, 2, 2>| match i / 2 == j / 2 {
            true => m[(i % 2, j % 2)],
            false => 0.0,
        };
        let prior = DMatrix::from_fn(n, n, |i, j| between[(i % 2, j % 2)] + own(i, j, &within));
        let noise = DMatrix::from_fn(n, n, |i, j| own(i, j, &problem.noise[range.start + i / 2]));
        let residual = DVector::from_fn(n, |i, _| {
            let impact = range.start + i / 2;
            (problem.observed[impact] - problem.mean(impact, &value.effects))[i % 2]
        });
        let gain = &prior * (&prior + noise).try_inverse().unwrap();
        let mean = &gain * residual;
        let covariance = &prior - &gain * &prior;
        for (k, impact) in range.enumerate() {
            let expected = problem.mean(impact, &value.effects);
            for a in 0..2 {
                let told = modes[impact].value[a];
                assert!((told - expected[a] - mean[2 * k + a]).abs() < 1e-12);
                for b in 0..2 {
                    let told = modes[impact].covariance[(a, b)];
                    assert!((told - covariance[(2 * k + a, 2 * k + b)]).abs() < 1e-12);
                }
            }
        }
    }
}
