//! Fractions of two levels with minimum aberration.

use crate::error::DesignError;
use crate::word::{Generator, Word};

/// Factors, runs, and the products of base factors that generate the others:
/// bit 0 is A, bit 1 is B, and so on (1 = A, 2 = B, 3 = AB, 4 = C …).
///
/// Found by search over all columns: exhaustive up to 16 runs, up to 9 factors
/// in 32, 64 and 128; by exchange from many starts for the others. The word
/// lengths are those of Chen, Sun and Wu (1993), International Statistical
/// Review 61, 131-145, where they list them (up to 64 runs).
const CATALOGUE: [(usize, usize, &[u64]); 42] = [
    (3, 4, &[3]),
    (4, 8, &[7]),
    (5, 8, &[3, 5]),
    (6, 8, &[3, 5, 6]),
    (7, 8, &[3, 5, 6, 7]),
    (5, 16, &[15]),
    (6, 16, &[7, 11]),
    (7, 16, &[7, 11, 13]),
    (8, 16, &[7, 11, 13, 14]),
    (9, 16, &[3, 5, 9, 14, 15]),
    (10, 16, &[3, 5, 6, 9, 14, 15]),
    (11, 16, &[3, 5, 6, 9, 10, 13, 14]),
    (12, 16, &[3, 5, 6, 9, 10, 13, 14, 15]),
    (13, 16, &[3, 5, 6, 7, 9, 10, 11, 12, 13]),
    (14, 16, &[3, 5, 6, 7, 9, 10, 11, 12, 13, 14]),
    (15, 16, &[3, 5, 6, 7, 9, 10, 11, 12, 13, 14, 15]),
    (6, 32, &[31]),
    (7, 32, &[7, 27]),
    (8, 32, &[7, 11, 29]),
    (9, 32, &[7, 11, 19, 29]),
    (10, 32, &[7, 11, 19, 29, 30]),
    (11, 32, &[7, 11, 13, 19, 21, 26]),
    (12, 32, &[7, 11, 13, 14, 19, 21, 25]),
    (13, 32, &[7, 11, 13, 14, 19, 21, 22, 25]),
    (14, 32, &[7, 11, 13, 14, 19, 21, 22, 25, 26]),
    (15, 32, &[7, 11, 13, 14, 19, 21, 22, 25, 26, 28]),
    (16, 32, &[7, 11, 13, 14, 19, 21, 22, 25, 26, 28, 31]),
    (7, 64, &[63]),
    (8, 64, &[15, 51]),
    (9, 64, &[7, 27, 45]),
    (10, 64, &[7, 27, 51, 62]),
    (11, 64, &[7, 30, 38, 43, 61]),
    (12, 64, &[7, 27, 29, 46, 54, 56]),
    (13, 64, &[7, 11, 21, 38, 49, 60, 63]),
    (14, 64, &[7, 14, 22, 27, 44, 47, 51, 62]),
    (15, 64, &[7, 13, 21, 30, 37, 43, 54, 58, 60]),
    (16, 64, &[7, 11, 19, 22, 28, 35, 45, 46, 55, 58]),
    (8, 128, &[127]),
    (9, 128, &[31, 103]),
    (10, 128, &[15, 51, 125]),
    (11, 128, &[15, 53, 83, 108]),
    (12, 128, &[15, 49, 93, 107, 119]),
];

/// Generators of the fraction with the least aberration of so many factors in
/// so many runs; none for the full factorial.
///
/// # Errors
/// [`DesignError::FractionUnknown`], with the runs that there are.
pub fn catalogued(factors: usize, runs: usize) -> Result<Vec<Generator>, DesignError> {
    if factors < 64 && runs == 1 << factors {
        return Ok(Vec::new());
    }
    let entries = || CATALOGUE.iter().filter(|entry| entry.0 == factors);
    let found = entries().find(|entry| entry.1 == runs);
    let (_, _, columns) = found.ok_or_else(|| {
        let sizes: Vec<String> = entries().map(|entry| entry.1.to_string()).collect();
        let advice = match sizes.is_empty() {
            true => "give generators, or take a Plackett-Burman design".to_owned(),
            false => format!(
                "there are fractions in {} runs, or give generators",
                sizes.join(", ")
            ),
        };
        DesignError::FractionUnknown {
            factors,
            runs,
            advice,
        }
    })?;
    let base = factors - columns.len();
    let generators = columns
        .iter()
        .enumerate()
        .map(|(place, &letters)| Generator {
            factor: base + place,
            word: Word::of(letters),
        });
    Ok(generators.collect())
}

