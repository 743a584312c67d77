//! Mean, standard deviation and number of impacts, over all and per group.

use crate::result::outcome::{GroupOutcome, ImpactOutcome};
use itertools::Itertools;
use windfall_files::found::{SpreadOutcome, spread};
use windfall_files::named::Named;

/// Spread of the impacts of each group and law, groups and laws in order of
/// first appearance.
#[must_use]
pub fn summarise_groups(impacts: &[ImpactOutcome]) -> Vec<GroupOutcome> {
    let mut keys: Vec<(&str, Option<&str>)> = Vec::new();
    for impact in impacts {
        let key = (impact.law.as_str(), impact.group.as_deref());
        if !keys.contains(&key) {
            keys.push(key);
        }
    }
    let laws: Vec<&str> = keys.iter().map(|(law, _)| *law).unique().collect();
    keys.sort_by_key(|(law, _)| laws.iter().position(|known| known == law));
    keys.into_iter()
        .map(|(law, group)| {
            let members: Vec<&ImpactOutcome> = impacts
                .iter()
                .filter(|impact| impact.law == law && impact.group.as_deref() == group)
                .collect();
            summarise(law, group, &members)
        })
        .collect()
}

/// Spread of parameters and derived quantities over some impacts of one law.
#[must_use]
pub fn summarise(law: &str, group: Option<&str>, impacts: &[&ImpactOutcome]) -> GroupOutcome {
    let mut specimens: Vec<&str> = impacts.iter().map(|i| i.specimen.as_str()).collect();
    specimens.sort_unstable();
    specimens.dedup();
    let parameters = collect(impacts, |impact| {
        let estimated = impact
            .parameters
            .0
            .iter()
            .filter(|(_, estimate)| !estimate.held);
        estimated
            .map(|(name, estimate)| (name.as_str(), Some(estimate.value)))
            .collect()
    });
    let derived = collect(impacts, |impact| {
        impact
            .derived
            .0
            .iter()
            .map(|(name, value)| (name.as_str(), *value))
            .collect()
    });
    GroupOutcome {
        group: group.map(str::to_owned),
        law: law.to_owned(),
        impacts: impacts.len(),
        specimens: specimens.len(),
        parameters,
        derived,
    }
}

/// Spread per name, names in order of first appearance.
fn collect<'a>(
    impacts: &[&'a ImpactOutcome],
    values: impl Fn(&'a ImpactOutcome) -> Vec<(&'a str, Option<f64>)>,
) -> Named<SpreadOutcome> {
    let mut gathered: Vec<(&str, Vec<f64>)> = Vec::new();
    for impact in impacts {
        for (name, value) in values(impact) {
            let Some(value) = value else { continue };
            match gathered.iter_mut().find(|(known, _)| *known == name) {
                Some((_, list)) => list.push(value),
                None => gathered.push((name, vec![value])),
            }
        }
    }
    let spreads = gathered
        .into_iter()
        .filter_map(|(name, list)| Some((name.to_owned(), spread(&list)?)))
        .collect();
    Named(spreads)
}
