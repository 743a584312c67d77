//! What closes a family, in numbers, and the next experiment.

use crate::calibrate::features::telling_heights;
use crate::calibrate::law::{FreeLaw, Setting, hertz_of, law_error};
use crate::calibrate::outcome::{CandidateOutcome, ClosingOutcome, NextOutcome};
use crate::calibrate::target::{DropData, PEAK, heights_of, same_height, target_problem};
use windfall_drop_rig::experiment::{Candidate, Choice, expected, ranked};
use windfall_drop_rig::feature_problem::{
    CoordinatePrior, FeatureProblem, MeasuredFeature, linearise, nuisances,
};
use windfall_drop_rig::information::{Information, information};
use windfall_drop_rig::measured::{DropFeature, FeatureKind};
use windfall_files::error::Error;
use windfall_files::text::number::plain;
use windfall_signal::uncertain::Uncertain;

/// Relative uncertainty of a stiffness by Hertz's contact: moduli of fruit vary by a third.
const HERTZ_SD: f64 = 0.3;

/// Candidates that are shown.
const SHOWN: usize = 10;

/// Drops of a candidate.
const DROPS: usize = 5;

fn told(law: &FreeLaw, problem: &FeatureProblem, at: &[f64]) -> Result<Information, Error> {
    let known = nuisances(problem);
    let shifts = vec![0.0; known.len()];
    let found = linearise(problem, &law.coordinates, &known, (at, &shifts));
    Ok(information(&found.map_err(law_error)?))
}

fn sds(information: &Information) -> Vec<Option<f64>> {
    let covariance = information.covariance.as_ref();
    let places = 0..information.root.ncols();
    places
        .map(|place| Some(covariance?[(place, place)].sqrt()))
        .collect()
}

fn row(with: String, information: &Information) -> ClosingOutcome {
    ClosingOutcome {
        with,
        rank: information.rank,
        sds: sds(information),
    }
}

/// What the target alone leaves, and what further knowledge makes of it, at a law.
///
/// # Errors
/// The law cannot be simulated.
pub fn closing(setting: &Setting, at: &[f64]) -> Result<Vec<ClosingOutcome>, Error> {
    let law = setting.law;
    let one = target_problem(setting.rig, setting.target, setting.end);
    let height = setting.target.height;
    let text = format!("first peak and interval from {} m", plain(height.value));
    let mut rows = vec![row(text, &told(law, &one, at)?)];
    let mut add = |with: String, problem: &FeatureProblem| {
        // A feature that the drop does not show closes nothing.
        if let Ok(information) = told(law, problem, at) {
            rows.push(row(with, &information));
        }
    };
    let further = |kind: FeatureKind, impact: usize, sd: f64| {
        let mut problem = one.clone();
        let feature = DropFeature { kind, impact };
        let value = 0.0;
        problem.drops[0]
            .features
            .push(MeasuredFeature { feature, value, sd });
        problem
    };
    let features = &setting.target.features;
    let later = further(FeatureKind::PeakSupportForce, 1, features[0].sd);
    add("with the second peak of the same drops".to_owned(), &later);
    for other in telling_heights(&heights_of(setting.drops), height.value) {
        if same_height(other, height.value) {
            continue;
        }
        let mut problem = one.clone();
        problem.heights.push(Uncertain::new(other, height.sd));
        let mut drop = problem.drops[0].clone();
        drop.height = 1;
        problem.drops.push(drop);
        add(format!("with the same from {} m", plain(other)), &problem);
    }
    if let (Some(_), Some(place)) = (hertz_of(setting.settings), stiffness_place(law)) {
        let mut problem = one.clone();
        problem.priors.push(CoordinatePrior {
            place,
            value: at[place],
            sd: HERTZ_SD,
        });
        let percent = 100.0 * HERTZ_SD;
        let with = format!("with k known to {percent} % from Hertz's contact");
        add(with, &problem);
    }
    if setting.drops.len() > setting.target.outcome.drops
        || setting.drops.iter().any(|drop| drop.features.len() > 2)
    {
        add("all features of all drops".to_owned(), setting.problem);
    }
    Ok(rows)
}

