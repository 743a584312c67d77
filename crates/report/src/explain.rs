//! `windfall explain`: what a finding means and what to do, from the guide's page.

use serde::Serialize;
use windfall_files::error::Error;
use windfall_files::option_value::unusable;
use windfall_files::severity::Severity;
use windfall_files::text::table::paragraph;
use windfall_files::text::toml_source::suggestion;

/// The page of the guide. It lies here a second time, so that the crate is whole without the
/// repository.
const PAGE: &str = include_str!("findings.md");

/// A finding as the guide explains it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, utoipa::ToSchema)]
pub struct Explanation {
    /// Its code.
    pub code: String,
    /// Section of the page: where it comes from.
    pub section: String,
    /// How grave it is.
    pub severity: Severity,
    /// What it means.
    pub meaning: String,
    /// What to do.
    pub advice: String,
}

/// Every finding, in the order of the page.
pub fn all_explanations() -> Vec<Explanation> {
    let mut section = "";
    let mut found = Vec::new();
    for line in PAGE.lines() {
        if let Some(heading) = line.strip_prefix("## ") {
            section = heading;
        }
        let Some(row) = line.strip_prefix("| `") else {
            continue;
        };
        let cells: Vec<&str> = row.trim_end_matches('|').split(" | ").collect();
        let [codes, _, meaning, advice] = cells[..] else {
            continue;
        };
        // One row may explain several codes.
        for code in codes.split(", ") {
            let code = code.trim_matches([' ', '`']);
            found.push(Explanation {
                code: code.to_owned(),
                section: section.to_owned(),
                severity: Severity::of(code),
                meaning: meaning.trim().to_owned(),
                advice: advice.trim().to_owned(),
            });
        }
    }
    found
}

/// What the guide says of each of some codes; of all when none is named.
///
/// # Errors
/// There is no finding of that code.
pub fn explain(codes: &[String]) -> Result<Vec<Explanation>, Error> {
    let all = all_explanations();
    if codes.is_empty() {
        return Ok(all);
    }
    let mut found = Vec::new();
    for code in codes {
        let known = all.iter().filter(|known| known.code == *code);
        let before = found.len();
        found.extend(known.cloned());
        if found.len() == before {
            let near = suggestion(code, all.iter().map(|known| known.code.as_str()));
            let problem =
                format!("there is no finding of this code{near}; `windfall explain` lists all");
            return Err(unusable(code.clone(), problem));
        }
    }
    Ok(found)
}

/// Explanations for a terminal.
pub fn text_of_explanations(explanations: &[Explanation]) -> String {
    let mut text = String::new();
    let mut section = "";
    for one in explanations {
        if one.section != section {
            section = &one.section;
            text += &format!("\n{section}\n");
        }
        let word = one.severity.word();
        let words = format!("  [{word}] {}: {} {}", one.code, one.meaning, one.advice);
        text += &(paragraph(&words.replace('`', ""), 4) + "\n");
    }
    text.trim_start().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reference_the_page_is_that_of_the_guide() {
        let guide = concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../../docs/guide/src/findings.md"
        );
        assert!(
            std::fs::read_to_string(guide).unwrap() == PAGE,
            "cp docs/guide/src/findings.md crates/report/src/findings.md"
        );
    }

    #[test]
    fn reference_every_row_of_the_page_is_read() {
        let rows = PAGE.lines().filter(|line| line.starts_with("| `")).count();
        let all = all_explanations();
        assert!(all.len() >= rows && rows > 100, "{} of {rows}", all.len());
        assert!(
            all.iter()
                .all(|one| !one.meaning.is_empty() && !one.section.is_empty())
        );
    }

    #[test]
    fn rejects_a_misspelt_code() {
        let told = explain(&["cliped".to_owned()]).unwrap_err().to_string();
        assert!(told.contains("clipped"), "{told}");
        let [clipped] = &explain(&["clipped".to_owned()]).unwrap()[..] else {
            panic!("clipped has one explanation");
        };
        assert_eq!(clipped.severity, Severity::Wrong);
        assert!(clipped.meaning.starts_with("Samples are"), "{clipped:?}");
        assert!(
            text_of_explanations(std::slice::from_ref(clipped))
                .contains("[wrong] clipped: Samples")
        );
    }
}
