//! Least squares of many records that share some parameters: the normal matrix
//! has the shape of an arrow, and is solved record by record.

use windfall_numerics::cholesky::{inverse, solve};

/// Parameters that all records share, at most.
pub(crate) const SHARED: usize = 10;
/// Parameters of one record.
pub(crate) const OWN: usize = 4;
/// Both.
pub(crate) const ALL: usize = SHARED + OWN;

/// Normal equations of one record: shared parameters first, then its own.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RecordEquations {
    /// Σ w r².
    pub cost: f64,
    /// Σ w J r.
    pub gradient: [f64; ALL],
    /// Σ w J Jᵀ; the lower triangle.
    pub normal: [[f64; ALL]; ALL],
    /// Residuals that are data, not priors.
    pub samples: usize,
}

impl RecordEquations {
    pub const ZERO: Self = Self {
        cost: 0.0,
        gradient: [0.0; ALL],
        normal: [[0.0; ALL]; ALL],
        samples: 0,
    };

    /// Adds a residual; `columns` holds the places of what it depends on.
    #[inline(always)]
    pub fn add(&mut self, weight: f64, residual: f64, row: &[f64; ALL]) {
        self.cost += weight * residual * residual;
        for i in 0..ALL {
            let weighted = weight * row[i];
            self.gradient[i] += weighted * residual;
            for j in 0..=i {
                self.normal[i][j] += weighted * row[j];
            }
        }
    }

    fn element(&self, i: usize, j: usize) -> f64 {
        if i >= j {
            self.normal[i][j]
        } else {
            self.normal[j][i]
        }
    }

    /// Own block, with its diagonal raised; parameters without information
    /// stay where they are.
    fn own(&self, damping: f64) -> [[f64; OWN]; OWN] {
        let mut block = [[0.0; OWN]; OWN];
        for (i, row) in block.iter_mut().enumerate() {
            for (j, value) in row.iter_mut().enumerate() {
                *value = self.element(SHARED + i, SHARED + j);
            }
            raise(&mut row[i], damping);
        }
        block
    }

    /// Coupling of the record's own parameters (rows) to the shared ones.
    fn coupling(&self) -> [[f64; SHARED]; OWN] {
        let mut block = [[0.0; SHARED]; OWN];
        for (i, row) in block.iter_mut().enumerate() {
            row.copy_from_slice(&self.normal[SHARED + i][..SHARED]);
        }
        block
    }

    /// Gradient by its own parameters.
    fn own_gradient(&self) -> [f64; OWN] {
        std::array::from_fn(|i| self.gradient[SHARED + i])
    }
}

fn raise(diagonal: &mut f64, damping: f64) {
    match *diagonal == 0.0 {
        true => *diagonal = 1.0,
        false => *diagonal *= 1.0 + damping,
    }
}

/// Equations of all records and of the priors on shared parameters.
#[derive(Clone, Debug)]
pub(crate) struct Arrow {
    /// One for each record.
    pub records: Vec<RecordEquations>,
    /// Cost of the priors on shared parameters.
    pub prior_cost: f64,
    /// Their half gradient.
    pub prior_gradient: [f64; SHARED],
    /// Their weights.
    pub prior_weight: [f64; SHARED],
}

/// A step of all parameters.
#[derive(Clone, Debug)]
pub(crate) struct ArrowStep {
    /// Of the shared ones.
    pub shared: [f64; SHARED],
    /// Of those of each record.
    pub own: Vec<[f64; OWN]>,
    /// By how much the cost falls if the problem is linear.
    pub gain: f64,
}

impl Arrow {
    /// Sum of weighted squares.
    pub fn cost(&self) -> f64 {
        self.prior_cost + self.records.iter().map(|record| record.cost).sum::<f64>()
    }

    /// Residuals that are data.
    pub fn samples(&self) -> usize {
        self.records.iter().map(|record| record.samples).sum()
    }

    /// Normal matrix of the shared parameters with those of the records
    /// eliminated, and its right-hand side (minus the half gradient).
    ///
    /// `None` where a record's own parameters are inseparable.
    pub fn reduced(&self, damping: f64) -> Option<([[f64; SHARED]; SHARED], [f64; SHARED])> {
        let mut matrix = [[0.0; SHARED]; SHARED];
        let mut right = self.prior_gradient.map(|value| -value);
        for i in 0..SHARED {
            matrix[i][i] = self.prior_weight[i];
        }
        for record in &self.records {
            for (i, row) in matrix.iter_mut().enumerate() {
                for (j, value) in row.iter_mut().enumerate() {
                    *value += record.element(i, j);
                }
                right[i] -= record.gradient[i];
            }
        }
        for (i, row) in matrix.iter_mut().enumerate() {
            raise(&mut row[i], damping);
        }
        for record in &self.records {
            let own = inverse(&record.own(damping))?;
            let (coupling, gradient) = (record.coupling(), record.own_gradient());
            for a in 0..OWN {
                for b in 0..OWN {
                    for i in 0..SHARED {
                        let part = coupling[a][i] * own[a][b];
                        right[i] += part * gradient[b];
                        for j in 0..SHARED {
                            matrix[i][j] -= part * coupling[b][j];
                        }
                    }
                }
            }
        }
        Some((matrix, right))
    }

