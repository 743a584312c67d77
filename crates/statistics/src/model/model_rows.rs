//! Formula and table → rows of a model.

use crate::error::Error;
use crate::model::contrast::Contrast;
use crate::model::encoding::{Encoding, encoding};
use crate::model::expression::{columns_of, values};
use crate::model::formula::Formula;
use crate::model::lost_digits::{LostDigits, lost_digits};
use crate::model::model_frame::{ModelFrame, chosen_rows, frame_of, prediction_rows};
use crate::model::model_matrix::ModelMatrix;
use crate::model::reduced::{Reduced, is_ordinary, reduce_evaluated, reduce_written};
use crate::runs::Runs;
use crate::table::Table;
use nalgebra::DMatrix;
use std::borrow::Cow;
use windfall_mixed::weights::Weights;

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

/// Rows of a model whose matrix is held only where it is small.
#[derive(Clone, Debug, PartialEq)]
pub struct FormulaRows<'a> {
    /// How columns came about.
    pub frame: ModelFrame,
    /// The response in these rows; empty if there is none.
    pub y: Vec<f64>,
    /// Rows of the table that are here, from 0.
    pub kept: Runs,
    /// Rows with missing cells, which were left out, and the first missing column.
    pub left_out: Vec<(usize, String)>,
    /// What the rows weigh.
    pub weights: Weights,
    table: &'a Table,
    held: Option<(DMatrix<f64>, LostDigits)>,
}

impl FormulaRows<'_> {
    /// The model matrix.
    pub fn x(&self) -> ModelMatrix<'_> {
        match &self.held {
            Some((x, _)) => ModelMatrix::Held(x),
            None => ModelMatrix::Evaluated {
                frame: &self.frame,
                table: self.table,
                kept: &self.kept,
            },
        }
    }

    /// The triangle of the weighted rows.
    ///
    /// # Errors
    /// Undefined values, with the row of the table.
    pub fn reduced(&self) -> Result<Reduced, Error> {
        let y = self.weights.weigh(&self.y);
        match &self.held {
            Some((x, lost)) if self.weights.is_empty() => Ok(reduce_written(x, lost, &y)),
            Some((x, lost)) => {
                let (x, lost) = self.weights.weigh_precisely(x, lost);
                Ok(reduce_written(&x, &lost, &y))
            }
            None => {
                let x = self.x();
                let reduced = reduce_evaluated(&x.weighted(&self.weights), &y);
                reduced.map_err(|error| error.of_rows(|row| self.kept.get(row)))
            }
        }
    }
}

/// Evaluates a formula on a table.
///
/// * `contrast`: of categories that name none themselves
/// * `also`: other columns that must not be missing
///
/// # Errors
/// Unknown columns and functions, text in a column of numbers, undefined values.
pub fn formula_rows<'a>(
    formula: &Formula,
    table: &'a Table,
    contrast: Contrast,
    also: &[String],
) -> Result<FormulaRows<'a>, Error> {
    let (kept, left_out) = complete(table, &names_of(formula, also))?;
    if kept.is_empty() {
        return Err(Error::TooFewRows {
            rows: 0,
            terms: formula.terms.len() + usize::from(formula.intercept),
        });
    }
    let told = |error: Error| error.of_rows(|row| kept.get(row));
    let chosen = match left_out.is_empty() {
        true => Cow::Borrowed(table),
        false => chosen_rows(table, &kept.iter().collect::<Vec<_>>()),
    };
    let y = match &formula.response {
        Some(node) => values(node, &chosen).map_err(told)?,
        None => Vec::new(),
    };
    let atoms = formula.atoms.iter();
    let atoms: Vec<Encoding> = atoms
        .map(|atom| encoding(atom, &chosen, contrast))
        .collect::<Result<_, Error>>()
        .map_err(told)?;
    let frame = frame_of(formula, atoms);
    let held = match is_ordinary(kept.len(), frame.names.len()) {
        true => {
            let x = prediction_rows(&frame, &chosen).map_err(told)?;
            let lost = lost(&frame, &chosen, &x);
            Some((x, lost))
        }
        false => None,
    };
    Ok(FormulaRows {
        frame,
        y,
        kept,
        left_out,
        weights: Weights::default(),
        table,
        held,
    })
}

/// [`formula_rows`] with the whole model matrix.
///
/// # Errors
/// As [`formula_rows`].
pub fn model_rows(
    formula: &Formula,
    table: &Table,
    contrast: Contrast,
    also: &[String],
) -> Result<ModelRows, Error> {
    let mut rows = formula_rows(formula, table, contrast, also)?;
    let (x, lost) = match rows.held.take() {
        Some(held) => held,
        None => {
            let x = rows.x().whole().map(Cow::into_owned);
            let told = |error: Error| error.of_rows(|row| rows.kept.get(row));
            (x.map_err(told)?, Vec::new())
        }
    };
    Ok(ModelRows {
        x,
        lost,
        frame: rows.frame,
        y: rows.y,
        kept: rows.kept.iter().collect(),
        left_out: rows.left_out,
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

/// Rows without missing cells, and those with and the first column that misses.
pub type Completeness = (Vec<usize>, Vec<(usize, String)>);

/// Rows in which no column of a formula is missing.
pub fn complete_rows(
    formula: &Formula,
    table: &Table,
    also: &[String],
) -> Result<Completeness, Error> {
    rows_with_all(table, &names_of(formula, also))
}

/// Columns of the table that a formula names, and others, each once.
pub fn names_of(formula: &Formula, also: &[String]) -> Vec<String> {
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
    names
}

/// Rows in which none of these columns is missing.
pub fn rows_with_all(table: &Table, names: &[String]) -> Result<Completeness, Error> {
    let (kept, left_out) = complete(table, names)?;
    Ok((kept.iter().collect(), left_out))
}

fn complete(table: &Table, names: &[String]) -> Result<(Runs, Vec<(usize, String)>), Error> {
    let columns = names.iter().map(|name| table.column(name));
    let mut columns: Vec<_> = columns.collect::<Result<_, _>>()?;
    columns.retain(|column| column.cells.any_missing());
    let (mut kept, mut left_out) = (Runs::default(), Vec::new());
    for row in 0..table.rows() {
        match columns.iter().find(|column| column.cells.is_missing(row)) {
            None => kept.push(row),
            Some(column) => left_out.push((row, column.name.clone())),
        }
    }
    Ok((kept, left_out))
}

/// Weights in a column of a table, of the rows `kept`.
///
/// # Errors
/// No such column, text in it, and weights that are not positive or infinite, with the row.
pub fn column_weights(
    table: &Table,
    name: &str,
    kept: impl Iterator<Item = usize>,
) -> Result<Weights, Error> {
    let values = table.numbers(name)?.values();
    let weight = |row: usize| match values[row] {
        weight if weight > 0.0 && weight.is_finite() => Ok(weight),
        weight => Err(Error::Weight {
            name: name.to_owned(),
            weight,
            row: row + 1,
        }),
    };
    let weights: Vec<f64> = kept.map(weight).collect::<Result<_, _>>()?;
    Ok(Weights::of(weights.into_iter()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::formula::formula;
    use crate::table::{Categories, Cells, Column};

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
