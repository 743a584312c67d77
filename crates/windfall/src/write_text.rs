//! Results of `fit` as text for a terminal.

use crate::named::Named;
use crate::outcome::{CampaignOutcome, GroupOutcome, ImpactOutcome};
use crate::text_number::{plain, spread_text, value_and_sd};
use comfy_table::{CellAlignment, ContentArrangement, LineStyle, Table, TableStyle};
use std::fmt::Write;

/// More impacts than this are shown as groups only.
const LISTED_IMPACTS: usize = 40;

/// Derived quantities in the tables: name, heading, factor from SI.
const DERIVED: [(&str, &str, f64); 6] = [
    ("impact_velocity", "velocity (m/s)", 1.0),
    ("peak_force", "peak force (N)", 1.0),
    ("max_displacement", "displacement (mm)", 1e3),
    ("contact_duration", "duration (ms)", 1e3),
    ("restitution", "restitution", 1.0),
    ("absorbed_energy", "absorbed (mJ)", 1e3),
];

/// A campaign's results: impacts, groups, what was left out, findings.
#[must_use]
pub fn text_of_campaign(outcome: &CampaignOutcome) -> String {
    let mut text = format!("{}\n", outcome.campaign);
    if let Some(label) = &outcome.simulated {
        let _ = writeln!(text, "SIMULATED recordings: {label}");
    }
    let _ = writeln!(text, "{}", mass_line(outcome));
    for law in laws_of(outcome) {
        let impacts: Vec<&ImpactOutcome> = outcome
            .impacts
            .iter()
            .filter(|impact| impact.law == law)
            .collect();
        let _ = writeln!(
            text,
            "\n{law}, fitted to {}",
            impacts[0].quantities.join(", ")
        );
        if impacts.len() <= LISTED_IMPACTS {
            let _ = writeln!(text, "{}\n", impact_table(&impacts));
        }
        let groups: Vec<&GroupOutcome> = outcome.groups.iter().filter(|g| g.law == law).collect();
        text += "Mean ± standard deviation over the impacts (coefficient of variation):\n";
        let _ = writeln!(text, "{}", group_table(&groups, &impacts));
        if impacts.len() > LISTED_IMPACTS {
            let _ = writeln!(
                text,
                "Each of the {} impacts: --format csv or json.",
                impacts.len()
            );
        }
    }
    text += &findings_text(outcome);
    for failure in &outcome.failed {
        let _ = writeln!(text, "not fitted: {}: {}", failure.id, failure.message);
    }
    text
}

fn mass_line(outcome: &CampaignOutcome) -> String {
    let mass = &outcome.effective_mass;
    let value = value_and_sd(mass.value, Some(mass.sd));
    match mass.impacts {
        0 => format!("effective mass {value} kg"),
        n => {
            format!("effective mass {value} kg, from impulse and change of velocity of {n} impacts")
        }
    }
}

fn laws_of(outcome: &CampaignOutcome) -> Vec<&str> {
    let mut laws: Vec<&str> = Vec::new();
    for impact in &outcome.impacts {
        if !laws.contains(&impact.law.as_str()) {
            laws.push(&impact.law);
        }
    }
    laws
}

fn impact_table(impacts: &[&ImpactOutcome]) -> String {
    let mut header = vec!["impact".to_owned(), "specimen".to_owned()];
    header.extend(parameter_headings(impacts));
    header.extend(DERIVED.iter().map(|(_, heading, _)| (*heading).to_owned()));
    header.push("findings".to_owned());
    let rows = impacts.iter().map(|impact| {
        let mut row = vec![impact.id.clone(), impact.specimen.clone()];
        for (_, estimate) in &impact.parameters.0 {
            row.push(match estimate.held {
                false => value_and_sd(estimate.value, estimate.sd),
                true => format!("{} held", plain(estimate.value)),
            });
        }
        for (name, _, factor) in DERIVED {
            let value = impact.derived.get(name).copied().flatten();
            row.push(value.map_or_else(|| "-".to_owned(), |value| plain(value * factor)));
        }
        let mut codes: Vec<&str> = impact.findings.iter().map(|f| f.code.as_str()).collect();
        codes.dedup();
        row.push(codes.join(" "));
        row
    });
    let mut left: Vec<usize> = vec![0, 1];
    left.push(header.len() - 1);
    table_text(&header, rows, &left)
}

