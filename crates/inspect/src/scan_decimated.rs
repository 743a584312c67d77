//! A bounded choice out of a stream of unknown length.

/// Most values that are kept.
const MOST: usize = 1 << 16;

/// Every value of a stream while it is short, then every second, fourth, ….
#[derive(Clone, Debug)]
pub struct Decimated {
    /// The values kept; value `i` was number `i · stride` of the stream.
    pub kept: Vec<f64>,
    /// Values of the stream per value kept.
    pub stride: u64,
    /// Values of the stream so far.
    pub seen: u64,
}

impl Default for Decimated {
    fn default() -> Self {
        Self {
            kept: Vec::new(),
            stride: 1,
            seen: 0,
        }
    }
}

impl Decimated {
    /// Takes the next value.
    pub fn push(&mut self, value: f64) {
        if self.seen.is_multiple_of(self.stride) {
            if self.kept.len() == MOST {
                self.kept = self.kept.iter().copied().step_by(2).collect();
                self.stride *= 2;
            }
            if self.seen.is_multiple_of(self.stride) {
                self.kept.push(value);
            }
        }
        self.seen += 1;
    }

    /// The kept value of that rank in rising order, a part of their number; 1.
    ///
    /// * `from_above`: how far the rank stays below the number kept at least
    pub fn quantile(&self, part: f64, from_above: usize) -> Option<f64> {
        let mut values = self.kept.clone();
        let last = values.len().checked_sub(from_above)?;
        let rank = ((part * values.len() as f64) as usize).min(last);
        if rank >= values.len() {
            return None;
        }
        Some(*values.select_nth_unstable_by(rank, f64::total_cmp).1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_every_value_then_every_second() {
        let mut decimated = Decimated::default();
        (0..MOST).for_each(|i| decimated.push(i as f64));
        assert_eq!((decimated.kept.len(), decimated.stride), (MOST, 1));
        (MOST..2 * MOST + 1).for_each(|i| decimated.push(i as f64));
        let stride = decimated.stride;
        assert_eq!(stride, 4);
        let expected: Vec<f64> = (0..2 * MOST as u64 + 1)
            .step_by(stride as usize)
            .map(|i| i as f64)
            .collect();
        assert_eq!(decimated.kept, expected);
        assert_eq!(decimated.seen, 2 * MOST as u64 + 1);
    }

    #[test]
    fn closed_form_quantile_of_few() {
        let mut decimated = Decimated::default();
        [5.0, 1.0, 3.0].into_iter().for_each(|v| decimated.push(v));
        assert_eq!(decimated.quantile(0.5, 1), Some(3.0));
        assert_eq!(decimated.quantile(0.99, 1), Some(5.0));
        assert_eq!(Decimated::default().quantile(0.5, 1), None);
    }
}
