//! Random parts of a formula → columns and groups.

use crate::error::Error;
use crate::model::contrast::Contrast;
use crate::model::formula::{Formula, RandomPart};
use crate::model::model_frame::{ModelFrame, prediction_rows};
use crate::model::model_rows::model_rows;
use crate::table::{Cells, Table};
use windfall_mixed::predict::NewTerm;
use windfall_mixed::term::RandomTerm;

/// A random term and how its columns came about.
#[derive(Clone, Debug, PartialEq)]
pub struct FramedTerm {
    /// Its numbers.
    pub term: RandomTerm,
    /// Columns that name its groups.
    pub groups: Vec<String>,
    /// How its columns are made.
    pub frame: ModelFrame,
}

/// Evaluates the random parts of a formula; errors as in [`model_rows`].
pub fn random_terms(
    formula: &Formula,
    table: &Table,
    contrast: Contrast,
) -> Result<Vec<FramedTerm>, Error> {
    let parts = formula.random.iter();
    parts
        .map(|part| framed(formula, part, table, contrast))
        .collect()
}

fn framed(
    formula: &Formula,
    part: &RandomPart,
    table: &Table,
    contrast: Contrast,
) -> Result<FramedTerm, Error> {
    let inner = Formula {
        response: None,
        atoms: formula.atoms.clone(),
        terms: part.terms.clone(),
        intercept: part.intercept,
        random: Vec::new(),
    };
    let rows = model_rows(&inner, table, contrast, &part.groups)?;
    if rows.x.ncols() == 0 {
        return Err(Error::Request {
            what: format!("(0 | {})", part.groups.join(":")),
            problem: "nothing varies between these groups: write 1 for the mean".to_owned(),
        });
    }
    let labels = labels(table, &part.groups)?;
    let mut group_names: Vec<String> = Vec::new();
    let mut places = std::collections::BTreeMap::new();
    let group = labels
        .into_iter()
        .map(|label| {
            *places.entry(label).or_insert_with_key(|label| {
                group_names.push(label.clone());
                group_names.len() - 1
            })
        })
        .collect();
    let columns = rows.x.column_iter();
    Ok(FramedTerm {
        term: RandomTerm {
            name: part.groups.join(":"),
            columns: columns.map(|c| c.iter().copied().collect()).collect(),
            column_names: rows.frame.names.clone(),
            group,
            groups: group_names.len(),
            group_names,
            correlated: true,
        },
        groups: part.groups.clone(),
        frame: rows.frame,
    })
}

/// Names of the groups that rows belong to; blank where a cell is missing.
fn labels(table: &Table, groups: &[String]) -> Result<Vec<String>, Error> {
    let columns = groups.iter().map(|name| table.column(name));
    let columns: Vec<_> = columns.collect::<Result<_, _>>()?;
    let label = |row: usize| {
        let parts = columns.iter().map(|column| match &column.cells {
            Cells::Numbers(numbers) => numbers.at(row).to_string(),
            Cells::Categories(categories) => {
                categories.codes[row].map_or_else(String::new, |c| categories.levels[c].clone())
            }
        });
        parts.collect::<Vec<_>>().join(":")
    };
    Ok((0..table.rows()).map(label).collect())
}

/// Random terms at new rows; errors as in [`prediction_rows`].
pub fn new_terms(terms: &[FramedTerm], table: &Table) -> Result<Vec<NewTerm>, Error> {
    let found = terms.iter().map(|framed| {
        let x = prediction_rows(&framed.frame, table)?;
        let known = &framed.term.group_names;
        let labels = labels(table, &framed.groups)?;
        Ok(NewTerm {
            columns: x
                .column_iter()
                .map(|c| c.iter().copied().collect())
                .collect(),
            group: labels
                .iter()
                .map(|label| known.iter().position(|name| name == label))
                .collect(),
        })
    });
    found.collect()
}
