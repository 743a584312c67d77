//! Factorial designs: all combinations of levels, and fractions of two levels.

use crate::blocks::{block_of, block_words};
use crate::error::DesignError;
use crate::finding::DesignFinding;
use crate::kind::{
    Design, Factor, Point, add_centres, centres_of, check_centre, check_factors, check_runs,
    check_two_levels, design_of, number_by_block,
};
use crate::word::{Fraction, Generator, MOST_LETTERS, fraction_of};

/// How a factorial design is laid out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FactorialOptions {
    /// How often every combination is run.
    pub replicates: usize,
    /// Centre points in each block.
    pub centre: usize,
    /// Blocks; a power of two for two levels, else 1.
    pub blocks: usize,
}

impl Default for FactorialOptions {
    fn default() -> Self {
        Self {
            replicates: 1,
            centre: 0,
            blocks: 1,
        }
    }
}

/// All combinations of the levels of each factor, in standard order: the first
/// factor changes fastest.
///
/// * `levels`: coded levels of each factor
///
/// # Errors
/// No factor, a factor of fewer than two levels, too many runs, or blocks
/// (two-level designs alone have them: [`two_level`]).
pub fn full_factorial(
    factors: Vec<Factor>,
    levels: &[Vec<f64>],
    options: &FactorialOptions,
) -> Result<Design, DesignError> {
    check_factors("factorial", &factors, 1)?;
    if levels.len() != factors.len() {
        return Err(DesignError::PointLength {
            point: 1,
            found: levels.len(),
            expected: factors.len(),
        });
    }
    if let Some(few) = (0..factors.len()).find(|i| levels[*i].len() < 2) {
        let (name, found) = (factors[few].name.clone(), levels[few].len());
        return Err(DesignError::LevelsTooFew { name, found });
    }
    let two_levels = levels.iter().all(|levels| levels[..] == [-1.0, 1.0]);
    if two_levels && factors.len() <= MOST_LETTERS {
        return two_level(factors, &[], options);
    }
    if options.blocks > 1 {
        return Err(DesignError::BlocksImpossible {
            blocks: options.blocks,
            problem: "only designs of two levels are divided into blocks".into(),
        });
    }
    check_size(
        levels.iter().map(|levels| levels.len() as f64).product(),
        &factors,
        options,
    )?;
    let mut points = vec![Vec::new()];
    for levels in levels.iter().rev() {
        // The factors after this one are in place; this one changes faster.
        let longer = points.iter().flat_map(|rest: &Vec<f64>| {
            levels.iter().map(move |level| {
                let mut point = vec![*level];
                point.extend(rest);
                point
            })
        });
        points = longer.collect();
    }
    let counts: Vec<String> = levels
        .iter()
        .map(|levels| levels.len().to_string())
        .collect();
    let kind = format!("full factorial, {} levels", counts.join(" × "));
    lay_out(kind, factors, points, options, None)
}

/// A two-level factorial, or the fraction that generators make of it.
///
/// # Errors
/// Factors with more than two categories, generators that make no design of
/// resolution III or higher, blocks that would take main effects, too many runs.
pub fn two_level(
    factors: Vec<Factor>,
    generators: &[Generator],
    options: &FactorialOptions,
) -> Result<Design, DesignError> {
    check_factors("factorial", &factors, 1)?;
    check_two_levels("two-level factorial", &factors)?;
    let fraction = fraction_of(generators, factors.len())?;
    check_size(fraction.runs(), &factors, options)?;
    let points = two_level_points(&fraction);
    let (k, p) = (factors.len(), generators.len());
    let kind = match fraction.resolution() {
        None => format!("full factorial, 2^{k}"),
        Some(r) => format!("fractional factorial, 2^({k}-{p}), resolution {}", roman(r)),
    };
    let mut design = lay_out(kind, factors, points, options, Some(&fraction))?;
    if let Some(resolution) = fraction.resolution().filter(|r| *r < 5) {
        design
            .findings
            .push(DesignFinding::LowResolution { resolution });
    }
    design.fraction = Some(fraction);
    Ok(design)
}

/// Points of ±1 in standard order of the base factors: the first changes fastest.
pub fn two_level_points(fraction: &Fraction) -> Vec<Vec<f64>> {
    let base = fraction.base();
    (0..1_usize << base.len())
        .map(|index| {
            let mut point = vec![1.0; fraction.factors];
            for (bit, factor) in base.iter().enumerate() {
                point[*factor] = if index >> bit & 1 == 1 { 1.0 } else { -1.0 };
            }
            for generator in &fraction.generators {
                point[generator.factor] = generator.word.value(&point);
            }
            point
        })
        .collect()
}

