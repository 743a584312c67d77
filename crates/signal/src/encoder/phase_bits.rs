//! Phases of an encoder as one bit per sample, decoded 64 samples at a time.

use crate::error::Error;

/// Half-width of the switching band as a part of the distance between the two
/// levels; 1. A level must cross 30 % (falling) or 70 % (rising) to switch.
const HYSTERESIS: f64 = 0.2;

/// Least distance of two levels, in their own standard deviations (one noisy level split: 2.6).
const DISTINCT_LEVELS: f64 = 5.0;

/// Rounds that move the levels from the extremes to the means, at most.
const ROUNDS: usize = 8;

/// Sums that run beside each other, so that they can share vector registers.
const LANES: usize = 8;

/// One phase: bit `i % 64` of word `i / 64` is high if sample `i` is.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PhaseBits {
    /// 64 samples each; bits after the last sample repeat it.
    pub words: Vec<u64>,
    /// Number of samples.
    pub samples: usize,
}

/// A phase out of the bytes of a logic capture.
///
/// * `bit`: which bit of a byte, 0 to 7; higher ones are taken modulo 8
pub fn phase_of_bytes(bytes: &[u8], bit: u32) -> PhaseBits {
    const ONES: u64 = 0x0101_0101_0101_0101;
    // Bits 0, 8, … 56 times this gather in the highest byte, in order.
    const GATHER: u64 = 0x0102_0408_1020_4080;
    let shift = bit % 8;
    let mut words = Vec::with_capacity(bytes.len().div_ceil(64));
    let (blocks, rest) = bytes.as_chunks::<64>();
    for block in blocks {
        let (eights, _) = block.as_chunks::<8>();
        let mut word = 0u64;
        for (i, eight) in eights.iter().enumerate() {
            let ones = (u64::from_le_bytes(*eight) >> shift) & ONES;
            word |= (ones.wrapping_mul(GATHER) >> 56) << (8 * i);
        }
        words.push(word);
    }
    let mut last = rest.iter().enumerate().fold(0u64, |word, (i, byte)| {
        word | u64::from((byte >> shift) & 1) << i
    });
    if let Some(final_byte) = rest.last() {
        if (final_byte >> shift) & 1 == 1 {
            last |= u64::MAX << rest.len();
        }
        words.push(last);
    }
    PhaseBits {
        words,
        samples: bytes.len(),
    }
}

/// A phase out of volts or logic levels, switching midway between its two levels.
///
/// * `name`: of the channel, for messages
///
/// # Errors
/// [`Error::PhaseLevels`] if the samples show no two levels.
pub fn phase_of_volts(name: &str, samples: &[f64]) -> Result<PhaseBits, Error> {
    let (low, high) = extremes(samples);
    let levels = two_levels(samples, low, high).ok_or_else(|| Error::PhaseLevels {
        channel: name.to_owned(),
        low,
        high,
    })?;
    let middle = 0.5 * (levels.0 + levels.1);
    let band = HYSTERESIS * (levels.1 - levels.0);
    let (rise, fall) = (middle + band, middle - band);
    let mut state = samples.first().is_some_and(|&first| first > middle);
    let mut words = Vec::with_capacity(samples.len().div_ceil(64));
    let (blocks, rest) = samples.as_chunks::<64>();
    for block in blocks {
        let (above, below) = (
            bits_where(block, |v| v > rise),
            bits_where(block, |v| v < fall),
        );
        let word = held(above, below, state);
        state = word >> 63 == 1;
        words.push(word);
    }
    if !rest.is_empty() {
        let mut block = [middle; 64];
        block[..rest.len()].copy_from_slice(rest);
        let (above, below) = (
            bits_where(&block, |v| v > rise),
            bits_where(&block, |v| v < fall),
        );
        words.push(held(above, below, state));
    }
    Ok(PhaseBits {
        words,
        samples: samples.len(),
    })
}

/// Bit i is set where `test` holds for sample i.
#[inline]
fn bits_where(block: &[f64; 64], test: impl Fn(f64) -> bool) -> u64 {
    let (eights, _) = block.as_chunks::<8>();
    let mut word = 0;
    for (i, eight) in eights.iter().enumerate() {
        let mut byte = 0u64;
        for (j, &value) in eight.iter().enumerate() {
            byte |= u64::from(test(value)) << j;
        }
        word |= byte << (8 * i);
    }
    word
}

/// High where above, low where below, as before where neither.
fn held(above: u64, below: u64, mut state: bool) -> u64 {
    let mut open = !(above | below);
    let mut word = above;
    // Runs of open bits take the state of the bit under them.
    while open != 0 {
        let first = open.trailing_zeros();
        let run = (!(open >> first)).trailing_zeros();
        let bits = if run >= 64 { u64::MAX } else { (1 << run) - 1 } << first;
        if first > 0 {
            state = (word >> (first - 1)) & 1 == 1;
        }
        if state {
            word |= bits;
        }
        open &= !bits;
    }
    word
}

