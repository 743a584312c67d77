//! Columns of numbers. Those that were written with few digits are kept as whole numbers over
//! one power of ten, which takes half the memory of doubles and gives back the same doubles.

use crate::runs::Runs;
use std::borrow::Cow;
use std::ops::Range;

/// Most decimal places that are tried.
const MOST_PLACES: usize = 9;

/// Stands for a missing value among whole numbers.
const MISSING: i32 = i32::MIN;

/// Numbers; NaN where one is missing.
#[derive(Clone, Debug)]
pub struct Numbers(Kept);

#[derive(Clone, Debug)]
enum Kept {
    Doubles(Vec<f64>),
    /// Whole numbers to be divided by 10 to the number of decimal places.
    Decimals(Vec<i32>, usize),
}

impl Default for Numbers {
    fn default() -> Self {
        Self(Kept::Decimals(Vec::new(), 0))
    }
}

impl From<Vec<f64>> for Numbers {
    /// As they are; [`Numbers::compact`] saves memory.
    fn from(values: Vec<f64>) -> Self {
        Self(Kept::Doubles(values))
    }
}

impl FromIterator<f64> for Numbers {
    fn from_iter<I: IntoIterator<Item = f64>>(values: I) -> Self {
        Self::from(values.into_iter().collect::<Vec<f64>>())
    }
}

/// Equal numbers, however they are kept.
impl PartialEq for Numbers {
    fn eq(&self, other: &Self) -> bool {
        self.len() == other.len() && self.iter().zip(other.iter()).all(|(a, b)| a == b)
    }
}

/// Powers of ten.
const SCALES: [f64; MOST_PLACES + 1] = [1.0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9];

fn scale_of(places: usize) -> f64 {
    SCALES[places]
}

/// The double that a whole number stands for: the nearest one to the decimal, as both are exact.
fn double(digits: i32, scale: f64) -> f64 {
    match digits {
        MISSING => f64::NAN,
        _ => f64::from(digits) / scale,
    }
}

/// The whole number that gives back exactly this double.
fn whole(value: f64, scale: f64) -> Option<i32> {
    if value.is_nan() {
        return Some(MISSING);
    }
    let digits = (value * scale + 0.5_f64.copysign(value)) as i32;
    // Zero has no sign here.
    let same = f64::from(digits) / scale == value && (digits != 0 || value.is_sign_positive());
    (same && digits != MISSING).then_some(digits)
}

/// The same whole numbers with more decimal places, if they are not too large.
fn shift(all: &mut [i32], places: usize) -> Option<()> {
    let factor = 10_i32.checked_pow(u32::try_from(places).ok()?)?;
    for digits in all.iter_mut().filter(|own| **own != MISSING) {
        *digits = digits.checked_mul(factor).filter(|own| *own != MISSING)?;
    }
    Some(())
}

impl Numbers {
    /// Numbers in as little memory as gives back the same doubles.
    pub fn compact(values: &[f64]) -> Self {
        let decimals = decimals(values);
        decimals.unwrap_or_else(|| Self(Kept::Doubles(values.to_vec())))
    }

    /// Appends others.
    pub fn append(&mut self, other: &Self) {
        if self.append_decimals(other).is_none() {
            let mut values = self.values().into_owned();
            values.extend(other.iter());
            self.0 = Kept::Doubles(values);
        }
    }

    /// Appends whole numbers to whole numbers; `None`, with nothing changed, where some are too
    /// large for the decimal places of the others.
    fn append_decimals(&mut self, other: &Self) -> Option<()> {
        let (own, places, more, others) = match (&mut self.0, &other.0) {
            (Kept::Doubles(own), _) => {
                own.extend(other.iter());
                return Some(());
            }
            (Kept::Decimals(own, places), Kept::Decimals(more, others)) => {
                (own, places, more, *others)
            }
            _ => return None,
        };
        let before = own.len();
        own.extend_from_slice(more);
        let done = match others > *places {
            false => shift(&mut own[before..], *places - others),
            true => {
                let mut shifted = own[..before].to_vec();
                shift(&mut shifted, others - *places).map(|()| {
                    own[..before].copy_from_slice(&shifted);
                    *places = others;
                })
            }
        };
        if done.is_none() {
            own.truncate(before);
        }
        done
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        match &self.0 {
            Kept::Doubles(values) => values.len(),
            Kept::Decimals(all, _) => all.len(),
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether any is missing.
    pub fn any_missing(&self) -> bool {
        match &self.0 {
            Kept::Doubles(values) => values.iter().any(|own| own.is_nan()),
            Kept::Decimals(all, _) => all.contains(&MISSING),
        }
    }

    /// The number of a row, from 0.
    pub fn at(&self, row: usize) -> f64 {
        match &self.0 {
            Kept::Doubles(values) => values[row],
            Kept::Decimals(all, places) => double(all[row], scale_of(*places)),
        }
    }

    /// The numbers in their order.
    pub fn iter(&self) -> impl Iterator<Item = f64> {
        let (values, all, scale) = match &self.0 {
            Kept::Doubles(values) => (&values[..], &[][..], 1.0),
            Kept::Decimals(all, places) => (&[][..], &all[..], scale_of(*places)),
        };
        let all = all.iter().map(move |own| double(*own, scale));
        values.iter().copied().chain(all)
    }

    /// The smallest and the largest of some rows; infinite, and the wrong way round, of none.
    pub fn range(&self, rows: &Runs) -> (f64, f64) {
        let own = rows.within(0..rows.len()).flat_map(|run| self.parts(run));
        own.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), part| {
            let own = part.iter();
            own.fold((low, high), |(low, high), own| {
                (low.min(*own), high.max(*own))
            })
        })
    }

