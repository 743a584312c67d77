//! One channel looked through in bounded memory: extremes, clipping, spikes.

use crate::scan_decimated::Decimated;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Successive samples at an extreme value that look like clipping.
pub const CLIPPED_RUN: u64 = 4;

/// A plateau has a side that is steeper than this many of the channel's smallest steps: the
/// rounded top of a pulse that is stored in coarse steps has none; 1.
const CORNER: f64 = 4.0;

/// Distinct values up to which a channel is a logic level, never clipped.
const LOGIC_LEVELS: usize = 3;

/// Fewest samples among which a spike, or a level of rest, can be told.
const LEAST_TOLD: u64 = 50;

/// Part of the steps between samples that counts as usual.
const USUAL_STEPS: f64 = 0.99;

/// … and by this many times the steps beside it: the top of a short pulse does not.
const LONELY: f64 = 5.0;

/// A channel rests at an extreme that is nearer to its median than this part of the distance
/// of the other extreme.
const RESTS: f64 = 0.25;

/// A spike has two large steps: those of two spikes are never usual.
const STEPS_OF_SPIKES: usize = 5;

/// A spike stands out by this many times the usual step.
const SPIKE: f64 = 10.0;

/// Most samples that are remembered as standing out.
const MOST_SPIKES: usize = 4096;

/// What one pass over a channel has found so far; missing samples are skipped.
#[derive(Clone, Debug, Default)]
pub struct ValueScan {
    /// Rows, with and without a sample.
    pub rows: u64,
    /// Rows with a finite sample.
    pub samples: u64,
    /// Samples that are infinite.
    pub infinite: u64,
    first: Option<u64>,
    last: Option<u64>,
    /// Smallest sample.
    pub smallest: Option<f64>,
    /// Largest sample.
    pub largest: Option<f64>,
    run: u64,
    at_smallest: Plateau,
    at_largest: Plateau,
    smallest_step: Option<f64>,
    levels: Vec<f64>,
    // Counts of distances 1, 2, … between rows with a sample.
    gaps: Vec<u64>,
    before: [Option<f64>; 4],
    values: Decimated,
    steps: Decimated,
    spikes: BinaryHeap<StandingOut>,
    forgotten: bool,
}

/// Samples that stand at one value.
#[derive(Clone, Copy, Debug, Default)]
struct Plateau {
    /// Most successive ones.
    run: u64,
    /// Largest step to that value or from it; unit of the channel.
    step: f64,
}

/// Longest usual distance between rows with a sample.
const LONGEST_GAP: usize = 64;

/// A sample outside the span of its neighbours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StandingOut {
    /// By how much; unit of the channel.
    pub by: f64,
    /// Number of the sample, from 0, blanks not counted.
    pub sample: u64,
    /// The sample before, the sample, the sample after.
    pub values: [f64; 3],
}

impl Eq for StandingOut {}

impl PartialOrd for StandingOut {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// The one that stands out least is the greatest: it is forgotten first.
impl Ord for StandingOut {
    fn cmp(&self, other: &Self) -> Ordering {
        let by = other.by.total_cmp(&self.by);
        by.then(self.sample.cmp(&other.sample))
    }
}

/// Spikes of a channel.
#[derive(Clone, Debug, PartialEq)]
pub struct Spikes {
    /// Number; at least this many where `more`.
    pub count: usize,
    /// The first of them.
    pub first: StandingOut,
    /// Whether there may be more.
    pub more: bool,
}

impl ValueScan {
    /// Takes the next samples; NaN where there is none.
    pub fn take(&mut self, samples: &[f64]) {
        for &value in samples {
            let row = self.rows;
            self.rows += 1;
            if value.is_nan() {
                continue;
            }
            if value.is_infinite() {
                self.infinite += 1;
                continue;
            }
            self.sample(row, value);
        }
    }

