//! Central composite designs.

use crate::blocks::{block_of, block_words};
use crate::error::DesignError;
use crate::factorial::{roman, two_level_points};
use crate::finding::DesignFinding;
use crate::kind::{
    Design, Factor, Point, Run, add_centres, check_factors, check_numbers, check_runs, design_of,
    number_by_block,
};
use crate::word::{Fraction, Generator, Word, fraction_of};

/// Axial distances that differ by less, relative, are the same; 1.
const SAME_ALPHA: f64 = 1e-9;

/// How the axial distance is chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Alpha {
    /// Variance of prediction depends on the distance from the centre alone.
    Rotatable,
    /// 1: three levels.
    Face,
    /// √k: corners and axial points on one sphere.
    Spherical,
    /// Estimates of the quadratic terms are uncorrelated.
    Orthogonal,
    /// Differences between blocks do not enter the quadratic model.
    Blocks,
    /// A number of half-ranges.
    Given(f64),
}

/// Where the ends of a factor's range lie.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Ends {
    /// At coded −1 and 1, the corners of the cube.
    #[default]
    Factorial,
    /// At coded −α and α, the axial points.
    Axial,
}

/// How a central composite design is laid out.
#[derive(Clone, Debug, PartialEq)]
pub struct CompositeOptions {
    /// Axial distance.
    pub alpha: Alpha,
    /// Where the ends of the ranges lie.
    pub ends: Ends,
    /// Generators, where the cube is a fraction.
    pub generators: Vec<Generator>,
    /// Blocks: 1, or 1 (axial points) + a power of two (parts of the cube).
    pub blocks: usize,
    /// Centre points; with blocks, in each part of the cube.
    pub centre: usize,
    /// Centre points in the axial block; unused with one block.
    pub centre_axial: usize,
}

impl Default for CompositeOptions {
    fn default() -> Self {
        Self {
            alpha: Alpha::Rotatable,
            ends: Ends::Factorial,
            generators: Vec::new(),
            blocks: 1,
            centre: 5,
            centre_axial: 2,
        }
    }
}

/// Sizes of the parts of a composite design.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CompositeSize {
    /// Factors, k.
    pub factors: f64,
    /// Runs of the cube, n_f.
    pub cube: f64,
    /// Centre points with the cube.
    pub centre_cube: f64,
    /// Centre points with the axial points; 0 with one block.
    pub centre_axial: f64,
}

/// A central composite design: a two-level cube, 2k axial points at ±α, centre.
///
/// # Errors
/// Fewer than two factors, categories, α that is not above zero or does not
/// exist, generators or blocks that cannot be.
///
/// # Source
/// Box and Wilson (1951); Box and Hunter (1957), Annals of Mathematical
/// Statistics 28, 195-241.
pub fn central_composite(
    factors: Vec<Factor>,
    options: &CompositeOptions,
) -> Result<Design, DesignError> {
    check_factors("central composite", &factors, 2)?;
    check_numbers("central composite", &factors)?;
    let fraction = fraction_of(&options.generators, factors.len())?;
    let size = size_of(&fraction, options)?;
    let alpha = axial_distance(options.alpha, &size)?;
    let words = match options.blocks {
        1 => Vec::new(),
        blocks => block_words(&fraction, blocks - 1, 2)?,
    };
    let factors = scaled(factors, options.ends, alpha);
    let mut design = lay_out(factors, &fraction, options, alpha, &words);
    design.alpha = Some(alpha);
    add_findings(&mut design, options.blocks, fraction.resolution(), &size);
    design.fraction = Some(fraction);
    Ok(design)
}

/// The axial distance, in half-ranges of the cube.
///
/// * rotatable: α = n_f^(1/4)
/// * spherical: α = √k
/// * orthogonal: α² = (√(n_f N) − n_f)/2 with N all runs
/// * blocks: α² = k (1 + c_a/2k) / (1 + c_f/n_f), with c_f and c_a centre points
///   with the cube and with the axial points
///
/// # Errors
/// [`DesignError::AlphaInvalid`] for a given α that is not above zero;
/// [`DesignError::AlphaImpossible`].
///
/// # Source
/// Myers, Montgomery and Anderson-Cook (2016), Response Surface Methodology,
/// chapter 8; Box and Hunter (1957) for the blocks.
pub fn axial_distance(alpha: Alpha, size: &CompositeSize) -> Result<f64, DesignError> {
    let value = match alpha {
        Alpha::Rotatable => size.cube.sqrt().sqrt(),
        Alpha::Face => 1.0,
        Alpha::Spherical => size.factors.sqrt(),
        Alpha::Orthogonal => {
            let runs = size.cube + 2.0 * size.factors + size.centre_cube + size.centre_axial;
            (0.5 * ((size.cube * runs).sqrt() - size.cube)).sqrt()
        }
        Alpha::Blocks => {
            let axial = 1.0 + size.centre_axial / (2.0 * size.factors);
            let cube = 1.0 + size.centre_cube / size.cube;
            (size.factors * axial / cube).sqrt()
        }
        Alpha::Given(alpha) => alpha,
    };
    match value.is_finite() && value > 0.0 {
        true => Ok(value),
        false => Err(DesignError::AlphaInvalid { alpha: value }),
    }
}

