//! Results of a study.

use crate::bruise::scene::{LimitOutcome, PlaceOutcome};
use crate::run::outcome::SceneOutcome;
use crate::study::interval::{Counts, difference, share};
use crate::study::read::{Factor, StudyPlan, VariantPlan};
use serde::Serialize;
use std::path::PathBuf;
use windfall_files::found::FindingOutcome;

/// Results of a study; SI throughout.
#[derive(Clone, Debug, Serialize, utoipa::ToSchema)]
pub struct StudyOutcome {
    /// As the file has it.
    pub title: String,
    /// Version of windfall, and when it ran, UTC.
    pub made: [String; 2],
    /// SHA-256 of the study and of the scene.
    pub digests: [String; 2],
    /// Runs of each variant.
    pub replicates: usize,
    /// What was varied.
    pub factors: Vec<Factor>,
    /// Every combination of levels.
    pub variants: Vec<VariantOutcome>,
    /// What the levels change, against the first of each factor.
    pub effects: Vec<EffectOutcome>,
    /// What a reader must know.
    pub findings: Vec<FindingOutcome>,
    /// Files written.
    #[schema(value_type = Vec<String>)]
    pub files: Vec<PathBuf>,
}

/// One combination of levels.
#[derive(Clone, Debug, Default, Serialize, utoipa::ToSchema)]
pub struct VariantOutcome {
    /// Names of its levels.
    pub name: String,
    /// Its directory in that of the study.
    #[schema(value_type = String)]
    pub directory: PathBuf,
    /// Why there is no result.
    pub failed: Option<String>,
    /// Fruit of a replicate.
    pub fruit: usize,
    /// Contacts of a replicate, the mean.
    pub contacts: f64,
    /// Fruit that had no room to come in, or left, of all replicates.
    pub waiting: usize,
    /// Fruit that left through a sink, of all replicates.
    pub left: usize,
    /// Share of bruised fruit that another batch would have.
    pub limits: Vec<LimitOutcome>,
    /// Mean volume of the largest bruise of a fruit; m³.
    pub mean_largest: f64,
    /// What bruised, the worst first, of all replicates.
    pub places: Vec<PlaceOutcome>,
}

/// What a level changes.
#[derive(Clone, Debug, Serialize, utoipa::ToSchema)]
pub struct EffectOutcome {
    /// What was varied.
    pub factor: String,
    /// The level.
    pub level: String,
    /// The level that it is compared with.
    pub against: String,
    /// Pairs of variants that differ in it alone.
    pub pairs: usize,
    /// Volume above which a fruit counts as bruised; m³.
    pub limit: f64,
    /// Change of the share of bruised fruit; 1.
    pub difference: f64,
    /// Ends of its 95 % interval.
    pub interval: [f64; 2],
}

/// One run of a variant.
#[derive(Clone, Debug)]
pub struct Replicate {
    /// Fruit above each limit: by models, then limits.
    pub above: Vec<Vec<usize>>,
    /// Limits; m³.
    pub limits: Vec<f64>,
    /// Variance of the share above each over that of independent fruit; 1.
    pub variance_ratios: Vec<f64>,
    /// Its results.
    pub scene: SceneOutcome,
}

/// Fruit above a limit in the replicates of a variant.
fn counts(replicates: &[Replicate], limit: usize) -> Counts {
    let of = |own: &Replicate| own.above.iter().map(|model| model[limit]).collect();
    Counts {
        above: replicates.iter().map(of).collect(),
        fruit: replicates
            .first()
            .and_then(|own| own.scene.bruise.as_ref())
            .map_or(0, |own| own.fruit),
        variance_ratio: replicates
            .first()
            .and_then(|own| own.variance_ratios.get(limit).copied())
            .unwrap_or(1.0),
    }
}

