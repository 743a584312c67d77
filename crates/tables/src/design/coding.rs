//! The coding of a table that was written as a design.

use crate::design::factor::CODED;
use crate::design::file::read_coding;
use windfall_design::kind::Factor;
use windfall_files::error::Error;
use windfall_files::table::data::Data;
use windfall_statistics::numbers::Numbers;
use windfall_statistics::surface::coding::{
    CodedFactors, FactorCoding, Recognised, code_by_levels,
};

/// Rounding of settings in the last bits, in half-ranges.
const SAME: f64 = 1e-9;

/// The numeric factors of a design's header; none without a valid one.
pub fn number_factors(data: &Data) -> Vec<String> {
    let factors = read_coding(&data.comments)
        .ok()
        .flatten()
        .unwrap_or_default();
    let numbers = factors
        .into_iter()
        .filter(|factor| factor.categories.is_empty());
    numbers.map(|factor| factor.name).collect()
}

/// Coded values of a table with the header of a design; `None` where it has
/// none of these factors.
///
/// A setting that is the planned level up to its printed decimals takes the exact coded
/// value; another setting, run instead of the planned one, is coded itself.
///
/// * `columns`: name and values of each factor
///
/// # Errors
/// A damaged header.
pub fn coding_of_design(
    data: &Data,
    columns: &[(String, &[f64])],
) -> Result<Option<CodedFactors>, Error> {
    let header = read_coding(&data.comments)?.unwrap_or_default();
    let planned = |name: &String| {
        let numbers = header.iter().filter(|factor| factor.categories.is_empty());
        numbers.into_iter().find(|factor| factor.name == *name)
    };
    if !columns.iter().any(|(name, _)| planned(name).is_some()) {
        return Ok(None);
    }
    // Factors that the header does not know are coded by their levels.
    let mut coded = code_by_levels(columns);
    let (mut rounded, mut changed) = (Vec::new(), Vec::new());
    for (place, (name, settings)) in columns.iter().enumerate() {
        let Some(factor) = planned(name) else {
            continue;
        };
        coded.factors[place] = FactorCoding {
            name: name.clone(),
            centre: factor.centre,
            half: factor.half,
        };
        let exact = data.table.numbers(&format!("{name}{CODED}")).ok();
        let exact = exact.map(Numbers::values);
        let found = factor_values(factor, settings, exact.as_deref());
        coded.values[place] = found.values;
        if found.rounded > SAME {
            rounded.push((name.clone(), found.rounded));
        }
        if !found.changed.is_empty() {
            let lines = found.changed.iter().map(|row| data.line(*row));
            changed.push((name.clone(), lines.collect()));
        }
    }
    coded.recognised = Recognised::Design { rounded, changed };
    Ok(Some(coded))
}

struct FactorValues {
    values: Vec<f64>,
    /// Largest difference between a setting and its exact level; half-ranges.
    rounded: f64,
    /// Rows with a setting that is not the planned level.
    changed: Vec<usize>,
}

fn factor_values(factor: &Factor, settings: &[f64], exact: Option<&[f64]>) -> FactorValues {
    let half_a_digit = factor
        .decimals
        .map_or(0.0, |d| 0.5 * 10_f64.powi(-(d as i32)));
    let tolerance = half_a_digit / factor.half + SAME;
    let mut found = FactorValues {
        values: Vec::new(),
        rounded: 0.0,
        changed: Vec::new(),
    };
    for (row, setting) in settings.iter().enumerate() {
        let own = factor.coded(*setting);
        let planned = exact
            .map(|exact| exact[row])
            .filter(|planned| !planned.is_nan());
        let value = match planned {
            Some(planned) if (own - planned).abs() <= tolerance => {
                found.rounded = found.rounded.max((own - planned).abs());
                planned
            }
            Some(_) if !own.is_nan() => {
                found.changed.push(row);
                own
            }
            _ => own,
        };
        found.values.push(value);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::file::write_design;
    use windfall_design::composite::{CompositeOptions, central_composite};
    use windfall_files::table::data::read_data;

    /// A design with one setting changed and the columns as `change` leaves them.
    fn coded(change: impl Fn(String) -> String) -> (CodedFactors, Vec<Vec<f64>>) {
        let mut factors = vec![
            Factor::between("k", "", 0.3, 1.0).unwrap(),
            Factor::between("e", "", 1.5, 3.0).unwrap(),
        ];
        factors[0].decimals = Some(2);
        let design = central_composite(factors, &CompositeOptions::default()).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("design.csv");
        std::fs::write(&path, change(write_design(&design, &[]).unwrap())).unwrap();
        let data = read_data(&path).unwrap();
        assert_eq!(number_factors(&data), ["k", "e"]);
        let column = |name: &str| data.table.numbers(name).unwrap().values();
        let (k, e) = (column("k"), column("e"));
        let columns = [("k".to_owned(), &*k), ("e".to_owned(), &*e)];
        let found = coding_of_design(&data, &columns).unwrap().unwrap();
        let exact = |place: usize| design.runs.iter().map(|run| run.coded[place]).collect();
        (found, vec![exact(0), exact(1)])
    }

    #[test]
    fn recovers_the_exact_coding_beside_rounded_settings() {
        let (found, exact) = coded(|text| text);
        assert_eq!(found.values, exact);
        assert_eq!(
            (found.factors[0].centre, found.factors[0].half),
            (0.65, 0.35)
        );
        match found.recognised {
            Recognised::Design { rounded, changed } => {
                // 0.65 + 0.35 √2 = 1.14497… is printed as 1.14, half a digit at most.
                assert_eq!((rounded.len(), &rounded[0].0[..]), (1, "k"));
                assert!((rounded[0].1 - 0.004_974_746_830_6 / 0.35).abs() < 1e-9);
                assert!(changed.is_empty());
            }
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn recovers_settings_that_were_changed() {
        let (found, exact) = coded(|text| text.replace(",1.00,1.5,1,-1\n", ",0.95,1.5,1,-1\n"));
        let differ: Vec<usize> = (0..exact[0].len())
            .filter(|row| found.values[0][*row] != exact[0][*row])
            .collect();
        assert_eq!(differ.len(), 1);
        assert!((found.values[0][differ[0]] - (0.95 - 0.65) / 0.35).abs() < 1e-12);
        assert_eq!(found.values[1], exact[1]);
        let Recognised::Design { changed, .. } = found.recognised else {
            panic!("a design");
        };
        assert_eq!((changed.len(), changed[0].1.len()), (1, 1));
    }
}
