//! How fruit differ, by the two-stage way: fit each impact, then take moments.

use windfall_numerics::cholesky;

/// Estimates by impact and fruit.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimates {
    /// Parameters.
    pub names: Vec<String>,
    /// Whether the logarithm of a parameter stands in the rows.
    pub logarithmic: Vec<bool>,
    /// For each fruit a row for each of its impacts.
    pub fruit: Vec<Vec<Vec<f64>>>,
}

impl Estimates {
    /// Values of the parameters at a row.
    pub fn values(&self, row: &[f64]) -> Vec<f64> {
        let pairs = row.iter().zip(&self.logarithmic);
        pairs
            .map(|(value, logarithmic)| if *logarithmic { value.exp() } else { *value })
            .collect()
    }
}

/// Moments of a population of fruit.
#[derive(Clone, Debug, PartialEq)]
pub struct Population {
    /// Mean over fruit.
    pub mean: Vec<f64>,
    /// Covariance of that mean; not a number for a single fruit.
    pub of_mean: Vec<Vec<f64>>,
    /// Covariance between fruit; none for a single fruit.
    pub between: Option<Vec<Vec<f64>>>,
    /// Covariance between the impacts of a fruit; none where no fruit has two.
    pub within: Option<Vec<Vec<f64>>>,
    /// Fruit.
    pub fruit: usize,
    /// How it was estimated, and what that leaves out.
    pub method: String,
}

/// Parts of the scatter within fruit that are tried to be taken off the scatter
/// of their means, until what is left is a covariance.
const PARTS: [f64; 4] = [1.0, 0.5, 0.25, 0.0];

/// Moments of the means of fruit; every fruit counts the same.
///
/// The covariance between fruit is that of their means less the mean covariance
/// within fruit over the number of their impacts,
///
/// ```text
/// B = cov(ȳ_i) − W mean(1/n_i)
/// ```
///
/// # Source
/// Moment estimator of the one-way random model; Searle, Casella and McCulloch
/// (1992), Variance Components, ch. 3, for unweighted means.
pub fn two_stage(estimates: &Estimates) -> Population {
    let size = estimates.names.len();
    let count = estimates.fruit.len();
    let means: Vec<Vec<f64>> = estimates.fruit.iter().map(|rows| mean_of(rows)).collect();
    let mean = mean_of(&means);
    let scatter = (count > 1).then(|| {
        let sum = products(&means, &mean, size);
        divided(&sum, (count - 1) as f64)
    });
    let freedom: usize = estimates.fruit.iter().map(|rows| rows.len() - 1).sum();
    let within = (freedom > 0).then(|| {
        let mut sum = vec![vec![0.0; size]; size];
        for (rows, mean) in estimates.fruit.iter().zip(&means) {
            add(&mut sum, &products(rows, mean, size), 1.0);
        }
        divided(&sum, freedom as f64)
    });
    let inverse: f64 = estimates
        .fruit
        .iter()
        .map(|rows| 1.0 / rows.len() as f64)
        .sum();
    let share = inverse / count as f64;
    let (between, method) = match (&scatter, &within) {
        (None, _) => (None, "one fruit: nothing is known of how fruit differ"),
        (Some(scatter), None) => (
            Some(scatter.clone()),
            "two stages; no fruit has two impacts, so that the covariance between fruit holds that of the measurement too",
        ),
        (Some(scatter), Some(within)) => less_within(scatter, within, share),
    };
    Population {
        mean,
        of_mean: match scatter {
            Some(scatter) => divided(&scatter, count as f64),
            None => vec![vec![f64::NAN; size]; size],
        },
        between,
        within,
        fruit: count,
        method: method.to_owned(),
    }
}

fn less_within(
    scatter: &[Vec<f64>],
    within: &[Vec<f64>],
    share: f64,
) -> (Option<Vec<Vec<f64>>>, &'static str) {
    // A variance is not negative: what does not differ between fruit has none.
    let differs: Vec<bool> = (0..scatter.len())
        .map(|i| scatter[i][i] > share * within[i][i])
        .collect();
    let all = differs.iter().all(|differs| *differs);
    for part in PARTS {
        let mut left = scatter.to_vec();
        add(&mut left, within, -part * share);
        keep(&mut left, &differs, 0.0);
        let mut tried = left.clone();
        keep(&mut tried, &differs, 1.0);
        if part == 0.0 || is_covariance(&tried) {
            let method = match (part == 1.0, all) {
                (true, true) => {
                    "two stages: covariance of the fruit's means, less that within fruit"
                }
                (true, false) => {
                    "two stages; a parameter that scatters no more between fruit than within has the variance 0"
                }
                _ => {
                    "two stages; parameters scatter hardly more between fruit than within: the covariance between fruit is an upper estimate"
                }
            };
            return (Some(left), method);
        }
    }
    (Some(scatter.to_vec()), "two stages")
}

