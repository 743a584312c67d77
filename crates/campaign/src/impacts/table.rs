//! Results of `fit` as a table: one row per impact and law.

use crate::result::outcome::{CampaignOutcome, ImpactOutcome};
use crate::result::quantity::{QUANTITIES, Quantity};
use crate::settings::model::ImpactCampaign;
use itertools::Itertools;
use std::iter::once;
use windfall_files::error::Error;
use windfall_files::found::EstimateOutcome;
use windfall_files::sheet::write::csv_of_table;
use windfall_files::sheet::{Cell, Column, Kind, Schema};
use windfall_files::table::data::LEFT_OUT_COLUMN;

/// Raised when a column goes or changes its meaning.
const VERSION: u32 = 1;

/// Quantities that have a column in CSV even when no impact has a value.
const ALWAYS: usize = 12;

/// The table of impacts.
///
/// Parameters carry their unit in a column beside them, because it depends on
/// the law. Simulated recordings are marked in every row.
pub struct ImpactTable<'a> {
    /// Its columns: the parameters are those of all laws, the rest is always the same.
    pub schema: Schema,
    simulated: &'a str,
    parameters: Vec<&'a str>,
}

impl<'a> ImpactTable<'a> {
    /// The table of results.
    pub fn of(outcome: &'a CampaignOutcome) -> Self {
        let impacts = outcome.impacts.iter();
        let parameters = impacts.flat_map(|impact| impact.parameters.names());
        let parameters = parameters.unique().collect();
        Self::new(&outcome.campaign, outcome.simulated.as_deref(), parameters)
    }

    /// The table of the results that a campaign will have.
    pub fn of_campaign(campaign: &'a ImpactCampaign) -> Self {
        let laws = campaign.fit.laws.iter();
        let parameters = laws.flat_map(|law| law.kind.describe().parameters);
        let parameters = parameters.map(|own| own.name).unique().collect();
        let shared = &campaign.shared;
        Self::new(&shared.title, shared.simulated.as_deref(), parameters)
    }

    fn new(title: &str, simulated: Option<&'a str>, parameters: Vec<&'a str>) -> Self {
        Self {
            schema: Schema {
                table: "fit",
                version: VERSION,
                columns: columns(&parameters),
                notes: vec![("campaign".to_owned(), title.to_owned())],
            },
            simulated: simulated.unwrap_or(""),
            parameters,
        }
    }

    /// The row of a result.
    pub fn row<'b>(&'b self, impact: &'b ImpactOutcome) -> Vec<Cell<'b>> {
        let names = [&impact.id, &impact.specimen].map(|own| Cell::text(own.as_str()));
        let group = Cell::text(impact.group.as_deref().unwrap_or(""));
        let rest = [impact.file.as_str(), &impact.law].map(Cell::text);
        let mut row: Vec<Cell> = names.into_iter().chain(once(group)).chain(rest).collect();
        for name in &self.parameters {
            row.extend(cells_of_estimate(impact.parameters.get(name)));
        }
        let derived = |quantity: &Quantity| Cell::number(impact.derived(quantity.name));
        let sd = |quantity: &Quantity| impact.derived_sd.get(quantity.name).copied();
        let (always, others) = QUANTITIES.split_at(ALWAYS);
        row.extend(always.iter().map(derived));
        // What the fitted law gives, beside what it takes as a parameter.
        let delivered = ["restitution", "nominal_restitution"];
        row.extend(delivered.map(|name| Cell::number(impact.fitted(name))));
        let findings = impact.findings.iter().map(|own| own.code.as_str());
        row.extend([
            Cell::Number(impact.cost),
            Cell::Count(impact.samples as u64),
            Cell::Flag(impact.converged),
            Cell::text(findings.collect::<Vec<_>>().join(" ")),
            Cell::text(self.simulated),
        ]);
        row.extend(others.iter().map(derived));
        row.extend(QUANTITIES.iter().map(|own| Cell::number(sd(own))));
        let reasons = impact.left_out.iter().map(|reason| reason.code.as_str());
        row.push(Cell::text(reasons.unique().join(" ")));
        row
    }
}

/// The table of impacts as CSV.
///
/// # Errors
/// None in practice: every cell can be written.
pub fn csv_of_campaign(outcome: &CampaignOutcome) -> Result<String, Error> {
    let table = ImpactTable::of(outcome);
    let rows = outcome.impacts.iter().map(|impact| table.row(impact));
    csv_of_table(&table.schema, rows)
}

