//! Two-level runs in blocks: which interactions are given up.

use crate::error::DesignError;
use crate::word::{Fraction, Word};

/// Effects of up to so many factors are counted when block words are compared.
const COUNTED_ORDER: usize = 4;

/// Most choices of block words that are compared.
const MOST_CHOICES: f64 = 2e7;

/// Number of effects of 1, 2, 3 … factors that a column is aliased with.
type Counts = [u32; COUNTED_ORDER];

/// Words whose signs divide a two-level design into `blocks` blocks.
///
/// The choice that mixes the fewest effects with blocks, those of low order first.
///
/// # Errors
/// [`DesignError::BlocksImpossible`] unless the number is a power of two and a
/// choice exists that mixes no effect of up to `clear` factors.
pub fn block_words(
    fraction: &Fraction,
    blocks: usize,
    clear: usize,
) -> Result<Vec<Word>, DesignError> {
    let impossible = |problem: String| DesignError::BlocksImpossible { blocks, problem };
    let base = fraction.base();
    if !blocks.is_power_of_two() {
        return Err(impossible(
            "two-level runs divide into 2, 4, 8 … blocks".into(),
        ));
    }
    let wanted = blocks.trailing_zeros() as usize;
    if wanted >= base.len() {
        return Err(impossible(format!(
            "{} runs divide into at most {} blocks of two",
            fraction.runs(),
            1_usize << base.len().saturating_sub(1)
        )));
    }
    let columns = (1_usize << base.len()) - 1;
    let choices = (0..wanted).fold(1.0, |c, i| c * (columns - i) as f64 / (i + 1) as f64);
    if choices > MOST_CHOICES {
        return Err(impossible(format!(
            "{choices:.1e} choices of block words are too many to compare; take fewer blocks"
        )));
    }
    let counts = column_counts(fraction, &base);
    let mut search = Search {
        counts: &counts,
        wanted,
        best: None,
    };
    search.extend(&mut Vec::new(), &[0], [0; COUNTED_ORDER]);
    let found = search
        .best
        .filter(|(lost, _)| lost[..clear].iter().all(|n| *n == 0));
    let (_, words) = found.ok_or_else(|| {
        let order = if clear > 1 {
            "two-factor interactions"
        } else {
            "main effects"
        };
        impossible(format!(
            "{order} would be mixed with differences between blocks"
        ))
    })?;
    Ok(words
        .into_iter()
        .map(|column| spread(column, &base))
        .collect())
}

/// Block, from 1, of a point of ±1 levels.
pub fn block_of(words: &[Word], coded: &[f64]) -> usize {
    let bits = words.iter().enumerate();
    1 + bits
        .map(|(bit, word)| usize::from(word.value(coded) > 0.0) << bit)
        .sum::<usize>()
}

/// For each column in base factors (compact bits), the effects aliased with it.
fn column_counts(fraction: &Fraction, base: &[usize]) -> Vec<Counts> {
    let mut counts = vec![[0; COUNTED_ORDER]; 1 << base.len()];
    // Compact column of each factor, then of all products of up to four.
    let columns: Vec<usize> = (0..fraction.factors)
        .map(|factor| compact(fraction.in_base(Word::of(1 << factor)), base))
        .collect();
    let mut last = vec![(0, 0)];
    for order in 0..COUNTED_ORDER.min(fraction.factors) {
        let longer = last.iter().flat_map(|&(column, next)| {
            let columns = &columns;
            (next..columns.len()).map(move |factor| (column ^ columns[factor], factor + 1))
        });
        last = longer.collect();
        for (column, _) in &last {
            counts[*column][order] += 1;
        }
    }
    counts
}

/// Bits of the base factors side by side.
fn compact(word: Word, base: &[usize]) -> usize {
    let bits = base.iter().enumerate();
    bits.map(|(bit, factor)| ((word.letters >> factor & 1) as usize) << bit)
        .sum()
}

fn spread(column: usize, base: &[usize]) -> Word {
    let bits = base.iter().enumerate();
    let letters = bits
        .map(|(bit, factor)| ((column >> bit & 1) as u64) << factor)
        .sum();
    Word::of(letters)
}

/// Search over all sets of independent columns.
struct Search<'a> {
    counts: &'a [Counts],
    wanted: usize,
    best: Option<(Counts, Vec<usize>)>,
}

impl Search<'_> {
    /// Adds columns above the last one; `span` holds all products so far.
    fn extend(&mut self, chosen: &mut Vec<usize>, span: &[usize], lost: Counts) {
        if self.best.as_ref().is_some_and(|(best, _)| lost >= *best) {
            return;
        }
        if chosen.len() == self.wanted {
            self.best = Some((lost, chosen.clone()));
            return;
        }
        let first = chosen.last().map_or(1, |column| column + 1);
        for column in first..self.counts.len() {
            if span.contains(&column) {
                continue;
            }
            let mut more = lost;
            for product in span {
                let counts = &self.counts[product ^ column];
                more.iter_mut()
                    .zip(counts)
                    .for_each(|(sum, count)| *sum += count);
            }
            let mut wider = span.to_vec();
            wider.extend(span.iter().map(|product| product ^ column));
            chosen.push(column);
            self.extend(chosen, &wider, more);
            chosen.pop();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::word::fraction_of;

    fn lost(factors: usize, blocks: usize) -> Vec<String> {
        let fraction = fraction_of(&[], factors).unwrap();
        let words = block_words(&fraction, blocks, 1).unwrap();
        let mut all = vec![Word::default()];
        for word in words {
            let more: Vec<Word> = all.iter().map(|w| w.times(word)).collect();
            all.extend(more);
        }
        let mut texts: Vec<String> = all[1..].iter().map(Word::to_string).collect();
        texts.sort_by_key(|text| (text.len(), text.clone()));
        texts
    }

    /// Montgomery, table 7.9: the recommended blocking of 2^3 in 2, of 2^4 in 2
    /// and 4, and of 2^5 in 4 blocks loses one word of the highest order, one
    /// two-factor interaction of 2^4 in 4, none of 2^5 in 4.
    #[test]
    fn reference_orders_of_confounded_words() {
        assert_eq!(lost(3, 2), ["ABC"]);
        assert_eq!(lost(4, 2), ["ABCD"]);
        let lengths = |words: Vec<String>| words.iter().map(String::len).collect::<Vec<_>>();
        assert_eq!(lengths(lost(4, 4)), [2, 3, 3]);
        assert_eq!(lengths(lost(5, 4)), [3, 3, 4]);
        assert_eq!(lengths(lost(6, 8)), [3, 3, 3, 3, 4, 4, 4]);
    }

    #[test]
    fn rejects_blocks_that_cannot_be() {
        let fraction = fraction_of(&[], 3).unwrap();
        for (blocks, clear) in [(3, 1), (8, 1), (4, 2)] {
            let error = block_words(&fraction, blocks, clear).unwrap_err();
            assert!(matches!(error, DesignError::BlocksImpossible { .. }));
        }
    }
}
