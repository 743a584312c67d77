//! Plackett-Burman designs: main effects of up to N − 1 factors in N runs.

use crate::error::DesignError;
use crate::finding::DesignFinding;
use crate::kind::{
    Design, Factor, Point, add_centres, check_centre, check_factors, check_two_levels, design_of,
};

/// Most runs.
pub const MOST_RUNS: usize = 256;

/// A Plackett-Burman design.
///
/// * `runs`: a multiple of 4; `None` for the smallest above the number of
///   factors
/// * `centre`: centre points
///
/// # Errors
/// Too few runs, a number of runs that no construction here gives, factors of
/// more than two categories.
///
/// # Source
/// Plackett and Burman (1946), Biometrika 33, 305-325. N = q + 1 with a prime
/// q = 4m + 3 is Paley's first construction, whose first row is the published
/// one (12, 20, 24, 32, 44, 48 …); others are Paley's second, N = 2(q + 1) with
/// a prime q = 4m + 1 (28, 36, 76 …), or doubled (16, 40, 56 …).
pub fn plackett_burman(
    factors: Vec<Factor>,
    runs: Option<usize>,
    centre: usize,
) -> Result<Design, DesignError> {
    let kind = "Plackett-Burman";
    check_factors(kind, &factors, 1)?;
    check_two_levels(kind, &factors)?;
    if centre > 0 {
        check_centre("Plackett-Burman design with centre points", &factors)?;
    }
    let least = factors.len() + 1;
    let available =
        |from: usize| (from..=MOST_RUNS).find(|n| n.is_multiple_of(4) && signs(*n).is_some());
    let runs = match runs {
        Some(runs) if runs < least => {
            let what = format!("a Plackett-Burman design of {} factors", factors.len());
            return Err(DesignError::RunsTooFew { runs, least, what });
        }
        Some(runs) => runs,
        None => available(least).unwrap_or(least),
    };
    let unknown = || {
        let below = (4..runs.min(MOST_RUNS)).rev().find(|n| signs(*n).is_some());
        let near: Vec<String> = [below, available(runs)]
            .into_iter()
            .flatten()
            .map(|n| n.to_string())
            .collect();
        DesignError::RunsUnknown {
            kind,
            runs,
            nearest: near.join(", "),
        }
    };
    let matrix = signs(runs)
        .filter(|_| runs <= MOST_RUNS)
        .ok_or_else(unknown)?;
    let points = matrix.iter().map(|row| {
        let coded = row[..factors.len()].iter().map(|sign| f64::from(*sign));
        (Point::Factorial, coded.collect())
    });
    let mut design = design_of(
        format!("{kind}, {runs} runs"),
        factors.clone(),
        points.collect(),
    );
    add_centres(&mut design, 1, centre);
    design
        .findings
        .push(DesignFinding::LowResolution { resolution: 3 });
    if centre < 2 {
        design.findings.push(DesignFinding::NoReplicates);
    }
    Ok(design)
}

/// N rows of N − 1 signs with orthogonal columns that sum to zero, cyclic where possible;
/// `None` without a construction.
pub fn signs(runs: usize) -> Option<Vec<Vec<i8>>> {
    if runs < 4 || !runs.is_multiple_of(4) || runs > MOST_RUNS {
        return None;
    }
    if is_prime(runs - 1) {
        return Some(cyclic(runs - 1));
    }
    let matrix = hadamard(runs)?;
    // Rows are turned so that the first column is +, which is then left out.
    let turned = matrix
        .iter()
        .map(|row| row[1..].iter().map(|sign| sign * row[0]).collect());
    Some(turned.collect())
}

/// Shifts of the row of quadratic residues modulo q, and a row of −1.
fn cyclic(q: usize) -> Vec<Vec<i8>> {
    let first: Vec<i8> = (0..q)
        .map(|i| if i == 0 { 1 } else { residue(i, q) })
        .collect();
    let shifted = |shift: usize| (0..q).map(|i| first[(i + q - shift) % q]).collect();
    let mut rows: Vec<Vec<i8>> = (0..q).map(shifted).collect();
    rows.push(vec![-1; q]);
    rows
}

