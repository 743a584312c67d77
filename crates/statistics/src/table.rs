//! Columns of numbers and of categories.

use crate::error::Error;
use crate::numbers::Numbers;
use foldhash::fast::RandomState;
use std::borrow::Cow;
use std::collections::HashMap;
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
    Numbers(Numbers),
    /// Categories.
    Categories(Categories),
}

/// Cells that name a category each.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Categories {
    /// Names of the levels, the reference first.
    pub levels: Vec<String>,
    /// Level of each row; `None` where a cell is missing.
    pub codes: Vec<Option<usize>>,
    /// Whether the levels have an order of their own: one that was declared, or that of numbers.
    pub ordered: bool,
}

impl Categories {
    /// Categories of cells, levels in the order of numbers where all are numbers,
    /// else of the alphabet; a blank cell is missing.
    pub fn of_cells(cells: &[String]) -> Self {
        let mut found = LevelCodes::default();
        for cell in cells {
            found.push(Some(cell.as_str()).filter(|cell| !cell.is_empty()));
        }
        found.sorted()
    }

    /// The same with the levels in the order that was declared; a number is the level of the
    /// same value, however it is written.
    ///
    /// # Errors
    /// The row, from 1, and the text of the first cell that is none of them.
    pub fn declared(&self, levels: &[String]) -> Result<Self, (usize, String)> {
        let value = |text: &str| text.parse::<f64>().ok();
        let place = |text: &String| {
            let number = value(text);
            let same = |own: &String| number.is_some() && value(own) == number;
            let exact = levels.iter().position(|own| own == text);
            exact.or_else(|| levels.iter().position(same))
        };
        let places: Vec<Option<usize>> = self.levels.iter().map(place).collect();
        let moved = |(row, code): (usize, &Option<usize>)| match code {
            Some(code) => match places[*code] {
                None => Err((row + 1, self.levels[*code].clone())),
                found => Ok(found),
            },
            None => Ok(None),
        };
        let codes = self.codes.iter().enumerate().map(moved);
        Ok(Self {
            levels: levels.to_vec(),
            codes: codes.collect::<Result<_, _>>()?,
            ordered: true,
        })
    }
}

/// Levels as they come, cell by cell.
#[derive(Clone, Debug, Default)]
pub struct LevelCodes {
    known: HashMap<String, usize, RandomState>,
    codes: Vec<Option<usize>>,
}

impl LevelCodes {
    /// Takes the cell of the next row; `None` where it is missing.
    pub fn push(&mut self, cell: Option<&str>) {
        let code = cell.map(|cell| self.code(cell));
        self.codes.push(code);
    }

    /// Takes the cells of the next rows, by the places of their texts among some.
    pub fn append<T: AsRef<str>>(&mut self, texts: &[T], codes: &[Option<usize>]) {
        let known = texts.iter().map(|text| self.code(text.as_ref()));
        let known: Vec<usize> = known.collect();
        let codes = codes.iter().map(|code| code.map(|code| known[code]));
        self.codes.extend(codes);
    }

    fn code(&mut self, cell: &str) -> usize {
        let next = self.known.len();
        match self.known.get(cell) {
            Some(code) => *code,
            None => *self.known.entry(cell.to_owned()).or_insert(next),
        }
    }

    /// Categories with the levels in the order of numbers where all are numbers, else of the
    /// alphabet.
    pub fn sorted(mut self) -> Categories {
        let mut levels: Vec<String> = self.known.keys().cloned().collect();
        levels.sort_unstable();
        let numbers = levels
            .iter()
            .map(|level| Some((level.parse().ok()?, level)));
        let numbers: Option<Vec<(f64, &String)>> = numbers.collect();
        let ordered = numbers.is_some();
        if let Some(mut numbers) = numbers {
            numbers.sort_by(|a, b| a.0.total_cmp(&b.0));
            levels = numbers
                .into_iter()
                .map(|(_, level)| level.clone())
                .collect();
        }
        let mut moved = vec![0; levels.len()];
        for (place, level) in levels.iter().enumerate() {
            moved[self.known[level]] = place;
        }
        for code in self.codes.iter_mut().flatten() {
            *code = moved[*code];
        }
        Categories {
            levels,
            codes: self.codes,
            ordered,
        }
    }
}

