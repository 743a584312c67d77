//! Models that designs are made for, in coded factors.

use crate::kind::Factor;
use crate::sobol::unit_points;
use crate::sobol_table::DIMENSIONS;
use crate::word::letter;

/// Most points that a mean over the region is taken from; 1.
const MOST_POINTS: usize = 20_000;

/// Points of the sequence that stands for the region where a grid has too many.
const SEQUENCE_POINTS: usize = 4096;

/// A model in all factors.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum DesignModel {
    /// Intercept and main effects.
    Linear,
    /// And two-factor interactions.
    Interactions,
    /// And squares of the factors that are numbers.
    Quadratic,
}

impl DesignModel {
    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Linear => "linear",
            Self::Interactions => "2fi",
            Self::Quadratic => "quadratic",
        }
    }
}

/// Terms of a model in the order of its row: 1, A, B, AB, A^2; categories C1, C2.
pub fn model_terms(factors: &[Factor], model: DesignModel) -> Vec<String> {
    let mains: Vec<Vec<String>> = (0..factors.len())
        .map(|place| {
            let columns = factors[place].categories.len().max(2) - 1;
            let own = factor_symbol(place);
            match columns {
                1 => vec![own],
                _ => (1..=columns).map(|c| format!("{own}{c}")).collect(),
            }
        })
        .collect();
    let product = |a: &String, b: &String| match a.len() + b.len() {
        2 => format!("{a}{b}"),
        _ => format!("{a}*{b}"),
    };
    let square = |a: &String| format!("{a}^2");
    expanded(factors, model, &mains, "1".to_owned(), product, square)
}

/// "A", "B" …, "x51" beyond the letters.
fn factor_symbol(place: usize) -> String {
    match letter(place) {
        '?' => format!("x{}", place + 1),
        letter => letter.to_string(),
    }
}

/// Row of the model matrix at a point, with sum contrasts for categories.
pub fn model_row(factors: &[Factor], model: DesignModel, coded: &[f64]) -> Vec<f64> {
    let mains: Vec<Vec<f64>> = factors
        .iter()
        .zip(coded)
        .map(|(factor, value)| main_columns(factor, *value))
        .collect();
    expanded(factors, model, &mains, 1.0, |a, b| a * b, |a| a * a)
}

fn main_columns(factor: &Factor, coded: f64) -> Vec<f64> {
    let Some(place) = factor.category_place(coded) else {
        return vec![coded];
    };
    let columns = factor.categories.len() - 1;
    let indicator = |column: usize| f64::from(u8::from(place == column));
    let last = indicator(columns);
    (0..columns)
        .map(|column| indicator(column) - last)
        .collect()
}

fn expanded<T: Clone>(
    factors: &[Factor],
    model: DesignModel,
    mains: &[Vec<T>],
    one: T,
    product: impl Fn(&T, &T) -> T,
    square: impl Fn(&T) -> T,
) -> Vec<T> {
    let mut row = vec![one];
    row.extend(mains.iter().flatten().cloned());
    if model >= DesignModel::Interactions {
        for (place, first) in mains.iter().enumerate() {
            for second in &mains[place + 1..] {
                let products = first
                    .iter()
                    .flat_map(|a| second.iter().map(|b| product(a, b)));
                row.extend(products.collect::<Vec<T>>());
            }
        }
    }
    if model >= DesignModel::Quadratic {
        let numbers = mains.iter().zip(factors);
        let numbers = numbers.filter(|(_, factor)| factor.categories.is_empty());
        row.extend(numbers.map(|(main, _)| square(&main[0])));
    }
    row
}

/// Points with weights for means over the region −1 … 1 of all factors.
///
/// Gauss-Legendre points in each number, exact for products of rows with powers
/// up to 2 (3 in up to 7 factors, 4 in up to 6), and all categories; where that
/// is more than 20 000 points, Sobol points.
pub fn region_points(factors: &[Factor]) -> Vec<(f64, Vec<f64>)> {
    let levels = |count: usize| -> Vec<Vec<(f64, f64)>> {
        factors
            .iter()
            .map(|factor| factor_points(factor, count))
            .collect()
    };
    let fits = |count: &usize| {
        let sizes = levels(*count).into_iter().map(|points| points.len() as f64);
        sizes.product::<f64>() <= MOST_POINTS as f64
    };
    let Some(count) = [5, 4, 3].into_iter().find(fits) else {
        return sequence_points(factors);
    };
    let mut points = vec![(1.0, Vec::new())];
    for factor in levels(count) {
        let longer = points.iter().flat_map(|(weight, point): &(f64, Vec<f64>)| {
            factor.iter().map(move |(share, value)| {
                let mut point = point.clone();
                point.push(*value);
                (weight * share, point)
            })
        });
        points = longer.collect();
    }
    points
}

