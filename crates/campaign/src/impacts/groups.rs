//! Tables of groups: parameters, signals and energies, laws compared.

use crate::result::outcome::{CampaignOutcome, GroupOutcome, ImpactOutcome};
use crate::result::quantity::{Quantity, quantities_named};
use itertools::Itertools;
use windfall_files::found::{SpreadOutcome, spread};
use windfall_files::text::number::{plain, spread_percent, spread_text, unit_text};
use windfall_files::text::table::{Cells, header_of, page_tables, paragraph};

/// Velocities and peaks.
const SIGNALS: [&str; 4] = [
    "impact_velocity",
    "peak_force",
    "max_displacement",
    "contact_duration",
];

/// Energies and their ratio.
const ENERGIES: [&str; 4] = [
    "impact_energy",
    "elastic_energy",
    "absorbed_energy",
    "restitution",
];

/// Up to this relative spread a quantity is said once and not in every row; 1.
const ALIKE: f64 = 1e-3;

/// Groups of one law, in their order.
pub fn groups_of<'a>(outcome: &'a CampaignOutcome, law: &str) -> Vec<&'a GroupOutcome> {
    let groups = outcome.groups.iter();
    groups.filter(|group| group.law == law).collect()
}

/// "k (N/m¹˙⁵)", or the name alone where impacts differ in the unit.
pub fn heading_of(impacts: &[&ImpactOutcome], name: &str) -> String {
    let mut units = impacts
        .iter()
        .filter_map(|i| i.parameters.get(name))
        .map(|e| &e.unit);
    match units.next() {
        Some(unit) if unit != "1" && units.all(|other| other == unit) => {
            format!("{name} ({})", unit_text(unit))
        }
        _ => name.to_owned(),
    }
}

/// Parameters per group, as Table 2 of the 2003 pendulum study.
pub fn parameter_table(groups: &[&GroupOutcome], impacts: &[&ImpactOutcome]) -> String {
    let cells = parameter_cells(groups, impacts);
    page_tables(&cells.header, &cells.rows, &[0])
}

/// The cells of [`parameter_table`].
pub fn parameter_cells(groups: &[&GroupOutcome], impacts: &[&ImpactOutcome]) -> Cells {
    let mut header = header_of(&["group", "impacts", "specimens"]);
    let estimated: Vec<&str> = parameter_names(groups);
    header.extend(estimated.iter().map(|name| heading_of(impacts, name)));
    let rows = groups.iter().map(|group| {
        let mut row = vec![
            group_name(group.group.as_deref()),
            group.impacts.to_string(),
            group.specimens.to_string(),
        ];
        row.extend(estimated.iter().map(|name| {
            let spread = group.parameters.get(name);
            spread.map_or_else(dash, |s| spread_text(s.mean, s.sd, s.cv))
        }));
        row
    });
    let rows = rows.collect();
    Cells { header, rows }
}

/// Where velocities, peaks and energies come from, with the words for it.
pub const SOURCES: [(&str, &str); 2] = [
    ("signal", "read off the signals"),
    (
        "fit",
        "under the fitted law, where the signals do not show them",
    ),
];

/// Velocities, peaks and energies per group that come from one of [`SOURCES`], in tables that
/// are not empty.
pub fn derived_cells(outcome: &CampaignOutcome, law: &str, source: &str) -> Vec<Cells> {
    let groups = groups_of(outcome, law);
    let tables = [SIGNALS, ENERGIES].map(|names| from_source(outcome, law, source, &names));
    let tables = tables.iter().filter(|names| !names.is_empty());
    tables
        .map(|names| cells_of(&groups, &quantities_named(names)))
        .collect()
}

