//! The next experiment: which further drop is most informative about a law.

use crate::coordinates::LawCoordinates;
use crate::feature_problem::{FeatureProblem, MeasuredDrop, MeasuredFeature, linearise, nuisances};
use crate::information::{Information, information};
use crate::measured::DropFeature;
use windfall_identify::error::Error;
use windfall_signal::uncertain::Uncertain;

/// Drops that could be made.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// Mass of the fruit; kg.
    pub mass: Choice,
    /// Drop height; m.
    pub height: Choice,
    /// What would be read off each, with its standard uncertainty; SI.
    pub features: Vec<(DropFeature, f64)>,
    /// How many drops of one fruit from one height setting.
    pub drops: usize,
}

/// A mass or height of a candidate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Choice {
    /// One that is there already, with its error.
    Same(usize),
    /// A new one.
    New(Uncertain),
}

/// What a candidate would bring.
#[derive(Clone, Debug, PartialEq)]
pub struct Expected {
    /// Information of all drops together.
    pub information: Information,
    /// Standard uncertainties of the free parameters, in their coordinates;
    /// infinite where still not determined.
    pub sds: Vec<f64>,
    /// Gain in the logarithm of the determinant of the information; infinite where
    /// it closes what was open, `None` where it stays open.
    pub gain: Option<f64>,
    /// Gain for each parameter alone (Ds): logarithm of the ratio of its variances.
    pub gains: Vec<Option<f64>>,
}

/// What is expected of candidates at a law, without making them.
///
/// * `at`: coordinates of the law, the best that is known
///
/// `None` for a candidate that does not show its features.
///
/// # Errors
/// The drops already made cannot be simulated.
///
/// # Source
/// D- and Ds-optimality: Atkinson, Donev and Tobias (2007), Optimum Experimental
/// Designs, with SAS, chapters 10 and 17 (local designs of nonlinear models).
pub fn expected(
    problem: &FeatureProblem,
    coordinates: &LawCoordinates,
    at: &[f64],
    candidates: &[Candidate],
) -> Result<(Information, Vec<Option<Expected>>), Error> {
    let now = informed(problem, coordinates, at)?;
    let outcomes = candidates.iter().map(|candidate| {
        let further = with_candidate(problem, candidate);
        let told = informed(&further, coordinates, at).ok()?;
        Some(compare(&now, told))
    });
    let outcomes = outcomes.collect();
    Ok((now, outcomes))
}

fn informed(
    problem: &FeatureProblem,
    coordinates: &LawCoordinates,
    at: &[f64],
) -> Result<Information, Error> {
    let known = nuisances(problem);
    let shifts = vec![0.0; known.len()];
    let found = linearise(problem, coordinates, &known, (at, &shifts))?;
    Ok(information(&found))
}

/// A problem with the drops of a candidate, measured at no value in particular.
pub fn with_candidate(problem: &FeatureProblem, candidate: &Candidate) -> FeatureProblem {
    let mut further = problem.clone();
    let place = |list: &mut Vec<Uncertain>, choice: Choice| match choice {
        Choice::Same(index) => index,
        Choice::New(known) => {
            list.push(known);
            list.len() - 1
        }
    };
    let fruit = place(&mut further.fruits, candidate.mass);
    let height = place(&mut further.heights, candidate.height);
    let features = candidate
        .features
        .iter()
        .map(|(feature, sd)| MeasuredFeature {
            feature: *feature,
            value: 0.0,
            // Equal drops average.
            sd: sd / (candidate.drops.max(1) as f64).sqrt(),
        });
    further.drops.push(MeasuredDrop {
        fruit,
        height,
        features: features.collect(),
    });
    further
}

fn compare(now: &Information, told: Information) -> Expected {
    let variance = |information: &Information, place: usize| {
        information.covariance.as_ref().map(|c| c[(place, place)])
    };
    let places = 0..told.root.ncols();
    let gains = places.clone().map(|place| {
        let after = variance(&told, place)?;
        Some(variance(now, place).map_or(f64::INFINITY, |before| (before / after).ln()))
    });
    let sds = places.map(|place| variance(&told, place).map_or(f64::INFINITY, f64::sqrt));
    let gained = told.log_determinant - now.log_determinant;
    let gain = told.covariance.is_some().then_some(gained);
    Expected {
        sds: sds.collect(),
        gains: gains.collect(),
        gain,
        information: told,
    }
}

/// Places of the candidates from the best to the worst: first those that leave
/// nothing open, by determinant.
pub fn ranked(outcomes: &[Option<Expected>]) -> Vec<usize> {
    let key = |place: usize| match &outcomes[place] {
        Some(expected) => (
            expected.information.rank,
            expected.information.log_determinant,
        ),
        None => (0, f64::NEG_INFINITY),
    };
    let mut order: Vec<usize> = (0..outcomes.len()).collect();
    order.sort_by(|a, b| {
        let (one, other) = (key(*a), key(*b));
        other.0.cmp(&one.0).then(other.1.total_cmp(&one.1))
    });
    order
}
