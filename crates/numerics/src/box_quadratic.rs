//! Minimum of a small convex quadratic within a box.

use crate::cholesky;

/// A slope below this fraction of the terms that add up to it is rounding.
const ROUNDING: f64 = 32.0 * f64::EPSILON;

/// What one variable may do.
#[derive(Clone, Copy, PartialEq)]
enum Hold {
    /// Moves.
    Free,
    /// Stays on its lower bound.
    Lower,
    /// Stays on its upper bound.
    Upper,
    /// Has no effect, or no room.
    Fixed,
}

/// The x in `lower` ≤ x ≤ `upper` that minimises ½ xᵀ A x + gᵀ x, searched from
/// x = 0, which the box must contain. `None` when A is singular.
///
/// Variables without diagonal in A stay at 0.
///
/// # Numerics
/// Primal active set: exact but for rounding, and never above its start, as
/// each round walks to the minimum over the free variables, or to the first
/// bound on the way.
///
/// # Source
/// Nocedal and Wright (2006), Numerical Optimization, algorithm 16.3.
pub(crate) fn minimum_in_box<const P: usize>(
    matrix: &[[f64; P]; P],
    gradient: &[f64; P],
    lower: &[f64; P],
    upper: &[f64; P],
) -> Option<[f64; P]> {
    let mut hold: [Hold; P] = std::array::from_fn(|i| {
        if matrix[i][i] <= 0.0 || lower[i] >= upper[i] {
            Hold::Fixed
        } else if lower[i] >= 0.0 && gradient[i] > 0.0 {
            Hold::Lower
        } else if upper[i] <= 0.0 && gradient[i] < 0.0 {
            Hold::Upper
        } else {
            Hold::Free
        }
    });
    let mut x = [0.0; P];
    // Each round puts a variable on its bound or releases one. Few are needed;
    // the limit is for rounding, and leaves an x that is in the box.
    for _ in 0..4 * (P + 1) {
        let target = free_minimum(matrix, gradient, &hold, &x)?;
        match first_bound(lower, upper, &hold, &x, &target) {
            Some((i, bound, fraction)) => {
                for j in 0..P {
                    x[j] += fraction * (target[j] - x[j]);
                }
                x[i] = match bound {
                    Hold::Lower => lower[i],
                    _ => upper[i],
                };
                hold[i] = bound;
            }
            None => {
                x = target;
                match held_in_vain(matrix, gradient, &hold, &x) {
                    Some(i) => hold[i] = Hold::Free,
                    None => break,
                }
            }
        }
    }
    Some(x)
}

/// Minimum over the free variables, the others staying where they are.
fn free_minimum<const P: usize>(
    matrix: &[[f64; P]; P],
    gradient: &[f64; P],
    hold: &[Hold; P],
    x: &[f64; P],
) -> Option<[f64; P]> {
    let held = hold.map(|hold| hold != Hold::Free);
    let mut reduced = *matrix;
    let mut right = gradient.map(|g| -g);
    for i in 0..P {
        for j in 0..P {
            if held[j] && !held[i] {
                right[i] -= matrix[i][j] * x[j];
            }
            if held[i] || held[j] {
                reduced[i][j] = if i == j { 1.0 } else { 0.0 };
            }
        }
        if held[i] {
            right[i] = x[i];
        }
    }
    cholesky::solve(&reduced, &right)
}

/// The bound met first on the way from `x` to `target`, and after which
/// fraction of the way.
fn first_bound<const P: usize>(
    lower: &[f64; P],
    upper: &[f64; P],
    hold: &[Hold; P],
    x: &[f64; P],
    target: &[f64; P],
) -> Option<(usize, Hold, f64)> {
    let mut first: Option<(usize, Hold, f64)> = None;
    for i in (0..P).filter(|&i| hold[i] == Hold::Free) {
        let (bound, limit) = if target[i] < lower[i] {
            (Hold::Lower, lower[i])
        } else if target[i] > upper[i] {
            (Hold::Upper, upper[i])
        } else {
            continue;
        };
        let fraction = ((limit - x[i]) / (target[i] - x[i])).clamp(0.0, 1.0);
        if first.is_none_or(|(_, _, least)| fraction < least) {
            first = Some((i, bound, fraction));
        }
    }
    first
}