    /// Rows as doubles, a few at a time.
    fn parts(&self, rows: Range<usize>) -> impl Iterator<Item = Cow<'_, [f64]>> {
        let starts = rows.clone().step_by(1024);
        starts.map(move |start| self.within(start..(start + 1024).min(rows.end)))
    }

    /// Those of some rows, kept as they are.
    pub fn chosen(&self, rows: &[usize]) -> Self {
        Self(match &self.0 {
            Kept::Doubles(own) => Kept::Doubles(rows.iter().map(|row| own[*row]).collect()),
            Kept::Decimals(own, places) => {
                Kept::Decimals(rows.iter().map(|row| own[*row]).collect(), *places)
            }
        })
    }

    /// All of them as doubles.
    pub fn values(&self) -> Cow<'_, [f64]> {
        self.within(0..self.len())
    }

    /// Those of some rows as doubles.
    pub fn within(&self, rows: Range<usize>) -> Cow<'_, [f64]> {
        match &self.0 {
            Kept::Doubles(values) => Cow::Borrowed(&values[rows]),
            Kept::Decimals(all, places) => {
                let scale = scale_of(*places);
                all[rows].iter().map(|own| double(*own, scale)).collect()
            }
        }
    }

    /// Writes those of some rows as doubles.
    ///
    /// * `into`: as many as there are rows
    pub fn fill(&self, rows: Range<usize>, into: &mut [f64]) {
        match &self.0 {
            Kept::Doubles(values) => into.copy_from_slice(&values[rows]),
            Kept::Decimals(all, places) => {
                let scale = scale_of(*places);
                let pairs = into.iter_mut().zip(&all[rows]);
                pairs.for_each(|(into, own)| *into = double(*own, scale));
            }
        }
    }
}

/// Numbers as decimals of as few places as all of them need.
fn decimals(values: &[f64]) -> Option<Numbers> {
    let mut all = Vec::with_capacity(values.len());
    let mut places = 0;
    for value in values {
        let mut digits = whole(*value, scale_of(places));
        if digits.is_none() {
            let before = places;
            places = (before + 1..=MOST_PLACES)
                .find(|places| whole(*value, scale_of(*places)).is_some())?;
            shift(&mut all, places - before)?;
            digits = whole(*value, scale_of(places));
        }
        all.push(digits?);
    }
    Some(Numbers(Kept::Decimals(all, places)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn same(numbers: &Numbers, values: &[f64]) {
        let bits = |own: f64| own.to_bits();
        assert!(
            numbers
                .iter()
                .map(bits)
                .eq(values.iter().copied().map(bits))
        );
        let each = (0..values.len()).map(|row| bits(numbers.at(row)));
        assert!(each.eq(values.iter().copied().map(bits)));
    }

    /// Decimals give back the doubles that were read, to the last bit.
    #[test]
    fn repeats_the_doubles() {
        let few = [1.0, 0.1, f64::NAN, -2.25, 1e3, 0.0, 123.456, -0.0003];
        let numbers = Numbers::compact(&few);
        assert!(matches!(&numbers.0, Kept::Decimals(_, 4)));
        same(&numbers, &few);
        assert!(numbers.any_missing() && !Numbers::compact(&few[3..]).any_missing());
        for odd in [1.0 / 3.0, -0.0, 1e12, 5e-324, f64::INFINITY, 2147483648.0] {
            let all = [few.as_slice(), &[odd]].concat();
            let mixed = Numbers::compact(&all);
            assert!(matches!(&mixed.0, Kept::Doubles(_)), "{odd}");
            same(&mixed, &all);
        }
        let every: Vec<f64> = (-50_000..50_000)
            .map(|own| f64::from(own) / 1000.0)
            .collect();
        same(&Numbers::compact(&every), &every);
    }

    #[test]
    fn repeats_what_was_appended() {
        let parts: [&[f64]; 5] = [
            &[1.0, 2.0],
            &[0.25, f64::NAN],
            &[20.0, 0.125],
            &[1e-9, 3.0],
            &[1e9, 0.5],
        ];
        let mut numbers = Numbers::default();
        let mut values = Vec::new();
        for part in parts {
            numbers.append(&Numbers::compact(part));
            values.extend_from_slice(part);
            same(&numbers, &values);
        }
        assert!(matches!(&numbers.0, Kept::Doubles(_)));
        numbers.append(&Numbers::compact(&[4.5]));
        let rows = [1, 2, 5].into_iter().collect();
        assert_eq!(numbers.range(&rows), (0.125, 2.0));
        assert_eq!(numbers.within(9..11).as_ref(), [0.5, 4.5]);
        let mut few = [0.0; 2];
        numbers.fill(9..11, &mut few);
        assert_eq!(few, [0.5, 4.5]);
    }
}