/// A resolution in Roman numerals, as is the custom.
pub fn roman(resolution: usize) -> String {
    let tens = "X".repeat(resolution / 10);
    let units = ["", "I", "II", "III", "IV", "V", "VI", "VII", "VIII", "IX"];
    tens + units[resolution % 10]
}

fn check_size(
    points: f64,
    factors: &[Factor],
    options: &FactorialOptions,
) -> Result<(), DesignError> {
    let blocks = options.blocks;
    if blocks == 0 || options.replicates == 0 {
        let what = "a factorial design, with one block and one replicate,".to_owned();
        let least = points as usize;
        return Err(DesignError::RunsTooFew {
            runs: 0,
            least,
            what,
        });
    }
    let each = match options.centre {
        0 => 0,
        count => count * centres_of(factors).len(),
    };
    let centres = each as f64 * blocks as f64;
    check_runs(points * options.replicates as f64 + centres)
}

/// Replicates, blocks and centre points.
fn lay_out(
    kind: String,
    factors: Vec<Factor>,
    points: Vec<Vec<f64>>,
    options: &FactorialOptions,
    fraction: Option<&Fraction>,
) -> Result<Design, DesignError> {
    if options.centre > 0 {
        check_centre("factorial with centre points", &factors)?;
    }
    let words = match fraction {
        Some(fraction) if options.blocks > 1 => block_words(fraction, options.blocks, 1)?,
        _ => Vec::new(),
    };
    let replicates = options.replicates;
    let repeated = (0..replicates).flat_map(|_| points.iter().cloned());
    let points = repeated.map(|coded| (Point::Factorial, coded)).collect();
    let mut design = design_of(kind, factors, points);
    for run in &mut design.runs {
        run.block = block_of(&words, &run.coded);
    }
    for block in 1..=options.blocks {
        add_centres(&mut design, block, options.centre);
    }
    number_by_block(&mut design);
    if replicates == 1 && options.centre < 2 {
        design.findings.push(DesignFinding::NoReplicates);
    }
    Ok(design)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kind::evenly;

    fn factors(count: usize) -> Vec<Factor> {
        (0..count)
            .map(|i| Factor::between(&format!("x{i}"), "", 0.0, 1.0).unwrap())
            .collect()
    }

    #[test]
    fn closed_form_mixed_levels_in_standard_order() {
        let levels = [evenly(2), evenly(3)];
        let found = full_factorial(factors(2), &levels, &FactorialOptions::default()).unwrap();
        let points: Vec<&[f64]> = found.runs.iter().map(|run| &run.coded[..]).collect();
        let expected: [&[f64]; 6] = [
            &[-1.0, -1.0],
            &[1.0, -1.0],
            &[-1.0, 0.0],
            &[1.0, 0.0],
            &[-1.0, 1.0],
            &[1.0, 1.0],
        ];
        assert_eq!(points, expected);
    }

    /// Yates order of 2^3: (1), a, b, ab, c, ac, bc, abc.
    #[test]
    fn closed_form_yates_order_and_blocks() {
        let options = FactorialOptions {
            replicates: 2,
            centre: 3,
            blocks: 2,
        };
        let found = two_level(factors(3), &[], &options).unwrap();
        assert_eq!(found.runs.len(), 2 * 8 + 2 * 3);
        assert_eq!(found.runs.iter().filter(|run| run.block == 1).count(), 11);
        // (1) has ABC = −1 and lies in the first block with ab, ac, bc.
        let first: Vec<f64> = found.runs[..4]
            .iter()
            .map(|r| r.coded.iter().sum())
            .collect();
        assert_eq!(first, [-3.0, 1.0, 1.0, 1.0]);
    }

    #[test]
    fn rejects_what_makes_no_factorial() {
        let none = full_factorial(vec![], &[], &FactorialOptions::default()).unwrap_err();
        assert!(matches!(none, DesignError::FactorCount { found: 0, .. }));
        let levels = vec![evenly(10); 7];
        let many = full_factorial(factors(7), &levels, &FactorialOptions::default()).unwrap_err();
        let expected = DesignError::RunsTooMany {
            runs: 1e7,
            most: 1_000_000,
        };
        assert_eq!(many, expected);
        let many = two_level(factors(40), &[], &FactorialOptions::default()).unwrap_err();
        assert!(matches!(many, DesignError::RunsTooMany { .. }));
        let mut same = factors(2);
        same[1].name = "x0".into();
        let error = two_level(same, &[], &FactorialOptions::default()).unwrap_err();
        assert_eq!(error, DesignError::FactorRepeated { name: "x0".into() });
    }
}
