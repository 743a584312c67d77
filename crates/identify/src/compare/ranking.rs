//! Which law fits best, and how certain the ranking is.
//!
//! Each law is fitted to each impact by itself, all with the same noise, so that
//! their likelihoods can be compared; then each law predicts the impacts of a
//! held-out velocity.

use crate::compare::prediction::{Example, prediction_error};
use crate::error::Error;
use crate::fit::problem::{FitOptions, LawProblem};
use crate::fit::result::{Fit, fit_laws};
use crate::rig::kind::Rig;
use windfall_contact::laws::kind::LawKind;
use windfall_distribution::tail::t_upper_quantile;
use windfall_signal::impact::Impact;
use windfall_signal::noise::gaussian::{noise_source, uniform};

/// Resampled campaigns behind the share of first places.
const RESAMPLED: usize = 2000;
/// Share of resampled campaigns that makes a first place sure; 1.
const SURE: f64 = 0.95;

/// An impact with the velocity level that it belongs to.
#[derive(Clone, Debug)]
pub struct LeveledImpact {
    /// The impact.
    pub impact: Impact,
    /// Number of its velocity level.
    pub level: usize,
}

/// Evidence for one law.
#[derive(Clone, Debug, PartialEq)]
pub struct LawEvidence {
    /// The law.
    pub kind: LawKind,
    /// Impacts that it was fitted to, of those that all laws were.
    pub impacts: usize,
    /// Impacts that it could not be fitted to.
    pub failed: usize,
    /// Free parameters, over all impacts.
    pub parameters: usize,
    /// −2 ln of the likelihood, up to what all laws have in common.
    pub cost: f64,
    /// Akaike's criterion with its correction for small samples, relative to the
    /// best law.
    pub aicc: f64,
    /// Lower end of the 95 % interval of `aicc`, from its spread over the impacts by
    /// Student's t; `None` for the best law, and with fewer than three impacts.
    pub aicc_low: Option<f64>,
    /// Its upper end.
    pub aicc_high: Option<f64>,
    /// Akaike's criterion on each impact, relative to the best law on that impact, in
    /// the order of [`LawRanking::compared`].
    pub aicc_of_impacts: Vec<f64>,
    /// Schwarz's criterion, relative to the best law.
    pub bic: f64,
    /// Share of campaigns of resampled impacts in which it has the least AICc; 1.
    pub first_share: f64,
    /// Root mean square of predicted less measured force (or displacement) at a
    /// held-out velocity level, over the peak; 1. `None` with a single level.
    pub prediction: Option<f64>,
    /// Its standard error over the impacts; 1.
    pub prediction_error: Option<f64>,
    /// Largest root mean square residual of a channel over its noise; 1.
    pub residual_ratio: f64,
    /// Least runs-test score of a channel, mean over the impacts: far below 0
    /// where residuals have structure along the loop.
    pub runs_z: f64,
}

/// All laws, the best first.
#[derive(Clone, Debug, PartialEq)]
pub struct LawRanking {
    /// Evidence, by AICc.
    pub laws: Vec<LawEvidence>,
    /// Impacts on which all laws are compared.
    pub impacts: usize,
    /// Their places among those given.
    pub compared: Vec<usize>,
    /// Velocity levels among them.
    pub levels: usize,
    /// What it means.
    pub verdict: Verdict,
}

/// What a ranking means.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// One law describes the impacts better than all others.
    Sure {
        /// The law.
        law: LawKind,
        /// Whether it describes them to their noise.
        to_noise: bool,
    },
    /// The data cannot separate these.
    Undecided {
        /// The first.
        first: LawKind,
        /// The next.
        second: LawKind,
    },
    /// The likelihood and the prediction of other velocities prefer different
    /// laws.
    Divided {
        /// By the likelihood of each impact.
        likelihood: LawKind,
        /// By the prediction of other velocities.
        prediction: LawKind,
    },
}

/// Residuals no larger than this times the noise are the noise's own.
const NOISE_RATIO: f64 = 1.1;

