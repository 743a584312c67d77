//! Mean, standard deviation and number of impacts, over all and per group.

use crate::named::Named;
use crate::outcome::{GroupOutcome, ImpactOutcome, SpreadOutcome};

/// Spread of some values; `None` when there is none.
///
/// ```text
/// mean = Σx / n,   sd² = Σ(x − mean)² / (n − 1),   cv = sd / |mean|
/// ```
///
/// The sums run in the order of the values.
#[must_use]
pub fn spread(values: &[f64]) -> Option<SpreadOutcome> {
    if values.is_empty() {
        return None;
    }
    let n = values.len();
    let mean = values.iter().sum::<f64>() / n as f64;
    let squares: f64 = values.iter().map(|x| (x - mean) * (x - mean)).sum();
    let sd = (n > 1).then(|| (squares / (n - 1) as f64).sqrt());
    let cv = sd.filter(|_| mean != 0.0).map(|sd| sd / mean.abs());
    Some(SpreadOutcome { mean, sd, n, cv })
}

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
    let mut laws: Vec<&str> = Vec::new();
    for (law, _) in &keys {
        if !laws.contains(law) {
            laws.push(law);
        }
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    /// NIST Statistical Reference Datasets, univariate, `NumAcc1`: certified mean
    /// 10000002, standard deviation 1.
    #[test]
    fn reference_nist_numacc1() {
        let found = spread(&[10000001.0, 10000003.0, 10000002.0]).unwrap();
        assert_eq!((found.mean, found.sd, found.n), (10000002.0, Some(1.0), 3));
    }

    #[test]
    fn closed_form_one_impact_has_no_spread() {
        let found = spread(&[5.0]).unwrap();
        assert_eq!((found.sd, found.cv), (None, None));
        assert!(spread(&[]).is_none());
    }
}
