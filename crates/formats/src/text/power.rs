//! Converts decimal numbers to doubles, correctly rounded.

use std::sync::LazyLock;

/// Largest power of ten in the table; the standard library handles the rest.
const LARGEST_POWER: i32 = 80;

/// The leading 128 bits of 5^q for q ≥ −[`LARGEST_POWER`], rounded away from 1.
static FIVES: LazyLock<Vec<u128>> = LazyLock::new(|| {
    (-LARGEST_POWER..=LARGEST_POWER)
        .map(|q| match q < 0 {
            true => reciprocal(&power_of_five(q.unsigned_abs())),
            false => leading_bits(&power_of_five(q.unsigned_abs())),
        })
        .collect()
});

/// 5^n in words of 32 bits, least significant first.
fn power_of_five(n: u32) -> Vec<u32> {
    let mut words = vec![1_u32];
    for _ in 0..n {
        let mut carry = 0_u64;
        for word in &mut words {
            let product = u64::from(*word) * 5 + carry;
            *word = product as u32;
            carry = product >> 32;
        }
        if carry > 0 {
            words.push(carry as u32);
        }
    }
    words
}

fn bit(words: &[u32], index: usize) -> bool {
    words
        .get(index / 32)
        .is_some_and(|word| word >> (index % 32) & 1 == 1)
}

fn bit_length(words: &[u32]) -> usize {
    let last = words.last().copied().unwrap_or(0);
    32 * words.len() - last.leading_zeros() as usize
}

/// The leading 128 bits, padded with zeros.
fn leading_bits(words: &[u32]) -> u128 {
    let length = bit_length(words);
    (0..128).fold(0, |bits, i| {
        bits << 1 | u128::from(i < length && bit(words, length - 1 - i))
    })
}

/// The leading 128 bits of 1/n, rounded up, by long division.
fn reciprocal(n: &[u32]) -> u128 {
    // 2^length / n lies between 1 and 2.
    let mut rest: Vec<u32> = vec![0; n.len() + 1];
    let length = bit_length(n);
    rest[length / 32] |= 1 << (length % 32);
    let mut quotient = 0_u128;
    for _ in 0..128 {
        let fits = !less(&rest, n);
        quotient = quotient << 1 | u128::from(fits);
        if fits {
            subtract(&mut rest, n);
        }
        double(&mut rest);
    }
    quotient + 1
}

fn less(a: &[u32], b: &[u32]) -> bool {
    for i in (0..a.len().max(b.len())).rev() {
        let (x, y) = (
            a.get(i).copied().unwrap_or(0),
            b.get(i).copied().unwrap_or(0),
        );
        if x != y {
            return x < y;
        }
    }
    false
}

fn subtract(a: &mut [u32], b: &[u32]) {
    let mut borrow = 0_i64;
    for (i, word) in a.iter_mut().enumerate() {
        let difference = i64::from(*word) - i64::from(b.get(i).copied().unwrap_or(0)) - borrow;
        borrow = i64::from(difference < 0);
        *word = difference as u32;
    }
}

fn double(words: &mut [u32]) {
    let mut carry = 0;
    for word in words {
        let next = *word >> 31;
        *word = *word << 1 | carry;
        carry = next;
    }
}

/// The double nearest to `mantissa` · 10^`power`; `None` if 128 bits of the power
/// do not decide it or the result is not a normal number.
///
/// # Source
/// D. Lemire (2021), "Number parsing at a gigabyte per second", Softw. Pract.
/// Exper. 51:1700: a product with 128 bits of 5^q decides all but a few cases.
pub fn nearest_double(mantissa: u64, power: i32) -> Option<f64> {
    if mantissa == 0 {
        return Some(0.0);
    }
    let five = *FIVES.get(usize::try_from(power.checked_add(LARGEST_POWER)?).ok()?)?;
    let zeros = mantissa.leading_zeros();
    let scaled = mantissa << zeros;
    // The upper 128 of 192 bits of the product.
    let upper = u128::from(scaled) * (five >> 64);
    let lower = u128::from(scaled) * (five & u128::from(u64::MAX));
    let product = upper + (lower >> 64);
    let (high, low) = ((product >> 64) as u64, product as u64);
    // The truncated part might carry into the bits kept.
    if low == u64::MAX && !(-27..=55).contains(&power) {
        return None;
    }
    let top = high >> 63;
    // 53 bits and a rounding bit.
    let shift = top as u32 + 9;
    let mut kept = high >> shift;
    // floor(q log2 10) as an integer product.
    let log = (power * 217_706) >> 16;
    let exponent = log + 63 + top as i32 - zeros as i32;
    // Exactly half way between two doubles: round to even.
    if low <= 1 && (-4..=23).contains(&power) && kept & 3 == 1 && kept << shift == high {
        kept &= !1;
    }
    kept = (kept + (kept & 1)) >> 1;
    let (kept, exponent) = match kept >> 53 {
        0 => (kept, exponent),
        _ => (kept >> 1, exponent + 1),
    };
    let biased = exponent + 1023;
    if !(1..=2046).contains(&biased) {
        return None;
    }
    Some(f64::from_bits(
        kept & ((1 << 52) - 1) | (biased as u64) << 52,
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn closed_form_powers() {
        let five = |q: i32| FIVES[(q + LARGEST_POWER) as usize];
        assert_eq!(five(0), 1 << 127);
        assert_eq!(five(1), 5 << 125);
        assert_eq!(five(2), 25 << 123);
        // 1/5 = 0.0011 0011 … in binary, rounded up.
        assert_eq!(five(-1), 0xcccc_cccc_cccc_cccc_cccc_cccc_cccc_cccd);
    }

    proptest! {
        #[test]
        fn reference_as_the_standard_library(mantissa in any::<u64>(), power in -80..=80_i32) {
            let expected: f64 = format!("{mantissa}e{power}").parse().unwrap();
            if let Some(found) = nearest_double(mantissa, power) {
                prop_assert_eq!(found.to_bits(), expected.to_bits());
            }
        }

        #[test]
        fn reference_half_way(mantissa in 1_u64 << 53..1 << 54, power in -6..=24_i32) {
            // Odd numbers of 54 bits lie half way between two doubles.
            let odd = mantissa | 1;
            let expected: f64 = format!("{odd}e{power}").parse().unwrap();
            let found = nearest_double(odd, power);
            prop_assert_eq!(found.map(f64::to_bits), Some(expected.to_bits()));
        }
    }
}
