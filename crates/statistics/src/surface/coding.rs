//! Coding of the factors of a response surface: actual = centre + half · coded.

/// Parts of a range by which numbers may differ and be one level.
const SAME: f64 = 1e-9;

/// A factor with its coding.
#[derive(Clone, Debug, PartialEq)]
pub struct FactorCoding {
    /// Its name.
    pub name: String,
    /// Actual value of coded 0.
    pub centre: f64,
    /// Actual step of coded 1.
    pub half: f64,
}

impl FactorCoding {
    /// Coded value of an actual one.
    pub fn coded(&self, actual: f64) -> f64 {
        (actual - self.centre) / self.half
    }

    /// Actual value of a coded one.
    pub fn actual(&self, coded: f64) -> f64 {
        self.centre + self.half * coded
    }
}

/// A table's factors in coded units.
#[derive(Clone, Debug, PartialEq)]
pub struct CodedFactors {
    /// The codings.
    pub factors: Vec<FactorCoding>,
    /// Coded values, a vector for each factor.
    pub values: Vec<Vec<f64>>,
    /// What design was recognised.
    pub recognised: Recognised,
}

impl CodedFactors {
    /// Lowest and highest coded value of a factor.
    pub fn range(&self, factor: usize) -> (f64, f64) {
        let values = self.values[factor].iter();
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(*value), high.max(*value))
        })
    }

    /// Actual settings of a coded point.
    pub fn actual(&self, coded: &[f64]) -> Vec<f64> {
        let pairs = self.factors.iter().zip(coded);
        pairs.map(|(factor, value)| factor.actual(*value)).collect()
    }
}

/// What the levels of a table look like.
#[derive(Clone, Debug, PartialEq)]
pub enum Recognised {
    /// Nothing in particular: ±1 are the ends of each range.
    Ranges,
    /// A central composite design.
    CentralComposite {
        /// Distance of its axial points in coded units.
        alpha: f64,
        /// Factors with rounded levels, and the largest difference in coded units.
        rounded: Vec<(String, f64)>,
    },
    /// The coding stands in the header of the design.
    Design {
        /// Factors with rounded settings, and the largest difference in coded units.
        rounded: Vec<(String, f64)>,
        /// Factors with settings that are not the planned levels, and the lines.
        changed: Vec<(String, Vec<usize>)>,
    },
    /// Given.
    Given,
}

/// Different values in increasing order.
fn levels(values: &[f64]) -> Vec<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let range = sorted.last().unwrap_or(&0.0) - sorted.first().unwrap_or(&0.0);
    sorted.dedup_by(|a, b| (*a - *b).abs() <= SAME * range);
    sorted
}

/// Codes a table without a header. A central composite design is recognised by its
/// points, also with levels rounded for print, and gets its exact levels.
///
/// * `columns`: name and values of each factor, which is not constant
pub fn code_by_levels(columns: &[(String, &[f64])]) -> CodedFactors {
    central_composite(columns).unwrap_or_else(|| {
        let factors: Vec<FactorCoding> = columns
            .iter()
            .map(|(name, values)| {
                let levels = levels(values);
                let (low, high) = (levels[0], levels[levels.len() - 1]);
                FactorCoding {
                    name: name.clone(),
                    centre: 0.5 * (low + high),
                    half: 0.5 * (high - low),
                }
            })
            .collect();
        code_with(factors, columns, Recognised::Ranges)
    })
}

/// Codes a table by known codings, one for each column.
pub fn code_with(
    factors: Vec<FactorCoding>,
    columns: &[(String, &[f64])],
    recognised: Recognised,
) -> CodedFactors {
    let pairs = factors.iter().zip(columns);
    let values = pairs.map(|(factor, (_, values))| {
        let coded = values.iter().map(|value| factor.coded(*value));
        coded.collect()
    });
    CodedFactors {
        values: values.collect(),
        factors,
        recognised,
    }
}

/// Half a unit in the last decimal of the most precisely written number.
fn rounding(values: &[f64]) -> f64 {
    let decimals = values.iter().map(|value| {
        let text = format!("{value}");
        text.split_once('.')
            .map_or(0, |(_, decimals)| decimals.len())
    });
    0.5 * 10.0_f64.powi(-(decimals.max().unwrap_or(0) as i32))
}

