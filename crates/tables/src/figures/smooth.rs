//! A smooth line through a cloud of points.

use rayon::prelude::*;

/// Share of the points in each neighbourhood, and rounds that take weight from outliers.
const SHARE: f64 = 2.0 / 3.0;
const ROUNDS: usize = 3;

/// Distance of fitted points as a part of the range; between them the line is straight.
const SPACING: f64 = 0.01;

/// Robust locally weighted regression (lowess) with the settings of R's `lowess`: two thirds of
/// the points in each neighbourhood, three robust rounds.
///
/// * `points`: abscissa and ordinate, finite, in any order
///
/// Returns the line at every distinct abscissa, rising; empty for fewer than three points or
/// where all lie at one abscissa.
///
/// # Source
/// Cleveland, W. S. (1979), Robust locally weighted regression and smoothing scatterplots,
/// J. Am. Stat. Assoc. 74, 829-836; (1981), LOWESS, Am. Stat. 35, 54, for the spacing.
pub fn lowess(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (Some(first), Some(last)) = (sorted.first(), sorted.last()) else {
        return Vec::new();
    };
    let range = last.0 - first.0;
    if sorted.len() < 3 || range <= 0.0 {
        return Vec::new();
    }
    let x: Vec<f64> = sorted.iter().map(|point| point.0).collect();
    let y: Vec<f64> = sorted.iter().map(|point| point.1).collect();
    let near = ((SHARE * x.len() as f64 + 1e-7) as usize).clamp(2, x.len());
    let centres = centres_of(&x, SPACING * range);
    let mut robust = vec![1.0; x.len()];
    let mut line = Vec::new();
    for round in 0..=ROUNDS {
        let fitted: Vec<(f64, f64)> = centres
            .par_iter()
            .map(|place| {
                let value = fitted_at(&x, &y, &robust, (x[*place], near), range);
                (x[*place], value.unwrap_or(y[*place]))
            })
            .collect();
        line = between(&fitted, &x);
        if round == ROUNDS || !reweigh(&mut robust, &y, &line) {
            break;
        }
    }
    let mut shown: Vec<(f64, f64)> = x.into_iter().zip(line).collect();
    shown.dedup_by(|a, b| a.0 == b.0);
    shown
}

/// Places of the points at which the line is fitted: ends, and the last within each spacing.
fn centres_of(x: &[f64], spacing: f64) -> Vec<usize> {
    let mut centres = vec![0];
    let mut last = x.partition_point(|own| *own <= x[0]) - 1;
    while last + 1 < x.len() {
        let beyond = x.partition_point(|own| *own <= x[last] + spacing);
        let next = (last + 1).max(beyond - 1);
        centres.push(next);
        last = x.partition_point(|own| *own <= x[next]) - 1;
    }
    centres
}

/// The local line at a place; `None` where no neighbour has a weight.
fn fitted_at(
    x: &[f64],
    y: &[f64],
    robust: &[f64],
    (at, near): (f64, usize),
    range: f64,
) -> Option<f64> {
    let reach = distance_of_neighbours(x, at, near);
    let from = x.partition_point(|own| *own < at - reach);
    let to = x.partition_point(|own| *own <= at + reach);
    let weight = |place: usize| {
        let away = (x[place] - at).abs();
        match away {
            away if away > 0.999 * reach => 0.0,
            away if away <= 0.001 * reach => robust[place],
            away => robust[place] * (1.0 - (away / reach).powi(3)).powi(3),
        }
    };
    let weights: Vec<f64> = (from..to).map(weight).collect();
    let total: f64 = weights.iter().sum();
    if total <= 0.0 {
        return None;
    }
    let mean = |value: &dyn Fn(usize) -> f64| {
        let terms = weights.iter().zip(from..to);
        terms
            .map(|(weight, place)| weight * value(place))
            .sum::<f64>()
            / total
    };
    let centre = mean(&|place| x[place]);
    let level = mean(&|place| y[place]);
    let spread = mean(&|place| (x[place] - centre).powi(2));
    // Neighbours at almost one place tell no slope.
    if reach <= 0.0 || spread.sqrt() <= 0.001 * range {
        return Some(level);
    }
    let slope = mean(&|place| (x[place] - centre) * y[place]) / spread;
    Some(level + slope * (at - centre))
}

