//! Every pair of groups compared by the method that was chosen.

use crate::compare::group_outcome::statistics_error;
use crate::compare::outcome::PairOutcome;
use windfall_files::error::Error;
use windfall_files::option_value::unusable;
use windfall_statistics::compare::means::{MeanDifference, paired, pooled, welch};
use windfall_statistics::compare::multiple_comparison::{bonferroni, holm};
use windfall_statistics::compare::tukey::{PairDifference, games_howell, tukey_kramer};
use windfall_statistics::sample_error::SampleError;

/// How groups are compared in pairs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum PairMethod {
    /// Tukey's honest significant difference, common variance
    #[default]
    Tukey,
    /// Each pair with its own variances
    GamesHowell,
    /// Welch's t tests adjusted by Holm
    Holm,
}

/// A comparison by Student's t of two groups, as it stands in a table.
fn of_means(names: [&str; 2], found: &MeanDifference, n_pairs: Option<usize>) -> PairOutcome {
    PairOutcome {
        first: names[0].to_owned(),
        second: names[1].to_owned(),
        difference: found.difference,
        se: found.standard_error,
        statistic: found.t,
        df: found.df,
        p: found.p,
        low: found.low,
        high: found.high,
        hedges_g: found.hedges_g,
        n_pairs,
    }
}

/// Groups with a variance of their own, by their places.
fn with_variance(groups: &[Vec<f64>]) -> Vec<usize> {
    let places = 0..groups.len();
    places.filter(|place| groups[*place].len() > 1).collect()
}

/// Pairs of groups and the method in words. A group of a single value has no variance of its
/// own, and no pairs where one is needed.
pub(crate) fn compare_pairs(
    names: &[String],
    groups: &[Vec<f64>],
    method: PairMethod,
    confidence: f64,
) -> Result<(Vec<PairOutcome>, &'static str), Error> {
    if let [first, second] = groups {
        // of two groups the studentised range is √2 |t|
        let (found, words) = match method {
            PairMethod::Tukey => (
                pooled(second, first, confidence),
                "Student's t test, common variance",
            ),
            _ => (welch(second, first, confidence), "Welch's t test"),
        };
        let found = found.map_err(statistics_error)?;
        return Ok((vec![of_means([&names[0], &names[1]], &found, None)], words));
    }
    let own = with_variance(groups);
    if method != PairMethod::Tukey && (2..groups.len()).contains(&own.len()) {
        let names: Vec<String> = own.iter().map(|place| names[*place].clone()).collect();
        let groups: Vec<Vec<f64>> = own.iter().map(|place| groups[*place].clone()).collect();
        return compare_pairs(&names, &groups, method, confidence);
    }
    match method {
        PairMethod::Tukey => {
            let found = tukey_kramer(groups, confidence).map_err(statistics_error)?;
            let words = "Tukey's honest significant difference, common variance";
            Ok((ranged(names, groups, &found, Variances::Common)?, words))
        }
        PairMethod::GamesHowell => {
            let found = games_howell(groups, confidence).map_err(statistics_error)?;
            let words = "Games and Howell, each pair with its own variances";
            Ok((ranged(names, groups, &found, Variances::Own)?, words))
        }
        PairMethod::Holm => {
            let level = adjusted_confidence(groups.len(), confidence);
            let found = by_places(groups.len(), |a, b| {
                let found = welch(&groups[b], &groups[a], level);
                let found = found.map_err(|error| of_pair(&names[a], &names[b], &error))?;
                Ok(of_means([&names[a], &names[b]], &found, None))
            })?;
            let words = "Welch's t tests, p by Holm, intervals by Bonferroni";
            Ok((adjusted(found), words))
        }
    }
}

/// The error of one pair, with its names.
fn of_pair(first: &str, second: &str, error: &SampleError) -> Error {
    unusable(format!("{first} against {second}"), error.to_string())
}

/// Confidence of each interval so that all hold together (Bonferroni).
fn adjusted_confidence(groups: usize, confidence: f64) -> f64 {
    let pairs = (groups * (groups - 1) / 2) as f64;
    1.0 - (1.0 - confidence) / pairs
}

/// Whose variances an effect size counts in.
enum Variances {
    Common,
    Own,
}

/// Comparisons by the studentised range, with effect sizes.
fn ranged(
    names: &[String],
    groups: &[Vec<f64>],
    found: &[PairDifference],
    variances: Variances,
) -> Result<Vec<PairOutcome>, Error> {
    let outcome = |pair: &PairDifference| {
        let (first, second) = (&groups[pair.first], &groups[pair.second]);
        // single values have a place in the range but no deviation of their own
        let effect = match variances {
            Variances::Common => pooled(second, first, 0.95),
            Variances::Own => welch(second, first, 0.95),
        };
        PairOutcome {
            first: names[pair.first].clone(),
            second: names[pair.second].clone(),
            difference: pair.difference,
            se: pair.standard_error,
            statistic: pair.q,
            df: pair.df,
            p: pair.p,
            low: pair.low,
            high: pair.high,
            hedges_g: effect.map_or(f64::NAN, |effect| effect.hedges_g),
            n_pairs: None,
        }
    };
    Ok(found.iter().map(outcome).collect())
}

/// Specimens that two groups share.
pub(crate) fn compare_paired(
    names: &[String],
    specimens: &[Vec<(String, f64)>],
    confidence: f64,
) -> Result<Vec<PairOutcome>, Error> {
    let level = adjusted_confidence(specimens.len(), confidence);
    let found = by_places(specimens.len(), |a, b| {
        let (first, second) = shared(&specimens[a], &specimens[b]);
        let found = paired(&second, &first, level);
        let found = found.map_err(|error| of_pair(&names[a], &names[b], &error))?;
        Ok(of_means([&names[a], &names[b]], &found, Some(first.len())))
    })?;
    Ok(adjusted(found))
}

/// Values of the specimens that are in both groups.
pub(crate) fn shared(first: &[(String, f64)], second: &[(String, f64)]) -> (Vec<f64>, Vec<f64>) {
    let partner = |name: &String| {
        let place = second.binary_search_by(|(other, _)| other.cmp(name)).ok();
        place.map(|place| second[place].1)
    };
    let pairs = first.iter();
    pairs
        .filter_map(|(name, value)| partner(name).map(|other| (*value, other)))
        .unzip()
}

fn by_places(
    groups: usize,
    compare: impl Fn(usize, usize) -> Result<PairOutcome, Error>,
) -> Result<Vec<PairOutcome>, Error> {
    let mut found = Vec::new();
    for first in 0..groups {
        for second in first + 1..groups {
            found.push(compare(first, second)?);
        }
    }
    Ok(found)
}

/// Probabilities adjusted by Holm: never larger than Bonferroni's of the intervals.
fn adjusted(mut pairs: Vec<PairOutcome>) -> Vec<PairOutcome> {
    let p: Vec<f64> = pairs.iter().map(|pair| pair.p).collect();
    debug_assert!(holm(&p).iter().zip(bonferroni(&p)).all(|(h, b)| *h <= b));
    for (pair, p) in pairs.iter_mut().zip(holm(&p)) {
        pair.p = p;
    }
    pairs
}