fn stiffness_place(law: &FreeLaw) -> Option<usize> {
    law.names().iter().position(|name| name == "k")
}

/// Further drops by what they would tell, at a law.
///
/// # Errors
/// The law cannot be simulated at the drops already made.
pub fn next_experiment(setting: &Setting, at: &[f64]) -> Result<NextOutcome, Error> {
    let law = setting.law;
    let places = candidates(setting);
    let all: Vec<Candidate> = places.iter().map(|(own, ..)| own.clone()).collect();
    let (now, outcomes) =
        expected(setting.problem, &law.coordinates, at, &all).map_err(law_error)?;
    // The stiffness is what a simulation needs most, unless it is held.
    let interest = stiffness_place(law).unwrap_or(0);
    let shown = ranked(&outcomes).into_iter().filter_map(|place| {
        let outcome = outcomes[place].as_ref()?;
        let (candidate, mass, height) = &places[place];
        let finite = |value: f64| value.is_finite().then_some(value);
        Some(CandidateOutcome {
            height: *height,
            mass: *mass,
            fruit: match candidate.mass {
                Choice::Same(_) => "as before".to_owned(),
                Choice::New(_) => "another".to_owned(),
            },
            impacts: peaks(candidate),
            drops: candidate.drops,
            sds: outcome.sds.iter().map(|sd| finite(*sd)).collect(),
            gain: outcome.gain.and_then(finite),
            rank: outcome.information.rank,
            gain_of_interest: outcome.gains[interest].and_then(finite),
        })
    });
    Ok(NextOutcome {
        interest: law.names()[interest].clone(),
        now: sds(&now),
        candidates: shown.take(SHOWN).collect(),
    })
}

fn peaks(candidate: &Candidate) -> usize {
    let features = candidate.features.iter();
    features
        .filter(|(feature, _)| feature.kind == FeatureKind::PeakSupportForce)
        .count()
}

/// Heights around the target's, the same fruit or other masses, two impacts or three.
fn candidates(setting: &Setting) -> Vec<(Candidate, f64, f64)> {
    let target = setting.target;
    let fruit = setting.problem.drops.len().checked_sub(1);
    let at_target = |drop: &DropData| same_height(drop.height.value, target.height.value);
    let place = setting.drops.iter().position(at_target).or(fruit);
    let own = place.map_or(0, |place| setting.problem.drops[place].fruit);
    let known = setting.problem.fruits[own];
    let scaled = |times: f64| Uncertain::new(times * known.value, known.sd);
    let masses = [
        (Choice::Same(own), known.value),
        (Choice::New(scaled(0.6)), 0.6 * known.value),
        (Choice::New(scaled(1.6)), 1.6 * known.value),
    ];
    let mut found = Vec::new();
    for times in [0.1, 0.2, 0.4, 0.7, 1.0, 1.5, 2.0] {
        let height = times * target.height.value;
        for (choice, mass) in masses {
            for impacts in [2, 3] {
                let candidate = Candidate {
                    mass: choice,
                    height: Choice::New(Uncertain::new(height, target.height.sd)),
                    features: features(setting, impacts),
                    drops: DROPS,
                };
                found.push((candidate, mass, height));
            }
        }
    }
    found
}

/// Peaks and intervals of some impacts, as uncertain as those of one drop so far.
fn features(setting: &Setting, impacts: usize) -> Vec<(DropFeature, f64)> {
    let drops = (setting.target.outcome.drops.max(1) as f64).sqrt();
    let [peak, interval] = [0, 1].map(|place| drops * setting.target.features[place].sd);
    let peaks = (0..impacts).map(|impact| (DropFeature { impact, ..PEAK }, peak));
    let intervals = (0..impacts - 1).map(|impact| {
        let kind = FeatureKind::Interval;
        (DropFeature { kind, impact }, interval)
    });
    peaks.chain(intervals).collect()
}