/// A variant from its runs.
pub fn variant(
    name: &str,
    directory: PathBuf,
    runs: &Result<Vec<Replicate>, String>,
) -> VariantOutcome {
    let mut outcome = VariantOutcome {
        name: name.to_owned(),
        directory,
        ..VariantOutcome::default()
    };
    let replicates = match runs {
        Ok(replicates) => replicates,
        Err(problem) => {
            outcome.failed = Some(problem.clone());
            return outcome;
        }
    };
    let count = replicates.len().max(1) as f64;
    let limits = replicates.first().map_or(&[][..], |own| &own.limits);
    let limits = limits.iter().enumerate().map(|(place, &limit)| {
        let found = share(&counts(replicates, place));
        LimitOutcome {
            limit,
            share: found.value,
            interval: [found.low, found.high],
        }
    });
    outcome.limits = limits.collect();
    let sum =
        |of: fn(&SceneOutcome) -> f64| replicates.iter().map(|own| of(&own.scene)).sum::<f64>();
    outcome.fruit = replicates.first().map_or(0, |own| own.scene.fruit);
    outcome.contacts = sum(|own| own.contacts as f64) / count;
    outcome.mean_largest =
        sum(|own| own.bruise.as_ref().map_or(0.0, |own| own.mean_largest)) / count;
    outcome.waiting = replicates.iter().map(|own| own.scene.waiting).sum();
    outcome.left = replicates.iter().map(|own| own.scene.left).sum();
    outcome.places = pooled(replicates);
    outcome
}

fn pooled(replicates: &[Replicate]) -> Vec<PlaceOutcome> {
    let mut all: Vec<PlaceOutcome> = Vec::new();
    let bruises = replicates
        .iter()
        .filter_map(|own| own.scene.bruise.as_ref());
    for place in bruises.flat_map(|own| &own.places) {
        match all.iter_mut().find(|own| own.name == place.name) {
            Some(own) => {
                own.bruises += place.bruises;
                own.fruit += place.fruit;
                own.largest = own.largest.max(place.largest);
            }
            None => all.push(place.clone()),
        }
    }
    all.sort_by(|a, b| b.fruit.cmp(&a.fruit).then(b.largest.total_cmp(&a.largest)));
    all
}

/// What each level changes, over all pairs of variants that differ in it alone.
pub fn effects(plan: &StudyPlan, runs: &[Result<Vec<Replicate>, String>]) -> Vec<EffectOutcome> {
    let mut all = Vec::new();
    let limits = runs.iter().find_map(|own| own.as_ref().ok()?.first());
    let limits = limits.map_or_else(Vec::new, |own| own.limits.clone());
    for (factor, Factor { name, levels }) in plan.factors.iter().enumerate() {
        for level in 1..levels.len() {
            for (place, &limit) in limits.iter().enumerate() {
                let pairs = pairs_of(plan, runs, (factor, level), place);
                let both: Vec<(&Counts, &Counts)> = pairs.iter().map(|(a, b)| (a, b)).collect();
                let Some(found) = difference(&both) else {
                    continue;
                };
                all.push(EffectOutcome {
                    factor: name.clone(),
                    level: levels[level].clone(),
                    against: levels[0].clone(),
                    pairs: both.len(),
                    limit,
                    difference: found.value,
                    interval: [found.low, found.high],
                });
            }
        }
    }
    all
}

fn pairs_of(
    plan: &StudyPlan,
    runs: &[Result<Vec<Replicate>, String>],
    (factor, level): (usize, usize),
    limit: usize,
) -> Vec<(Counts, Counts)> {
    let second = plan.variants.iter().zip(runs);
    let second = second.filter(|(own, _)| own.levels[factor] == level);
    let pair = |(own, run): (&VariantPlan, &Result<Vec<Replicate>, String>)| {
        let mut levels = own.levels.clone();
        levels[factor] = 0;
        let first = plan
            .variants
            .iter()
            .position(|other| other.levels == levels)?;
        let (a, b) = (runs[first].as_ref().ok()?, run.as_ref().ok()?);
        Some((counts(a, limit), counts(b, limit)))
    };
    second.filter_map(pair).collect()
}
