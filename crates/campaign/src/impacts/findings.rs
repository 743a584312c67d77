//! Findings and failures as text: each kind once, with how many share it.

use crate::result::outcome::CampaignOutcome;
use itertools::Itertools;
use windfall_files::finding_kind::{FindingKind, FoundOn, finding_kinds};
use windfall_files::found::FindingOutcome;
use windfall_files::text::table::{failures_list, findings_list};

/// What a reader of the results must know, and what was left out.
pub fn findings_text(outcome: &CampaignOutcome) -> String {
    let findings = findings_list(&findings_once(outcome));
    findings + &failures_list("not fitted", &outcome.failed, 4)
}

/// [`finding_kinds_of`] in words.
pub fn findings_once(outcome: &CampaignOutcome) -> Vec<FindingOutcome> {
    let kinds = finding_kinds_of(outcome);
    kinds.iter().map(FindingKind::told).collect()
}

/// Findings of the whole, then one of each kind on impacts, the gravest first.
pub fn finding_kinds_of(outcome: &CampaignOutcome) -> Vec<FindingKind> {
    let fits = outcome.impacts.iter();
    let found = fits.clone().flat_map(|impact| {
        let all = impact.findings.iter().chain(&impact.left_out);
        let own = all.unique_by(|finding| &finding.code);
        own.map(|finding| FoundOn {
            finding,
            id: &impact.id,
            law: &impact.law,
        })
    });
    let laws: Vec<&str> = fits.clone().map(|own| own.law.as_str()).unique().collect();
    let impacts = fits.map(|impact| impact.id.as_str()).unique().count();
    finding_kinds(&outcome.findings, found, &laws, Some(impacts))
}
