//! Whether a quantity stays the same within a margin: two one-sided tests.

use windfall_distribution::tail::{t_upper, t_upper_quantile};
use windfall_signal::error::Error;

/// What the data say about a change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// There is a change.
    Changed,
    /// Any change is within the margin.
    Unchanged,
    /// Neither can be said.
    Undecided,
}

impl Verdict {
    /// The word for tables.
    pub fn word(self) -> &'static str {
        match self {
            Self::Changed => "changed",
            Self::Unchanged => "unchanged",
            Self::Undecided => "undecided",
        }
    }
}

/// Mean change over fruit held against a margin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Equivalence {
    /// Fruit.
    pub n: usize,
    /// Mean change; unit of the changes.
    pub mean: f64,
    /// Standard deviation between fruit; unit of the changes.
    pub sd: f64,
    /// Lower end of the interval at 1 − 2 `level` (90 % for 5 %).
    pub low: f64,
    /// Upper end of it.
    pub high: f64,
    /// The larger p of the two one-sided tests against ± margin; 1.
    pub p_equivalence: f64,
    /// Two-sided p of no change on average; 1.
    pub p_change: f64,
    /// Margin; unit of the changes.
    pub margin: f64,
    /// Unchanged: interval within the margin; else changed: `p_change` up to the level.
    pub verdict: Verdict,
}

/// Two one-sided t tests of a mean change against ± `margin`.
///
/// The mean is within the margin at level α where its interval at 1 − 2α is.
///
/// # Errors
/// [`Error::TooFewFruit`] with fewer than two, [`Error::BadOption`].
///
/// # Source
/// Schuirmann (1987), J. Pharmacokinet. Biopharm. 15, 657.
pub fn equivalence(changes: &[f64], margin: f64, level: f64) -> Result<Equivalence, Error> {
    let n = changes.len();
    if n < 2 {
        return Err(Error::TooFewFruit { fruit: n, least: 2 });
    }
    if !(margin > 0.0 && margin.is_finite()) {
        return Err(Error::bad_option("margin", margin, "a positive number"));
    }
    check_level(level)?;
    let count = n as f64;
    let mean = changes.iter().sum::<f64>() / count;
    let squares: f64 = changes.iter().map(|x| (x - mean) * (x - mean)).sum();
    let sd = (squares / (count - 1.0)).sqrt();
    let error = sd / count.sqrt();
    let freedom = count - 1.0;
    let half = t_quantile(1.0 - level, freedom) * error;
    let above = |value: f64| match error > 0.0 {
        true => t_above(value / error, freedom),
        false if value > 0.0 => 0.0,
        false if value < 0.0 => 1.0,
        false => 0.5,
    };
    let p_equivalence = above(margin + mean).max(above(margin - mean));
    let p_change = (2.0 * above(mean.abs())).min(1.0);
    let (low, high) = (mean - half, mean + half);
    let verdict = match (low > -margin && high < margin, p_change <= level) {
        (true, _) => Verdict::Unchanged,
        (false, true) => Verdict::Changed,
        (false, false) => Verdict::Undecided,
    };
    Ok(Equivalence {
        n,
        mean,
        sd,
        low,
        high,
        p_equivalence,
        p_change,
        margin,
        verdict,
    })
}

pub(crate) fn check_level(level: f64) -> Result<(), Error> {
    match level > 0.0 && level < 0.5 {
        true => Ok(()),
        false => Err(Error::bad_option(
            "level",
            level,
            "a probability between 0 and 0.5",
        )),
    }
}

/// Quantile of Student's t; infinite without degrees of freedom.
pub fn t_quantile(probability: f64, freedom: f64) -> f64 {
    match freedom > 0.0 {
        true => -t_upper_quantile(probability, freedom),
        false => f64::INFINITY,
    }
}

/// Probability that Student's t is above a value.
fn t_above(value: f64, freedom: f64) -> f64 {
    match freedom > 0.0 {
        true => t_upper(value, freedom),
        false => 1.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reference_quantiles_of_students_t() {
        // scipy.stats.t.ppf, SciPy 1.17.1; and the closed form for 2 degrees of
        // freedom, t = (2p − 1)/√(2 p (1 − p)).
        let table = [
            (0.95, 9.0, 1.833_112_932_656_237),
            (0.975, 4.0, 2.776_445_105_197_793),
            (0.9999, 9.0, 6.010_132_129_081_531),
        ];
        for (p, freedom, expected) in table {
            assert!(
                (t_quantile(p, freedom) / expected - 1.0).abs() < 1e-9,
                "{p} {freedom}: {}",
                t_quantile(p, freedom)
            );
        }
        for p in [0.6_f64, 0.9, 0.999] {
            let exact = (2.0 * p - 1.0) / (2.0 * p * (1.0 - p)).sqrt();
            assert!((t_quantile(p, 2.0) / exact - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn reference_two_one_sided_tests() {
        // scipy.stats.ttest_1samp of the same numbers: against −0.03 (greater)
        // and 0.03 (less), and two-sided against 0; SciPy 1.17.1.
        let changes = [0.011, -0.004, 0.007, 0.016, -0.002, 0.009];
        let found = equivalence(&changes, 0.03, 0.05).unwrap();
        assert_eq!(found.verdict, Verdict::Unchanged);
        let expected = [
            3.226_981_093_647_929e-4,
            0.108_132_491_491_409,
            -1.930_734_419_041_662e-4,
            0.012_526_406_775_237_5,
        ];
        let values = [found.p_equivalence, found.p_change, found.low, found.high];
        for (value, expected) in values.iter().zip(expected) {
            assert!((value / expected - 1.0).abs() < 1e-9, "{values:?}");
        }
    }

    #[test]
    fn closed_form_three_words() {
        let verdict = |changes: &[f64], margin| equivalence(changes, margin, 0.05).unwrap().verdict;
        assert_eq!(verdict(&[0.10, 0.11, 0.12, 0.10], 0.05), Verdict::Changed);
        assert_eq!(verdict(&[0.01, -0.01, 0.0, 0.01], 0.05), Verdict::Unchanged);
        assert_eq!(verdict(&[0.2, -0.2, 0.1, -0.15], 0.05), Verdict::Undecided);
        // Two equal values: no scatter, no doubt.
        assert_eq!(verdict(&[0.01, 0.01], 0.05), Verdict::Unchanged);
    }

    #[test]
    fn rejects_what_cannot_be_tested() {
        assert!(equivalence(&[0.1], 0.05, 0.05).is_err());
        assert!(equivalence(&[0.1, 0.2], 0.0, 0.05).is_err());
        assert!(equivalence(&[0.1, 0.2], 0.05, 0.7).is_err());
    }
}