fn columns(parameters: &[&str]) -> Vec<Column> {
    let mut columns = first_columns();
    let others = other_columns();
    let of_parameters = parameters.iter().fold(Vec::new(), |mut all, name| {
        let taken = columns.iter().chain(&others).chain(&all);
        let taken: Vec<&str> = taken.map(|own| own.name.as_str()).collect();
        let own = columns_of_parameter(name, &taken);
        all.extend(own);
        all
    });
    columns.extend(of_parameters);
    columns.extend(others);
    columns
}

fn text(name: &str, meaning: &str) -> Column {
    Column::new(name, Kind::Text, meaning)
}

fn first_columns() -> Vec<Column> {
    vec![
        text("id", "id of the impact"),
        text("specimen", "id of the specimen"),
        text("group", "group of the specimen or impact"),
        text("file", "the recording, as impacts.csv names it"),
        text("law", "name of the law"),
    ]
}

fn other_columns() -> Vec<Column> {
    let (always, others) = QUANTITIES.split_at(ALWAYS);
    let mut columns: Vec<Column> = always.iter().map(column).collect();
    let number = |name, meaning| Column::new(name, Kind::Number, meaning);
    columns.extend([
        number("restitution_delivered", "restitution of the fitted motion"),
        number(
            "restitution_nominal",
            "restitution that the law takes as a parameter",
        ),
        number("cost", "value of the cost function"),
        Column::new("samples", Kind::Count, "samples in the cost function"),
        Column::new("converged", Kind::Flag, "whether a minimum was reached"),
        text("findings", "codes of findings, separated by blanks"),
        text("simulated", "what simulated the recording"),
    ]);
    columns.extend(others.iter().map(|own| column(own).seldom()));
    columns.extend(QUANTITIES.iter().map(|own| {
        let meaning = format!("standard uncertainty of {}", own.label.to_lowercase());
        let column = Column::new(own.sd_column(), Kind::Number, meaning);
        column.in_unit(own.unit).seldom()
    }));
    let why = "why the impact does not count, as codes separated by blanks; blank if it does";
    columns.push(text(LEFT_OUT_COLUMN, why));
    columns
}

fn column(quantity: &Quantity) -> Column {
    let meaning = quantity.label.to_lowercase();
    Column::new(quantity.column(), Kind::Number, meaning).in_unit(quantity.unit)
}

/// Columns of a parameter. One that is called like a quantity of impacts, as the restitution of
/// some laws, has `law_` before its name.
///
/// * `taken`: names of other columns
fn columns_of_parameter(name: &str, taken: &[&str]) -> [Column; 5] {
    let number = |end: &str, meaning: &str| {
        let meaning = format!("{meaning}, in the unit of {name}_unit");
        Column::new(format!("{name}{end}"), Kind::Number, meaning)
    };
    let columns = [
        number("", "parameter of the law"),
        number("_sd", "its standard deviation"),
        number("_low", "lower end of its 95 % interval"),
        number("_high", "upper end of its 95 % interval"),
        text(&format!("{name}_unit"), "its SI unit"),
    ];
    match columns.iter().any(|own| taken.contains(&own.name.as_str())) {
        true => columns_of_parameter(&format!("law_{name}"), taken),
        false => columns,
    }
}

fn cells_of_estimate(estimate: Option<&EstimateOutcome>) -> [Cell<'_>; 5] {
    match estimate {
        None => [const { Cell::Blank }; 5],
        Some(own) => [
            Cell::Number(own.value),
            Cell::number(own.sd),
            Cell::number(own.low),
            Cell::number(own.high),
            Cell::text(own.unit.as_str()),
        ],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use windfall_contact::laws::kind::LawKind;

    #[test]
    fn closed_form_no_two_columns_share_a_name() {
        let parameters = LawKind::ALL
            .iter()
            .flat_map(|law| law.describe().parameters);
        let names = parameters.map(|own| own.name);
        // Parameters of laws of the user may be called anything.
        let names = names.chain(["id", "cost", "k_sd", "law_restitution"]);
        let names: Vec<&str> = names.unique().collect();
        assert!(names.contains(&"restitution"));
        let columns = columns(&names);
        let all: Vec<&str> = columns.iter().map(|own| own.name.as_str()).collect();
        assert_eq!(all.iter().duplicates().next(), None);
        for name in [
            "k",
            "restitution",
            "law_law_restitution",
            "law_id",
            "law_k_sd_low",
        ] {
            assert!(all.contains(&name), "{name}: {all:?}");
        }
    }
}
