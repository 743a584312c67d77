//! Cubic smoothing spline through samples at any times.

/// A natural cubic spline with a knot at each sample.
#[derive(Clone, Debug, PartialEq)]
pub struct SmoothingSpline {
    /// Values at the knots.
    pub values: Vec<f64>,
    /// First derivatives at the knots; unit of the values per second.
    pub rates: Vec<f64>,
    /// Second derivatives at the knots.
    pub curvatures: Vec<f64>,
    /// Weight of the curvature; s³.
    pub penalty: f64,
    /// Equivalent number of parameters: the trace of the smoothing matrix.
    pub parameters: f64,
}

/// Decades on either side of the middle in which a penalty is searched.
const DECADES: f64 = 12.0;

/// Trials per decade before the best is refined.
const TRIALS: usize = 3;

/// Steps of the golden section.
const SECTIONS: usize = 60;

/// The spline that minimises
///
/// ```text
/// Σ (y_i − f(t_i))² + λ ∫ f''(t)² dt
/// ```
///
/// * `times`: strictly increasing, at least five; s
/// * `penalty`: λ; s³
///
/// `None` where times do not increase, are too few, or numbers are not finite.
///
/// # Numerics
/// Pentadiagonal Cholesky in time scaled to a unit mean interval; O(n).
///
/// # Source
/// Reinsch (1967), Numer. Math. 10:177; Hutchinson and de Hoog (1985), Numer.
/// Math. 47:99, for the trace.
pub fn smoothing_spline(times: &[f64], values: &[f64], penalty: f64) -> Option<SmoothingSpline> {
    let system = System::new(times, values)?;
    let unit = system.unit;
    let solved = system.solve(penalty / unit.powi(3))?;
    Some(system.spline(solved, penalty))
}

/// The smoothing spline whose penalty minimises the generalised cross-validation
///
/// ```text
/// n Σ (y_i − f(t_i))² / (n − p)²,   p the equivalent number of parameters
/// ```
///
/// Right for independent errors. Errors that are correlated, as those of counts
/// sampled more often than they change, call for one sample per count.
///
/// # Source
/// Craven and Wahba (1979), Numer. Math. 31:377.
pub fn smoothing_spline_gcv(times: &[f64], values: &[f64]) -> Option<SmoothingSpline> {
    let system = System::new(times, values)?;
    let score = |exponent: f64| {
        let solved = system.solve(10_f64.powf(exponent));
        solved.map_or(f64::INFINITY, |s| s.score)
    };
    let count = (2.0 * DECADES) as usize * TRIALS;
    let step = 1.0 / TRIALS as f64;
    let trials = (0..=count).map(|i| {
        let exponent = i as f64 * step - DECADES;
        (exponent, score(exponent))
    });
    let best = trials.min_by(|a, b| a.1.total_cmp(&b.1))?.0;
    let exponent = golden_section(best - step, best + step, score);
    let penalty = 10_f64.powf(exponent);
    let solved = system.solve(penalty)?;
    let unit = system.unit;
    Some(system.spline(solved, penalty * unit.powi(3)))
}

fn golden_section(mut low: f64, mut high: f64, of: impl Fn(f64) -> f64) -> f64 {
    let part = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut a, mut b) = (high - part * (high - low), low + part * (high - low));
    let (mut at_a, mut at_b) = (of(a), of(b));
    for _ in 0..SECTIONS {
        if at_a < at_b {
            (high, b, at_b) = (b, a, at_a);
            a = high - part * (high - low);
            at_a = of(a);
        } else {
            (low, a, at_a) = (a, b, at_b);
            b = low + part * (high - low);
            at_b = of(b);
        }
    }
    0.5 * (low + high)
}

/// Reinsch's matrices, in time scaled to a unit mean interval.
struct System<'a> {
    values: &'a [f64],
    /// Mean interval; s.
    unit: f64,
    /// Intervals.
    steps: Vec<f64>,
    /// Diagonal and first band of R.
    r: [Vec<f64>; 2],
    /// Diagonal and two bands of QᵀQ.
    q: [Vec<f64>; 3],
    /// Qᵀy.
    right: Vec<f64>,
}

struct Solved {
    /// Second derivatives at the inner knots, in scaled time.
    curvatures: Vec<f64>,
    /// Values at the knots.
    fitted: Vec<f64>,
    parameters: f64,
    score: f64,
}

impl<'a> System<'a> {
    fn new(times: &[f64], values: &'a [f64]) -> Option<Self> {
        let n = times.len();
        if n < 5 || values.len() != n || values.iter().any(|v| !v.is_finite()) {
            return None;
        }
        let unit = (times[n - 1] - times[0]) / (n - 1) as f64;
        let steps: Vec<f64> = times.windows(2).map(|t| (t[1] - t[0]) / unit).collect();
        if steps.iter().any(|step| !step.is_finite() || *step <= 0.0) {
            return None;
        }
        let inner = n - 2;
        // Column j of Q: 1/h_j, −1/h_j − 1/h_{j+1}, 1/h_{j+1}.
        let column = |j: usize| {
            let (before, after) = (1.0 / steps[j], 1.0 / steps[j + 1]);
            [before, -before - after, after]
        };
        let band = |shift: usize, of: &dyn Fn(usize) -> f64| -> Vec<f64> {
            (0..inner.saturating_sub(shift)).map(of).collect()
        };
        let r = [
            band(0, &|j| (steps[j] + steps[j + 1]) / 3.0),
            band(1, &|j| steps[j + 1] / 6.0),
        ];
        let q = [
            band(0, &|j| column(j).iter().map(|c| c * c).sum()),
            band(1, &|j| {
                let (a, b) = (column(j), column(j + 1));
                a[1] * b[0] + a[2] * b[1]
            }),
            band(2, &|j| column(j)[2] * column(j + 2)[0]),
        ];
        let right = band(0, &|j| {
            let c = column(j);
            c[0] * values[j] + c[1] * values[j + 1] + c[2] * values[j + 2]
        });
        Some(Self {
            values,
            unit,
            steps,
            r,
            q,
            right,
        })
    }