/// Ranks `problems` over `impacts`.
///
/// # Errors
/// [`Error::NothingToCompare`] when no impact can be fitted by two laws.
///
/// # Numerics
/// The noise of an impact is that of its best law, for all laws. AICc and BIC
/// add up over the impacts, each of which has parameters of its own, so that
/// parameters that vary from spot to spot do not count against a law. The share of
/// first places is that among campaigns of resampled impacts.
///
/// # Source
/// Hurvich and Tsai (1989), Biometrika 76:297 (AICc); Schwarz (1978), Ann.
/// Statist. 6:461 (BIC); Shimodaira (1998), Ann. Inst. Statist. Math. 50:1, for
/// resampling the first place.
pub fn rank_laws(
    impacts: &[LeveledImpact],
    fits: &[Vec<Option<Fit>>],
    rig: &Rig,
    problems: &[LawProblem],
    options: &FitOptions,
) -> Result<LawRanking, Error> {
    let failed: Vec<usize> = (0..problems.len())
        .map(|law| fits.iter().filter(|of| of[law].is_none()).count())
        .collect();
    // A law that fails on half of the impacts is no candidate; the others are
    // compared where all of them could be fitted.
    let candidates: Vec<usize> = (0..problems.len())
        .filter(|&law| 2 * failed[law] <= impacts.len())
        .collect();
    let common: Vec<usize> = (0..impacts.len())
        .filter(|&i| candidates.iter().all(|&law| fits[i][law].is_some()))
        .collect();
    if candidates.len() < 2 || common.is_empty() {
        return Err(Error::NothingToCompare {
            laws: problems.len(),
            impacts: impacts.len(),
        });
    }
    let levels: Vec<usize> = common.iter().map(|&i| impacts[i].level).collect();
    let mut distinct = levels.clone();
    distinct.sort_unstable();
    distinct.dedup();
    // AICc of each law on each impact.
    let criteria: Vec<Vec<f64>> = candidates
        .iter()
        .map(|&law| {
            let of = common.iter().filter_map(|&i| fits[i][law].as_ref());
            of.map(corrected_akaike).collect()
        })
        .collect();
    let shares = first_shares(&criteria);
    let mut laws = Vec::new();
    for (place, &law) in candidates.iter().enumerate() {
        let own: Vec<(&LeveledImpact, &Fit)> = common
            .iter()
            .filter_map(|&i| Some((&impacts[i], fits[i][law].as_ref()?)))
            .collect();
        let predicted = (distinct.len() > 1)
            .then(|| predicted(&own, &problems[law], rig, options))
            .flatten();
        laws.push(LawEvidence {
            failed: failed[law],
            aicc: criteria[place].iter().sum(),
            aicc_of_impacts: criteria[place].clone(),
            first_share: shares[place],
            prediction: predicted.map(|f| f.0),
            prediction_error: predicted.map(|f| f.1),
            ..evidence(problems[law].kind, &own)
        });
    }
    laws.sort_by(|a, b| a.aicc.total_cmp(&b.aicc));
    let (aicc, bic) = (
        laws[0].aicc,
        laws.iter().map(|l| l.bic).fold(f64::INFINITY, f64::min),
    );
    let best = laws[0].aicc_of_impacts.clone();
    for (place, law) in laws.iter_mut().enumerate() {
        law.aicc -= aicc;
        law.bic -= bic;
        if let (Some((low, high)), true) = (interval(&law.aicc_of_impacts, &best), place > 0) {
            (law.aicc_low, law.aicc_high) = (Some(low), Some(high));
        }
    }
    for impact in 0..common.len() {
        let own = laws.iter().map(|law| law.aicc_of_impacts[impact]);
        let least = own.fold(f64::INFINITY, f64::min);
        laws.iter_mut()
            .for_each(|law| law.aicc_of_impacts[impact] -= least);
    }
    let verdict = verdict(&laws);
    Ok(LawRanking {
        laws,
        impacts: common.len(),
        compared: common,
        levels: distinct.len(),
        verdict,
    })
}

/// What the fits of one law add up to, without what takes the other laws.
fn evidence(kind: LawKind, own: &[(&LeveledImpact, &Fit)]) -> LawEvidence {
    let sum = |of: &dyn Fn(&Fit) -> f64| own.iter().map(|(_, fit)| of(fit)).sum::<f64>();
    let count = own.len() as f64;
    LawEvidence {
        kind,
        impacts: own.len(),
        failed: 0,
        parameters: own.iter().map(|(_, fit)| free_count(fit)).sum(),
        cost: sum(&|fit| fit.cost),
        aicc: 0.0,
        aicc_low: None,
        aicc_high: None,
        aicc_of_impacts: Vec::new(),
        bic: sum(&schwarz),
        first_share: 0.0,
        prediction: None,
        prediction_error: None,
        residual_ratio: sum(&residual_ratio) / count,
        runs_z: sum(&least_runs) / count,
    }
}

/// Prediction error at held-out velocities.
fn predicted(
    own: &[(&LeveledImpact, &Fit)],
    problem: &LawProblem,
    rig: &Rig,
    options: &FitOptions,
) -> Option<(f64, f64)> {
    let examples: Vec<Example> = own
        .iter()
        .map(|&(leveled, fit)| Example {
            impact: &leveled.impact,
            fit,
            level: leveled.level,
        })
        .collect();
    prediction_error(&examples, problem, rig, options)
}

/// All laws on one impact, with one noise.
pub fn fits_of_impact(
    impact: &Impact,
    rig: &Rig,
    problems: &[LawProblem],
    options: &FitOptions,
) -> Vec<Option<Fit>> {
    let fits = fit_laws(impact, rig, problems, options);
    let usable = |fit: Result<Fit, Error>| fit.ok().filter(|fit| fit.cost.is_finite());
    fits.into_iter().map(usable).collect()
}

