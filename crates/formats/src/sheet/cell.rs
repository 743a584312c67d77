//! Cells of a sheet.

use windfall_source::error::{Error, Place};
use windfall_source::source::Source;

/// Most rows and columns of a sheet, in every program.
const MOST_ROWS: u64 = 1 << 20;
const MOST_COLUMNS: u64 = 1 << 14;

/// What stands in a cell.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    Number(f64),
    Text(Box<str>),
    /// Date and time; days since 1899-12-30.
    Date(f64),
    /// Time of day, or a time that has passed; s.
    Clock(f64),
}

/// A cell that is not blank.
#[derive(Clone, Debug, PartialEq)]
pub struct Placed {
    /// Row, from 0.
    pub row: u32,
    /// Column, from 0.
    pub column: u32,
    pub cell: Cell,
}

/// A sheet: its cells by rows, then columns.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sheet {
    pub name: String,
    pub cells: Vec<Placed>,
}

impl Sheet {
    /// Adds a cell, wherever it stands.
    ///
    /// # Errors
    /// It stands beyond the last row or column that a sheet can have.
    pub fn push(
        &mut self,
        source: &Source,
        row: u64,
        column: u64,
        cell: Cell,
    ) -> Result<(), Error> {
        if row >= MOST_ROWS || column >= MOST_COLUMNS {
            return Err(source.malformed(
                Place::Object(self.name.clone()),
                format!("a cell is in row {} and column {}", row + 1, column + 1),
                "no sheet is so large: the file is damaged; save it again",
            ));
        }
        let (row, column) = (row as u32, column as u32);
        self.cells.push(Placed { row, column, cell });
        Ok(())
    }

    /// Puts the cells in order; of two in one place the later one stays.
    pub fn order(&mut self) {
        let place = |placed: &Placed| (placed.row, placed.column);
        if !self.cells.is_sorted_by(|a, b| place(a) < place(b)) {
            self.cells.sort_by_key(place);
            self.cells.reverse();
            self.cells.dedup_by_key(|placed| place(placed));
            self.cells.reverse();
        }
    }
}

/// Seconds of a duration of ISO 8601 with hours, minutes and seconds: "PT20H39M53.123S".
pub fn duration(text: &str) -> Option<f64> {
    let mut rest = text.strip_prefix("PT")?;
    let mut seconds = 0.0;
    for (mark, factor) in [('H', 3600.0), ('M', 60.0), ('S', 1.0)] {
        if let Some((number, after)) = rest.split_once(mark) {
            seconds += factor * number.replace(',', ".").parse::<f64>().ok()?;
            rest = after;
        }
    }
    (rest.is_empty() && seconds.is_finite() && seconds >= 0.0).then_some(seconds)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_durations() {
        assert_eq!(duration("PT20H39M53.25S"), Some(74393.25));
        assert_eq!(duration("PT0S"), Some(0.0));
        for text in ["", "P1D", "PT1X", "PTaS", "PT-1S", "PT1S2"] {
            assert_eq!(duration(text), None, "{text}");
        }
    }

    #[test]
    fn closed_form_cells_are_put_in_order() {
        let source = Source::from_bytes("b.xlsx", Vec::new());
        let mut sheet = Sheet::default();
        for (row, column, value) in [(1, 0, 1.0), (0, 1, 2.0), (1, 0, 3.0), (0, 0, 4.0)] {
            sheet
                .push(&source, row, column, Cell::Number(value))
                .unwrap();
        }
        sheet.order();
        let found: Vec<(u32, u32, Cell)> = sheet
            .cells
            .iter()
            .map(|p| (p.row, p.column, p.cell.clone()))
            .collect();
        let number = Cell::Number;
        assert_eq!(
            found,
            [
                (0, 0, number(4.0)),
                (0, 1, number(2.0)),
                (1, 0, number(3.0))
            ]
        );
        assert!(sheet.push(&source, 1 << 20, 0, Cell::Number(0.0)).is_err());
        assert!(sheet.push(&source, 0, 1 << 14, Cell::Number(0.0)).is_err());
    }
}
