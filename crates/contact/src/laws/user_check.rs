//! Whether a formula is a contact force: defined at first touch and in the
//! working range, pushing while loading, without jumps.

use crate::formula::error::{FormulaError, FormulaPlace};
use crate::formula::graph::{Graph, Id, Node};
use crate::formula::syntax::Term;
use crate::formula::value::{culprit, node_values};
use crate::law::SMALLEST_DISPLACEMENT;
use crate::laws::user_finding::UserLawFinding;
use crate::parameter::number_text;

/// Rates checked; m/s. Fruit meet at up to a few metres per second.
pub(crate) const RATES: [f64; 7] = [2.0, 0.5, 0.05, 0.0, -0.05, -0.5, -2.0];
/// Smallest and largest displacement checked; m.
const DISPLACEMENTS: (f64, f64) = (1e-7, 1e-2);
/// How many.
const STEPS: usize = 60;
/// Up to here a law must be in order; beyond, a finding says what is not; m.
pub(crate) const MUST: f64 = 1e-3;
/// A jump is a change across a point of more than this part of the force, and
/// more than this force.
pub(crate) const JUMP: (f64, f64) = (1e-6, 1e-9);

/// A formula to check.
pub(crate) struct Looked<'a> {
    pub formula: &'a str,
    pub term: &'a Term,
    pub names: &'a [String],
    pub graph: &'a Graph,
    pub force: Id,
    /// Slopes in x, v and the parameters.
    pub slopes: &'a [Id],
    /// Values at which it is checked; SI.
    pub values: &'a [f64],
}

/// Looks at the formula over the working range.
///
/// # Errors
/// It has no value where it needs one, pulls while loading, or jumps.
pub(crate) fn check_force(looked: &Looked) -> Result<Vec<UserLawFinding>, FormulaError> {
    let mut findings = Vec::new();
    touch(looked, &mut findings)?;
    range(looked, &mut findings)?;
    rising(looked, &mut findings);
    jumps(looked)?;
    Ok(findings)
}

impl Looked<'_> {
    fn at(&self, x: f64, v: f64) -> Vec<f64> {
        node_values(self.graph, self.values, x, v)
    }

    pub(crate) fn force(&self, x: f64, v: f64) -> f64 {
        self.at(x, v)[self.force]
    }

    /// "k = 4e5, n = 1.5".
    pub(crate) fn values_text(&self) -> String {
        let named = self.names.iter().zip(self.values);
        let texts: Vec<String> = named
            .map(|(name, value)| format!("{name} = {}", number_text(*value)))
            .collect();
        texts.join(", ")
    }
}

pub(crate) fn displacements() -> impl Iterator<Item = f64> + Clone {
    let (low, high) = DISPLACEMENTS;
    let ratio: f64 = high / low;
    (0..=STEPS).map(move |i| low * ratio.powf(i as f64 / STEPS as f64))
}

/// First touch: the force must not grow without bound as x goes to zero.
fn touch(looked: &Looked, findings: &mut Vec<UserLawFinding>) -> Result<(), FormulaError> {
    for v in [0.5, 0.0] {
        let at = |x: f64| looked.force(x, v).abs();
        let (nearest, near, typical) = (at(SMALLEST_DISPLACEMENT), at(1e-20), at(1e-3));
        if nearest.is_finite() && nearest <= 1.001 * near + 1e-9 * typical.max(1.0) {
            continue;
        }
        let (term, reason) = culprit(looked.term, looked.values, 0.0, v)
            .unwrap_or((looked.term, "grows without bound as x goes to 0"));
        return Err(FormulaError::UndefinedAtTouch {
            term: looked.formula[term.span.clone()].into(),
            reason,
            place: Box::new(FormulaPlace::new(looked.formula, term.span.start)),
        });
    }
    let force = looked.force(SMALLEST_DISPLACEMENT, 0.0);
    if force.abs() > 1e-6 * looked.force(MUST, 0.0).abs() {
        findings.push(UserLawFinding::ForceAtTouch { force });
    }
    Ok(())
}