    /// Damped Gauss-Newton step.
    pub fn step(&self, damping: f64) -> Option<ArrowStep> {
        let (matrix, right) = self.reduced(damping)?;
        let shared = solve(&matrix, &right)?;
        let mut own = Vec::with_capacity(self.records.len());
        // Gain of the linear problem: −2 gᵀs − sᵀNs.
        let mut gain = 0.0;
        for i in 0..SHARED {
            gain -= 2.0 * self.prior_gradient[i] * shared[i];
            gain -= self.prior_weight[i] * shared[i] * shared[i];
        }
        for record in &self.records {
            let coupling = record.coupling();
            let mut right = record.own_gradient().map(|value| -value);
            for (a, value) in right.iter_mut().enumerate() {
                *value -= (0..SHARED).map(|i| coupling[a][i] * shared[i]).sum::<f64>();
            }
            let step = solve(&record.own(damping), &right)?;
            let all: [f64; ALL] = std::array::from_fn(|i| match i < SHARED {
                true => shared[i],
                false => step[i - SHARED],
            });
            for i in 0..ALL {
                gain -= 2.0 * record.gradient[i] * all[i];
                gain -= (0..ALL)
                    .map(|j| record.element(i, j) * all[i] * all[j])
                    .sum::<f64>();
            }
            own.push(step);
        }
        Some(ArrowStep { shared, own, gain })
    }

    /// Covariance of the shared parameters for unit weights; `None` where they
    /// are inseparable. Parameters that are not in use get 1.
    pub fn covariance(&self) -> Option<[[f64; SHARED]; SHARED]> {
        let (matrix, _) = self.reduced(0.0)?;
        inverse(&matrix)
    }

    /// Covariance of one record's own parameters.
    pub fn own_covariance(
        &self,
        index: usize,
        shared: &[[f64; SHARED]; SHARED],
    ) -> Option<[[f64; OWN]; OWN]> {
        let record = &self.records[index];
        let own = inverse(&record.own(0.0))?;
        let coupling = record.coupling();
        // G = C⁻¹ B: how the record's own parameters follow the shared ones.
        let follow: [[f64; SHARED]; OWN] = std::array::from_fn(|a| {
            std::array::from_fn(|i| (0..OWN).map(|b| own[a][b] * coupling[b][i]).sum())
        });
        let mut out = own;
        for (a, row) in out.iter_mut().enumerate() {
            for (b, value) in row.iter_mut().enumerate() {
                for i in 0..SHARED {
                    for j in 0..SHARED {
                        *value += follow[a][i] * shared[i][j] * follow[b][j];
                    }
                }
            }
        }
        Some(out)
    }

    /// Half gradient of each record by the shared parameters, its own ones at
    /// their best: what the record pulls.
    pub fn pulls(&self) -> Option<Vec<[f64; SHARED]>> {
        self.records
            .iter()
            .map(|record| {
                let own = inverse(&record.own(0.0))?;
                let (coupling, gradient) = (record.coupling(), record.own_gradient());
                let mut pull: [f64; SHARED] = std::array::from_fn(|i| record.gradient[i]);
                for a in 0..OWN {
                    for b in 0..OWN {
                        for (i, value) in pull.iter_mut().enumerate() {
                            *value -= coupling[a][i] * own[a][b] * gradient[b];
                        }
                    }
                }
                Some(pull)
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A straight line through each of three records: a common slope, an own
    /// intercept. The closed form is the pooled within-record slope.
    #[test]
    fn closed_form_common_slope() {
        let data = [
            [(0.0, 1.0), (1.0, 3.1), (2.0, 4.9)],
            [(0.0, -2.0), (1.0, 0.2), (3.0, 4.1)],
            [(1.0, 5.0), (2.0, 7.2), (4.0, 10.9)],
        ];
        let mut records = Vec::new();
        let (mut sxx, mut sxy) = (0.0, 0.0);
        for points in data {
            let mut record = RecordEquations::ZERO;
            let mean = points
                .iter()
                .fold((0.0, 0.0), |m, p| (m.0 + p.0 / 3.0, m.1 + p.1 / 3.0));
            for (x, y) in points {
                let mut row = [0.0; ALL];
                row[0] = x;
                row[SHARED] = 1.0;
                record.add(1.0, -y, &row);
                sxx += (x - mean.0) * (x - mean.0);
                sxy += (x - mean.0) * (y - mean.1);
            }
            records.push(record);
        }
        let arrow = Arrow {
            records,
            prior_cost: 0.0,
            prior_gradient: [0.0; SHARED],
            prior_weight: [0.0; SHARED],
        };
        let step = arrow.step(0.0).unwrap();
        assert!((step.shared[0] - sxy / sxx).abs() < 1e-13);
        assert!((arrow.covariance().unwrap()[0][0] - 1.0 / sxx).abs() < 1e-13);
        // The mean of a record's intercept: ȳ − b x̄.
        assert!((step.own[0][0] - (3.0 - sxy / sxx)).abs() < 1e-12);
        // var(ȳ − b x̄) = 1/n + x̄²/Sxx.
        let own = arrow
            .own_covariance(0, &arrow.covariance().unwrap())
            .unwrap();
        assert!((own[0][0] - (1.0 / 3.0 + 1.0 / sxx)).abs() < 1e-13);
        // The gain of the linear problem is what the cost falls by.
        let left: f64 = data
            .iter()
            .zip(&step.own)
            .flat_map(|(points, own)| {
                let b = step.shared[0];
                points
                    .iter()
                    .map(move |(x, y)| (y - own[0] - b * x).powi(2))
            })
            .sum();
        assert!((arrow.cost() - step.gain - left).abs() < 1e-11);
    }
}
