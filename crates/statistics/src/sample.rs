//! Checks that samples have to pass before anything is computed from them.

use crate::sample_error::SampleError;

/// Values that are all finite, and enough of them.
///
/// # Errors
/// [`SampleError::NotFinite`] with the first place; [`SampleError::TooFewValues`].
pub fn check_sample(what: &str, values: &[f64], needed: usize) -> Result<(), SampleError> {
    if let Some(place) = values.iter().position(|value| !value.is_finite()) {
        return Err(SampleError::NotFinite {
            what: what.to_owned(),
            place: place + 1,
            value: values[place],
        });
    }
    if values.len() < needed {
        return Err(SampleError::too_few(what, values.len(), needed));
    }
    Ok(())
}

/// Two samples of one length, finite.
///
/// # Errors
/// [`SampleError::LengthsDiffer`], and those of [`check_sample`].
pub fn check_pairs(
    what: &str,
    first: &[f64],
    second: &[f64],
    needed: usize,
) -> Result<(), SampleError> {
    if first.len() != second.len() {
        return Err(SampleError::lengths(what, first.len(), second.len()));
    }
    check_sample(what, first, needed)?;
    check_sample(what, second, needed)
}

/// At least two groups, each with enough finite values.
///
/// # Errors
/// Those of [`check_sample`], with the group's number, from 1;
/// [`SampleError::TooFewValues`] for fewer than two groups.
pub fn check_groups<G: AsRef<[f64]>>(groups: &[G], needed: usize) -> Result<(), SampleError> {
    if groups.len() < 2 {
        return Err(SampleError::TooFewGroups {
            found: groups.len(),
        });
    }
    for (place, group) in groups.iter().enumerate() {
        check_sample(&format!("group {}", place + 1), group.as_ref(), needed)?;
    }
    Ok(())
}

/// A probability strictly between zero and one, or [`SampleError::OutOfRange`].
pub fn check_probability(quantity: &'static str, value: f64) -> Result<(), SampleError> {
    match value > 0.0 && value < 1.0 {
        true => Ok(()),
        false => Err(SampleError::OutOfRange {
            quantity,
            value,
            expected: "a number between 0 and 1",
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rejects_missing_values_short_samples_and_odd_partners() {
        let of = |result: Result<(), SampleError>| result.unwrap_err().to_string();
        assert_eq!(
            of(check_sample("k", &[1.0, f64::NAN], 2)),
            "k: value 2 is NaN; leave out missing values first"
        );
        assert_eq!(
            of(check_sample("k", &[1.0], 2)),
            "k: 1 values, and at least 2 are needed"
        );
        assert_eq!(
            of(check_pairs("k", &[1.0], &[1.0, 2.0], 2)),
            "k: 1 values against 2; each needs its partner"
        );
        assert_eq!(
            of(check_groups(&[vec![1.0, 2.0], vec![1.0]], 2)),
            "group 2: 1 values, and at least 2 are needed"
        );
        assert_eq!(
            of(check_groups(&[vec![1.0, 2.0]], 2)),
            "1 group; a comparison needs at least two"
        );
        assert_eq!(
            of(check_probability("the confidence", 95.0)),
            "the confidence is 95; a number between 0 and 1 is expected"
        );
    }
}
