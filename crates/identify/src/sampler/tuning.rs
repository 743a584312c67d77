//! Tunes a chain before its draws are kept: the width of its steps and the variance of
//! each coordinate.
//!
//! # Source
//! Hoffman and Gelman (2014), J. Machine Learning Research 15:1593, section 3.2, for the
//! steps; Carpenter et al. (2017), J. Statistical Software 76:1, for the windows of
//! draws over which variances are taken.

use crate::sampler::no_u_turn::Chain;

/// Probability of acceptance that the steps are tuned to.
const ACCEPTANCE: f64 = 0.8;
/// Draws before, in the first of, and behind the windows of variances.
const BEFORE: usize = 75;
const FIRST_WINDOW: usize = 25;
const BEHIND: usize = 50;
/// Draws that a prior variance of [`SMALL_VARIANCE`] counts for.
const PRIOR_DRAWS: f64 = 5.0;
const SMALL_VARIANCE: f64 = 1e-3;

/// What tuning has learned so far.
pub(crate) struct Tuning {
    draws: usize,
    done: usize,
    steps: StepWidth,
    /// Draws at which variances are taken, and the first that counts for them.
    ends: Vec<usize>,
    from: usize,
    moments: Moments,
}

impl Tuning {
    /// Tunes `chain` over so many draws.
    pub(crate) fn new(chain: &mut Chain, draws: usize) -> Self {
        let (from, ends) = windows(draws);
        Self {
            draws,
            done: 0,
            steps: StepWidth::near(chain),
            ends,
            from,
            moments: Moments::default(),
        }
    }

    /// Learns from the last draw of `chain`.
    pub(crate) fn learn(&mut self, chain: &mut Chain, acceptance: f64) {
        self.done += 1;
        chain.step = self.steps.next(acceptance);
        if self.done > self.from && self.ends.last().is_some_and(|last| self.done <= *last) {
            self.moments.add(chain.position());
        }
        if self.ends.contains(&self.done) {
            chain.variances = std::mem::take(&mut self.moments).variances();
            self.steps = StepWidth::near(chain);
        }
        if self.done == self.draws {
            chain.step = self.steps.settled();
        }
    }
}

/// Draws before the windows, and the last draw of each, which are twice as long one
/// after the other.
fn windows(draws: usize) -> (usize, Vec<usize>) {
    let (before, behind) = match draws >= BEFORE + FIRST_WINDOW + BEHIND {
        true => (BEFORE, BEHIND),
        false => (draws * 3 / 20, draws / 10),
    };
    let last = draws - behind;
    let (mut end, mut size) = (before, FIRST_WINDOW);
    let mut ends = Vec::new();
    while end < last {
        end += size;
        size *= 2;
        if end + size >= last {
            end = last;
        }
        ends.push(end);
    }
    (before, ends)
}

/// Width of steps, found by dual averaging.
struct StepWidth {
    /// Logarithm that it is drawn to.
    centre: f64,
    log: f64,
    average: f64,
    error: f64,
    count: f64,
}

impl StepWidth {
    /// Starts where one step is accepted with about [`ACCEPTANCE`], and sets it.
    fn near(chain: &mut Chain) -> Self {
        let good = ACCEPTANCE.ln();
        let mut step = chain.step;
        let wider = chain.gain_of_a_step(step) > good;
        let factor: f64 = if wider { 2.0 } else { 0.5 };
        while (1e-10..1e10).contains(&step) {
            step *= factor;
            if (chain.gain_of_a_step(step) > good) != wider {
                break;
            }
        }
        chain.step = step;
        Self {
            centre: (10.0 * step).ln(),
            log: step.ln(),
            average: step.ln(),
            error: 0.0,
            count: 0.0,
        }
    }

    /// The width after a draw with this acceptance.
    fn next(&mut self, acceptance: f64) -> f64 {
        const GAMMA: f64 = 0.05;
        const LATE: f64 = 10.0;
        const KAPPA: f64 = 0.75;
        self.count += 1.0;
        let share = 1.0 / (self.count + LATE);
        self.error += share * (ACCEPTANCE - acceptance - self.error);
        self.log = self.centre - self.error * self.count.sqrt() / GAMMA;
        let share = self.count.powf(-KAPPA);
        self.average += share * (self.log - self.average);
        self.log.exp()
    }

    /// The width when tuning is over.
    fn settled(&self) -> f64 {
        self.average.exp()
    }
}

/// Mean and sum of squares of each coordinate.
#[derive(Default)]
struct Moments {
    count: f64,
    mean: Vec<f64>,
    square: Vec<f64>,
}

impl Moments {
    fn add(&mut self, position: &[f64]) {
        self.count += 1.0;
        self.mean.resize(position.len(), 0.0);
        self.square.resize(position.len(), 0.0);
        let moments = self.mean.iter_mut().zip(&mut self.square);
        for ((mean, square), value) in moments.zip(position) {
            let away = value - *mean;
            *mean += away / self.count;
            *square += away * (value - *mean);
        }
    }

    fn variances(self) -> Vec<f64> {
        let all = self.count + PRIOR_DRAWS;
        let of = |square: f64| {
            let found = square / (self.count - 1.0).max(1.0);
            (self.count * found + PRIOR_DRAWS * SMALL_VARIANCE) / all
        };
        self.square.iter().map(|square| of(*square)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_windows_cover_what_lies_between() {
        assert_eq!(windows(1000), (75, vec![100, 150, 250, 450, 950]));
        assert_eq!(windows(500), (75, vec![100, 150, 450]));
        assert_eq!(windows(100), (15, vec![90]));
        assert_eq!(windows(0), (0, vec![]));
    }

    #[test]
    fn closed_form_variances() {
        let mut moments = Moments::default();
        for value in [1.0, 2.0, 3.0, 4.0] {
            moments.add(&[value, 0.0]);
        }
        let found = moments.variances();
        let expected = (4.0 * 5.0 / 3.0 + 5.0 * 1e-3) / 9.0;
        assert!((found[0] / expected - 1.0).abs() < 1e-14);
        assert!((found[1] / (5.0 * 1e-3 / 9.0) - 1.0).abs() < 1e-14);
    }
}