/// Ends and middles of all factors, or only ends, up to 20 000 points: here the variance
/// of prediction is largest.
pub fn extreme_points(factors: &[Factor]) -> Vec<Vec<f64>> {
    let levels = |middle: bool| -> Vec<Vec<f64>> {
        let of = |factor: &Factor| match factor.categories.is_empty() && middle {
            true => vec![-1.0, 0.0, 1.0],
            false => factor.ends(),
        };
        factors.iter().map(of).collect()
    };
    let fits = |levels: &Vec<Vec<f64>>| {
        let size: f64 = levels.iter().map(|levels| levels.len() as f64).product();
        size <= MOST_POINTS as f64
    };
    let Some(levels) = [levels(true), levels(false)].into_iter().find(fits) else {
        return Vec::new();
    };
    levels.iter().fold(vec![Vec::new()], |points, levels| {
        let longer = points.iter().flat_map(|point: &Vec<f64>| {
            levels.iter().map(move |level| {
                let mut longer = point.clone();
                longer.push(*level);
                longer
            })
        });
        longer.collect()
    })
}

/// Weights and coded values of one factor.
fn factor_points(factor: &Factor, count: usize) -> Vec<(f64, f64)> {
    if !factor.categories.is_empty() {
        let ends = factor.ends();
        let share = 1.0 / ends.len() as f64;
        return ends.into_iter().map(|value| (share, value)).collect();
    }
    // Positive points and half weights of Gauss and Legendre.
    let half: Vec<(f64, f64)> = match count {
        3 => vec![(4.0 / 9.0, 0.0), (5.0 / 18.0, 0.6_f64.sqrt())],
        4 => {
            let (inner, outer) = ((4.8_f64).sqrt(), 30_f64.sqrt());
            vec![
                ((18.0 + outer) / 72.0, ((3.0 - inner) / 7.0).sqrt()),
                ((18.0 - outer) / 72.0, ((3.0 + inner) / 7.0).sqrt()),
            ]
        }
        _ => {
            let (root, large) = ((10.0_f64 / 7.0).sqrt(), 70_f64.sqrt());
            vec![
                (64.0 / 225.0, 0.0),
                (
                    (322.0 + 13.0 * large) / 1800.0,
                    (5.0 - 2.0 * root).sqrt() / 3.0,
                ),
                (
                    (322.0 - 13.0 * large) / 1800.0,
                    (5.0 + 2.0 * root).sqrt() / 3.0,
                ),
            ]
        }
    };
    let mirrored = half.iter().filter(|(_, x)| *x > 0.0).map(|(w, x)| (*w, -x));
    mirrored.chain(half.iter().copied()).collect()
}

fn sequence_points(factors: &[Factor]) -> Vec<(f64, Vec<f64>)> {
    let weight = 1.0 / SEQUENCE_POINTS as f64;
    // The first point is a corner of the region: it is left out.
    let points = unit_points(factors.len().min(DIMENSIONS), SEQUENCE_POINTS + 1);
    points[1..]
        .iter()
        .map(|unit| {
            let coded = factors.iter().enumerate().map(|(place, factor)| {
                let unit = unit[place % DIMENSIONS];
                match factor.categories.len() {
                    0 => 2.0 * unit - 1.0,
                    count => factor.ends()[((unit * count as f64) as usize).min(count - 1)],
                }
            });
            (weight, coded.collect())
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn factors(count: usize) -> Vec<Factor> {
        let name = |i: usize| Factor::between(&format!("x{i}"), "", 0.0, 1.0).unwrap();
        (0..count).map(name).collect()
    }

    #[test]
    fn closed_form_rows_and_terms() {
        let mut factors = factors(2);
        let names = ["a", "b", "c"].map(str::to_owned);
        factors.push(Factor::of_categories("v", &names).unwrap());
        let terms = model_terms(&factors, DesignModel::Quadratic);
        let expected = [
            "1", "A", "B", "C1", "C2", "AB", "A*C1", "A*C2", "B*C1", "B*C2", "A^2", "B^2",
        ];
        assert_eq!(terms, expected);
        let row = model_row(&factors, DesignModel::Quadratic, &[2.0, 3.0, 1.0]);
        let last = [
            1.0, 2.0, 3.0, -1.0, -1.0, 6.0, -2.0, -2.0, -3.0, -3.0, 4.0, 9.0,
        ];
        assert_eq!(row, last);
        let row = model_row(&factors, DesignModel::Linear, &[2.0, 3.0, 0.0]);
        assert_eq!(row, [1.0, 2.0, 3.0, 0.0, 1.0]);
    }

    /// Means of 1, x², x⁴ and x²y² over a square are 1, 1/3, 1/5 and 1/9.
    #[test]
    fn closed_form_means_over_the_region() {
        for count in [2, 6, 7, 8] {
            let points = region_points(&factors(count));
            let mean = |f: &dyn Fn(&[f64]) -> f64| -> f64 {
                points.iter().map(|(weight, point)| weight * f(point)).sum()
            };
            for (found, expected) in [
                (mean(&|_| 1.0), 1.0),
                (mean(&|x| x[0]), 0.0),
                (mean(&|x| x[1].powi(2)), 1.0 / 3.0),
                (mean(&|x| x[0].powi(4)), 0.2),
                (mean(&|x| x[0].powi(2) * x[1].powi(2)), 1.0 / 9.0),
            ] {
                assert!(
                    (found - expected).abs() < 1e-13,
                    "{count}: {found} {expected}"
                );
            }
        }
        let points = region_points(&factors(12));
        let mean: f64 = points.iter().map(|(w, x)| w * x[3].powi(2)).sum();
        assert!((mean - 1.0 / 3.0).abs() < 1e-3, "{mean}");
    }
}