/// The variable on a bound that would gain most by leaving it.
fn held_in_vain<const P: usize>(
    matrix: &[[f64; P]; P],
    gradient: &[f64; P],
    hold: &[Hold; P],
    x: &[f64; P],
) -> Option<usize> {
    let mut best: Option<(usize, f64)> = None;
    for i in 0..P {
        let (mut slope, mut size) = (gradient[i], gradient[i].abs());
        for j in 0..P {
            slope += matrix[i][j] * x[j];
            size += (matrix[i][j] * x[j]).abs();
        }
        let inward = match hold[i] {
            Hold::Lower => -slope,
            Hold::Upper => slope,
            Hold::Free | Hold::Fixed => continue,
        };
        let gain = inward * inward / matrix[i][i];
        if inward > ROUNDING * size && best.is_none_or(|(_, most)| gain > most) {
            best = Some((i, gain));
        }
    }
    best.map(|(i, _)| i)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Slopes at `x`: zero inside the box, outward on its sides (Karush, Kuhn,
    /// Tucker), which for a convex quadratic is its minimum.
    fn check<const P: usize>(
        matrix: &[[f64; P]; P],
        gradient: &[f64; P],
        lower: &[f64; P],
        upper: &[f64; P],
    ) {
        let x = minimum_in_box(matrix, gradient, lower, upper).unwrap();
        for i in 0..P {
            let slope: f64 = gradient[i] + (0..P).map(|j| matrix[i][j] * x[j]).sum::<f64>();
            assert!(lower[i] <= x[i] && x[i] <= upper[i], "{x:?}");
            assert!(slope < 1e-9 || x[i] == lower[i], "{i}: {slope} at {x:?}");
            assert!(slope > -1e-9 || x[i] == upper[i], "{i}: {slope} at {x:?}");
        }
    }

    #[test]
    fn closed_form_slopes_point_outwards_on_the_sides() {
        // By a fixed linear congruential generator (Knuth's MMIX).
        let mut state = 1_u64;
        let mut next = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        };
        for _ in 0..20_000 {
            // Four rows over four columns, hence positive definite.
            let rows: [[f64; 4]; 4] = std::array::from_fn(|_| std::array::from_fn(|_| next()));
            let mut matrix = [[0.0; 4]; 4];
            for i in 0..4 {
                for j in 0..4 {
                    matrix[i][j] = rows.iter().map(|row| row[i] * row[j]).sum();
                }
                matrix[i][i] += 1e-3;
            }
            let gradient = std::array::from_fn(|_| next());
            // A third of the sides touch the start.
            let lower = std::array::from_fn(|_| (3.0 * next()).clamp(-2.0, 0.0));
            let upper = std::array::from_fn(|_| (3.0 * next()).clamp(0.0, 2.0));
            check(&matrix, &gradient, &lower, &upper);
        }
    }

    #[test]
    fn closed_form_releases_a_side_it_met_on_the_way() {
        // By hand: the way to the unbounded minimum (−1, −3) meets x1 = −0.6
        // before x2 = −2, yet along x2 = −2 the best x1 is −½.
        let matrix = [[2.0, -1.0], [-1.0, 1.0]];
        let x = minimum_in_box(&matrix, &[-1.0, 2.0], &[-0.6, -2.0], &[4.0, 4.0]).unwrap();
        assert!((x[0] + 0.5).abs() < 1e-15 && x[1] == -2.0, "{x:?}");
    }

    #[test]
    fn rejects_a_singular_matrix() {
        let matrix = [[1.0, 1.0], [1.0, 1.0]];
        let bounds = ([-1.0; 2], [1.0; 2]);
        assert_eq!(
            minimum_in_box(&matrix, &[1.0, 2.0], &bounds.0, &bounds.1),
            None
        );
    }
}
