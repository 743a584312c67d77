//! How a formula and a table become columns of numbers.

use crate::error::Error;
use crate::model::encoding::{Coding, Encoding};
use crate::model::formula::{Formula, Term, term_name};
use crate::table::{Cells, Table};
use nalgebra::DMatrix;
use std::borrow::Cow;
use std::ops::Range;

/// How terms of a formula became columns; kept for predictions.
#[derive(Clone, Debug, PartialEq)]
pub struct ModelFrame {
    /// How each atom of the formula is evaluated.
    pub atoms: Vec<Encoding>,
    /// Terms with their columns.
    pub terms: Vec<TermColumns>,
    /// Whether the first column is the intercept.
    pub intercept: bool,
    /// Names of the columns.
    pub names: Vec<String>,
}

/// A term with its columns.
#[derive(Clone, Debug, PartialEq)]
pub struct TermColumns {
    /// How it is written.
    pub name: String,
    /// Its atoms and how categories among them are coded.
    pub atoms: Vec<(usize, Coding)>,
    /// Its columns.
    pub columns: Range<usize>,
}

/// Model matrix of other rows; errors as in
/// [`model_rows`](crate::model::model_rows::model_rows), and for new levels.
pub fn prediction_rows(frame: &ModelFrame, table: &Table) -> Result<DMatrix<f64>, Error> {
    let plain = |name: &str, own: &mut [f64]| {
        table.numbers(name)?.fill(0..table.rows(), own);
        Ok(())
    };
    matrix(frame, table, plain)
}

/// Some rows of a table, in their order; the table itself where these are all.
pub fn chosen_rows<'a>(table: &'a Table, rows: &[usize]) -> Cow<'a, Table> {
    if rows.len() == table.rows() && rows.iter().enumerate().all(|(place, row)| place == *row) {
        return Cow::Borrowed(table);
    }
    let mut chosen = table.clone();
    for column in &mut chosen.columns {
        match &mut column.cells {
            Cells::Numbers(numbers) => *numbers = numbers.chosen(rows),
            Cells::Categories(categories) => {
                categories.codes = rows.iter().map(|row| categories.codes[*row]).collect();
            }
        }
    }
    Cow::Owned(chosen)
}

pub(crate) fn frame_of(formula: &Formula, atoms: Vec<Encoding>) -> ModelFrame {
    let mut names: Vec<String> = Vec::new();
    if formula.intercept {
        names.push("(Intercept)".to_owned());
    }
    let mut terms = Vec::new();
    for term in &formula.terms {
        let coded = coding(formula, &atoms, term);
        let start = names.len();
        let mut products = vec![String::new()];
        for (atom, coding) in &coded {
            let own = atoms[*atom].columns(*coding);
            // The first factor varies fastest, as in R.
            products = own
                .iter()
                .flat_map(|name| {
                    let joined = |before: &String| match before.is_empty() {
                        true => name.clone(),
                        false => format!("{before}:{name}"),
                    };
                    products.iter().map(joined).collect::<Vec<_>>()
                })
                .collect();
        }
        names.extend(products);
        terms.push(TermColumns {
            name: term_name(&formula.atoms, term),
            atoms: coded,
            columns: start..names.len(),
        });
    }
    ModelFrame {
        atoms,
        terms,
        intercept: formula.intercept,
        names,
    }
}

/// A category is coded by contrasts where the term without it is in the model,
/// else by all its levels (Chambers & Hastie, Statistical Models in S, 1992, ch. 2).
fn coding(formula: &Formula, atoms: &[Encoding], term: &Term) -> Vec<(usize, Coding)> {
    let coded = term.iter().map(|atom| {
        let margin: Term = term
            .iter()
            .filter(|other| *other != atom)
            .copied()
            .collect();
        let present = match margin.is_empty() {
            true => formula.intercept || first_category(formula, atoms) != Some(*atom),
            false => formula.terms.contains(&margin),
        };
        let full = !present && matches!(atoms[*atom], Encoding::Category { .. });
        (*atom, if full { Coding::Full } else { Coding::Contrast })
    });
    coded.collect()
}

/// Without an intercept the first category that stands alone takes its place.
fn first_category(formula: &Formula, atoms: &[Encoding]) -> Option<usize> {
    let mut alone = formula.terms.iter().filter(|term| term.len() == 1);
    alone
        .find(|term| matches!(atoms[term[0]], Encoding::Category { .. }))
        .map(|term| term[0])
}

/// A model matrix.
///
/// * `table`: what terms are evaluated on
/// * `plain`: writes the numbers of a column that is a term by itself
pub(crate) fn matrix(
    frame: &ModelFrame,
    table: &Table,
    plain: impl Fn(&str, &mut [f64]) -> Result<(), Error>,
) -> Result<DMatrix<f64>, Error> {
    let rows = table.rows();
    let mut x = DMatrix::zeros(rows, frame.names.len());
    if frame.intercept {
        x.column_mut(0).fill(1.0);
    }
    for term in &frame.terms {
        if let Some(name) = frame.plain_column(term) {
            plain(name, x.column_mut(term.columns.start).as_mut_slice())?;
            continue;
        }
        let mut columns: Vec<Vec<f64>> = Vec::new();
        for (place, (atom, coding)) in term.atoms.iter().enumerate() {
            let own = frame.atoms[*atom].values(*coding, table)?;
            columns = match place {
                0 => own,
                _ => own
                    .iter()
                    .flat_map(|column| columns.iter().map(|before| multiplied(before, column)))
                    .collect(),
            };
        }
        for (column, values) in term.columns.clone().zip(columns) {
            x.column_mut(column).copy_from_slice(&values);
        }
    }
    let finite = x
        .as_slice()
        .iter()
        .fold(true, |all, own| all & own.is_finite());
    if !finite && let Some(place) = x.iter().position(|value| !value.is_finite()) {
        return Err(Error::NotFinite {
            expression: frame.names[place / rows].clone(),
            value: x[(place % rows, place / rows)],
            row: place % rows + 1,
        });
    }
    Ok(x)
}

fn multiplied(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a * b).collect()
}

impl ModelFrame {
    /// The column of the table that a term is, where it is one.
    fn plain_column(&self, term: &TermColumns) -> Option<&str> {
        match &term.atoms[..] {
            [(atom, _)] => self.atoms[*atom].plain_column(),
            _ => None,
        }
    }

    /// Columns of the table that it is made from.
    pub fn columns(&self) -> Vec<String> {
        self.sources(|_| true)
    }

    /// Columns of the table that terms are evaluated on, other than those that are columns.
    pub(crate) fn evaluated_columns(&self) -> Vec<String> {
        self.sources(|term| self.plain_column(term).is_none())
    }

    fn sources(&self, of: impl Fn(&TermColumns) -> bool) -> Vec<String> {
        let terms = self.terms.iter().filter(|term| of(term));
        let used = terms.flat_map(|term| &term.atoms);
        used.flat_map(|(atom, _)| self.atoms[*atom].sources())
            .collect()
    }

    /// Whether any term holds a category.
    pub fn has_categories(&self) -> bool {
        let used = self.terms.iter().flat_map(|term| &term.atoms);
        let mut atoms = used.map(|(atom, _)| &self.atoms[*atom]);
        atoms.any(|atom| matches!(atom, Encoding::Category { .. }))
    }
}
