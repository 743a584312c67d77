//! Splits an array, read in storage order, into its channels.

use crate::arrays::tree::Series;
use crate::reader::Sink;
use windfall_source::error::Error;

/// Passes the elements of an array on to the requested channels.
pub(crate) struct Pass {
    /// Position among the requested channels, and where the samples are.
    wanted: Vec<(usize, Series)>,
    gathered: Vec<f64>,
}

impl Pass {
    /// A pass for the requested channels within one array.
    pub fn new(array: usize, wanted: &[usize], series: &[Series]) -> Self {
        let wanted = wanted
            .iter()
            .enumerate()
            .map(|(position, &channel)| (position, series[channel]))
            .filter(|(_, series)| series.array == array)
            .collect();
        Self {
            wanted,
            gathered: Vec::new(),
        }
    }

    /// The range of elements needed; the end is exclusive.
    pub fn range(&self) -> (u64, u64) {
        let first = self.wanted.iter().map(|(_, s)| s.start).min();
        let end = self.wanted.iter().map(|(_, s)| end_of(s)).max();
        (first.unwrap_or(0), end.unwrap_or(0))
    }

    /// Takes the next elements of the array, starting with number `first`.
    pub fn take(&mut self, first: u64, elements: &[f64], sink: &mut dyn Sink) -> Result<(), Error> {
        let end = first + elements.len() as u64;
        for (position, series) in &self.wanted {
            let (from, to) = (first.max(series.start), end.min(end_of(series)));
            if from >= to {
                continue;
            }
            if series.step == 1 {
                let part = &elements[(from - first) as usize..(to - first) as usize];
                sink.take(*position, part)?;
                continue;
            }
            let next = (from - series.start).div_ceil(series.step) * series.step + series.start;
            if next >= to {
                continue;
            }
            let part = &elements[(next - first) as usize..(to - first) as usize];
            self.gathered.clear();
            self.gathered
                .extend(part.iter().step_by(series.step as usize));
            sink.take(*position, &self.gathered)?;
        }
        Ok(())
    }
}

/// One past the last element of a series.
fn end_of(series: &Series) -> u64 {
    match series.length {
        0 => series.start,
        n => series
            .start
            .saturating_add((n - 1).saturating_mul(series.step))
            .saturating_add(1),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Kept(Vec<Vec<f64>>);

    impl Sink for Kept {
        fn take(&mut self, position: usize, samples: &[f64]) -> Result<(), Error> {
            self.0[position].extend_from_slice(samples);
            Ok(())
        }
    }

    #[test]
    fn closed_form_columns_and_rows_in_blocks_of_any_size() {
        // Three columns of four: element e is in column e / 4 and in row e % 4.
        let elements: Vec<f64> = (0..12).map(f64::from).collect();
        let series = |start, step, length| Series {
            array: 0,
            start,
            step,
            length,
        };
        for block in 1..13 {
            let mut kept = Kept(vec![Vec::new(); 3]);
            let all = [series(4, 1, 4), series(3, 4, 3), series(1, 4, 3)];
            let mut pass = Pass::new(0, &[0, 1, 2], &all);
            assert_eq!(pass.range(), (1, 12));
            for (i, part) in elements.chunks(block).enumerate() {
                pass.take((i * block) as u64, part, &mut kept).unwrap();
            }
            assert_eq!(kept.0[0], [4.0, 5.0, 6.0, 7.0]);
            assert_eq!(kept.0[1], [3.0, 7.0, 11.0]);
            assert_eq!(kept.0[2], [1.0, 5.0, 9.0]);
        }
    }
}
