//! Findings and failures as text: each kind once, with how many share it.

use crate::result::outcome::CampaignOutcome;
use itertools::Itertools;
use windfall_distribution::tail::beta_lower;
use windfall_files::finding_kind::{FindingKind, FoundOn, finding_kinds};
use windfall_files::found::FindingOutcome;
use windfall_files::severity::Severity;
use windfall_files::text::table::{failures_list, findings_list};
use windfall_identify::finding::LACK_OF_FIT;

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
    let fits = outcome.impacts.len();
    let mut kinds = finding_kinds(&outcome.findings, found, &laws, Some(impacts));
    let have = outcome.impacts.iter().filter(|own| {
        let mut codes = own.findings.iter().map(|finding| &finding.code);
        codes.any(|code| *code == CHANCE)
    });
    if by_chance(have.count(), fits) {
        for kind in kinds.iter_mut().filter(|kind| &*kind.code == CHANCE) {
            kind.severity = Severity::Note;
            kind.message += "; here there are no more";
        }
        kinds.sort_by_key(|kind| kind.severity);
    }
    kinds
}

/// Finding that some impacts have under a true law, too.
const CHANCE: &str = "lack-of-fit";

/// Whether chance gives as many of some fits, with a probability above that of one finding.
fn by_chance(have: usize, fits: usize) -> bool {
    let (have, fits) = (have as f64, fits as f64);
    // P(X ≥ k) of a binomial is the incomplete beta function of k and n − k + 1.
    have > 0.0 && beta_lower(LACK_OF_FIT, have, fits - have + 1.0) > ROUNDED * LACK_OF_FIT
}

/// What is above a probability by more than rounding, over it; 1.
const ROUNDED: f64 = 1.0 + 1e-9;

#[cfg(test)]
mod tests {
    use super::*;

    /// Of 500, five are expected; P(X ≥ 11) = 0.0132 and P(X ≥ 12) = 0.0052 (sums of the
    /// binomial). Of two, one is no more than chance; a single impact has it once in 100.
    #[test]
    fn closed_form_as_many_as_chance_gives() {
        let cases = [
            (0, 500, false),
            (5, 500, true),
            (11, 500, true),
            (12, 500, false),
            (1, 1, false),
            (1, 2, true),
            (2, 2, false),
        ];
        for (have, fits, expected) in cases {
            assert_eq!(by_chance(have, fits), expected, "{have} of {fits}");
        }
    }
}