    /// Solves (R + λQᵀQ) γ = Qᵀy; `None` where that is singular.
    fn solve(&self, penalty: f64) -> Option<Solved> {
        let inner = self.right.len();
        let entry = |shift: usize, j: usize| {
            let stiff = self.r.get(shift).map_or(0.0, |band| band[j]);
            stiff + penalty * self.q[shift][j]
        };
        // L D Lᵀ with a unit lower triangle of two bands.
        let (mut d, mut l1, mut l2) = (vec![0.0; inner], vec![0.0; inner], vec![0.0; inner]);
        for j in 0..inner {
            let mut pivot = entry(0, j);
            if j >= 1 {
                pivot -= l1[j - 1] * l1[j - 1] * d[j - 1];
            }
            if j >= 2 {
                pivot -= l2[j - 2] * l2[j - 2] * d[j - 2];
            }
            if pivot.is_nan() || pivot <= 0.0 {
                return None;
            }
            d[j] = pivot;
            if j + 1 < inner {
                let mut next = entry(1, j);
                if j >= 1 {
                    next -= l1[j - 1] * l2[j - 1] * d[j - 1];
                }
                l1[j] = next / pivot;
            }
            if j + 2 < inner {
                l2[j] = entry(2, j) / pivot;
            }
        }
        let mut curvatures = self.right.clone();
        for j in 0..inner {
            if j >= 1 {
                curvatures[j] -= l1[j - 1] * curvatures[j - 1];
            }
            if j >= 2 {
                curvatures[j] -= l2[j - 2] * curvatures[j - 2];
            }
        }
        for (value, pivot) in curvatures.iter_mut().zip(&d) {
            *value /= pivot;
        }
        for j in (0..inner).rev() {
            if j + 1 < inner {
                curvatures[j] -= l1[j] * curvatures[j + 1];
            }
            if j + 2 < inner {
                curvatures[j] -= l2[j] * curvatures[j + 2];
            }
        }
        let fitted = self.fitted(&curvatures, penalty);
        let rest: f64 = self
            .values
            .iter()
            .zip(&fitted)
            .map(|(y, f)| (y - f).powi(2))
            .sum();
        let freedom = penalty * self.trace(&d, &l1, &l2);
        let n = self.values.len() as f64;
        Some(Solved {
            curvatures,
            fitted,
            parameters: n - freedom,
            score: n * rest / (freedom * freedom),
        })
    }

    /// y − λQγ.
    fn fitted(&self, curvatures: &[f64], penalty: f64) -> Vec<f64> {
        let mut fitted = self.values.to_vec();
        for (j, curvature) in curvatures.iter().enumerate() {
            let (before, after) = (1.0 / self.steps[j], 1.0 / self.steps[j + 1]);
            let weight = penalty * curvature;
            fitted[j] -= weight * before;
            fitted[j + 1] += weight * (before + after);
            fitted[j + 2] -= weight * after;
        }
        fitted
    }

    /// Trace of QᵀQ (R + λQᵀQ)⁻¹ from the bands of the inverse.
    fn trace(&self, d: &[f64], l1: &[f64], l2: &[f64]) -> f64 {
        let inner = d.len();
        // Entries (j, j), (j, j + 1), (j, j + 2) of the inverse, from the end.
        let (mut s0, mut s1, mut s2) = ([0.0; 3], [0.0; 3], [0.0; 3]);
        let mut trace = 0.0;
        for j in (0..inner).rev() {
            let two = -l1[j] * s1[0] - l2[j] * s0[1];
            let one = -l1[j] * s0[0] - l2[j] * s1[0];
            let own = 1.0 / d[j] - l1[j] * one - l2[j] * two;
            s0 = [own, s0[0], s0[1]];
            s1 = [one, s1[0], s1[1]];
            s2 = [two, s2[0], s2[1]];
            trace += self.q[0][j] * own;
            if j + 1 < inner {
                trace += 2.0 * self.q[1][j] * one;
            }
            if j + 2 < inner {
                trace += 2.0 * self.q[2][j] * two;
            }
        }
        trace
    }

    fn spline(&self, solved: Solved, penalty: f64) -> SmoothingSpline {
        let n = self.values.len();
        let mut curvatures = vec![0.0; n];
        curvatures[1..n - 1].copy_from_slice(&solved.curvatures);
        let g = &solved.fitted;
        let rates = (0..n).map(|i| {
            let (at, sign) = if i + 1 < n { (i, 1.0) } else { (i - 1, -1.0) };
            let h = self.steps[at];
            let (near, far) = match i + 1 < n {
                true => (curvatures[at], curvatures[at + 1]),
                false => (curvatures[at + 1], curvatures[at]),
            };
            let slope = (g[at + 1] - g[at]) / h;
            (slope - sign * h * (2.0 * near + far) / 6.0) / self.unit
        });
        let rates = rates.collect();
        let scale = self.unit * self.unit;
        curvatures.iter_mut().for_each(|c| *c /= scale);
        SmoothingSpline {
            values: solved.fitted,
            rates,
            curvatures,
            penalty,
            parameters: solved.parameters,
        }
    }
}
