//! Formula and table → columns of numbers.

use crate::error::Error;
use crate::model::contrast::{Contrast, ContrastMatrix, PolynomialBasis};
use crate::model::expression::{columns_of, values};
use crate::model::formula::{Atom, Formula, Term, term_name};
use crate::model::formula_syntax::{Argument, Kind, Node};
use crate::table::{Categories, Cells, Table};
use nalgebra::DMatrix;
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

/// How an atom stands in a term.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coding {
    /// As numbers, or categories by their contrast.
    Contrast,
    /// Categories by a column for each level, since the term without them is
    /// not in the model.
    Full,
}

/// How an atom becomes numbers.
#[derive(Clone, Debug, PartialEq)]
pub enum Encoding {
    /// A calculation.
    Numbers {
        /// How it is written.
        name: String,
        /// The calculation.
        node: Node,
    },
    /// Orthonormal polynomials of a calculation.
    Polynomial {
        /// How it is written.
        name: String,
        /// The calculation.
        node: Node,
        /// The polynomials.
        basis: PolynomialBasis,
    },
    /// A calculation shifted and scaled.
    Scaled {
        /// How it is written.
        name: String,
        /// The calculation.
        node: Node,
        /// What is taken off.
        centre: f64,
        /// What it is divided by.
        scale: f64,
    },
    /// A category.
    Category {
        /// How it is written.
        name: String,
        /// The column.
        column: String,
        /// Its levels.
        levels: Vec<String>,
        /// Its contrasts.
        contrast: ContrastMatrix,
        /// A column for each level.
        full: ContrastMatrix,
    },
}

/// Rows of a model: what is explained, and by what.
#[derive(Clone, Debug, PartialEq)]
pub struct ModelRows {
    /// How columns came about.
    pub frame: ModelFrame,
    /// Model matrix: rows without missing cells, in the order of the table.
    pub x: DMatrix<f64>,
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
    let table = &chosen_rows(table, &kept);
    let y = match &formula.response {
        Some(node) => values(node, table)?,
        None => Vec::new(),
    };
    let atoms = formula.atoms.iter();
    let atoms: Vec<Encoding> = atoms
        .map(|atom| encoding(atom, table, contrast))
        .collect::<Result<_, Error>>()?;
    let frame = frame_of(formula, atoms);
    let x = matrix(&frame, table)?;
    Ok(ModelRows {
        frame,
        x,
        y,
        kept,
        left_out,
    })
}

/// Rows of a table that is to be predicted from.
///
/// # Errors
/// As [`model_rows`]; a level the frame has not seen; a missing cell.
pub fn prediction_rows(frame: &ModelFrame, table: &Table) -> Result<DMatrix<f64>, Error> {
    matrix(frame, table)
}

/// Some rows of a table.
#[must_use]
pub fn chosen_rows(table: &Table, rows: &[usize]) -> Table {
    let mut chosen = table.clone();
    if rows.len() == table.rows() && rows.iter().enumerate().all(|(place, row)| place == *row) {
        return chosen;
    }
    for column in &mut chosen.columns {
        match &mut column.cells {
            Cells::Numbers(numbers) => *numbers = rows.iter().map(|row| numbers[*row]).collect(),
            Cells::Categories(categories) => {
                categories.codes = rows.iter().map(|row| categories.codes[*row]).collect();
            }
        }
    }
    chosen
}

/// Rows without missing cells, and those with and the first column that misses.
pub type Completeness = (Vec<usize>, Vec<(usize, String)>);

/// Rows in which no column of a formula is missing.
///
/// # Errors
/// An unknown column.
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

fn encoding(atom: &Atom, table: &Table, contrast: Contrast) -> Result<Encoding, Error> {
    let name = atom.name.clone();
    match &atom.node.kind {
        Kind::Name(column) => match &table.column(column)?.cells {
            Cells::Categories(categories) => {
                check_mostly_text(column, categories)?;
                Ok(category(name, column, categories, contrast, None))
            }
            Cells::Numbers(_) => Ok(Encoding::Numbers {
                name,
                node: atom.node.clone(),
            }),
        },
        Kind::Call(function, arguments) => match (function.as_str(), &arguments[..]) {
            ("C", [first, options @ ..]) => category_call(name, first, options, table, contrast),
            ("poly", [first, options @ ..]) => polynomial(name, first, options, table),
            ("center" | "scale", [first]) => {
                let numbers = values(&first.value, table)?;
                let mean = numbers.iter().sum::<f64>() / numbers.len() as f64;
                let square: f64 = numbers.iter().map(|x| (x - mean).powi(2)).sum();
                let deviation = (square / (numbers.len().max(2) - 1) as f64).sqrt();
                if deviation == 0.0 && function == "scale" {
                    return Err(Error::Constant { name });
                }
                Ok(Encoding::Scaled {
                    name,
                    node: first.value.clone(),
                    centre: mean,
                    scale: if function == "scale" { deviation } else { 1.0 },
                })
            }
            _ => Ok(Encoding::Numbers {
                name,
                node: atom.node.clone(),
            }),
        },
        _ => Ok(Encoding::Numbers {
            name,
            node: atom.node.clone(),
        }),
    }
}

