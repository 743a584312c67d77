//! Findings and failures as text: each kind once, with how many share it.

use crate::result::outcome::CampaignOutcome;
use windfall_files::found::FindingOutcome;
use windfall_files::text::table::paragraph;

/// Indentation of the second line of a finding; characters.
const INDENT: usize = 4;

/// What a reader of the results must know, and what was left out.
#[must_use]
pub fn findings_text(outcome: &CampaignOutcome) -> String {
    let mut lines: Vec<String> = Vec::new();
    for finding in findings_once(outcome) {
        lines.push(format!("  {}: {}", finding.code, finding.message));
    }
    let mut text = String::new();
    if !lines.is_empty() {
        text += "\nFindings:\n";
    }
    for failure in &outcome.failed {
        lines.push(format!("not fitted: {}: {}", failure.id, failure.message));
    }
    for line in lines {
        text += &paragraph(&line, INDENT);
        text.push('\n');
    }
    text
}

/// Findings of the whole, then each kind of those of impacts once, with the first
/// impact that has it and how many share it.
#[must_use]
pub fn findings_once(outcome: &CampaignOutcome) -> Vec<FindingOutcome> {
    let mut findings = outcome.findings.clone();
    findings.extend(kinds(outcome).into_iter().map(|(finding, first, impacts)| {
        let more = match impacts {
            1 => String::new(),
            n if n == outcome.impacts.len() => " (all have one of this kind)".to_owned(),
            n => format!(" (and {} more of this kind)", n - 1),
        };
        FindingOutcome {
            code: finding.code.clone(),
            message: format!("{first}: {}{more}", finding.message),
        }
    }));
    findings
}

/// The first finding of each kind with its impact and the number of impacts that have
/// one, in order of first appearance.
fn kinds(outcome: &CampaignOutcome) -> Vec<(&FindingOutcome, &str, usize)> {
    let mut seen: Vec<(&FindingOutcome, &str, usize)> = Vec::new();
    for impact in &outcome.impacts {
        let mut codes: Vec<&str> = Vec::new();
        for finding in &impact.findings {
            if codes.contains(&finding.code.as_str()) {
                continue;
            }
            codes.push(&finding.code);
            match seen
                .iter_mut()
                .find(|(known, ..)| known.code == finding.code)
            {
                Some((.., impacts)) => *impacts += 1,
                None => seen.push((finding, &impact.id, 1)),
            }
        }
    }
    seen
}
