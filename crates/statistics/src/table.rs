//! Columns of numbers and of categories.

use crate::error::Error;
use windfall_numerics::unit::nearest_name::nearest_names;

/// Columns of one length.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// The columns, in the order of the file.
    pub columns: Vec<Column>,
}

/// One column.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Its name; no two columns of a table share one.
    pub name: String,
    /// What it holds.
    pub cells: Cells,
}

/// The cells of a column.
#[derive(Clone, Debug, PartialEq)]
pub enum Cells {
    /// Numbers; NaN where a cell is missing.
    Numbers(Vec<f64>),
    /// Categories.
    Categories(Categories),
}

/// Cells that name a category each.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Categories {
    /// Names of the levels.
    pub levels: Vec<String>,
    /// Level of each row; `None` where a cell is missing.
    pub codes: Vec<Option<usize>>,
}

impl Categories {
    /// Categories of cells, levels in the order of numbers where all are numbers,
    /// else of the alphabet; a blank cell is missing.
    pub fn of_cells(cells: &[String]) -> Self {
        let mut levels: Vec<String> = cells.iter().filter(|c| !c.is_empty()).cloned().collect();
        levels.sort_unstable();
        levels.dedup();
        let numbers: Option<Vec<f64>> = levels.iter().map(|level| level.parse().ok()).collect();
        if let Some(numbers) = numbers {
            let mut order: Vec<usize> = (0..levels.len()).collect();
            order.sort_by(|a, b| numbers[*a].total_cmp(&numbers[*b]));
            levels = order.iter().map(|place| levels[*place].clone()).collect();
        }
        let codes = cells
            .iter()
            .map(|cell| levels.iter().position(|level| level == cell))
            .collect();
        Self { levels, codes }
    }
}

impl Cells {
    /// Number of rows.
    pub fn len(&self) -> usize {
        match self {
            Self::Numbers(numbers) => numbers.len(),
            Self::Categories(categories) => categories.codes.len(),
        }
    }

    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether the cell of a row is missing.
    pub fn is_missing(&self, row: usize) -> bool {
        match self {
            Self::Numbers(numbers) => numbers[row].is_nan(),
            Self::Categories(categories) => categories.codes[row].is_none(),
        }
    }
}

impl Table {
    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.columns.first().map_or(0, |column| column.cells.len())
    }

    /// A column by its name.
    ///
    /// # Errors
    /// [`Error::UnknownColumn`] with the nearest name.
    pub fn column(&self, name: &str) -> Result<&Column, Error> {
        let found = self.columns.iter().find(|column| column.name == name);
        found.ok_or_else(|| {
            let names: Vec<&str> = self.columns.iter().map(|c| c.name.as_str()).collect();
            Error::UnknownColumn {
                name: name.to_owned(),
                known: names.join(", "),
                suggestion: nearest_names(name, names.iter().copied())
                    .first()
                    .map(|name| (*name).to_owned()),
            }
        })
    }

    /// The numbers of a column.
    ///
    /// # Errors
    /// [`Error::UnknownColumn`]; [`Error::NotNumbers`] with the first cell.
    pub fn numbers(&self, name: &str) -> Result<&[f64], Error> {
        match &self.column(name)?.cells {
            Cells::Numbers(numbers) => Ok(numbers),
            Cells::Categories(categories) => {
                let text = |code: &Option<usize>| code.map(|code| &categories.levels[code]);
                let is_text = |code: &Option<usize>| {
                    text(code).is_some_and(|level| level.parse::<f64>().is_err())
                };
                let row = categories
                    .codes
                    .iter()
                    .position(is_text)
                    .unwrap_or_default();
                let code = categories.codes.get(row).copied().flatten();
                Err(Error::NotNumbers {
                    name: name.to_owned(),
                    row: row + 1,
                    text: code.map_or_else(String::new, |code| categories.levels[code].clone()),
                })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_levels_in_order_and_missing_cells() {
        let cells = ["10", "9", "", "9"].map(str::to_owned);
        let found = Categories::of_cells(&cells);
        assert_eq!(found.levels, ["9", "10"]);
        assert_eq!(found.codes, [Some(1), Some(0), None, Some(0)]);
    }

    #[test]
    fn rejects_an_unknown_column_with_the_nearest() {
        let table = Table {
            columns: vec![Column {
                name: "velocity".to_owned(),
                cells: Cells::Numbers(vec![1.0]),
            }],
        };
        let message = table.column("velocty").unwrap_err().to_string();
        assert!(message.ends_with("did you mean \"velocity\"?"), "{message}");
    }
}
