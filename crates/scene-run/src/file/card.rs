//! Differences between fruit, from a law card.

use std::path::Path;
use windfall_cards::law_card::LawCard;
use windfall_contact::laws::kind::Law;
use windfall_files::error::Error;
use windfall_files::option_value::unusable;
use windfall_scene::interaction::Spread;

/// The spread between fruit that a card states, if any.
///
/// # Errors
/// It varies what the law does not have, or its covariance is none.
pub fn spread_of_card(card: &LawCard, law: &Law, path: &Path) -> Result<Option<Spread>, Error> {
    let Some(population) = &card.population else {
        return Ok(None);
    };
    let wrong = |problem: String| {
        let name = path.display().to_string();
        Err(unusable(name, format!("not a usable law card: {problem}")))
    };
    let names: Vec<&str> = law
        .kind()
        .describe()
        .parameters
        .iter()
        .map(|own| own.name)
        .collect();
    let mut logarithm = vec![false; names.len()];
    let mut places = Vec::new();
    for of in &population.of {
        let (name, ln) = match of.strip_prefix("ln ") {
            Some(name) => (name, true),
            None => (of.as_str(), false),
        };
        let Some(place) = names.iter().position(|own| *own == name) else {
            return wrong(format!(
                "[population] varies \"{of}\", which {} has not",
                card.law
            ));
        };
        logarithm[place] = ln;
        places.push(place);
    }
    let Some(lower) = lower_factor(&population.between_fruit) else {
        return wrong("[population] between_fruit is no covariance".to_owned());
    };
    // Of the parameters in the order of the law; what does not vary has zeros.
    let mut factor = vec![vec![0.0; names.len()]; names.len()];
    for (row, &place) in places.iter().enumerate() {
        for (column, &other) in places.iter().enumerate() {
            factor[place][other] = lower[row][column];
        }
    }
    Ok(Some(Spread { logarithm, factor }))
}

/// L of A = L Lᵀ, also where A is singular; `None` where A is no covariance.
pub(crate) fn lower_factor(matrix: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
    let n = matrix.len();
    if matrix
        .iter()
        .any(|row| row.len() != n || row.iter().any(|own| !own.is_finite()))
    {
        return None;
    }
    let mut lower = vec![vec![0.0; n]; n];
    for i in 0..n {
        for j in 0..=i {
            let sum: f64 = (0..j).map(|k| lower[i][k] * lower[j][k]).sum();
            let rest = matrix[i][j] - sum;
            let small = ROUNDING * matrix[i][i].max(matrix[j][j]);
            lower[i][j] = if i == j {
                if rest < -small {
                    return None;
                }
                rest.max(0.0).sqrt()
            } else if lower[j][j] > 0.0 {
                rest / lower[j][j]
            } else {
                0.0
            };
        }
    }
    Some(lower)
}

/// What a variance may lack by rounding, over the largest; 1.
const ROUNDING: f64 = 1e-12;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_factors_of_covariances() {
        let lower = lower_factor(&[vec![4.0, 2.0], vec![2.0, 3.0]]).unwrap();
        assert_eq!(lower, [vec![2.0, 0.0], vec![1.0, 2.0_f64.sqrt()]]);
        // One that does not vary at all, and two that vary together.
        assert_eq!(lower_factor(&[vec![0.0]]).unwrap(), [vec![0.0]]);
        let both = lower_factor(&[vec![1.0, 1.0], vec![1.0, 1.0]]).unwrap();
        assert_eq!(both, [vec![1.0, 0.0], vec![1.0, 0.0]]);
        assert!(lower_factor(&[vec![1.0, 2.0], vec![2.0, 1.0]]).is_none());
        assert!(lower_factor(&[vec![-1.0]]).is_none());
    }
}