    fn sample(&mut self, row: u64, value: f64) {
        if let Some(last) = self.last {
            let gap = (row - last).min(LONGEST_GAP as u64) as usize;
            self.gaps.resize(LONGEST_GAP, 0);
            self.gaps[gap - 1] += 1;
        }
        self.first.get_or_insert(row);
        self.last = Some(row);
        if self.levels.len() <= LOGIC_LEVELS && !self.levels.contains(&value) {
            self.levels.push(value);
        }
        self.extremes(value);
        self.values.push(value);
        if let Some(last) = self.before[0] {
            self.steps.push((value - last).abs());
        }
        if let [Some(after), Some(own), Some(before), first] = self.before {
            let outer = [value - after, first.map_or(0.0, |first| before - first)];
            self.stands_out([before, own, after], outer);
        }
        self.before = [Some(value), self.before[0], self.before[1], self.before[2]];
        self.samples += 1;
    }

    fn extremes(&mut self, value: f64) {
        let step = self.before[0].map_or(0.0, |before| (value - before).abs());
        self.run = match self.before[0] == Some(value) {
            true => self.run + 1,
            false => 1,
        };
        if step > 0.0 && self.smallest_step.is_none_or(|smallest| step < smallest) {
            self.smallest_step = Some(step);
        }
        if self.smallest.is_none_or(|smallest| value < smallest) {
            (self.smallest, self.at_smallest) = (Some(value), Plateau::default());
        }
        if self.largest.is_none_or(|largest| value > largest) {
            (self.largest, self.at_largest) = (Some(value), Plateau::default());
        }
        let extremes = [
            (self.smallest, &mut self.at_smallest),
            (self.largest, &mut self.at_largest),
        ];
        for (extreme, plateau) in extremes {
            if extreme == Some(value) {
                plateau.run = plateau.run.max(self.run);
            }
            if extreme == Some(value) || extreme == self.before[0] {
                plateau.step = plateau.step.max(step);
            }
        }
    }

    /// * `outer`: the steps beside the two that `values` make
    fn stands_out(&mut self, values: [f64; 3], outer: [f64; 2]) {
        let (low, high) = (values[0].min(values[2]), values[0].max(values[2]));
        let by = (values[1] - high).max(low - values[1]);
        if by <= LONELY * outer[0].abs().max(outer[1].abs()) || by <= 0.0 {
            return;
        }
        let sample = self.samples - 2;
        self.spikes.push(StandingOut { by, sample, values });
        if self.spikes.len() > MOST_SPIKES {
            self.spikes.pop();
            self.forgotten = true;
        }
    }

    /// First and last row with a sample.
    pub fn span(&self) -> Option<(u64, u64)> {
        self.first.zip(self.last)
    }

    /// Usual number of rows from one sample to the next: the median.
    pub fn usual_gap(&self) -> Option<u64> {
        let total: u64 = self.gaps.iter().sum();
        let mut counted = 0;
        let median = self.gaps.iter().position(|count| {
            counted += count;
            2 * counted >= total && total > 0
        })?;
        Some(median as u64 + 1)
    }

    /// An extreme value at which the channel stands, and for how many samples.
    ///
    /// That is no clipping where it is zero, as of a force plate that nobody stands on, where
    /// the channel rests there, or where it gets there in its smallest steps.
    pub fn clipped(&self) -> Option<(f64, u64)> {
        if self.levels.len() <= LOGIC_LEVELS {
            return None;
        }
        let (low, high) = (self.smallest?, self.largest?);
        let middle = self.values.quantile(0.5, 1)?;
        let far = (high - middle).max(middle - low);
        let extremes = [(low, self.at_smallest), (high, self.at_largest)];
        let clips = |(value, plateau): &(f64, Plateau)| {
            let rests = self.samples >= LEAST_TOLD && (value - middle).abs() <= RESTS * far;
            let corner = plateau.step > CORNER * self.smallest_step.unwrap_or(0.0);
            plateau.run >= CLIPPED_RUN && *value != 0.0 && !rests && corner
        };
        let clipped = extremes.into_iter().find(clips);
        clipped.map(|(value, plateau)| (value, plateau.run))
    }

    /// The only value of a channel with so many samples that a live one would have more.
    pub fn dead(&self) -> Option<f64> {
        (self.levels.len() == 1 && self.samples >= LEAST_TOLD).then(|| self.levels[0])
    }

