//! Findings and failures as text: each kind once, with how many share it.

use crate::result::outcome::CampaignOutcome;
use itertools::Itertools;
use windfall_files::found::FindingOutcome;
use windfall_files::named::grouped;
use windfall_files::text::table::{failures_list, findings_list, of_impacts};

/// What a reader of the results must know, and what was left out.
pub fn findings_text(outcome: &CampaignOutcome) -> String {
    let findings = findings_list(&findings_once(outcome));
    findings + &failures_list("not fitted", &outcome.failed, 4)
}

/// Findings of the whole, then one of each kind on impacts, with how many share it.
pub fn findings_once(outcome: &CampaignOutcome) -> Vec<FindingOutcome> {
    let mut findings = outcome.findings.clone();
    findings.extend(kinds(outcome).into_iter().map(|(finding, impacts)| {
        FindingOutcome::new(
            &finding.code,
            of_impacts(&finding.message, &impacts, outcome.impacts.len()),
        )
    }));
    findings
}

/// The first finding of each kind, and the impacts that have one.
fn kinds(outcome: &CampaignOutcome) -> Vec<(&FindingOutcome, Vec<&str>)> {
    let found = outcome.impacts.iter().flat_map(|impact| {
        let all = impact.findings.iter().chain(&impact.left_out);
        let own = all.unique_by(|finding| &finding.code);
        own.map(|finding| (&finding.code, (finding, impact.id.as_str())))
    });
    let kinds = grouped(found).into_iter();
    kinds
        .map(|(_, all)| (all[0].0, all.iter().map(|(_, id)| *id).collect()))
        .collect()
}
