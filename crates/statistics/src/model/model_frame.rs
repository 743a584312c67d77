//! Formula and table → columns of numbers.

use crate::error::Error;
use crate::model::contrast::Contrast;
use crate::model::encoding::{Coding, Encoding, encoding};
use crate::model::expression::{columns_of, values};
use crate::model::formula::{Formula, Term, term_name};
use crate::model::lost_digits::{LostDigits, lost_digits};
use crate::model::reduced::is_ordinary;
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

/// Rows of a model: what is explained, and by what.
#[derive(Clone, Debug, PartialEq)]
pub struct ModelRows {
    /// How columns came about.
    pub frame: ModelFrame,
    /// Model matrix: rows without missing cells, in the order of the table.
    pub x: DMatrix<f64>,
    /// What rounding took from it; of so few rows that [`reduce_written`] uses it.
    ///
    /// [`reduce_written`]: crate::model::reduced::reduce_written
    pub lost: LostDigits,
    /// The response in these rows; empty if there is none.
    pub y: Vec<f64>,
    /// Rows of the table that are here, from 0.
    pub kept: Vec<usize>,
    /// Rows with missing cells, which were left out, and the first missing column.
    pub left_out: Vec<(usize, String)>,
}

/// Evaluates a formula on a table.
///
/// * `contrast`: of categories that name none themselves
/// * `also`: other columns that must not be missing
///
/// # Errors
/// Unknown columns and functions, text in a column of numbers, undefined values.
pub fn model_rows(
    formula: &Formula,
    table: &Table,
    contrast: Contrast,
    also: &[String],
) -> Result<ModelRows, Error> {
    let (kept, left_out) = complete_rows(formula, table, also)?;
    if kept.is_empty() {
        return Err(Error::TooFewRows {
            rows: 0,
            terms: formula.terms.len() + usize::from(formula.intercept),
        });
    }
    let table = &*chosen_rows(table, &kept);
    let told = |error: Error| error.of_rows(&kept);
    let y = match &formula.response {
        Some(node) => values(node, table).map_err(told)?,
        None => Vec::new(),
    };
    let atoms = formula.atoms.iter();
    let atoms: Vec<Encoding> = atoms
        .map(|atom| encoding(atom, table, contrast))
        .collect::<Result<_, Error>>()
        .map_err(told)?;
    let frame = frame_of(formula, atoms);
    let x = matrix(&frame, table).map_err(told)?;
    let lost = match is_ordinary(&x) {
        true => lost(&frame, table, &x),
        false => Vec::new(),
    };
    Ok(ModelRows {
        frame,
        x,
        lost,
        y,
        kept,
        left_out,
    })
}

/// What rounding took from the columns of a model matrix.
fn lost(frame: &ModelFrame, table: &Table, x: &DMatrix<f64>) -> LostDigits {
    let lost = frame.terms.iter().filter_map(|term| {
        let (column, rows) = (term.columns.start, x.nrows());
        let atoms = term.atoms.iter().map(|(atom, _)| &frame.atoms[*atom]);
        let rounded = x.as_slice().get(column * rows..(column + 1) * rows)?;
        Some((column, lost_digits(atoms, table, rounded)?))
    });
    lost.collect()
}

/// Model matrix of other rows; errors as in [`model_rows`], and for new levels.
pub fn prediction_rows(frame: &ModelFrame, table: &Table) -> Result<DMatrix<f64>, Error> {
    matrix(frame, table)
}

/// Some rows of a table, in their order; the table itself where these are all.
pub fn chosen_rows<'a>(table: &'a Table, rows: &[usize]) -> Cow<'a, Table> {
    if rows.len() == table.rows() && rows.iter().enumerate().all(|(place, row)| place == *row) {
        return Cow::Borrowed(table);
    }
    let mut chosen = table.clone();
    for column in &mut chosen.columns {
        match &mut column.cells {
            Cells::Numbers(numbers) => *numbers = rows.iter().map(|row| numbers.at(*row)).collect(),
            Cells::Categories(categories) => {
                categories.codes = rows.iter().map(|row| categories.codes[*row]).collect();
            }
        }
    }
    Cow::Owned(chosen)
}

/// Rows without missing cells, and those with and the first column that misses.
pub type Completeness = (Vec<usize>, Vec<(usize, String)>);

/// Rows in which no column of a formula is missing.
pub fn complete_rows(
    formula: &Formula,
    table: &Table,
    also: &[String],
) -> Result<Completeness, Error> {
    let mut names: Vec<String> = Vec::new();
    let nodes = formula.response.iter();
    let used = formula.terms.iter().flatten();
    let random = formula.random.iter().flat_map(|part| &part.terms).flatten();
    let atoms = used.chain(random).map(|atom| &formula.atoms[*atom].node);
    let groups = formula.random.iter().flat_map(|part| &part.groups);
    let columns = nodes.chain(atoms).flat_map(columns_of);
    for name in columns.chain(groups.cloned()).chain(also.iter().cloned()) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    rows_with_all(table, &names)
}

