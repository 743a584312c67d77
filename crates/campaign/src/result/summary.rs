//! Mean, standard deviation and number of impacts, over all and per group.

use crate::result::outcome::{GroupOutcome, ImpactOutcome};
use itertools::Itertools;
use windfall_files::found::spreads;
use windfall_files::named::grouped;

/// Spread of the impacts of each group and law, in order of first appearance.
pub fn summarise_groups(impacts: &[ImpactOutcome]) -> Vec<GroupOutcome> {
    let laws = grouped(impacts.iter().map(|impact| (impact.law.as_str(), impact)));
    let groups = laws.into_iter().flat_map(|(law, impacts)| {
        let groups = grouped(impacts.into_iter().map(|i| (i.group.as_deref(), i)));
        groups
            .into_iter()
            .map(move |(group, members)| summarise(law, group, &members))
    });
    groups.collect()
}

/// What one standard uncertainty of each quantity of the bench moves on average, of parameters
/// or of their logarithms: the same in all impacts. A row for each quantity.
pub fn common_moves(impacts: &[&ImpactOutcome], parameters: &[(&str, bool)]) -> Vec<Vec<f64>> {
    let quantities = impacts.iter().flat_map(|impact| &impact.common.0);
    let quantities = quantities.map(|(name, _)| name.as_str()).unique();
    let mean = |quantity: &str, (name, logarithmic): (&str, bool)| {
        let all = impacts.iter().filter_map(|impact| {
            let shift = *impact.common.get(quantity)?.get(name)?;
            let value = impact.parameters.get(name)?.value;
            Some(if logarithmic { shift / value } else { shift })
        });
        all.sum::<f64>() / impacts.len() as f64
    };
    let row = |quantity: &str| parameters.iter().map(|own| mean(quantity, *own)).collect();
    quantities.map(row).collect()
}

/// What of the bench's uncertainty the mean of a parameter carries: the mean of what each
/// quantity moves, over the quantities in squares.
fn common_sd(impacts: &[&ImpactOutcome], parameter: &str) -> Option<f64> {
    let moves = common_moves(impacts, &[(parameter, false)]);
    let square: f64 = moves.iter().map(|own| own[0] * own[0]).sum();
    (!moves.is_empty()).then(|| square.sqrt())
}

/// Spread of parameters and derived quantities over those of some impacts of one law that
/// count.
pub fn summarise(law: &str, group: Option<&str>, impacts: &[&ImpactOutcome]) -> GroupOutcome {
    let all = impacts.len();
    let counted: Vec<&ImpactOutcome> = impacts.iter().copied().filter(|i| i.counts()).collect();
    let impacts = &counted[..];
    let parameters = impacts.iter().flat_map(|impact| &impact.parameters.0);
    let estimated = parameters.filter(|(_, estimate)| !estimate.held);
    let derived = impacts.iter().flat_map(|impact| &impact.derived.0);
    let mut parameters = spreads(estimated.map(|(name, e)| (name.as_str(), e.value)));
    for (name, spread) in &mut parameters.0 {
        spread.common_sd = common_sd(impacts, name);
    }
    GroupOutcome {
        group: group.map(str::to_owned),
        law: law.to_owned(),
        impacts: impacts.len(),
        left_out: all - impacts.len(),
        specimens: impacts.iter().map(|i| &i.specimen).unique().count(),
        parameters,
        derived: spreads(derived.filter_map(|(name, value)| Some((name.as_str(), (*value)?)))),
    }
}
