//! Results of `fit` as text for a terminal.

use crate::named::Named;
use crate::outcome::{CampaignOutcome, GroupOutcome, ImpactOutcome, SpreadOutcome};
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

/// Derived quantities that stand in the table of impacts too, by position.
const OF_IMPACTS: [usize; 4] = [0, 1, 3, 4];

/// What the table of groups adds.
const IMPACT_ENERGY: (&str, &str, f64) = ("impact_energy", "impact energy (mJ)", 1e3);

/// A campaign's results: impacts, groups, what was left out, findings.
#[must_use]
pub fn text_of_campaign(outcome: &CampaignOutcome) -> String {
    let mut text = format!("{}\n", outcome.campaign);
    if let Some(label) = &outcome.simulated {
        let _ = writeln!(text, "SIMULATED recordings: {label}");
    }
    let _ = writeln!(text, "{}", mass_line(outcome));
    let laws = laws_of(outcome);
    for law in &laws {
        text += &law_text(outcome, law);
    }
    if let Some(first) = laws.first() {
        let groups = groups_of(outcome, first);
        text += "\nRead off the signals (from the fit where they do not show it), mean ± SD over the impacts:\n";
        let _ = writeln!(text, "{}", derived_table(&groups));
    }
    if laws.len() > 1 {
        text += "\nThe laws compared; 1 is a law that describes the signal to its noise:\n";
        let _ = writeln!(text, "{}", law_table(outcome, &laws));
    }
    text += &findings_text(outcome);
    for failure in &outcome.failed {
        let _ = writeln!(text, "not fitted: {}: {}", failure.id, failure.message);
    }
    text
}

fn groups_of<'a>(outcome: &'a CampaignOutcome, law: &str) -> Vec<&'a GroupOutcome> {
    outcome
        .groups
        .iter()
        .filter(|group| group.law == law)
        .collect()
}

/// One law: its impacts, if they are few, and its groups.
fn law_text(outcome: &CampaignOutcome, law: &str) -> String {
    let impacts: Vec<&ImpactOutcome> = outcome
        .impacts
        .iter()
        .filter(|impact| impact.law == law)
        .collect();
    let mut text = format!("\n{law}, fitted to {}\n", impacts[0].quantities.join(", "));
    if impacts.len() <= LISTED_IMPACTS {
        text += "Each impact (± standard deviation of the estimate):\n";
        let _ = writeln!(text, "{}\n", impact_table(&impacts));
    }
    text += "Mean ± standard deviation over the impacts (coefficient of variation):\n";
    let _ = writeln!(
        text,
        "{}",
        parameter_table(&groups_of(outcome, law), &impacts)
    );
    if impacts.len() > LISTED_IMPACTS {
        let _ = writeln!(
            text,
            "Each of the {} impacts: --format csv or json.",
            impacts.len()
        );
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
    header.extend(OF_IMPACTS.map(|index| DERIVED[index].1.to_owned()));
    header.push("findings".to_owned());
    let shared = shared_codes(impacts);
    let rows = impacts.iter().map(|impact| {
        let mut row = vec![impact.id.clone(), impact.specimen.clone()];
        for (_, estimate) in &impact.parameters.0 {
            row.push(match estimate.held {
                false => value_and_sd(estimate.value, estimate.sd),
                true => format!("{} held", plain(estimate.value)),
            });
        }
        for (name, _, factor) in OF_IMPACTS.map(|index| DERIVED[index]) {
            let value = impact.derived.get(name).copied().flatten();
            row.push(value.map_or_else(|| "-".to_owned(), |value| plain(value * factor)));
        }
        let mut codes: Vec<&str> = Vec::new();
        for code in impact.findings.iter().map(|finding| finding.code.as_str()) {
            if !shared.contains(&code) && !codes.contains(&code) {
                codes.push(code);
            }
        }
        row.push(codes.join(" "));
        row
    });
    let mut left: Vec<usize> = vec![0, 1];
    left.push(header.len() - 1);
    table_text(&header, rows, &left)
}

/// Codes of findings that every impact has: said once below the tables, they
/// tell nothing in a row.
fn shared_codes<'a>(impacts: &[&'a ImpactOutcome]) -> Vec<&'a str> {
    let Some((first, rest)) = impacts.split_first() else {
        return Vec::new();
    };
    let has = |impact: &ImpactOutcome, code: &str| impact.findings.iter().any(|f| f.code == code);
    let codes = first.findings.iter().map(|finding| finding.code.as_str());
    codes
        .filter(|code| rest.iter().all(|impact| has(impact, code)))
        .collect()
}

