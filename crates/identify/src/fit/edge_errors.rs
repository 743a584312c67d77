//! How uncertain the edges of a count leave the parameters.

use crate::samples::{Quantity, SampleGroup};
use windfall_numerics::least_squares::NormalEquations;

/// Phases of the clock over which the errors of edges are averaged.
const PHASES: usize = 8;

/// Variance of the gradient Σ w J e by the errors e of edges. An edge lies somewhere between two
/// readings, and where follows from the motion, so that errors of neighbours cancel or add up.
/// The square of the gradient is averaged over the phases that the clock might have had: each
/// phase moves every error on by the same part of its span. The rest of the variance (lines
/// that are out of place) is taken as independent.
///
/// * `residuals`, `jacobian`: of the edges; the derivatives may be more than P a row, which
///   are then left out
/// * `inflation`: of the sums, by what else correlates the residuals
pub(crate) fn meat_of_edges<const P: usize>(
    group: &SampleGroup,
    (residuals, jacobian): (&[f64], &[f64]),
    inflation: f64,
) -> [[f64; P]; P] {
    let mut meat = [[0.0; P]; P];
    let mut sums = [[0.0; P]; PHASES];
    let part = |place: f64| place - place.floor();
    let rows = jacobian.chunks_exact(jacobian.len() / residuals.len());
    for (i, (row, edge)) in rows.zip(&group.edges).enumerate() {
        let weight = group.weight_of(Quantity::Displacement, i);
        let place = match edge.span == 0.0 {
            true => 0.5,
            false => part(residuals[i] / edge.span + 0.5),
        };
        for (phase, sum) in sums.iter_mut().enumerate() {
            let moved = place + (phase as f64 + 0.5) / PHASES as f64;
            let moved = if moved < 1.0 { moved } else { moved - 1.0 };
            let error = (moved - 0.5) * edge.span;
            for (sum, derivative) in sum.iter_mut().zip(row) {
                *sum += weight * error * derivative;
            }
        }
        let own = weight * weight * edge.beyond;
        for (meat, one) in meat.iter_mut().zip(row) {
            for (meat, other) in meat.iter_mut().zip(row) {
                *meat += own * one * other;
            }
        }
    }
    for sum in &sums {
        for p in 0..P {
            for q in 0..P {
                meat[p][q] += inflation * sum[p] * sum[q] / PHASES as f64;
            }
        }
    }
    meat
}

/// By how much the variance of what is estimated from edges alone is wider than if their
/// errors were independent: the mean over all directions of the parameters, tr(N⁻¹ M) / P.
/// 1 where edges alone determine nothing.
///
/// * `residuals`, `jacobian`: of the edges
/// * `parameters`: number of free parameters, at most P
pub(crate) fn edge_inflation<const P: usize>(
    group: &SampleGroup,
    (residuals, jacobian): (&[f64], &[f64]),
    parameters: usize,
) -> f64 {
    let meat = meat_of_edges::<P>(group, (residuals, jacobian), 1.0);
    let mut equations = NormalEquations::<P>::ZERO;
    for (i, own) in jacobian
        .chunks_exact(jacobian.len() / residuals.len())
        .enumerate()
    {
        let mut row = [0.0; P];
        for (row, own) in row.iter_mut().zip(own) {
            *row = *own;
        }
        equations.add(group.weight_of(Quantity::Displacement, i), 0.0, &row);
    }
    let Some(bread) = equations.inverse(parameters) else {
        return 1.0;
    };
    let mut trace = 0.0;
    for p in 0..parameters {
        for q in 0..parameters {
            trace += bread[p][q] * meat[q][p];
        }
    }
    trace / parameters as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::residual::Rows;
    use crate::fit::uncertainty::covariance;
    use crate::samples::EdgeError;

    /// Motion that turns around under a constant force, read by a clock of any phase: the
    /// deviations of a fitted place and time are those of 400 such recordings.
    #[test]
    fn closed_form_variance_of_edges() {
        let (speed, slowing, interval, count) = (0.4_f64, 80.0, 5e-6, 8.8e-6);
        let half = (0.5 * speed * speed / slowing / count) as usize;
        // Both ways past each line, and the velocity there.
        let passes: Vec<(f64, f64)> = (1..2 * half)
            .map(|i| {
                let (line, way) = if i < half {
                    (i, 1.0)
                } else {
                    (2 * half - i, -1.0)
                };
                let rate = way * (speed * speed - 2.0 * slowing * line as f64 * count).sqrt();
                ((speed - rate) / slowing, rate)
            })
            .collect();
        let spans: Vec<f64> = passes.iter().map(|(_, rate)| rate * interval).collect();
        let variances = spans.iter().map(|s| s * s / 12.0 + 1e-20);
        let weights: Vec<f64> = variances.map(|v| 1.0 / v).collect();
        let jacobian: Vec<f64> = passes.iter().flat_map(|(_, rate)| [1.0, *rate]).collect();
        let mut equations = NormalEquations::<2>::ZERO;
        let rows = |i: usize| [jacobian[2 * i], jacobian[2 * i + 1]];
        for i in 0..passes.len() {
            equations.add(weights[i], 0.0, &rows(i));
        }
        let bread = equations.inverse(2).unwrap();
        let (mut squares, mut told) = ([0.0; 2], [0.0; 2]);
        let recordings = 400;
        for n in 0..recordings {
            let phase = n as f64 / f64::from(recordings);
            let errors = passes.iter().zip(&spans).map(|((time, _), span)| {
                let place = time / interval + phase;
                (place - place.floor() - 0.5) * span
            });
            let mut residuals: Vec<f64> = errors.collect();
            let mut score = [0.0; 2];
            for (i, residual) in residuals.iter().enumerate() {
                for p in 0..2 {
                    score[p] += weights[i] * residual * rows(i)[p];
                }
            }
            let off: [f64; 2] =
                std::array::from_fn(|p| bread[p][0] * score[0] + bread[p][1] * score[1]);
            for (i, residual) in residuals.iter_mut().enumerate() {
                *residual -= off[0] * rows(i)[0] + off[1] * rows(i)[1];
            }
            let times: Vec<f64> = passes.iter().map(|pass| pass.0).collect();
            let edges = spans.iter().map(|span| EdgeError {
                span: *span,
                beyond: 0.0,
            });
            let group = SampleGroup::new(&times, [Some((&residuals, 1.0)), None, None, None])
                .with_relative_weights(Quantity::Displacement, &weights)
                .with_edges(edges.collect());
            let mut own = Rows::default();
            own.residuals.push([residuals, vec![], vec![], vec![]]);
            own.jacobian
                .push([jacobian.clone(), vec![], vec![], vec![]]);
            let none = NormalEquations::ZERO;
            let found = covariance(&equations, (&own, &[group]), &[0.0; 4], &none, 2).unwrap();
            for p in 0..2 {
                squares[p] += off[p] * off[p] / f64::from(recordings);
                told[p] += found[p][p] / f64::from(recordings);
            }
        }
        for p in 0..2 {
            let (ratio, independent) = (told[p] / squares[p], bread[p][p] / squares[p]);
            assert!((0.7..1.5).contains(&ratio), "{p}: {ratio}");
            // As if the errors were independent: 2.8 and 0.74.
            assert!(
                ratio.ln().abs() < independent.ln().abs(),
                "{p}: {ratio} {independent}"
            );
        }
    }
}
