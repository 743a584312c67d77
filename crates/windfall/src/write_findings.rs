//! Findings and failures as text: each kind once, with how many share it.

use crate::outcome::CampaignOutcome;
use crate::write_table::paragraph;

/// Indentation of the second line of a finding; characters.
const INDENT: usize = 4;

/// One kind of finding over the impacts.
struct Kind<'a> {
    code: &'a str,
    first: &'a str,
    message: &'a str,
    impacts: usize,
}

/// What a reader of the results must know, and what was left out.
#[must_use]
pub fn findings_text(outcome: &CampaignOutcome) -> String {
    let mut lines: Vec<String> = Vec::new();
    for finding in &outcome.findings {
        lines.push(format!("  {}: {}", finding.code, finding.message));
    }
    for kind in kinds(outcome) {
        let more = match kind.impacts {
            1 => String::new(),
            n if n == outcome.impacts.len() => " (all have one of this kind)".to_owned(),
            n => format!(" (and {} more of this kind)", n - 1),
        };
        lines.push(format!(
            "  {}: {}: {}{more}",
            kind.code, kind.first, kind.message
        ));
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

/// Codes in order of first appearance.
fn kinds(outcome: &CampaignOutcome) -> Vec<Kind<'_>> {
    let mut seen: Vec<Kind> = Vec::new();
    for impact in &outcome.impacts {
        let mut codes: Vec<&str> = Vec::new();
        for finding in &impact.findings {
            if codes.contains(&finding.code.as_str()) {
                continue;
            }
            codes.push(&finding.code);
            match seen.iter_mut().find(|kind| kind.code == finding.code) {
                Some(kind) => kind.impacts += 1,
                None => seen.push(Kind {
                    code: &finding.code,
                    first: &impact.id,
                    message: &finding.message,
                    impacts: 1,
                }),
            }
        }
    }
    seen
}