/// Parameters per group, as Table 2 of the 2003 pendulum study.
fn parameter_table(groups: &[&GroupOutcome], impacts: &[&ImpactOutcome]) -> String {
    let mut header = vec![
        "group".to_owned(),
        "impacts".to_owned(),
        "specimens".to_owned(),
    ];
    let estimated: Vec<&str> = parameter_names(groups);
    header.extend(estimated.iter().map(|name| heading_of(impacts, name)));
    let rows = groups.iter().map(|group| {
        let mut row = vec![
            group_name(group),
            group.impacts.to_string(),
            group.specimens.to_string(),
        ];
        row.extend(
            estimated
                .iter()
                .map(|name| spread_cell(&group.parameters, name, 1.0)),
        );
        row
    });
    table_text(&header, rows, &[0])
}

/// Velocities, peaks and energies per group, as Table 3 of the same study. They
/// are read off the signals and hardly depend on the law.
fn derived_table(groups: &[&GroupOutcome]) -> String {
    let columns = || DERIVED.iter().chain([&IMPACT_ENERGY]);
    let mut header = vec!["group".to_owned()];
    header.extend(columns().map(|(_, heading, _)| (*heading).to_owned()));
    let rows = groups.iter().map(|group| {
        let mut row = vec![group_name(group)];
        row.extend(columns().map(|(name, _, factor)| spread_cell(&group.derived, name, *factor)));
        row
    });
    table_text(&header, rows, &[0])
}

fn group_name(group: &GroupOutcome) -> String {
    group.group.clone().unwrap_or_else(|| "all".to_owned())
}

fn spread_cell(spreads: &Named<SpreadOutcome>, name: &str, factor: f64) -> String {
    spreads.get(name).map_or_else(
        || "-".to_owned(),
        |s| spread_text(s.mean * factor, s.sd.map(|sd| sd * factor), s.cv),
    )
}

/// How several laws describe the same impacts: residuals over noise per
/// quantity, root mean square over impacts.
fn law_table(outcome: &CampaignOutcome, laws: &[&str]) -> String {
    let mut quantities: Vec<&str> = Vec::new();
    for (name, _) in outcome.impacts.iter().flat_map(|i| &i.residuals.0) {
        if !quantities.contains(&name.as_str()) {
            quantities.push(name);
        }
    }
    let groups: Vec<Option<&str>> = outcome.groups.iter().fold(Vec::new(), |mut seen, group| {
        if !seen.contains(&group.group.as_deref()) {
            seen.push(group.group.as_deref());
        }
        seen
    });
    let mut header = ["law", "group", "estimated", "impacts", "converged"]
        .map(str::to_owned)
        .to_vec();
    header.extend(
        quantities
            .iter()
            .map(|name| format!("{name} residual/noise")),
    );
    let rows = laws
        .iter()
        .flat_map(|law| groups.iter().map(move |group| (*law, *group)));
    let rows = rows.map(|(law, group)| {
        let of_law = |i: &&ImpactOutcome| i.law == law && i.group.as_deref() == group;
        let impacts: Vec<&ImpactOutcome> = outcome.impacts.iter().filter(of_law).collect();
        let free = impacts.first().map_or(0, |i| estimated_count(i));
        let converged = impacts.iter().filter(|i| i.converged).count();
        let mut row = vec![
            law.to_owned(),
            group.unwrap_or("all").to_owned(),
            free.to_string(),
            impacts.len().to_string(),
            converged.to_string(),
        ];
        row.extend(
            quantities
                .iter()
                .map(|name| residual_over_noise(&impacts, name)),
        );
        row
    });
    table_text(&header, rows, &[0, 1])
}

fn estimated_count(impact: &ImpactOutcome) -> usize {
    impact
        .parameters
        .0
        .iter()
        .filter(|(_, estimate)| !estimate.held)
        .count()
}

fn residual_over_noise(impacts: &[&ImpactOutcome], quantity: &str) -> String {
    let ratios: Vec<f64> = impacts
        .iter()
        .filter_map(|impact| impact.residuals.get(quantity))
        .filter(|residual| residual.noise > 0.0)
        .map(|residual| (residual.rms / residual.noise).powi(2))
        .collect();
    match ratios.len() {
        0 => "-".to_owned(),
        n => format!("{:.2}", (ratios.iter().sum::<f64>() / n as f64).sqrt()),
    }
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
            n if n == outcome.impacts.len() => " (all impacts have one of this kind)".to_owned(),
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