/// Empties rows and columns of what does not differ, but for its diagonal.
fn keep(matrix: &mut [Vec<f64>], differs: &[bool], diagonal: f64) {
    for (i, row) in matrix.iter_mut().enumerate() {
        for (j, cell) in row.iter_mut().enumerate() {
            if !(differs[i] && differs[j]) {
                *cell = if i == j { diagonal } else { 0.0 };
            }
        }
    }
}

/// Whether a symmetric matrix is positive definite.
fn is_covariance(matrix: &[Vec<f64>]) -> bool {
    const LARGEST: usize = windfall_contact::laws::any_law::LARGEST_PARAMETERS;
    let mut padded = [[0.0; LARGEST]; LARGEST];
    for (i, row) in padded.iter_mut().enumerate() {
        row[i] = 1.0;
        if let Some(found) = matrix.get(i) {
            row[..found.len()].copy_from_slice(found);
        }
    }
    cholesky::inverse(&padded).is_some()
}

fn mean_of(rows: &[Vec<f64>]) -> Vec<f64> {
    let size = rows.first().map_or(0, Vec::len);
    (0..size)
        .map(|i| rows.iter().map(|row| row[i]).sum::<f64>() / rows.len() as f64)
        .collect()
}

/// Σ (row − mean)(row − mean)ᵀ.
fn products(rows: &[Vec<f64>], mean: &[f64], size: usize) -> Vec<Vec<f64>> {
    let mut sum = vec![vec![0.0; size]; size];
    for row in rows {
        for i in 0..size {
            for j in 0..size {
                sum[i][j] += (row[i] - mean[i]) * (row[j] - mean[j]);
            }
        }
    }
    sum
}

fn add(sum: &mut [Vec<f64>], other: &[Vec<f64>], factor: f64) {
    for (row, other) in sum.iter_mut().zip(other) {
        for (cell, other) in row.iter_mut().zip(other) {
            *cell += factor * other;
        }
    }
}

fn divided(matrix: &[Vec<f64>], by: f64) -> Vec<Vec<f64>> {
    let rows = matrix.iter();
    rows.map(|row| row.iter().map(|cell| cell / by).collect())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(fruit: Vec<Vec<Vec<f64>>>) -> Population {
        let size = fruit[0][0].len();
        two_stage(&Estimates {
            names: (0..size).map(|i| format!("p{i}")).collect(),
            logarithmic: vec![false; size],
            fruit,
        })
    }

    /// Balanced one-way analysis of variance: between = (MSB − MSW)/n.
    #[test]
    fn closed_form_balanced_variance_components() {
        let one = |values: &[f64]| values.iter().map(|v| vec![*v]).collect::<Vec<_>>();
        // Means 2, 5, 11; within squares 2, 2, 8 with one degree of freedom each.
        let population = of(vec![one(&[1.0, 3.0]), one(&[4.0, 6.0]), one(&[9.0, 13.0])]);
        let within = population.within.unwrap()[0][0];
        assert!((within - 4.0).abs() < 1e-14);
        // Variance of the means 21, less 4/2.
        assert!((population.between.unwrap()[0][0] - 19.0).abs() < 1e-12);
        assert!((population.mean[0] - 6.0).abs() < 1e-14);
        assert!((population.of_mean[0][0] - 7.0).abs() < 1e-13);
    }

    #[test]
    fn closed_form_one_fruit_and_no_repeats() {
        let single = of(vec![vec![vec![1.0], vec![2.0]]]);
        assert!(single.between.is_none() && single.fruit == 1);
        let plain = of(vec![vec![vec![1.0]], vec![vec![3.0]]]);
        assert_eq!(plain.between.unwrap()[0][0], 2.0);
        assert!(plain.within.is_none());
        // Nothing but scatter within: no variance, never a negative one.
        let same = of(vec![vec![vec![1.0], vec![5.0]], vec![vec![2.0], vec![4.1]]]);
        assert_eq!(same.between.unwrap()[0][0], 0.0);
        assert!(same.method.contains("has the variance 0"));
    }
}