/// Those of some quantities that come from one of [`SOURCES`] in the impacts that count. One
/// that comes from the law in any of them comes from the law.
fn from_source<'a>(
    outcome: &CampaignOutcome,
    law: &str,
    source: &str,
    names: &[&'a str],
) -> Vec<&'a str> {
    let impacts = || {
        outcome
            .impacts
            .iter()
            .filter(|i| i.law == law && i.counts())
    };
    let of = |name: &str| {
        let mut sources = impacts().filter_map(|impact| impact.derived_from.get(name));
        let first = sources.next()?;
        Some(if first == "fit" || sources.any(|own| own == "fit") {
            "fit"
        } else {
            "signal"
        })
    };
    let mut names = names.to_vec();
    names.retain(|name| of(name) == Some(source));
    names
}

fn cells_of(groups: &[&GroupOutcome], columns: &[&Quantity]) -> Cells {
    let mut header = vec!["group".to_owned(), "n".to_owned()];
    header.extend(columns.iter().map(|column| column.title()));
    let rows = groups.iter().map(|group| derived_row(group, columns));
    let rows = rows.collect();
    Cells { header, rows }
}

/// Velocities, peaks and energies per group that come from one of [`SOURCES`], as Table 3 of
/// the same study; empty where there are none.
pub fn derived_tables(outcome: &CampaignOutcome, law: &str, source: &str) -> String {
    let groups = &groups_of(outcome, law)[..];
    let [signals, energies] =
        [SIGNALS, ENERGIES].map(|names| from_source(outcome, law, source, &names));
    let all = signals.iter().chain(&energies).copied();
    let (alike, varied): (Vec<&str>, Vec<&str>) = all.partition(|name| alike(groups, name));
    let mut text = String::new();
    for mut names in [signals, energies] {
        names.retain(|name| varied.contains(name));
        let columns = quantities_named(&names);
        if columns.is_empty() {
            continue;
        }
        let Cells { header, rows } = cells_of(groups, &columns);
        text += &(page_tables(&header, &rows, &[0]) + "\n\n");
    }
    let said: Vec<String> = quantities_named(&alike)
        .into_iter()
        .filter_map(|column| {
            let mean = groups.first()?.derived.get(column.name)?.mean;
            let number = plain(mean * column.factor);
            Some(
                format!("{} {number} {}", column.heading, column.shown_unit)
                    .trim_end()
                    .to_owned(),
            )
        })
        .collect();
    if !said.is_empty() {
        let line = format!(
            "The same in all impacts (SD below 0.1 %): {}",
            said.join(", ")
        );
        text += &(paragraph(&line, 2) + "\n");
    }
    match text.trim_end() {
        "" => String::new(),
        text => format!("{text}\n"),
    }
}

fn derived_row(group: &GroupOutcome, columns: &[&Quantity]) -> Vec<String> {
    let mut row = vec![
        group_name(group.group.as_deref()),
        group.impacts.to_string(),
    ];
    row.extend(columns.iter().map(|column| {
        let spread = group.derived.get(column.name);
        spread.map_or_else(dash, |s| spread_percent(s.mean * column.factor, s.cv))
    }));
    row
}

/// Whether a quantity is the same in all impacts of several.
fn alike(groups: &[&GroupOutcome], name: &str) -> bool {
    let spreads: Option<Vec<&SpreadOutcome>> =
        groups.iter().map(|group| group.derived.get(name)).collect();
    let Some(spreads) = spreads else { return false };
    let impacts: usize = spreads.iter().map(|spread| spread.n).sum();
    let first = spreads.first().map_or(0.0, |spread| spread.mean);
    impacts > 1
        && spreads.iter().all(|spread| {
            (spread.mean - first).abs() <= ALIKE * first.abs()
                && spread.cv.is_none_or(|cv| cv < ALIKE)
        })
}