fn extremes(samples: &[f64]) -> (f64, f64) {
    let mut low = [f64::INFINITY; LANES];
    let mut high = [f64::NEG_INFINITY; LANES];
    let (chunks, rest) = samples.as_chunks::<LANES>();
    let less = |a: f64, b: f64| if b < a { b } else { a };
    let more = |a: f64, b: f64| if b > a { b } else { a };
    for chunk in chunks {
        for i in 0..LANES {
            low[i] = less(low[i], chunk[i]);
            high[i] = more(high[i], chunk[i]);
        }
    }
    for &value in rest {
        low[0] = less(low[0], value);
        high[0] = more(high[0], value);
    }
    (
        low.into_iter().fold(f64::INFINITY, less),
        high.into_iter().fold(f64::NEG_INFINITY, more),
    )
}

/// Mean of the samples above and below a middle that lies midway between them.
fn two_levels(samples: &[f64], low: f64, high: f64) -> Option<(f64, f64)> {
    let mut levels = (low, high);
    let mut spread = 0.0;
    for _ in 0..ROUNDS {
        let before = levels;
        let middle = 0.5 * (levels.0 + levels.1);
        let (all, above) = side_sums(samples, middle);
        let below = Sums {
            number: all.number - above.number,
            sum: all.sum - above.sum,
            squares: all.squares - above.squares,
        };
        if below.number < 0.5 || above.number < 0.5 {
            return None;
        }
        levels = (middle + below.mean(), middle + above.mean());
        let squares = below.squares_about_mean() + above.squares_about_mean();
        spread = (squares.max(0.0) / samples.len() as f64).sqrt();
        // The same sides give the same levels but for rounding.
        let moved = (levels.0 - before.0).abs() + (levels.1 - before.1).abs();
        if moved <= 1e-9 * (levels.1 - levels.0) {
            break;
        }
    }
    (levels.1 - levels.0 > DISTINCT_LEVELS * spread).then_some(levels)
}

/// Number, sum and sum of squares.
#[derive(Clone, Copy, Default)]
struct Sums {
    number: f64,
    sum: f64,
    squares: f64,
}

impl Sums {
    fn mean(&self) -> f64 {
        self.sum / self.number
    }

    fn squares_about_mean(&self) -> f64 {
        self.squares - self.sum * self.mean()
    }
}

/// Sums about `middle` of all samples, and of those above it.
fn side_sums(samples: &[f64], middle: f64) -> (Sums, Sums) {
    let mut number = [0.0; LANES];
    let mut sum = [[0.0; LANES]; 2];
    let mut squares = [[0.0; LANES]; 2];
    let mut add = |i: usize, value: f64| {
        let (deviation, above) = (value - middle, value > middle);
        let part = if above { deviation } else { 0.0 };
        number[i] += if above { 1.0 } else { 0.0 };
        sum[0][i] += deviation;
        sum[1][i] += part;
        squares[0][i] += deviation * deviation;
        squares[1][i] += part * part;
    };
    let (chunks, rest) = samples.as_chunks::<LANES>();
    for chunk in chunks {
        for (i, &value) in chunk.iter().enumerate() {
            add(i, value);
        }
    }
    for &value in rest {
        add(0, value);
    }
    let total = |lanes: [f64; LANES]| lanes.into_iter().sum::<f64>();
    let all = Sums {
        number: samples.len() as f64,
        sum: total(sum[0]),
        squares: total(squares[0]),
    };
    let above = Sums {
        number: total(number),
        sum: total(sum[1]),
        squares: total(squares[1]),
    };
    (all, above)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bits(phase: &PhaseBits) -> Vec<u8> {
        (0..phase.samples)
            .map(|i| ((phase.words[i / 64] >> (i % 64)) & 1) as u8)
            .collect()
    }

    #[test]
    fn closed_form_bits_of_bytes() {
        let bytes: Vec<u8> = (0..200u32).map(|i| (i * 37 % 251) as u8).collect();
        for bit in 0..8 {
            for length in [0, 1, 63, 64, 65, 200] {
                let phase = phase_of_bytes(&bytes[..length], bit);
                let expected: Vec<u8> = bytes[..length].iter().map(|b| (b >> bit) & 1).collect();
                assert_eq!(bits(&phase), expected);
            }
        }
    }

    #[test]
    fn closed_form_hysteresis_holds_the_state_near_the_middle() {
        for shift in 0..130 {
            let mut a = vec![0.0; 20 + shift];
            a.extend([2.6, 2.4, 2.6, 4.9, 2.4, 2.6, 2.4, 0.1]);
            a.extend([5.0; 20]);
            let high = bits(&phase_of_volts("A", &a).unwrap());
            assert_eq!(high[19 + shift..29 + shift], [0, 0, 0, 0, 1, 1, 1, 1, 0, 1]);
            assert!(high[..20 + shift].iter().all(|&h| h == 0));
        }
    }

    #[test]
    fn closed_form_open_words_keep_the_state() {
        assert_eq!(held(0, 0, true), u64::MAX);
        assert_eq!(held(0, 0, false), 0);
        assert_eq!(held(1 << 5, 1 << 60, false), (1 << 60) - (1 << 5));
    }
}
