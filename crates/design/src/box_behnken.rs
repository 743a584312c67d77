//! Box-Behnken designs: three levels, no corner of the cube.

use crate::error::DesignError;
use crate::finding::DesignFinding;
use crate::kind::{
    Design, Factor, Point, add_centres, check_factors, check_numbers, design_of, number_by_block,
};

/// Factors, and the sets of factors that change together.
///
/// Source: Box and Behnken (1960), Technometrics 2, 455-475, table 4.
const SETS: [(usize, &str); 5] = [
    (3, "AB AC BC"),
    (4, "AB CD AD BC AC BD"),
    (5, "AB CD BE AC DE BC AD CE AE BD"),
    (6, "ABD BCE CDF ADE BEF ACF"),
    (7, "DEF AFG BEG ABD CDG ACE BCF"),
];

/// How a Box-Behnken design is laid out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BoxBehnkenOptions {
    /// Centre points in each block.
    pub centre: usize,
    /// Blocks: 1; or 3 for four factors, 2 for five to seven.
    pub blocks: usize,
}

/// A Box-Behnken design of 3 to 7 factors.
///
/// Four factors divide into three blocks and five into two by whole sets of
/// factors; six and seven into two by the sign of the product of each set's
/// three levels. Blocks are orthogonal to the quadratic model.
///
/// # Errors
/// Another number of factors, categories, blocks that do not exist.
pub fn box_behnken(
    factors: Vec<Factor>,
    options: &BoxBehnkenOptions,
) -> Result<Design, DesignError> {
    let kind = "Box-Behnken";
    check_factors(kind, &factors, 1)?;
    check_numbers(kind, &factors)?;
    let count = factors.len();
    let known = SETS.iter().find(|(factors, _)| *factors == count);
    let (_, sets) = known.ok_or_else(|| DesignError::FactorCount {
        kind,
        expected: "3 to 7".to_owned(),
        found: count,
    })?;
    check_blocks(count, options.blocks)?;
    let sets: Vec<&str> = sets.split(' ').collect();
    let mut points = Vec::new();
    let mut blocks = Vec::new();
    for (place, set) in sets.iter().enumerate() {
        for signs in 0..1_usize << set.len() {
            let mut coded = vec![0.0; count];
            for (bit, letter) in set.bytes().enumerate() {
                coded[usize::from(letter - b'A')] = if signs >> bit & 1 == 1 { 1.0 } else { -1.0 };
            }
            points.push((Point::Edge, coded));
            let by_set = place * options.blocks / sets.len();
            let by_sign = signs.count_ones() as usize % options.blocks;
            blocks.push(1 + if set.len() == 2 { by_set } else { by_sign });
        }
    }
    let mut design = design_of(kind.to_owned(), factors, points);
    for (run, block) in design.runs.iter_mut().zip(blocks) {
        run.block = block;
    }
    for block in 1..=options.blocks {
        add_centres(&mut design, block, options.centre);
    }
    number_by_block(&mut design);
    if options.centre * options.blocks < 2 {
        design.findings.push(DesignFinding::NoReplicates);
    }
    Ok(design)
}

fn check_blocks(factors: usize, blocks: usize) -> Result<(), DesignError> {
    let possible = match factors {
        4 => Some(3),
        5..=7 => Some(2),
        _ => None,
    };
    if blocks == 1 || possible == Some(blocks) {
        return Ok(());
    }
    let problem = match possible {
        Some(number) => {
            format!("a Box-Behnken design of {factors} factors has 1 or {number} blocks")
        }
        None => format!("a Box-Behnken design of {factors} factors has one block"),
    };
    Err(DesignError::BlocksImpossible { blocks, problem })
}
