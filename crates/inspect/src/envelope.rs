//! The outline of a channel of any length, for plots.

/// Most buckets.
const MOST: usize = 4096;

/// Smallest and largest sample of a stretch of rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bucket {
    /// First row with a sample.
    pub row: u64,
    /// First sample.
    pub first: f64,
    /// Last sample.
    pub last: f64,
    /// Smallest sample.
    pub smallest: f64,
    /// Largest sample.
    pub largest: f64,
}

/// The outline of a channel of any length with all extremes; up to 4096 rows it keeps
/// every sample. It does not depend on how samples are cut into blocks.
#[derive(Clone, Debug)]
pub struct Envelope {
    /// Rows in a bucket.
    pub rows_per_bucket: u64,
    rows: u64,
    // One per stretch of rows; `None` where no row has a sample.
    buckets: Vec<Option<Bucket>>,
}

impl Default for Envelope {
    fn default() -> Self {
        Self {
            rows_per_bucket: 1,
            rows: 0,
            buckets: Vec::new(),
        }
    }
}

impl Envelope {
    /// Takes the next samples; NaN where there is none.
    pub fn take(&mut self, samples: &[f64]) {
        for &value in samples {
            let row = self.rows;
            self.rows += 1;
            // Blank rows take no room: a channel of few samples beside long ones
            // is kept sample by sample.
            if !value.is_finite() {
                continue;
            }
            while row / self.rows_per_bucket >= MOST as u64 {
                self.halve();
            }
            let place = (row / self.rows_per_bucket) as usize;
            if place >= self.buckets.len() {
                self.buckets.resize(place + 1, None);
            }
            let single = Bucket {
                row,
                first: value,
                last: value,
                smallest: value,
                largest: value,
            };
            self.buckets[place] = joined(self.buckets[place], Some(single));
        }
    }

    fn halve(&mut self) {
        let pairs = self.buckets.chunks(2);
        self.buckets = pairs
            .map(|pair| joined(pair[0], pair.get(1).copied().flatten()))
            .collect();
        self.rows_per_bucket *= 2;
    }

    /// The stretches that have samples, in order.
    pub fn buckets(&self) -> impl Iterator<Item = Bucket> + '_ {
        self.buckets.iter().flatten().copied()
    }
}

fn joined(a: Option<Bucket>, b: Option<Bucket>) -> Option<Bucket> {
    let (Some(first), Some(second)) = (a, b) else {
        return a.or(b);
    };
    Some(Bucket {
        row: first.row,
        first: first.first,
        last: second.last,
        smallest: first.smallest.min(second.smallest),
        largest: first.largest.max(second.largest),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conserves_extremes_for_any_blocks() {
        let mut values: Vec<f64> = (0..50_000).map(|i| (0.01 * f64::from(i)).sin()).collect();
        values[31_234] = 17.0;
        values[7] = f64::NAN;
        let outline = |block: usize| {
            let mut envelope = Envelope::default();
            values.chunks(block).for_each(|block| envelope.take(block));
            envelope
        };
        let whole = outline(values.len());
        let buckets: Vec<Bucket> = whole.buckets().collect();
        assert!(buckets.len() <= MOST && buckets.len() >= MOST / 2);
        assert!(buckets.iter().any(|b| b.largest == 17.0));
        assert_eq!(buckets[0].row, 0);
        for block in [1, 999] {
            assert!(outline(block).buckets().eq(buckets.iter().copied()));
        }
    }

    #[test]
    fn closed_form_short_channels_are_kept_sample_by_sample() {
        let mut envelope = Envelope::default();
        envelope.take(&[1.0, f64::NAN, 3.0]);
        let rows: Vec<(u64, f64)> = envelope.buckets().map(|b| (b.row, b.first)).collect();
        assert_eq!(rows, [(0, 1.0), (2, 3.0)]);
        assert_eq!(envelope.rows_per_bucket, 1);
        envelope.take(&vec![f64::NAN; 3 * MOST]);
        assert_eq!(envelope.buckets().count(), 2);
        assert_eq!(envelope.rows_per_bucket, 1);
    }
}