/// Distance from a place to the farthest of its nearest points.
fn distance_of_neighbours(x: &[f64], at: f64, near: usize) -> f64 {
    let reach = |from: usize| (at - x[from]).max(x[from + near - 1] - at);
    // Of the windows of so many points, the farther end comes nearer and then goes away.
    let (mut low, mut high) = (0, x.len() - near);
    while low < high {
        let middle = (low + high) / 2;
        match at - x[middle] <= x[middle + near] - at {
            true => high = middle,
            false => low = middle + 1,
        }
    }
    reach(low)
}

/// Values at rising places by straight lines between fitted points.
fn between(fitted: &[(f64, f64)], x: &[f64]) -> Vec<f64> {
    let value = |at: &f64| {
        let next = fitted.partition_point(|point| point.0 < *at);
        let (a, b) = (
            fitted[next.saturating_sub(1)],
            fitted[next.min(fitted.len() - 1)],
        );
        match b.0 > a.0 {
            true => a.1 + (b.1 - a.1) * (at - a.0) / (b.0 - a.0),
            false => b.1,
        }
    };
    x.iter().map(value).collect()
}

/// Weights from the residuals (bisquare of six median residuals); whether another round is due.
fn reweigh(robust: &mut [f64], y: &[f64], line: &[f64]) -> bool {
    let residuals: Vec<f64> = y.iter().zip(line).map(|(y, own)| (y - own).abs()).collect();
    let limit = 6.0 * windfall_distribution::quantile::median(&residuals);
    let mean = residuals.iter().sum::<f64>() / residuals.len() as f64;
    if limit < 1e-7 * mean {
        return false;
    }
    for (weight, residual) in robust.iter_mut().zip(&residuals) {
        *weight = match *residual {
            own if own <= 0.001 * limit => 1.0,
            own if own > 0.999 * limit => 0.0,
            own => (1.0 - (own / limit).powi(2)).powi(2),
        };
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    /// R 4: lowess(cars), at the speeds 4, 7, 10, 15, 20 and 25.
    #[test]
    fn reference_cars() {
        let speed = [
            4, 4, 7, 7, 8, 9, 10, 10, 10, 11, 11, 12, 12, 12, 12, 13, 13, 13, 13, 14, 14, 14, 14,
            15, 15, 15, 16, 16, 17, 17, 17, 18, 18, 18, 18, 19, 19, 19, 20, 20, 20, 20, 20, 22, 23,
            24, 24, 24, 24, 25,
        ];
        let distance = [
            2, 10, 4, 22, 16, 10, 18, 26, 34, 17, 28, 14, 20, 24, 28, 26, 34, 34, 46, 26, 36, 60,
            80, 20, 26, 54, 32, 40, 32, 40, 50, 42, 56, 76, 84, 36, 46, 68, 32, 48, 52, 56, 64, 66,
            54, 70, 92, 93, 120, 85,
        ];
        let points: Vec<(f64, f64)> = speed
            .iter()
            .zip(&distance)
            .map(|(x, y)| (f64::from(*x), f64::from(*y)))
            .collect();
        let line = lowess(&points);
        for (at, expected) in REFERENCE {
            let found = line.iter().find(|point| point.0 == at).unwrap();
            assert!((found.1 - expected).abs() < 1e-9, "{at}: {}", found.1);
        }
    }

    const REFERENCE: [(f64, f64); 6] = [
        (4.0, 4.965459277187),
        (7.0, 13.124495039666),
        (10.0, 21.280312578528),
        (15.0, 36.757728341650),
        (20.0, 56.491224092877),
        (25.0, 84.328698096834),
    ];

    #[test]
    fn closed_form_a_line_stays_and_little_gives_nothing() {
        let points: Vec<(f64, f64)> = (0..50)
            .map(|i| (f64::from(i), 2.0 - f64::from(i)))
            .collect();
        assert!(
            lowess(&points)
                .iter()
                .all(|(x, y)| (y - (2.0 - x)).abs() < 1e-9)
        );
        assert!(lowess(&points[..2]).is_empty() && lowess(&[]).is_empty());
        assert!(lowess(&[(1.0, 2.0), (1.0, 3.0), (1.0, 5.0)]).is_empty());
        let steps = [(0.0, 1.0), (0.0, 3.0), (1.0, 5.0), (1.0, 5.0)];
        assert!(lowess(&steps).iter().all(|(_, y)| y.is_finite()));
    }
}
