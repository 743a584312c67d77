//! What the page shows of a campaign that fits no impacts: the tables of its report and the
//! figures that `fit` draws, of the whole or of one recording.

use crate::workspace::{Detail, stored_results, with_reasons};
use serde::Serialize;
use std::path::Path;
use windfall_campaign::settings::kind::{STORE_FILE, campaign_kind};
use windfall_campaign::store::runs::latest_run;
use windfall_draw::files::NamedFigure;
use windfall_draw::page::CaptionedTable;
use windfall_draw::theme::PAGE;
use windfall_draw::xy::{Figure, drawing_of_figure};
use windfall_files::error::Error;
use windfall_files::found::{FailureOutcome, FindingOutcome};
use windfall_files::option_value::unusable;
use windfall_measure::any_outcome::AnyOutcome;
use windfall_measure::measured::{MeasuredItem, MeasuredOutcome};
use windfall_report::fit_any::{MeasurementWork, measurement_of};
use windfall_report::items::{tables_of_each, tables_of_whole};

/// A table as the report has it.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct ShownTable {
    /// What stands above it.
    pub caption: String,
    /// Headings, with units.
    pub columns: Vec<String>,
    /// Cells, row by row.
    pub rows: Vec<Vec<String>>,
}

/// A figure as `fit --figures` draws it.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct ShownFigure {
    /// Name of its files, without an ending.
    pub name: String,
    /// Its title.
    pub title: String,
    /// What it shows.
    pub caption: String,
    /// The element `svg`, in the colours of the page.
    pub svg: String,
}

/// Results of the whole campaign, or of one recording.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct MeasuredView {
    /// Tables of the results.
    pub tables: Vec<ShownTable>,
    /// Figures of the whole, of kinds that draw it; or the figure of the recording.
    pub figures: Vec<ShownFigure>,
    /// What a reader must know of them.
    pub findings: Vec<FindingOutcome>,
    /// What could not be evaluated.
    pub failed: Vec<FailureOutcome>,
}

/// What the store holds of a campaign that fits no impacts; nothing is evaluated or written.
///
/// * `item`: id of a recording; `None` for the whole
///
/// # Errors
/// The campaign or its store cannot be read, it fits impacts, or it has no such recording.
pub fn measured_view(directory: &Path, item: Option<&str>) -> Result<MeasuredView, Error> {
    let measurement = measurement(directory)?;
    let (mut outcome, figures) = match item {
        Some(id) => {
            let item = (measurement.item)(directory, id)?;
            (Some(item.outcome), item.figure.into_iter().collect())
        }
        None => {
            let outcome = match stored_results(directory, Detail::Whole)?.outcome {
                Some(AnyOutcome::Measured(outcome)) => Some(*outcome),
                _ => None,
            };
            (outcome, (measurement.figures)(directory)?)
        }
    };
    let tables = match (&mut outcome, item) {
        (Some(outcome), Some(id)) => {
            only(outcome, id);
            let newest = latest_run(&directory.join(STORE_FILE))?;
            let failures = newest.map_or_else(Vec::new, |run| run.failures);
            let own = failures.into_iter().filter(|failure| failure.id == id);
            with_reasons(&mut outcome.failed, own);
            tables_of_each(outcome, "This recording")
        }
        (Some(outcome), None) => tables_of_whole(outcome),
        (None, _) => Vec::new(),
    };
    let (findings, failed) =
        outcome.map_or_else(Default::default, |own| (own.findings, own.failed));
    Ok(MeasuredView {
        tables: tables.into_iter().map(shown_table).collect(),
        figures: figures.iter().map(shown_figure).collect(),
        findings,
        failed,
    })
}

fn measurement(directory: &Path) -> Result<MeasurementWork, Error> {
    let kind = campaign_kind(directory)?;
    measurement_of(kind).ok_or_else(|| {
        let problem = "fits impacts, each of which has a live fit";
        unusable(kind.name().to_owned(), problem)
    })
}

/// A figure of a campaign that fits no impacts.
///
/// * `item`: id of a recording; `None` for the whole
/// * `name`: that of the figure, as [`MeasuredView`] gives it
///
/// # Errors
/// Those of [`measured_view`]; there is no such figure.
pub fn measured_figure(directory: &Path, item: Option<&str>, name: &str) -> Result<Figure, Error> {
    let measurement = measurement(directory)?;
    let figures = match item {
        Some(id) => (measurement.item)(directory, id)?
            .figure
            .into_iter()
            .collect(),
        None => (measurement.figures)(directory)?,
    };
    let found = figures.into_iter().find(|own| own.name == name);
    let found = found.map(|own| own.figure);
    found.ok_or_else(|| {
        unusable(
            format!("figure '{name}'"),
            "is not among those that are shown",
        )
    })
}

/// Leaves what comes from one recording, with its findings.
fn only(outcome: &mut MeasuredOutcome, id: &str) {
    // A tap is "ID tap 1", a bounce "ID, bounce 1".
    let own = |item: &MeasuredItem| {
        let rest = item.id.strip_prefix(id);
        rest.is_some_and(|rest| {
            rest.is_empty() || rest.starts_with(" tap ") || rest.starts_with(", bounce ")
        })
    };
    outcome.impacts.retain(own);
    outcome.parts.retain(own);
    outcome.failed.retain(|failure| failure.id == id);
    let items = outcome.impacts.iter().chain(&outcome.parts);
    let mut findings: Vec<FindingOutcome> = Vec::new();
    for finding in items.flat_map(|item| &item.findings) {
        if !findings.contains(finding) {
            findings.push(finding.clone());
        }
    }
    outcome.findings = findings;
}

fn shown_table(table: CaptionedTable) -> ShownTable {
    ShownTable {
        caption: table.caption,
        columns: table.cells.header,
        rows: table.cells.rows,
    }
}

fn shown_figure(named: &NamedFigure) -> ShownFigure {
    ShownFigure {
        name: named.name.clone(),
        title: named.figure.title.clone(),
        caption: named.caption.clone(),
        svg: drawing_of_figure(&named.figure, None).element(&PAGE, &named.figure.title),
    }
}
