//! Impacts of a campaign → pairs of successive impacts on one spot.

use crate::repeats::evaluate::{RepeatImpact, series_of};
use windfall_files::found::FailureOutcome;
use windfall_repeat::align::{AlignOptions, AlignedPair, align_pair};
use windfall_repeat::criterion::Difference;

/// Energies this close are one level; 1.
const SAME_ENERGY: f64 = 0.01;

/// One impact and the next on the same spot at the same energy.
#[derive(Clone, Debug, PartialEq)]
pub struct Pair {
    /// The specimen.
    pub specimen: String,
    /// Whether it cannot be damaged.
    pub reference: bool,
    /// Position among the energies of the campaign.
    pub level: usize,
    /// Position of the first of both at this energy, from 0.
    pub order: usize,
    /// The two forces.
    pub aligned: AlignedPair,
}

/// Pairs of a campaign.
#[derive(Clone, Debug, PartialEq)]
pub struct Pairs {
    /// Energies, rising; J.
    pub energies: Vec<f64>,
    /// The pairs, in the order of the impacts.
    pub pairs: Vec<Pair>,
    /// Pairs that could not be aligned.
    pub failed: Vec<FailureOutcome>,
    /// Ids of impacts without a partner.
    pub alone: Vec<String>,
}

/// The pairs of all impacts.
pub fn pairs_of(impacts: &[RepeatImpact], options: &AlignOptions) -> Pairs {
    let energies = levels(impacts);
    let mut found = Pairs {
        energies,
        pairs: Vec::new(),
        failed: Vec::new(),
        alone: Vec::new(),
    };
    let mut taken = vec![false; impacts.len()];
    for start in 0..impacts.len() {
        if taken[start] {
            continue;
        }
        let level = level_of(&found.energies, impacts[start].energy);
        let same = |other: &RepeatImpact| {
            other.item.specimen == impacts[start].item.specimen
                && other.spot == impacts[start].spot
                && level_of(&found.energies, other.energy) == level
        };
        let mut members: Vec<usize> = (start..impacts.len())
            .filter(|&i| same(&impacts[i]))
            .collect();
        for &member in &members {
            taken[member] = true;
        }
        // By the column; rows without a number keep their order.
        let number = |i: usize| impacts[i].repeat.unwrap_or(i as f64);
        members.sort_by(|a, b| number(*a).total_cmp(&number(*b)));
        if let [only] = members[..] {
            found.alone.push(impacts[only].item.id.clone());
        }
        for (order, two) in members.windows(2).enumerate() {
            add_pair(
                &mut found,
                [&impacts[two[0]], &impacts[two[1]]],
                (level, order),
                options,
            );
        }
    }
    found
}

fn add_pair(
    found: &mut Pairs,
    [first, second]: [&RepeatImpact; 2],
    (level, order): (usize, usize),
    options: &AlignOptions,
) {
    match align_pair(&series_of(first), &series_of(second), options) {
        Ok(aligned) => found.pairs.push(Pair {
            specimen: first.item.specimen.clone(),
            reference: first.reference,
            level,
            order,
            aligned,
        }),
        Err(error) => found.failed.push(FailureOutcome {
            id: second.item.id.clone(),
            specimen: second.item.specimen.clone(),
            file: second.item.file.clone(),
            law: None,
            message: format!("not compared with {}: {error}", first.item.id),
            findings: Vec::new(),
        }),
    }
}

/// Energies that are not the same, rising.
fn levels(impacts: &[RepeatImpact]) -> Vec<f64> {
    let mut energies: Vec<f64> = impacts.iter().map(|impact| impact.energy).collect();
    energies.sort_by(f64::total_cmp);
    let mut levels: Vec<f64> = Vec::new();
    for energy in energies {
        if levels
            .last()
            .is_none_or(|last| energy > last * (1.0 + SAME_ENERGY))
        {
            levels.push(energy);
        }
    }
    levels
}

fn level_of(levels: &[f64], energy: f64) -> usize {
    levels
        .partition_point(|level| *level <= energy)
        .saturating_sub(1)
}

/// The difference of a fruit at one energy and position: mean over its spots.
pub fn difference_of(pairs: &[&Pair]) -> Option<Difference> {
    let first = pairs.first()?;
    let n = pairs.len() as f64;
    let mut curve = vec![0.0; first.aligned.instants.len()];
    let mut changes = [0.0; 3];
    for pair in pairs {
        for (sum, d) in curve.iter_mut().zip(pair.aligned.difference()) {
            *sum += d / n;
        }
        for (sum, d) in changes.iter_mut().zip(pair.aligned.changes()) {
            *sum += d / n;
        }
    }
    Some(Difference { curve, changes })
}
