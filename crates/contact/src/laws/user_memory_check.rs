//! Whether a formula of unloading goes on where loading ends, without jumps and with a value
//! wherever a contact passes.

use crate::formula::error::FormulaError;
use crate::formula::graph::{Id, Node, Variable};
use crate::formula::value::values_after;
use crate::laws::user_check::{JUMP, Looked, MUST, RATES, displacements};
use crate::laws::user_finding::UserLawFinding;

/// Parts of the largest displacement at which unloading is checked; 1.
const PARTS: [f64; 9] = [1e-4, 0.02, 0.1, 0.25, 0.4, 0.6, 0.8, 0.95, 0.999];
/// Halvings until a change of piece is located.
const HALVINGS: usize = 60;

/// What a contact remembers and where it is: x, v, x_max; m, m/s, m.
type State = [f64; 3];

/// Looks at unloading over the working range.
///
/// * `looked`: the formula of loading, with the slopes of the whole force
///
/// # Errors
/// It does not begin where loading ends, has no value where it needs one, or jumps.
pub(crate) fn check_unloading(
    looked: &Looked,
    unloading: Id,
) -> Result<Vec<UserLawFinding>, FormulaError> {
    let mut findings = Vec::new();
    let deep = displacements().filter(|peak| *peak <= MUST);
    // From the deepest, which says most in a message.
    for peak in deep.collect::<Vec<f64>>().into_iter().rev() {
        begins(looked, unloading, peak)?;
        finite(looked, unloading, peak)?;
    }
    jumps(looked, unloading)?;
    let mut peaks = displacements().filter(|peak| (1e-6..=MUST).contains(peak));
    findings.extend(
        peaks
            .clone()
            .find_map(|peak| reloads(looked, unloading, peak)),
    );
    findings.extend(peaks.find_map(|peak| gains(looked, unloading, peak)));
    Ok(findings)
}

fn at(looked: &Looked, state: State) -> Vec<f64> {
    values_after(looked.graph, looked.values, state)
}

/// Whether two forces differ by more than rounding at the largest displacement leaves.
fn jumped(looked: &Looked, peak: f64, below: f64, above: f64) -> bool {
    let scale = looked.force(peak, 0.0).abs().max(below.abs());
    (above - below).abs() > JUMP.0 * scale + JUMP.1
}

/// At rest at the largest displacement both formulas give one force.
fn begins(looked: &Looked, unloading: Id, peak: f64) -> Result<(), FormulaError> {
    let below = looked.force(peak, 0.0);
    let above = at(looked, [peak, 0.0, peak])[unloading];
    match jumped(looked, peak, below, above) || !above.is_finite() {
        false => Ok(()),
        true => Err(FormulaError::StateJumps {
            below,
            above,
            displacement: peak,
            rate: 0.0,
            peak,
            change: "where unloading begins: at x = x_max and v = 0 it must give the force of \
                     loading, F_max",
            values: looked.values_text(),
        }),
    }
}

fn finite(looked: &Looked, unloading: Id, peak: f64) -> Result<(), FormulaError> {
    for (part, rate) in PARTS.iter().flat_map(|part| RATES.map(|rate| (part, rate))) {
        let displacement = part * peak;
        let values = at(looked, [displacement, rate, peak]);
        let slopes = looked.slopes.iter().map(|id| values[*id]);
        // Slopes at rest may be infinite: the motion only passes there.
        let own = rate == 0.0 || slopes.into_iter().all(f64::is_finite);
        if !values[unloading].is_finite() || !own {
            return Err(FormulaError::UndefinedUnloading {
                displacement,
                rate,
                peak,
                values: looked.values_text(),
            });
        }
    }
    Ok(())
}

/// Looks along lines of x, of v and of the largest displacement for places where a piece ends.
fn jumps(looked: &Looked, unloading: Id) -> Result<(), FormulaError> {
    let conditions: Vec<Id> = looked.graph.nodes[..=unloading]
        .iter()
        .filter_map(|node| match node {
            Node::Choice(condition, _, _) => Some(*condition),
            _ => None,
        })
        .filter(|condition| {
            let by = [Variable::Displacement, Variable::Rate, Variable::Peak];
            by.into_iter()
                .any(|by| looked.graph.depends(*condition, by))
        })
        .collect();
    let peaks: Vec<f64> = displacements()
        .filter(|peak| (1e-6..=MUST).contains(peak))
        .collect();
    for &condition in &conditions {
        let look = |one, other| crossing(looked, (unloading, condition), one, other);
        for rate in RATES {
            for &peak in &peaks {
                for parts in PARTS.windows(2) {
                    let of = |part: f64| [part * peak, rate, peak];
                    look(of(parts[0]), of(parts[1]))?;
                }
            }
            for (part, two) in PARTS
                .iter()
                .flat_map(|p| peaks.windows(2).map(move |t| (p, t)))
            {
                let of = |peak: f64| [part * peak, rate, peak];
                look(of(two[0]), of(two[1]))?;
            }
        }
        for (part, peak) in PARTS.iter().flat_map(|p| peaks.iter().map(move |t| (p, t))) {
            for rates in RATES.windows(2) {
                look(
                    [part * peak, rates[0], *peak],
                    [part * peak, rates[1], *peak],
                )?;
            }
        }
    }
    Ok(())
}

/// Whether the force of unloading jumps where a condition changes between two states.
fn crossing(
    looked: &Looked,
    (unloading, condition): (Id, Id),
    mut one: State,
    mut other: State,
) -> Result<(), FormulaError> {
    let holds = |state: State| at(looked, state)[condition] > 0.0;
    let first = holds(one);
    if first == holds(other) {
        return Ok(());
    }
    for _ in 0..HALVINGS {
        let middle = std::array::from_fn(|i| 0.5 * (one[i] + other[i]));
        match holds(middle) == first {
            true => one = middle,
            false => other = middle,
        }
    }
    let force = |state: State| at(looked, state)[unloading];
    match jumped(looked, one[2], force(one), force(other)) {
        false => Ok(()),
        true => Err(FormulaError::StateJumps {
            below: force(one),
            above: force(other),
            displacement: one[0],
            rate: one[1],
            peak: one[2],
            change: "where unloading changes its piece: make the pieces meet",
            values: looked.values_text(),
        }),
    }
}

/// A force that jumps where a reloading passes the largest displacement.
fn reloads(looked: &Looked, unloading: Id, peak: f64) -> Option<UserLawFinding> {
    let mut rates = RATES.into_iter().filter(|rate| *rate > 0.0);
    rates.find_map(|rate| {
        let own = at(looked, [peak, rate, peak])[unloading];
        let loading = looked.force(peak, rate);
        jumped(looked, peak, own, loading).then_some(UserLawFinding::JumpsOnReloading {
            peak,
            rate,
            unloading: own,
            loading,
        })
    })
}

/// Unloading above loading.
fn gains(looked: &Looked, unloading: Id, peak: f64) -> Option<UserLawFinding> {
    PARTS.into_iter().find_map(|part| {
        let displacement = part * peak;
        let own = at(looked, [displacement, 0.0, peak])[unloading];
        let loading = looked.force(displacement, 0.0);
        (own > loading && jumped(looked, peak, own, loading)).then(|| UserLawFinding::GainsEnergy {
            peak,
            displacement,
            values: looked.values_text(),
        })
    })
}