/// All numbers of factors and runs of the catalogue.
pub fn sizes() -> impl Iterator<Item = (usize, usize)> {
    CATALOGUE.iter().map(|entry| (entry.0, entry.1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::word::fraction_of;

    /// Numbers of words of length 3, 4, 5 (and 6) printed by Chen, Sun and Wu
    /// (1993), tables 2 to 4, and resolutions of Montgomery, table 8.14.
    #[test]
    fn reference_word_lengths_of_the_catalogue() {
        let published: [(usize, usize, &[usize]); 30] = [
            (5, 8, &[2, 1]),
            (6, 8, &[4, 3]),
            (7, 8, &[7, 7]),
            (5, 16, &[0, 0, 1]),
            (6, 16, &[0, 3, 0]),
            (7, 16, &[0, 7, 0]),
            (8, 16, &[0, 14, 0]),
            (9, 16, &[4, 14, 8]),
            (10, 16, &[8, 18, 16]),
            (11, 16, &[12, 26, 28]),
            (12, 16, &[16, 39, 48]),
            (13, 16, &[22, 55, 72]),
            (14, 16, &[28, 77, 112]),
            (15, 16, &[35, 105, 168]),
            (6, 32, &[0, 0, 0, 1]),
            (7, 32, &[0, 1, 2, 0]),
            (8, 32, &[0, 3, 4, 0]),
            (9, 32, &[0, 6, 8, 0]),
            (10, 32, &[0, 10, 16, 0]),
            (11, 32, &[0, 25, 0, 27]),
            (12, 32, &[0, 38, 0, 52]),
            (13, 32, &[0, 55, 0, 96]),
            (14, 32, &[0, 77, 0, 168]),
            (15, 32, &[0, 105, 0, 280]),
            (16, 32, &[0, 140, 0, 448]),
            (8, 64, &[0, 0, 2, 1]),
            (9, 64, &[0, 1, 4, 2]),
            (10, 64, &[0, 2, 8, 4]),
            (11, 64, &[0, 4, 14, 8]),
            (12, 64, &[0, 6, 24, 16]),
        ];
        for (factors, runs, expected) in published {
            let generators = catalogued(factors, runs).unwrap();
            let found = fraction_of(&generators, factors).unwrap();
            assert_eq!(found.runs(), runs as f64);
            let of_length = |n: usize| found.defining.iter().filter(|w| w.length() == n).count();
            let lengths: Vec<usize> = (3..3 + expected.len()).map(of_length).collect();
            assert_eq!(lengths, expected, "{factors} factors in {runs} runs");
        }
    }

    /// Resolutions of Montgomery, table 8.14, for 64 and 128 runs.
    #[test]
    fn reference_resolutions_of_large_fractions() {
        let published = [
            (7, 64, 7),
            (8, 64, 5),
            (9, 64, 4),
            (10, 64, 4),
            (9, 128, 6),
            (10, 128, 5),
            (11, 128, 5),
        ];
        for (factors, runs, resolution) in published {
            let found = fraction_of(&catalogued(factors, runs).unwrap(), factors).unwrap();
            assert_eq!(found.resolution(), Some(resolution));
        }
    }

    #[test]
    fn closed_form_every_entry_is_a_fraction_of_its_size() {
        for (factors, runs) in sizes() {
            let found = fraction_of(&catalogued(factors, runs).unwrap(), factors).unwrap();
            assert_eq!(found.runs(), runs as f64);
        }
    }

    #[test]
    fn rejects_sizes_that_are_not_there() {
        let message = catalogued(6, 12).unwrap_err().to_string();
        assert!(message.contains("8, 16, 32 runs"), "{message}");
    }
}
