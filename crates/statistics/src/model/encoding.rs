//! How an atom of a formula becomes columns of numbers.

use crate::error::Error;
use crate::model::contrast::{Contrast, ContrastMatrix, PolynomialBasis};
use crate::model::expression::{columns_of, values};
use crate::model::formula::Atom;
use crate::model::formula_syntax::{Argument, Kind, Node};
use crate::table::{Categories, Cells, Table};

/// How an atom stands in a term.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coding {
    /// As numbers, or categories by their contrast.
    Contrast,
    /// Categories by a column for each level.
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

pub(crate) fn encoding(atom: &Atom, table: &Table, contrast: Contrast) -> Result<Encoding, Error> {
    let name = atom.name.clone();
    match &atom.node.kind {
        Kind::Name(column) => match &table.column(column)?.cells {
            Cells::Categories(categories) => {
                check_mostly_text(column, categories)?;
                category(name, column, categories, contrast, None)
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
) -> Result<Encoding, Error> {
    // Levels that no row has would be columns of zeros.
    let mut used = vec![false; categories.levels.len()];
    for code in categories.codes.iter().flatten() {
        used[*code] = true;
    }
    let kept: Vec<usize> = (0..used.len()).filter(|level| used[*level]).collect();
    let reference = reference.and_then(|level| kept.iter().position(|k| *k == level));
    let levels: Vec<String> = kept.iter().map(|l| categories.levels[*l].clone()).collect();
    if contrast == Contrast::Polynomial && !categories.ordered && levels.len() > 2 {
        return Err(Error::UnorderedLevels {
            name: column.to_owned(),
            levels: levels.join(","),
        });
    }
    Ok(Encoding::Category {
        name,
        column: column.to_owned(),
        contrast: contrast.matrix(&levels, reference.unwrap_or(0)),
        full: Contrast::Full.matrix(&levels, 0),
        levels,
    })
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
    let categories = table.column(column)?.cells.categories();
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
    category(name, column, &categories, contrast, reference)
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
    /// The column that it is, where nothing is calculated.
    pub(crate) fn plain_column(&self) -> Option<&str> {
        match self {
            Self::Numbers { node, .. } => match &node.kind {
                Kind::Name(name) => Some(name),
                _ => None,
            },
            _ => None,
        }
    }

    /// Columns of the table that it is made from.
    pub(crate) fn sources(&self) -> Vec<String> {
        match self {
            Self::Numbers { node, .. }
            | Self::Polynomial { node, .. }
            | Self::Scaled { node, .. } => columns_of(node),
            Self::Category { column, .. } => vec![column.clone()],
        }
    }

    /// Names of its columns.
    pub(crate) fn columns(&self, coding: Coding) -> Vec<String> {
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

    pub(crate) fn values(&self, coding: Coding, table: &Table) -> Result<Vec<Vec<f64>>, Error> {
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
    let known = |name: &str| levels.iter().position(|level| level == name);
    let unknown = |name: &str, row: usize| Error::UnknownLevel {
        column: column.to_owned(),
        level: name.to_owned(),
        row: row + 1,
        known: levels.join(", "),
    };
    match &table.column(column)?.cells {
        Cells::Categories(own) => {
            let places = own.levels.iter().map(|name| known(name));
            let places: Vec<Option<usize>> = places.collect();
            let place = |(row, code): (usize, &Option<usize>)| {
                let name = code.map_or("", |code| &own.levels[code]);
                let place = code.map_or_else(|| known(""), |code| places[code]);
                place.ok_or_else(|| unknown(name, row))
            };
            own.codes.iter().enumerate().map(place).collect()
        }
        Cells::Numbers(numbers) => {
            let place = |(row, number): (usize, f64)| {
                let name = number.to_string();
                known(&name).ok_or_else(|| unknown(&name, row))
            };
            numbers.iter().enumerate().map(place).collect()
        }
    }
}
