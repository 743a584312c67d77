//! A quantity over time in bounded memory, for figures.

use windfall_scene::binary;

/// Sums or largest values over bins of time.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Trace {
    /// Width of a bin; s.
    pub width: f64,
    /// Of each bin; NaN where nothing was seen.
    values: Vec<f64>,
}

binary!(Trace { width, values });

/// Bins at most, about.
const MOST: f64 = 1000.0;

impl Trace {
    /// Bins of a whole number of intervals each.
    ///
    /// * `interval`, `end`: of the sensor, and of the scene; s
    pub fn new(interval: f64, end: f64) -> Self {
        let intervals = (end / interval / MOST).ceil().max(1.0);
        Self {
            width: intervals * interval,
            values: Vec::new(),
        }
    }

    fn at(&mut self, time: f64) -> &mut f64 {
        // A sample on an edge belongs to the bin that it begins.
        let bin = (time / self.width + 1e-9).max(0.0) as usize;
        if self.values.len() <= bin {
            self.values.resize(bin + 1, f64::NAN);
        }
        &mut self.values[bin]
    }

    /// Adds to the sum of a bin.
    pub fn add(&mut self, time: f64, value: f64) {
        let bin = self.at(time);
        *bin = value + if bin.is_nan() { 0.0 } else { *bin };
    }

    /// Raises the largest value of a bin.
    pub fn reach(&mut self, time: f64, value: f64) {
        let bin = self.at(time);
        *bin = bin.max(value);
    }

    /// Bins in which something was seen: middle and value.
    pub fn points(&self) -> Vec<(f64, f64)> {
        let points = self.values.iter().enumerate();
        let points = points.map(|(bin, value)| ((bin as f64 + 0.5) * self.width, *value));
        points.filter(|own| !own.1.is_nan()).collect()
    }

    /// Rates as an outline of bars; nothing seen is zero.
    ///
    /// * `since`, `until`: when the scene began and ended; bins are cut off there; s
    pub fn rates(&self, [since, until]: [f64; 2]) -> Vec<(f64, f64)> {
        let mut outline = vec![(since, 0.0)];
        let bins = (until / self.width - 1e-9).ceil().max(1.0) as usize;
        let first = (since / self.width + 1e-9).max(0.0) as usize;
        for bin in first..bins {
            let edges = [bin, bin + 1].map(|edge| edge as f64 * self.width);
            let [from, to] = edges.map(|edge| edge.clamp(since, until));
            let value = self.values.get(bin).filter(|own| !own.is_nan());
            let rate = value.map_or(0.0, |own| own / (to - from));
            outline.extend([(from, rate), (to, rate)]);
        }
        outline.push((until, 0.0));
        outline
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conserves_sums_and_largest_values_in_bounded_memory() {
        let mut sums = Trace::new(0.001, 100.0);
        let mut largest = Trace::new(0.001, 100.0);
        for sample in 0..100_000_u32 {
            let time = f64::from(sample) * 0.001;
            sums.add(time, 1.0);
            largest.reach(time, if sample == 54_321 { 7.0 } else { 1.0 });
        }
        assert!(sums.values.len() <= 1000, "{}", sums.values.len());
        assert_eq!(sums.values.iter().sum::<f64>(), 100_000.0);
        let peak: Vec<(f64, f64)> = largest
            .points()
            .into_iter()
            .filter(|own| own.1 > 1.0)
            .collect();
        assert_eq!(peak.len(), 1);
        assert!((peak[0].0 - 54.321).abs() <= 0.05 && peak[0].1 == 7.0);
        // A thousand a second, also in the last bin.
        let rates = sums.rates([0.0, 100.0]);
        let inner = &rates[1..rates.len() - 1];
        assert!(inner.iter().all(|own| (own.1 - 1000.0).abs() < 1e-6));
    }
}