/// A Hadamard matrix by Paley's constructions or by doubling.
fn hadamard(order: usize) -> Option<Vec<Vec<i8>>> {
    if order == 1 {
        return Some(vec![vec![1]]);
    }
    if order.is_multiple_of(4) && is_prime(order - 1) {
        let with_ones = cyclic(order - 1).into_iter().map(|mut row| {
            row.insert(0, 1);
            row
        });
        return Some(with_ones.collect());
    }
    let q = (order / 2).checked_sub(1)?;
    if order.is_multiple_of(4) && q % 4 == 1 && is_prime(q) {
        return Some(paley_second(q));
    }
    let half = hadamard(order / 2).filter(|_| order.is_multiple_of(2))?;
    let doubled = [1, -1].into_iter().flat_map(|sign| {
        half.iter().map(move |row| {
            row.iter()
                .copied()
                .chain(row.iter().map(|v| sign * v))
                .collect()
        })
    });
    Some(doubled.collect())
}

/// Order 2(q + 1): the symmetric conference matrix C of order q + 1 with each
/// ±1 replaced by ±(1 1; 1 −1) and each 0 of the diagonal by (1 −1; −1 −1).
fn paley_second(q: usize) -> Vec<Vec<i8>> {
    let conference = |i: usize, j: usize| match (i, j) {
        (i, j) if i == j => 0,
        (0, _) | (_, 0) => 1,
        (i, j) => residue((i + q - j) % q, q),
    };
    let entry = |i: usize, j: usize| match (conference(i / 2, j / 2), i % 2, j % 2) {
        (0, 0, 0) => 1,
        (0, _, _) => -1,
        (sign, 1, 1) => -sign,
        (sign, _, _) => sign,
    };
    let order = 2 * (q + 1);
    (0..order)
        .map(|i| (0..order).map(|j| entry(i, j)).collect())
        .collect()
}

/// 1 for a square modulo the prime q, −1 for another number; `value` is not 0.
fn residue(value: usize, q: usize) -> i8 {
    let square = (1..q).any(|root| root * root % q == value % q);
    if square { 1 } else { -1 }
}

fn is_prime(number: usize) -> bool {
    number > 1
        && (2..)
            .take_while(|d| d * d <= number)
            .all(|d| !number.is_multiple_of(d))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// First rows printed by Plackett and Burman (1946) for 8, 12, 20, 24 runs.
    #[test]
    fn reference_published_first_rows() {
        let published = [
            "+++-+--",
            "++-+++---+-",
            "++--++++-+-+----++-",
            "+++++-+-++--++--+-+----",
        ];
        for row in published {
            let found: String = signs(row.len() + 1).unwrap()[0]
                .iter()
                .map(|sign| if *sign > 0 { '+' } else { '-' })
                .collect();
            assert_eq!(found, row);
        }
    }

    /// With a column of ones H H' = N I; exactly the multiples of 4 up to 48 are
    /// there, and the known gaps above.
    #[test]
    fn closed_form_hadamard() {
        let mut missing = Vec::new();
        for runs in (4..=100).step_by(4) {
            let Some(rows) = signs(runs) else {
                missing.push(runs);
                continue;
            };
            assert!(rows.len() == runs && rows.iter().all(|row| row.len() == runs - 1));
            for (i, first) in rows.iter().enumerate() {
                for (j, second) in rows.iter().enumerate() {
                    let product = first.iter().zip(second).map(|(a, b)| i32::from(a * b));
                    let expected = if i == j { runs as i32 } else { 0 };
                    assert_eq!(1 + product.sum::<i32>(), expected, "{runs}: rows {i}, {j}");
                }
            }
        }
        assert_eq!(missing, [52, 92, 100]);
    }

    #[test]
    fn rejects_sizes_that_are_not_there() {
        let factors = |n: usize| {
            let name = |i: usize| Factor::between(&format!("x{i}"), "", 0.0, 1.0).unwrap();
            (0..n).map(name).collect::<Vec<_>>()
        };
        let error = plackett_burman(factors(11), Some(8), 0).unwrap_err();
        assert!(matches!(error, DesignError::RunsTooFew { least: 12, .. }));
        let error = plackett_burman(factors(11), Some(52), 0).unwrap_err();
        assert!(error.to_string().contains("nearest: 48, 56"), "{error}");
        let error = plackett_burman(factors(3), Some(14), 0).unwrap_err();
        assert!(error.to_string().contains("nearest: 12, 16"), "{error}");
        assert_eq!(
            plackett_burman(factors(11), None, 0).unwrap().runs.len(),
            12
        );
        assert_eq!(
            plackett_burman(factors(12), None, 0).unwrap().runs.len(),
            16
        );
    }
}