fn group_table(groups: &[&GroupOutcome], impacts: &[&ImpactOutcome]) -> String {
    let mut header = vec![
        "group".to_owned(),
        "impacts".to_owned(),
        "specimens".to_owned(),
    ];
    let estimated: Vec<&str> = parameter_names(groups);
    header.extend(estimated.iter().map(|name| heading_of(impacts, name)));
    header.extend(DERIVED.iter().map(|(_, heading, _)| (*heading).to_owned()));
    let rows = groups.iter().map(|group| {
        let mut row = vec![
            group.group.clone().unwrap_or_else(|| "all".to_owned()),
            group.impacts.to_string(),
            group.specimens.to_string(),
        ];
        let cell = |spreads: &Named<crate::outcome::SpreadOutcome>, name: &str, factor: f64| {
            spreads.get(name).map_or_else(
                || "-".to_owned(),
                |s| spread_text(s.mean * factor, s.sd.map(|sd| sd * factor), s.cv),
            )
        };
        row.extend(
            estimated
                .iter()
                .map(|name| cell(&group.parameters, name, 1.0)),
        );
        row.extend(
            DERIVED
                .iter()
                .map(|(name, _, factor)| cell(&group.derived, name, *factor)),
        );
        row
    });
    table_text(&header, rows, &[0])
}

fn parameter_names<'a>(groups: &[&'a GroupOutcome]) -> Vec<&'a str> {
    let mut names: Vec<&str> = Vec::new();
    for (name, _) in groups.iter().flat_map(|group| &group.parameters.0) {
        if !names.contains(&name.as_str()) {
            names.push(name);
        }
    }
    names
}

fn parameter_headings(impacts: &[&ImpactOutcome]) -> Vec<String> {
    let first = impacts.first().map(|impact| &impact.parameters.0);
    first
        .into_iter()
        .flatten()
        .map(|(name, _)| heading_of(impacts, name))
        .collect()
}

/// "k (N/m^1.5)", or the name alone where impacts differ in the unit.
fn heading_of(impacts: &[&ImpactOutcome], name: &str) -> String {
    let mut units = impacts
        .iter()
        .filter_map(|i| i.parameters.get(name))
        .map(|e| &e.unit);
    match units.next() {
        Some(unit) if unit != "1" && units.all(|other| other == unit) => format!("{name} ({unit})"),
        _ => name.to_owned(),
    }
}

fn findings_text(outcome: &CampaignOutcome) -> String {
    let mut text = String::new();
    for finding in &outcome.findings {
        let _ = writeln!(text, "finding: {}", finding.message);
    }
    // One line per code: the first message and how many impacts share the code.
    let mut seen: Vec<(&str, &str, &str, usize)> = Vec::new();
    for impact in &outcome.impacts {
        let mut codes: Vec<&str> = Vec::new();
        for finding in &impact.findings {
            if codes.contains(&finding.code.as_str()) {
                continue;
            }
            codes.push(&finding.code);
            match seen.iter_mut().find(|(code, ..)| *code == finding.code) {
                Some((.., count)) => *count += 1,
                None => seen.push((&finding.code, &impact.id, &finding.message, 1)),
            }
        }
    }
    if !seen.is_empty() {
        text += "\nFindings:\n";
    }
    for (code, id, message, count) in seen {
        let more = match count {
            1 => String::new(),
            n => format!(" (and {} more of this kind)", n - 1),
        };
        let _ = writeln!(text, "  {code}: {id}: {message}{more}");
    }
    text
}

/// An aligned table; columns not in `left` are set flush right.
#[must_use]
pub fn table_text(
    header: &[String],
    rows: impl IntoIterator<Item = Vec<String>>,
    left: &[usize],
) -> String {
    let line = LineStyle::none().fill('─').junction('─');
    let mut table = Table::new();
    table.load_style(TableStyle::new().header_separator(line));
    table.set_content_arrangement(ContentArrangement::Disabled);
    table.set_header(header);
    for row in rows {
        table.add_row(row);
    }
    for (index, column) in table.column_iter_mut().enumerate() {
        if !left.contains(&index) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    table.trim_fmt()
}