impl Cells {
    /// Categories as they are; numbers as categories of equal numbers.
    pub fn categories(&self) -> Categories {
        match self {
            Self::Categories(categories) => categories.clone(),
            Self::Numbers(numbers) => {
                // Zeros of both signs are one level.
                let value = |x: f64| x + 0.0;
                let known = numbers.iter().filter(|x| !x.is_nan());
                let mut known: Vec<f64> = known.map(value).collect();
                known.sort_by(f64::total_cmp);
                known.dedup();
                let place = |x: f64| {
                    known
                        .binary_search_by(|other| other.total_cmp(&value(x)))
                        .ok()
                };
                Categories {
                    codes: numbers.iter().map(place).collect(),
                    levels: known.iter().map(f64::to_string).collect(),
                    ordered: true,
                }
            }
        }
    }

    /// [`Cells::categories`], without a copy where they are some.
    pub fn as_categories(&self) -> Cow<'_, Categories> {
        match self {
            Self::Categories(categories) => Cow::Borrowed(categories),
            Self::Numbers(_) => Cow::Owned(self.categories()),
        }
    }

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

    /// Whether any cell is missing.
    pub fn any_missing(&self) -> bool {
        match self {
            Self::Numbers(numbers) => numbers.any_missing(),
            Self::Categories(categories) => categories.codes.contains(&None),
        }
    }

    /// Whether the cell of a row is missing.
    pub fn is_missing(&self, row: usize) -> bool {
        match self {
            Self::Numbers(numbers) => numbers.at(row).is_nan(),
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
    pub fn numbers(&self, name: &str) -> Result<&Numbers, Error> {
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
        assert!(found.ordered);
        let cells = ["b", "a", "b"].map(str::to_owned);
        let found = Categories::of_cells(&cells);
        assert_eq!(
            (&found.levels[..], found.ordered),
            (&["a".to_owned(), "b".to_owned()][..], false)
        );
        assert_eq!(found.codes, [Some(1), Some(0), Some(1)]);
    }

    #[test]
    fn closed_form_levels_of_numbers() {
        let found = Cells::Numbers(vec![1.0, 0.0, -0.0, f64::NAN].into()).categories();
        assert_eq!(found.levels, ["0", "1"]);
        assert_eq!(found.codes, [Some(1), Some(0), Some(0), None]);
    }

    #[test]
    fn closed_form_declared_levels() {
        let read = |cells: &[Option<&str>], levels: &[&str]| {
            let mut codes = LevelCodes::default();
            cells.iter().for_each(|cell| codes.push(*cell));
            let levels: Vec<String> = levels.iter().map(|level| (*level).to_owned()).collect();
            codes.sorted().declared(&levels)
        };
        let found = read(&[Some("high"), None, Some("low")], &["low", "high"]).unwrap();
        assert_eq!(found.codes, [Some(1), None, Some(0)]);
        let found = read(&[Some("2.0"), Some("2"), Some("10")], &["10", "2"]).unwrap();
        assert_eq!(found.codes, [Some(1), Some(1), Some(0)]);
        let error = read(&[Some("low"), Some("lwo")], &["low"]).unwrap_err();
        assert_eq!(error, (2, "lwo".to_owned()));
    }

    #[test]
    fn rejects_an_unknown_column_with_the_nearest() {
        let table = Table {
            columns: vec![Column {
                name: "velocity".to_owned(),
                cells: Cells::Numbers(vec![1.0].into()),
            }],
        };
        let message = table.column("velocty").unwrap_err().to_string();
        assert!(message.ends_with("did you mean \"velocity\"?"), "{message}");
    }
}