/// Finite and pushing.
fn range(looked: &Looked, findings: &mut Vec<UserLawFinding>) -> Result<(), FormulaError> {
    let (mut undefined, mut pulls) = (None, None);
    for x in displacements() {
        for v in RATES {
            let values = looked.at(x, v);
            let force = values[looked.force];
            // Slopes at rest may be infinite: the motion only passes there.
            let slopes = looked.slopes.iter().map(|id| values[*id]);
            let finite = force.is_finite() && (v == 0.0 || slopes.into_iter().all(f64::is_finite));
            if !finite && x <= MUST {
                return Err(undefined_at(looked, x, v));
            }
            if !finite {
                undefined.get_or_insert(x);
            }
            if force < 0.0 && v >= 0.0 && x <= MUST {
                return Err(FormulaError::PullsWhileLoading {
                    force,
                    displacement: x,
                    rate: v,
                    values: looked.values_text(),
                });
            }
            if force < 0.0 && v >= 0.0 {
                pulls.get_or_insert(x);
            }
        }
    }
    let values = || looked.values_text();
    findings.extend(
        undefined.map(|displacement| UserLawFinding::UndefinedBeyond {
            displacement,
            values: values(),
        }),
    );
    findings.extend(pulls.map(|displacement| UserLawFinding::PullsBeyond {
        displacement,
        values: values(),
    }));
    Ok(())
}

fn undefined_at(looked: &Looked, displacement: f64, rate: f64) -> FormulaError {
    let found = culprit(looked.term, looked.values, displacement, rate);
    let (term, reason) = found.unwrap_or((looked.term, "has a slope that is not finite"));
    FormulaError::Undefined {
        term: looked.formula[term.span.clone()].into(),
        reason,
        displacement,
        rate,
        values: looked.values_text(),
        place: Box::new(FormulaPlace::new(looked.formula, term.span.start)),
    }
}

fn rising(looked: &Looked, findings: &mut Vec<UserLawFinding>) {
    let mut before = looked.force(SMALLEST_DISPLACEMENT, 0.0);
    for x in displacements() {
        let force = looked.force(x, 0.0);
        // A piece that is still zero does not rise yet.
        if force < before || (force <= before && x >= MUST) {
            findings.push(UserLawFinding::DoesNotRise {
                displacement: x,
                values: looked.values_text(),
            });
            return;
        }
        before = force;
    }
}

/// Looks along lines of x and of v for places where a piece ends.
fn jumps(looked: &Looked) -> Result<(), FormulaError> {
    let conditions: Vec<Id> = looked
        .graph
        .nodes
        .iter()
        .filter_map(|node| match node {
            Node::Choice(condition, _, _) => Some(*condition),
            _ => None,
        })
        .collect();
    let places: Vec<f64> = displacements().filter(|x| *x >= 1e-6).collect();
    for &condition in &conditions {
        for v in RATES {
            for pair in places.windows(2) {
                crossing(looked, condition, (pair[0], v), (pair[1], v))?;
            }
        }
        for &x in &places {
            for pair in RATES.windows(2) {
                crossing(looked, condition, (x, pair[0]), (x, pair[1]))?;
            }
        }
    }
    Ok(())
}

/// Whether the force jumps where a condition changes between two states.
fn crossing(
    looked: &Looked,
    condition: Id,
    mut one: (f64, f64),
    mut other: (f64, f64),
) -> Result<(), FormulaError> {
    let holds = |state: (f64, f64)| looked.at(state.0, state.1)[condition] > 0.0;
    let first = holds(one);
    if first == holds(other) {
        return Ok(());
    }
    for _ in 0..60 {
        let middle = (0.5 * (one.0 + other.0), 0.5 * (one.1 + other.1));
        match holds(middle) == first {
            true => one = middle,
            false => other = middle,
        }
    }
    let (below, above) = (looked.force(one.0, one.1), looked.force(other.0, other.1));
    let change = (above - below).abs();
    match change > JUMP.0 * below.abs().max(above.abs()) + JUMP.1 {
        false => Ok(()),
        true => Err(FormulaError::Jump {
            below,
            above,
            displacement: one.0,
            rate: one.1,
            values: looked.values_text(),
        }),
    }
}