/// Nominal, delivered and measured restitution; empty for laws without a nominal one.
pub fn restitution_table(impacts: &[&ImpactOutcome]) -> String {
    let promised = |impact: &&ImpactOutcome| impact.fitted.get("nominal_restitution").is_some();
    if !impacts.iter().any(promised) {
        return String::new();
    }
    let header = ["group", "nominal (parameter)", "delivered (law)", "signal"].map(str::to_owned);
    let rows = group_names(impacts).into_iter().map(|group| {
        let members: Vec<&&ImpactOutcome> = impacts
            .iter()
            .filter(|impact| impact.group.as_deref() == group)
            .collect();
        let cell = |value: &dyn Fn(&ImpactOutcome) -> Option<f64>| {
            let values: Vec<f64> = members.iter().filter_map(|impact| value(impact)).collect();
            spread(&values).map_or_else(dash, |s| spread_percent(s.mean, s.cv))
        };
        vec![
            group_name(group),
            cell(&|impact| impact.fitted("nominal_restitution")),
            cell(&|impact| impact.fitted("restitution")),
            cell(&|impact| impact.derived("restitution")),
        ]
    });
    let table = page_tables(&header, &rows.collect::<Vec<_>>(), &[0]);
    format!("\nRestitution, nominal beside delivered (mean ± SD in %):\n{table}\n")
}

/// Residuals over noise per law and quantity, root mean square over impacts.
pub fn law_table(outcome: &CampaignOutcome, laws: &[&str]) -> String {
    let cells = law_cells(outcome, laws);
    page_tables(&cells.header, &cells.rows, &[0, 1])
}

/// The cells of [`law_table`].
pub fn law_cells(outcome: &CampaignOutcome, laws: &[&str]) -> Cells {
    let quantities = outcome.impacts.iter().flat_map(|i| i.residuals.names());
    let quantities: Vec<&str> = quantities.unique().collect();
    let mut header = header_of(&["law", "group", "estimated", "impacts", "converged"]);
    header.extend(quantities.iter().map(|name| (*name).to_owned()));
    let all: Vec<&ImpactOutcome> = outcome.impacts.iter().collect();
    let groups = group_names(&all);
    let pairs = laws
        .iter()
        .flat_map(|law| groups.iter().map(move |group| (*law, *group)));
    let rows = pairs.map(|(law, group)| {
        let of_law = |i: &&ImpactOutcome| i.law == law && i.group.as_deref() == group;
        let impacts: Vec<&ImpactOutcome> = outcome.impacts.iter().filter(of_law).collect();
        let estimated = impacts.first().map_or(0, |impact| estimated_count(impact));
        let converged = impacts.iter().filter(|i| i.converged).count();
        let mut row = vec![law.to_owned(), group_name(group)];
        row.extend([estimated, impacts.len(), converged].map(|n| n.to_string()));
        row.extend(
            quantities
                .iter()
                .map(|name| residual_over_noise(&impacts, name)),
        );
        row
    });
    let rows = rows.collect();
    Cells { header, rows }
}

fn group_names<'a>(impacts: &[&'a ImpactOutcome]) -> Vec<Option<&'a str>> {
    let groups = impacts.iter().map(|impact| impact.group.as_deref());
    groups.unique().collect()
}

fn estimated_count(impact: &ImpactOutcome) -> usize {
    let parameters = impact.parameters.0.iter();
    parameters.filter(|(_, estimate)| !estimate.held).count()
}

fn residual_over_noise(impacts: &[&ImpactOutcome], quantity: &str) -> String {
    let ratios: Vec<f64> = impacts
        .iter()
        .filter_map(|impact| impact.residuals.get(quantity))
        .filter(|residual| residual.noise > 0.0)
        .map(|residual| (residual.rms / residual.noise).powi(2))
        .collect();
    match ratios.len() {
        0 => dash(),
        n => format!("{:.2}", (ratios.iter().sum::<f64>() / n as f64).sqrt()),
    }
}

fn parameter_names<'a>(groups: &[&'a GroupOutcome]) -> Vec<&'a str> {
    let names = groups.iter().flat_map(|group| group.parameters.names());
    names.unique().collect()
}

fn group_name(group: Option<&str>) -> String {
    group.unwrap_or("all").to_owned()
}

fn dash() -> String {
    "-".to_owned()
}
