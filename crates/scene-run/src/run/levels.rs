//! Levels of many numbers in bounded memory.

use std::collections::BTreeMap;
use windfall_scene::binary;

/// How many numbers fell into each of narrow bins; the least and the largest as they are.
///
/// A bin is 2⁻¹² of its numbers wide, so that a level errs by at most 0.013 %; the number of
/// bins is bounded by the range of the numbers (4096 for each doubling), not by their count.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Levels {
    bins: BTreeMap<u32, u64>,
    count: u64,
    least: f64,
    largest: f64,
}

binary!(Levels {
    bins,
    count,
    least,
    largest
});

/// Bits of a single-precision number that its bin does not see.
const UNSEEN: u32 = 11;
const SIGN: u32 = 1 << 31;

impl Levels {
    /// Adds a number.
    pub fn add(&mut self, number: f64) {
        // Bits in the order of the numbers.
        let bits = (number as f32).to_bits();
        let ordered = if bits & SIGN == 0 { bits | SIGN } else { !bits };
        *self.bins.entry(ordered >> UNSEEN).or_default() += 1;
        (self.least, self.largest) = match self.count {
            0 => (number, number),
            _ => (self.least.min(number), self.largest.max(number)),
        };
        self.count += 1;
    }

    /// The smallest number that a share of all do not exceed; NaN where there are none.
    pub fn level(&self, share: f64) -> f64 {
        let rank = ((share * self.count as f64).ceil() as u64).clamp(1, self.count.max(1));
        if rank == self.count {
            return self.largest;
        }
        let mut below = 0;
        for (bin, count) in &self.bins {
            below += count;
            if below >= rank {
                let ordered = (bin << UNSEEN) | (1 << (UNSEEN - 1));
                let bits = if ordered & SIGN == 0 {
                    !ordered
                } else {
                    ordered & !SIGN
                };
                return f64::from(f32::from_bits(bits)).clamp(self.least, self.largest);
            }
        }
        f64::NAN
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_levels_of_sorted_numbers() {
        // As good as random over eight orders of magnitude, of both signs.
        let mut numbers = Vec::new();
        let mut levels = Levels::default();
        for n in 0..20_001_u64 {
            let share = (n as f64 * 0.618_033_988_749_894_9).fract();
            let number = 10.0_f64.powf(8.0 * share - 4.0) * if n % 5 == 0 { -1.0 } else { 1.0 };
            numbers.push(number);
            levels.add(number);
        }
        numbers.sort_by(f64::total_cmp);
        for share in [0.01, 0.1, 0.5, 0.95, 0.999] {
            let wanted = numbers[(share * numbers.len() as f64).ceil() as usize - 1];
            let found = levels.level(share);
            assert!(
                (found / wanted - 1.0).abs() < 1.3e-4,
                "{share}: {found} {wanted}"
            );
        }
        assert_eq!(levels.level(1.0), numbers[20_000]);
        assert!(levels.level(0.0) >= numbers[0]);
    }

    #[test]
    fn a_few_numbers() {
        let mut levels = Levels::default();
        assert!(levels.level(0.5).is_nan());
        levels.add(0.1);
        assert_eq!([0.0, 0.5, 1.0].map(|share| levels.level(share)), [0.1; 3]);
    }

    #[test]
    fn memory_does_not_grow_with_the_count() {
        let mut levels = Levels::default();
        for n in 0..300_000 {
            levels.add(1.0 + n as f64 / 100_000.0);
        }
        // Two doublings.
        assert!(levels.bins.len() <= 2 * 4096 + 1, "{}", levels.bins.len());
    }
}