fn central_composite(columns: &[(String, &[f64])]) -> Option<CodedFactors> {
    let count = columns.len();
    let all: Vec<Vec<f64>> = columns.iter().map(|(_, values)| levels(values)).collect();
    if count < 2 || all.iter().any(|levels| levels.len() != 5) {
        return None;
    }
    // Which level of its factor each cell is at, from -2 to 2.
    let rows = columns[0].1.len();
    let place = |factor: usize, row: usize| -> i32 {
        let value = columns[factor].1[row];
        let distance = |level: &f64| (level - value).abs();
        let nearest =
            (0..5).min_by(|a, b| distance(&all[factor][*a]).total_cmp(&distance(&all[factor][*b])));
        nearest.unwrap_or(2) as i32 - 2
    };
    let mut cube: Vec<Vec<i32>> = Vec::new();
    for row in 0..rows {
        let places: Vec<i32> = (0..count).map(|factor| place(factor, row)).collect();
        let outer = places.iter().filter(|p| p.abs() == 2).count();
        let inner = places.iter().filter(|p| p.abs() == 1).count();
        match (outer, inner) {
            (0, 0) | (1, 0) => {}
            (0, n) if n == count => {
                if !cube.contains(&places) {
                    cube.push(places);
                }
            }
            _ => return None,
        }
    }
    let (count_f, points) = (count as f64, cube.len() as f64);
    let measured: f64 = all
        .iter()
        .map(|l| (l[4] - l[0]) / (l[3] - l[1]))
        .sum::<f64>()
        / count_f;
    let candidates = [points.powf(0.25), count_f.sqrt(), measured];
    let alpha = candidates.into_iter().find(|alpha| {
        all.iter().zip(columns).all(|(levels, (_, values))| {
            let tolerance = rounding(values) + SAME * (levels[4] - levels[0]);
            let (centre, half) = exact(levels, *alpha);
            let expected = [centre - half, centre, centre + half];
            let pairs = levels[1..4].iter().zip(expected);
            pairs
                .into_iter()
                .all(|(level, exact)| (level - exact).abs() <= tolerance)
        })
    })?;
    let mut rounded = Vec::new();
    let mut factors = Vec::new();
    let mut coded = Vec::new();
    for (factor, (name, values)) in columns.iter().enumerate() {
        let (centre, half) = exact(&all[factor], alpha);
        let scale = [-alpha, -1.0, 0.0, 1.0, alpha];
        let own: Vec<f64> = (0..rows)
            .map(|row| scale[(place(factor, row) + 2) as usize])
            .collect();
        let pairs = own.iter().zip(*values);
        let off = pairs.map(|(coded, actual)| ((actual - centre) / half - coded).abs());
        let off = off.fold(0.0, f64::max);
        if off > 1e-7 {
            rounded.push((name.clone(), off));
        }
        factors.push(FactorCoding {
            name: name.clone(),
            centre,
            half,
        });
        coded.push(own);
    }
    Some(CodedFactors {
        factors,
        values: coded,
        recognised: Recognised::CentralComposite { alpha, rounded },
    })
}

/// Centre and half-range of a factor whose axial levels are exact.
fn exact(levels: &[f64], alpha: f64) -> (f64, f64) {
    (
        0.5 * (levels[0] + levels[4]),
        0.5 * (levels[4] - levels[0]) / alpha,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn two_factors(inner: f64) -> [Vec<f64>; 2] {
        let a = vec![-inner, inner, -inner, inner, -2.0, 2.0, 0.0, 0.0, 0.0];
        let b = vec![-inner, -inner, inner, inner, 0.0, 0.0, -2.0, 2.0, 0.0];
        [a, b]
    }

    fn code(columns: &[Vec<f64>; 2]) -> CodedFactors {
        let names = ["a", "b"].map(str::to_owned);
        let columns: Vec<(String, &[f64])> = names
            .into_iter()
            .zip(columns.iter().map(Vec::as_slice))
            .collect();
        code_by_levels(&columns)
    }

    /// Rotatable for two factors: α = √2; ±2 printed exactly, ±√2 as ±1.4.
    #[test]
    fn closed_form_rounded_levels_are_recognised() {
        let exact = code(&two_factors(std::f64::consts::SQRT_2));
        let found = code(&two_factors(1.4));
        assert_eq!(exact.values, found.values);
        assert!((found.factors[0].half - std::f64::consts::SQRT_2).abs() < 1e-15);
        match found.recognised {
            Recognised::CentralComposite { alpha, rounded } => {
                assert!((alpha - std::f64::consts::SQRT_2).abs() < 1e-15);
                assert_eq!(rounded.len(), 2);
            }
            other => panic!("{other:?}"),
        }
        // 1.3 is no rounding of √2: a design of its own.
        match code(&two_factors(1.3)).recognised {
            Recognised::CentralComposite { alpha, rounded } => {
                assert!((alpha - 2.0 / 1.3).abs() < 1e-12 && rounded.is_empty());
            }
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn closed_form_ranges_of_other_tables() {
        let found = code(&[vec![1.0, 2.0, 4.0, 5.0], vec![0.0, 1.0, 0.0, 1.0]]);
        assert_eq!(found.recognised, Recognised::Ranges);
        assert_eq!(found.values[0], [-1.0, -0.5, 0.5, 1.0]);
        assert_eq!(found.factors[1].actual(-1.0), 0.0);
    }
}