/// Numbers with a slip among them are no categories.
fn check_mostly_text(column: &str, categories: &Categories) -> Result<(), Error> {
    let is_number = |code: &usize| categories.levels[*code].parse::<f64>().is_ok();
    let codes = categories.codes.iter().enumerate();
    let given: Vec<(usize, usize)> = codes.filter_map(|(row, c)| c.map(|c| (row, c))).collect();
    let numbers = given.iter().filter(|(_, code)| is_number(code)).count();
    let slip = given.iter().find(|(_, code)| !is_number(code));
    match slip.filter(|_| 2 * numbers >= given.len()) {
        None => Ok(()),
        Some((row, code)) => Err(Error::NumbersWithText {
            name: column.to_owned(),
            row: row + 1,
            text: categories.levels[*code].clone(),
        }),
    }
}

fn category(
    name: String,
    column: &str,
    categories: &Categories,
    contrast: Contrast,
    reference: Option<usize>,
) -> Encoding {
    // Levels that no row has would be columns of zeros.
    let used = |level: &usize| categories.codes.contains(&Some(*level));
    let kept: Vec<usize> = (0..categories.levels.len()).filter(used).collect();
    let reference = reference.and_then(|level| kept.iter().position(|k| *k == level));
    let levels: Vec<String> = kept.iter().map(|l| categories.levels[*l].clone()).collect();
    Encoding::Category {
        name,
        column: column.to_owned(),
        contrast: contrast.matrix(&levels, reference.unwrap_or(0)),
        full: Contrast::Full.matrix(&levels, 0),
        levels,
    }
}

fn request(what: &str, problem: &str) -> Error {
    Error::Request {
        what: what.to_owned(),
        problem: problem.to_owned(),
    }
}

/// `C(column, sum, ref = "a")`.
fn category_call(
    name: String,
    first: &Argument,
    options: &[Argument],
    table: &Table,
    contrast: Contrast,
) -> Result<Encoding, Error> {
    let Kind::Name(column) = &first.value.kind else {
        return Err(request(&name, "C( ) takes a column first"));
    };
    let categories = match &table.column(column)?.cells {
        Cells::Categories(categories) => categories.clone(),
        Cells::Numbers(numbers) => {
            let text = |n: &f64| match n.is_nan() {
                true => String::new(),
                false => n.to_string(),
            };
            Categories::of_cells(&numbers.iter().map(text).collect::<Vec<_>>())
        }
    };
    let (mut contrast, mut reference) = (contrast, None);
    for option in options {
        let text = match &option.value.kind {
            Kind::Name(text) | Kind::Text(text) => text.clone(),
            Kind::Number(number) => number.to_string(),
            _ => return Err(request(&name, "options of C( ) are names")),
        };
        if option.name.as_deref() == Some("ref") {
            let found = categories.levels.iter().position(|level| *level == text);
            let known = categories.levels.join(", ");
            let problem = format!("{column} has no level {text:?}; it has {known}");
            reference = Some(found.ok_or_else(|| request(&name, &problem))?);
            continue;
        }
        let known = Contrast::NAMES.iter().find(|(name, _)| *name == text);
        let names = Contrast::NAMES.map(|(name, _)| name).join(", ");
        let problem = format!("there is no contrast {text:?}; there are {names}");
        contrast = known.ok_or_else(|| request(&name, &problem))?.1;
    }
    Ok(category(name, column, &categories, contrast, reference))
}