    /// Samples far from both neighbours, against what the channel usually does.
    pub fn spikes(&self) -> Option<Spikes> {
        if self.samples < LEAST_TOLD {
            return None;
        }
        let usual = self.steps.quantile(USUAL_STEPS, STEPS_OF_SPIKES)?;
        let out = |spike: &&StandingOut| usual > 0.0 && spike.by > SPIKE * usual;
        let first = self.spikes.iter().filter(out).min_by_key(|s| s.sample)?;
        let count = self.spikes.iter().filter(out).count();
        Some(Spikes {
            count,
            first: *first,
            more: self.forgotten && count == MOST_SPIKES,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scan(values: &[f64], block: usize) -> ValueScan {
        let mut scan = ValueScan::default();
        values.chunks(block).for_each(|block| scan.take(block));
        scan
    }

    #[test]
    fn recovers_a_glitch_put_into_a_sine() {
        let smooth: Vec<f64> = (0..200).map(|i| (0.1 * f64::from(i)).sin()).collect();
        assert_eq!(scan(&smooth, 7).spikes(), None);
        let mut glitched = smooth;
        glitched[77] = 6.0;
        for block in [1, 3, 200] {
            let found = scan(&glitched, block).spikes().unwrap();
            assert_eq!(
                (found.count, found.first.sample, found.more),
                (1, 77, false)
            );
            assert_eq!(found.first.values[1], 6.0);
        }
    }

    #[test]
    fn closed_form_runs_at_the_extremes() {
        let values = [1.0, 1.0, 1.0, 1.0, 2.0, 3.0, 9.0, 9.0, 9.0, 0.5, 9.0];
        assert_eq!(scan(&values, 4).clipped(), None);
        let values = [1.0, 2.0, 3.0, 9.0, f64::NAN, 9.0, 9.0, 9.0, 0.5];
        assert_eq!(scan(&values, 2).clipped(), Some((9.0, 4)));
        // Rest at an extreme, and flight at zero.
        let mut values = vec![1.3; 60];
        values.extend([1.2, 0.0, -2.0, -3.0, -1.0, 1.1]);
        assert_eq!(scan(&values, 4).clipped(), None);
        let values = [4.0, 4.1, 4.2, 0.0, 0.0, 0.0, 0.0, 0.0, 6.0, 9.0, 4.0, 4.1];
        assert_eq!(scan(&values, 4).clipped(), None);
        // The top of a half sine in 40 steps, and cut off at 30 of them.
        let half_sine = (0..400).map(|i| (40.0 * (f64::from(i) / 127.3).sin()).round());
        let half_sine: Vec<f64> = half_sine.collect();
        assert_eq!(scan(&half_sine, 4).clipped(), None);
        let mut fine: Vec<f64> = vec![0.0; 400];
        fine.extend((0..400).map(|i| (40.0 * (f64::from(i) / 127.3).sin()).min(30.0)));
        let found = scan(&fine, 4).clipped();
        assert!(found.is_some_and(|(limit, run)| limit == 30.0 && run > 100));
        assert_eq!(scan(&[2.5; 60], 7).dead(), Some(2.5));
        assert_eq!(scan(&half_sine, 7).dead(), None);
        // Two levels are logic, not clipping.
        let values = [0.0, 0.0, 0.0, 0.0, 5.0, 5.0, 5.0, 5.0];
        assert_eq!(scan(&values, 3).clipped(), None);
    }

    #[test]
    fn closed_form_gaps_and_span() {
        let blank = f64::NAN;
        let values = [blank, 1.0, blank, 2.0, blank, 3.0, 4.0, f64::INFINITY];
        let scan = scan(&values, 3);
        assert_eq!((scan.rows, scan.samples, scan.infinite), (8, 4, 1));
        assert_eq!((scan.span(), scan.usual_gap()), (Some((1, 6)), Some(2)));
        assert_eq!((scan.smallest, scan.largest), (Some(1.0), Some(4.0)));
    }
}