/// Rows in which none of these columns is missing.
pub fn rows_with_all(table: &Table, names: &[String]) -> Result<Completeness, Error> {
    let columns = names.iter().map(|name| table.column(name));
    let columns: Vec<_> = columns.collect::<Result<_, _>>()?;
    let (mut kept, mut left_out) = (Vec::new(), Vec::new());
    for row in 0..table.rows() {
        match columns.iter().find(|column| column.cells.is_missing(row)) {
            None => kept.push(row),
            Some(column) => left_out.push((row, column.name.clone())),
        }
    }
    Ok((kept, left_out))
}

fn frame_of(formula: &Formula, atoms: Vec<Encoding>) -> ModelFrame {
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

fn matrix(frame: &ModelFrame, table: &Table) -> Result<DMatrix<f64>, Error> {
    let rows = table.rows();
    let mut x = DMatrix::zeros(rows, frame.names.len());
    if frame.intercept {
        x.column_mut(0).fill(1.0);
    }
    for term in &frame.terms {
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
    if let Some(place) = x.iter().position(|value| !value.is_finite()) {
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
    /// Whether any term holds a category.
    pub fn has_categories(&self) -> bool {
        let used = self.terms.iter().flat_map(|term| &term.atoms);
        let mut atoms = used.map(|(atom, _)| &self.atoms[*atom]);
        atoms.any(|atom| matches!(atom, Encoding::Category { .. }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::formula::formula;
    use crate::table::Categories;
    use crate::table::Column;

    fn table() -> Table {
        let text = ["a", "b", "c", "a", "b", "c"].map(str::to_owned);
        let other = ["u", "u", "u", "v", "v", "v"].map(str::to_owned);
        let column = |name: &str, cells| Column {
            name: name.to_owned(),
            cells,
        };
        Table {
            columns: vec![
                column(
                    "y",
                    Cells::Numbers(vec![1.0, 2.0, 3.0, 5.0, 8.0, f64::NAN].into()),
                ),
                column(
                    "x",
                    Cells::Numbers(vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0].into()),
                ),
                column("f", Cells::Categories(Categories::of_cells(&text))),
                column("g", Cells::Categories(Categories::of_cells(&other))),
            ],
        }
    }

    fn names(text: &str) -> Vec<String> {
        let formula = formula(text, &[]).unwrap();
        let rows = model_rows(&formula, &table(), Contrast::Treatment, &[]).unwrap();
        rows.frame.names
    }

    /// Columns of R's model.matrix for the same formulas.
    #[test]
    fn reference_columns() {
        for (text, expected) in [
            ("~ f", "(Intercept) f[b] f[c]"),
            ("~ 0 + f", "f[a] f[b] f[c]"),
            ("~ 0 + f + g", "f[a] f[b] f[c] g[v]"),
            (
                "~ f:g",
                "(Intercept) f[a]:g[u] f[b]:g[u] f[c]:g[u] f[a]:g[v] f[b]:g[v] f[c]:g[v]",
            ),
            ("~ f*x", "(Intercept) f[b] f[c] x f[b]:x f[c]:x"),
            ("~ x:f", "(Intercept) x:f[a] x:f[b] x:f[c]"),
            (
                "~ f + f:g",
                "(Intercept) f[b] f[c] f[a]:g[v] f[b]:g[v] f[c]:g[v]",
            ),
            ("~ C(f, sum)", "(Intercept) C(f, sum)[a] C(f, sum)[b]"),
            (
                "~ C(f, ref = c)",
                "(Intercept) C(f, ref = c)[a] C(f, ref = c)[b]",
            ),
            (
                "~ x^2 + poly(x, 2)",
                "(Intercept) x^2 poly(x, 2)[1] poly(x, 2)[2]",
            ),
        ] {
            let names = names(text).join(" ");
            assert_eq!(names, expected, "{text}");
        }
    }

    #[test]
    fn closed_form_rows_with_missing_cells_are_left_out_and_named() {
        let formula = formula("y ~ x^2", &[]).unwrap();
        let rows = model_rows(&formula, &table(), Contrast::Treatment, &[]).unwrap();
        assert_eq!(rows.left_out, [(5, "y".to_owned())]);
        assert_eq!(rows.x.column(1).as_slice(), [1.0, 4.0, 9.0, 16.0, 25.0]);
    }

    #[test]
    fn rejects_unknown_levels_columns_and_text() {
        let formula_f = formula("y ~ f", &[]).unwrap();
        let rows = model_rows(&formula_f, &table(), Contrast::Treatment, &[]).unwrap();
        let mut other = table();
        other.columns[2].cells = Cells::Categories(Categories::of_cells(
            &["a", "b", "d", "a", "a", "a"].map(str::to_owned),
        ));
        let error = prediction_rows(&rows.frame, &other)
            .unwrap_err()
            .to_string();
        assert!(error.contains("\"d\" in row 3"), "{error}");
        for text in [
            "y ~ z",
            "f ~ x",
            "y ~ log(f)",
            "y ~ poly(x, 9)",
            "y ~ C(f, some)",
        ] {
            let formula = formula(text, &[]).unwrap();
            assert!(
                model_rows(&formula, &table(), Contrast::Treatment, &[]).is_err(),
                "{text}"
            );
        }
    }
}