/// `poly(x, degree)`.
fn polynomial(
    name: String,
    first: &Argument,
    options: &[Argument],
    table: &Table,
) -> Result<Encoding, Error> {
    let degree = match options {
        [
            Argument {
                value:
                    Node {
                        kind: Kind::Number(n),
                        ..
                    },
                ..
            },
        ] if n.fract() == 0.0 && (1.0..=20.0).contains(n) => *n as usize,
        _ => {
            return Err(request(
                &name,
                "poly( ) takes an expression and a degree from 1 to 20; x^2 is the plain square",
            ));
        }
    };
    let points = values(&first.value, table)?;
    let mut distinct = points.clone();
    distinct.sort_by(f64::total_cmp);
    distinct.dedup();
    if distinct.len() <= degree {
        let problem = format!(
            "degree {degree} needs more than the {} different values there are",
            distinct.len()
        );
        return Err(request(&name, &problem));
    }
    Ok(Encoding::Polynomial {
        name,
        node: first.value.clone(),
        basis: PolynomialBasis::new(&points, degree),
    })
}

impl Encoding {
    fn name(&self) -> &str {
        match self {
            Self::Numbers { name, .. }
            | Self::Polynomial { name, .. }
            | Self::Scaled { name, .. }
            | Self::Category { name, .. } => name,
        }
    }

    /// Names of its columns.
    fn columns(&self, coding: Coding) -> Vec<String> {
        match (self, coding) {
            (Self::Numbers { name, .. } | Self::Scaled { name, .. }, _) => vec![name.clone()],
            (Self::Polynomial { name, basis, .. }, _) => (1..=basis.centres.len())
                .map(|power| format!("{name}[{power}]"))
                .collect(),
            (Self::Category { name, contrast, .. }, Coding::Contrast) => {
                in_brackets(name, contrast)
            }
            (Self::Category { name, full, .. }, Coding::Full) => in_brackets(name, full),
        }
    }

    fn values(&self, coding: Coding, table: &Table) -> Result<Vec<Vec<f64>>, Error> {
        match self {
            Self::Numbers { node, .. } => Ok(vec![values(node, table)?]),
            Self::Scaled {
                node,
                centre,
                scale,
                ..
            } => {
                let numbers = values(node, table)?;
                Ok(vec![numbers.iter().map(|x| (x - centre) / scale).collect()])
            }
            Self::Polynomial { node, basis, .. } => {
                let matrix = basis.values(&values(node, table)?);
                let columns = matrix.column_iter();
                Ok(columns.map(|c| c.iter().copied().collect()).collect())
            }
            Self::Category {
                column,
                levels,
                contrast,
                full,
                ..
            } => {
                let codes = codes(table, column, levels)?;
                let matrix = match coding {
                    Coding::Contrast => &contrast.matrix,
                    Coding::Full => &full.matrix,
                };
                let columns = (0..matrix.ncols()).map(|column| {
                    let row = |code: &usize| matrix[(*code, column)];
                    codes.iter().map(row).collect()
                });
                Ok(columns.collect())
            }
        }
    }
}

fn in_brackets(name: &str, contrast: &ContrastMatrix) -> Vec<String> {
    let levels = contrast.names.iter();
    levels.map(|level| format!("{name}[{level}]")).collect()
}

/// Positions of the cells of a column among known levels.
fn codes(table: &Table, column: &str, levels: &[String]) -> Result<Vec<usize>, Error> {
    let name_of = |row: usize| match &table.column(column).map(|c| &c.cells) {
        Ok(Cells::Categories(categories)) => categories.codes[row]
            .map_or("", |code| &categories.levels[code])
            .to_owned(),
        Ok(Cells::Numbers(numbers)) => numbers[row].to_string(),
        Err(_) => String::new(),
    };
    let position = |row: usize| {
        let name = name_of(row);
        let known = levels.iter().position(|level| *level == name);
        known.ok_or_else(|| Error::UnknownLevel {
            column: column.to_owned(),
            level: name,
            row: row + 1,
            known: levels.join(", "),
        })
    };
    table.column(column)?;
    (0..table.rows()).map(position).collect()
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
    #[must_use]
    pub fn has_categories(&self) -> bool {
        let used = self.terms.iter().flat_map(|term| &term.atoms);
        let mut atoms = used.map(|(atom, _)| &self.atoms[*atom]);
        atoms.any(|atom| matches!(atom, Encoding::Category { .. }))
    }

    /// Names of the atoms, in the order of the formula.
    #[must_use]
    pub fn atom_names(&self) -> Vec<&str> {
        self.atoms.iter().map(Encoding::name).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::formula::formula;
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
                column("y", Cells::Numbers(vec![1.0, 2.0, 3.0, 5.0, 8.0, f64::NAN])),
                column("x", Cells::Numbers(vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0])),
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
