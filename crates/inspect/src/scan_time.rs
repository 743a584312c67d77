//! A channel of times looked through in bounded memory.

use crate::scan_decimated::Decimated;

/// Departure of a sampling interval from the median that counts as irregular.
pub const IRREGULAR: f64 = 0.01;

/// What one pass over a channel of times has found so far.
#[derive(Clone, Debug, Default)]
pub struct TimeScan {
    rows: u64,
    last: Option<(u64, f64)>,
    first: Option<(u64, f64)>,
    backwards: Option<Step>,
    shortest: Option<Step>,
    longest: Option<Step>,
    intervals: Decimated,
    // One time per row, NaN where there is none, thinned out.
    times: Decimated,
}

/// From one time to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// Number of the row of the second time, from 0.
    pub row: u64,
    /// The time before.
    pub before: f64,
    /// The time.
    pub time: f64,
}

impl Step {
    /// From the one to the other.
    pub fn interval(&self) -> f64 {
        self.time - self.before
    }
}

impl TimeScan {
    /// Takes the next times; NaN where there is none.
    pub fn take(&mut self, times: &[f64]) {
        for &time in times {
            let row = self.rows;
            self.rows += 1;
            self.times.push(time);
            if !time.is_finite() {
                continue;
            }
            if let Some((_, before)) = self.last {
                self.step(Step { row, before, time });
            }
            self.first.get_or_insert((row, time));
            self.last = Some((row, time));
        }
    }

    fn step(&mut self, step: Step) {
        let interval = step.interval();
        if interval <= 0.0 {
            self.backwards.get_or_insert(step);
        }
        self.intervals.push(interval);
        if self.shortest.is_none_or(|s| interval < s.interval()) {
            self.shortest = Some(step);
        }
        if self.longest.is_none_or(|l| interval > l.interval()) {
            self.longest = Some(step);
        }
    }

    /// Where time first stands still or goes back.
    pub fn backwards(&self) -> Option<Step> {
        self.backwards
    }

    /// The median interval; of a long channel, of a choice of its intervals.
    pub fn median_interval(&self) -> Option<f64> {
        self.intervals.quantile(0.5, 1)
    }

    /// The interval that departs most from the median, if that is much.
    pub fn irregular(&self) -> Option<Step> {
        let median = self.median_interval()?;
        let off = |step: &Step| (step.interval() - median).abs();
        let worst = [self.shortest?, self.longest?]
            .into_iter()
            .max_by(|a, b| off(a).total_cmp(&off(b)))?;
        (off(&worst) > IRREGULAR * median).then_some(worst)
    }

    /// The time of a row, interpolated in channels too long to remember each.
    pub fn at(&self, row: u64) -> Option<f64> {
        if let Some((last_row, last)) = self.last
            && row >= last_row
        {
            return Some(last);
        }
        let (stride, kept) = (self.times.stride, &self.times.kept);
        let place = (row / stride) as usize;
        let known = |at: usize| {
            let time = kept.get(at).copied().filter(|time| time.is_finite())?;
            Some((at as u64 * stride, time))
        };
        let before = (0..=place).rev().find_map(known)?;
        let after = known(place + 1).or(self.last)?;
        let part = (row - before.0) as f64 / (after.0 - before.0) as f64;
        Some(before.1 + (after.1 - before.1) * part)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scan(times: &[f64]) -> TimeScan {
        let mut scan = TimeScan::default();
        times.chunks(3).for_each(|block| scan.take(block));
        scan
    }

    #[test]
    fn closed_form_intervals() {
        let regular: Vec<f64> = (0..9).map(|i| 0.5 * f64::from(i)).collect();
        let found = scan(&regular);
        assert_eq!(found.median_interval(), Some(0.5));
        assert_eq!((found.irregular(), found.backwards()), (None, None));
        assert_eq!(found.at(3), Some(1.5));
        let found = scan(&[0.0, 1.0, 2.0, 4.5, 5.5, 5.5]);
        assert_eq!(found.irregular().map(|s| s.row), Some(3));
        assert_eq!(found.backwards().map(|s| s.row), Some(5));
    }

    #[test]
    fn closed_form_times_of_a_long_channel_lie_on_its_line() {
        let mut scan = TimeScan::default();
        let n = 300_000_u64;
        (0..n).for_each(|i| scan.take(&[i as f64 * 0.25]));
        for row in [0, 1, 77_777, n - 2, n - 1] {
            let time = scan.at(row).unwrap();
            assert!((time - row as f64 * 0.25).abs() < 1e-9, "{row} {time}");
        }
    }
}