/// Sizes; the cube's centre points are summed over its parts.
fn size_of(fraction: &Fraction, options: &CompositeOptions) -> Result<CompositeSize, DesignError> {
    let parts = match options.blocks {
        0 => 0,
        1 => 1,
        blocks => blocks - 1,
    };
    if !parts.is_power_of_two() {
        return Err(DesignError::BlocksImpossible {
            blocks: options.blocks,
            problem: "the cube divides into 1, 2, 4 … parts, and the axial points are one more \
                      block: 1, 2, 3, 5, 9"
                .into(),
        });
    }
    if options.alpha == Alpha::Blocks && options.blocks == 1 {
        return Err(DesignError::AlphaImpossible {
            property: "orthogonal to its blocks",
            problem: "it has one block; ask for 2 or more".into(),
        });
    }
    let size = CompositeSize {
        factors: fraction.factors as f64,
        cube: fraction.runs(),
        centre_cube: (options.centre * parts) as f64,
        centre_axial: if options.blocks > 1 {
            options.centre_axial as f64
        } else {
            0.0
        },
    };
    check_runs(size.cube + 2.0 * size.factors + size.centre_cube + size.centre_axial)?;
    Ok(size)
}

/// Factors whose half-range is the step from the centre to a corner.
fn scaled(mut factors: Vec<Factor>, ends: Ends, alpha: f64) -> Vec<Factor> {
    if ends == Ends::Axial {
        for factor in &mut factors {
            factor.half /= alpha;
        }
    }
    factors
}

fn lay_out(
    factors: Vec<Factor>,
    fraction: &Fraction,
    options: &CompositeOptions,
    alpha: f64,
    words: &[Word],
) -> Design {
    let count = factors.len();
    let points = two_level_points(fraction).into_iter();
    let points = points.map(|coded| (Point::Factorial, coded)).collect();
    let mut design = design_of(kind_of(options, fraction), factors, points);
    for run in &mut design.runs {
        run.block = block_of(words, &run.coded);
    }
    let axial_block = options.blocks;
    for factor in 0..count {
        for value in [-alpha, alpha] {
            let mut coded = vec![0.0; count];
            coded[factor] = value;
            design.runs.push(Run {
                standard_order: 0,
                block: axial_block,
                whole_plot: None,
                point: Point::Axial,
                coded,
            });
        }
    }
    for block in 1..options.blocks.max(2) {
        add_centres(&mut design, block, options.centre);
    }
    if options.blocks > 1 {
        add_centres(&mut design, axial_block, options.centre_axial);
    }
    number_by_block(&mut design);
    design
}

fn kind_of(options: &CompositeOptions, fraction: &Fraction) -> String {
    let alpha = match options.alpha {
        Alpha::Rotatable => "rotatable",
        Alpha::Face => "face-centred",
        Alpha::Spherical => "spherical",
        Alpha::Orthogonal => "orthogonal",
        Alpha::Blocks => "orthogonally blocked",
        Alpha::Given(_) => "given alpha",
    };
    let cube = match fraction.resolution() {
        None => String::new(),
        Some(r) => format!(
            ", cube 2^({}-{}) of resolution {}",
            fraction.factors,
            fraction.generators.len(),
            roman(r)
        ),
    };
    format!("central composite, {alpha}{cube}")
}

fn add_findings(
    design: &mut Design,
    blocks: usize,
    resolution: Option<usize>,
    size: &CompositeSize,
) {
    if let Some(resolution) = resolution.filter(|resolution| *resolution < 5) {
        design
            .findings
            .push(DesignFinding::LowResolution { resolution });
    }
    if blocks > 1
        && let Some(alpha) = design.alpha
        && let Ok(orthogonal) = axial_distance(Alpha::Blocks, size)
        && (alpha / orthogonal - 1.0).abs() > SAME_ALPHA
    {
        design
            .findings
            .push(DesignFinding::BlocksNotOrthogonal { alpha, orthogonal });
    }
    if size.centre_cube + size.centre_axial < 2.0 {
        design.findings.push(DesignFinding::NoReplicates);
    }
}