/// Akaike's criterion, with its correction for small samples, of each law on one impact under one
/// noise, less that of the best law; `None` for a law that cannot be fitted.
pub fn aicc_of_laws(
    impact: &Impact,
    rig: &Rig,
    problems: &[LawProblem],
    options: &FitOptions,
) -> Vec<Option<f64>> {
    let fits = fits_of_impact(impact, rig, problems, options);
    let all: Vec<Option<f64>> = fits
        .iter()
        .map(|fit| fit.as_ref().map(corrected_akaike))
        .collect();
    let least = all.iter().flatten().copied().fold(f64::INFINITY, f64::min);
    all.into_iter().map(|own| Some(own? - least)).collect()
}

/// 95 % interval of the sum of differences over impacts like these, taken as
/// independent: n (mean ± t s/√n).
fn interval(own: &[f64], best: &[f64]) -> Option<(f64, f64)> {
    let n = own.len() as f64;
    if own.len() < 3 {
        return None;
    }
    let differences: Vec<f64> = own.iter().zip(best).map(|(a, b)| a - b).collect();
    let mean = differences.iter().sum::<f64>() / n;
    let squares = differences.iter().map(|d| (d - mean) * (d - mean));
    let sd = (squares.sum::<f64>() / (n - 1.0)).sqrt();
    let reach = t_upper_quantile(0.025, n - 1.0) * sd * n.sqrt();
    Some((n * mean - reach, n * mean + reach))
}

fn free_count(fit: &Fit) -> usize {
    fit.parameters.len() + fit.nuisances.len()
}

fn corrected_akaike(fit: &Fit) -> f64 {
    let (p, n) = (free_count(fit) as f64, fit.samples as f64);
    fit.cost + 2.0 * p + 2.0 * p * (p + 1.0) / (n - p - 1.0).max(1.0)
}

fn schwarz(fit: &Fit) -> f64 {
    fit.cost + free_count(fit) as f64 * (fit.samples as f64).ln()
}

fn residual_ratio(fit: &Fit) -> f64 {
    let ratios = fit.quantities.iter().map(|q| q.standardised);
    ratios.fold(0.0, f64::max)
}

fn least_runs(fit: &Fit) -> f64 {
    let scores = fit.quantities.iter().filter_map(|q| q.runs.map(|r| r.z));
    scores.fold(0.0, f64::min)
}

/// How often each law has the least sum over impacts drawn with replacement.
fn first_shares(criteria: &[Vec<f64>]) -> Vec<f64> {
    let n = criteria[0].len();
    let mut counts = vec![0usize; criteria.len()];
    let mut source = noise_source(1, 0);
    for _ in 0..RESAMPLED {
        let mut sums = vec![0.0; criteria.len()];
        for _ in 0..n {
            let i = ((uniform(&mut source) * n as f64) as usize).min(n - 1);
            for (sum, of) in sums.iter_mut().zip(criteria) {
                *sum += of[i];
            }
        }
        let best = (0..sums.len()).min_by(|a, b| sums[*a].total_cmp(&sums[*b]));
        if let Some(best) = best {
            counts[best] += 1;
        }
    }
    let share = |count: usize| count as f64 / RESAMPLED as f64;
    counts.into_iter().map(share).collect()
}

fn verdict(laws: &[LawEvidence]) -> Verdict {
    let (first, second) = (&laws[0], &laws[1]);
    if first.first_share < SURE {
        return Verdict::Undecided {
            first: first.kind,
            second: second.kind,
        };
    }
    // Another law that predicts clearly better speaks against the first.
    let better = laws[1..].iter().find(|law| {
        match (law.prediction, law.prediction_error, first.prediction) {
            (Some(own), Some(error), Some(of_first)) => own + 2.0 * error < of_first,
            _ => false,
        }
    });
    match better {
        Some(law) => Verdict::Divided {
            likelihood: first.kind,
            prediction: law.kind,
        },
        None => Verdict::Sure {
            law: first.kind,
            to_noise: first.residual_ratio <= NOISE_RATIO,
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Differences 1, 2, 3: sum 6, s = 1, t(0.975; 2) = 4.302653 (table), so that the
    /// interval is 6 ± 4.302653 √3.
    #[test]
    fn reference_interval_of_a_sum_of_differences() {
        let (low, high) = interval(&[11.0, 22.0, 33.0], &[10.0, 20.0, 30.0]).unwrap();
        let reach = 4.302_653 * 3.0_f64.sqrt();
        assert!((low - (6.0 - reach)).abs() < 1e-5 && (high - (6.0 + reach)).abs() < 1e-5);
        assert!(interval(&[1.0, 2.0], &[0.0, 0.0]).is_none());
    }
}
