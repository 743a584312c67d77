//! Columns of numbers and of categories, read block by block on all cores.
//!
//! A column is one of numbers until a cell is none. What it held before has to be read again as
//! text then, which [`Columns::again`] says.

use crate::error::{Error, Place};
use crate::table::csv::{Form, Open, each_row, next_block};
use crate::table::records::Block;
use crate::table::write::plain_cell;
use foldhash::fast::RandomState;
use rayon::prelude::*;
use std::borrow::Cow;
use std::collections::HashMap;
use windfall_formats::text::number::leading_number;
use windfall_numerics::unit::quantity::LARGEST;
use windfall_statistics::numbers::Numbers;
use windfall_statistics::runs::Runs;
use windfall_statistics::table::{Cells, LevelCodes};

/// Most blocks that are in memory at once.
const MOST_BLOCKS: usize = 16;

/// Column in which windfall says why an impact does not count.
pub const LEFT_OUT_COLUMN: &str = "left_out";
/// Column by which the user leaves a row out.
pub const EXCLUDE_COLUMN: &str = "exclude";
/// Cells of [`EXCLUDE_COLUMN`] that leave nothing out.
const KEPT: [&str; 5] = ["", "0", "no", "false", "n"];

/// Whether a cell of [`EXCLUDE_COLUMN`] leaves its row out.
pub fn excludes(cell: &str) -> bool {
    !KEPT.contains(&cell.trim().to_lowercase().as_str())
}

/// What is to be read of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Reading {
    /// Nothing.
    Nothing,
    /// Numbers, or nothing where it holds text.
    Numbers,
    /// Numbers, or categories where it holds text.
    Anything,
    /// Categories.
    Text,
}

/// How cells are read.
pub(crate) struct Manner<'a> {
    /// Words that stand for a missing value.
    pub(crate) missing: &'a [String],
    /// Whether a comma may be the decimal mark.
    comma: bool,
    /// Whether one of these words is a number.
    numeric_words: bool,
    /// Columns that say which rows count.
    left_out: Option<usize>,
    exclude: Option<usize>,
}

impl<'a> Manner<'a> {
    pub(crate) fn new(form: &Form, missing: &'a [String]) -> Self {
        let comma = form.separator.1 != "commas";
        let place = |name: &str| form.columns.iter().position(|own| own == name);
        let is_number = |word: &String| number(word, comma).is_some();
        Self {
            missing,
            comma,
            numeric_words: missing.iter().any(is_number),
            left_out: place(LEFT_OUT_COLUMN),
            exclude: place(EXCLUDE_COLUMN),
        }
    }

    /// Whether a row counts.
    fn counts(&self, cells: &[Cow<str>]) -> bool {
        let cell = |column: Option<usize>| column.and_then(|column| cells.get(column));
        let blank = cell(self.left_out).is_none_or(|cell| cell.trim().is_empty());
        blank && cell(self.exclude).is_none_or(|cell| !excludes(cell))
    }

    /// Whether a cell is blank or one of the words that stand for a missing value.
    fn is_missing(&self, cell: &str) -> bool {
        cell.is_empty() || self.missing.iter().any(|word| word == cell)
    }

    /// The number in a cell, NaN where it is missing; `None` for text.
    fn number(&self, cell: &str) -> Option<f64> {
        if !self.numeric_words
            && let Some(number) = plain_number(cell)
        {
            return Some(number);
        }
        let cell = plain_cell(cell);
        match self.is_missing(cell) {
            true => Some(f64::NAN),
            false => number(cell, self.comma),
        }
    }
}

/// A number of digits, a point and a sign: nearly all numbers are.
fn plain_number(cell: &str) -> Option<f64> {
    let (number, length) = leading_number(cell.as_bytes(), b'.')?;
    // Letters, of which this bit is set, are left to the standard library, which knows other
    // words for exponents.
    let bits = cell.bytes().fold(0, |bits, byte| bits | byte);
    (length == cell.len() && bits & 0x40 == 0).then_some(number)
}

/// * `comma`: whether a comma may be the decimal mark
fn number(cell: &str, comma: bool) -> Option<f64> {
    if let Ok(number) = cell.parse() {
        return Some(number);
    }
    match comma && cell.matches(',').count() == 1 {
        true => cell.replace(',', ".").parse().ok(),
        false => None,
    }
}

/// Columns as they come.
pub(crate) struct Columns {
    /// Each with its cells.
    pub(crate) cells: Vec<Held>,
    /// Line of each row in the file, from 1.
    pub(crate) lines: Runs,
    /// Rows that do not count.
    pub(crate) left_out: usize,
    /// Columns of numbers that turned out to hold text.
    pub(crate) again: Vec<usize>,
}

/// Cells of a column.
#[derive(Default)]
pub(crate) enum Held {
    /// None are read.
    #[default]
    Nothing,
    /// Numbers so far.
    Numbers {
        numbers: Numbers,
        /// Whether any is not missing.
        given: bool,
        /// Whether text is welcome.
        or_text: bool,
    },
    /// Categories.
    Text(LevelCodes),
}

impl Held {
    /// The cells at the end of the table.
    pub(crate) fn whole(self) -> Option<Cells> {
        match self {
            Self::Nothing => None,
            Self::Numbers { numbers, .. } => Some(Cells::Numbers(numbers)),
            Self::Text(levels) => Some(Cells::Categories(levels.sorted())),
        }
    }
}

/// Reads columns to the end of a table.
///
/// # Errors
/// A row is ragged, text is not UTF-8, a number is infinite or beyond 1e100: the first of these.
pub(crate) fn read_columns(
    open: &mut Open,
    manner: &Manner,
    readings: &[Reading],
) -> Result<Columns, Error> {
    let held = readings.iter().map(|reading| match reading {
        Reading::Nothing => Held::Nothing,
        Reading::Text => Held::Text(LevelCodes::default()),
        Reading::Numbers | Reading::Anything => Held::Numbers {
            numbers: Numbers::default(),
            given: false,
            or_text: *reading == Reading::Anything,
        },
    });
    let mut columns = Columns {
        cells: held.collect(),
        lines: Runs::default(),
        left_out: 0,
        again: Vec::new(),
    };
    let at_once = rayon::current_num_threads().clamp(1, MOST_BLOCKS);
    loop {
        let mut blocks = Vec::with_capacity(at_once);
        while blocks.len() < at_once
            && let Some(block) = next_block(open)?
        {
            blocks.push(block);
        }
        if blocks.is_empty() {
            return Ok(columns);
        }
        let (form, held) = (&open.form, &columns.cells);
        let parts = blocks.par_iter();
        let parts: Vec<Part> = parts.map(|own| part(form, own, manner, held)).collect();
        for (part, block) in parts.into_iter().zip(&blocks) {
            append(&mut columns, part, form, block, manner)?;
        }
    }
}

/// The columns of a block.
struct Part<'a> {
    cells: Vec<PartCells<'a>>,
    lines: Runs,
    left_out: usize,
    /// What ended it before its end.
    fault: Option<Error>,
}

/// The cells of a column in a block.
enum PartCells<'a> {
    /// None are read.
    Nothing,
    /// Numbers, and the first that is infinite or beyond 1e100 with its line.
    Numbers {
        values: Vec<f64>,
        given: bool,
        beyond: Option<(usize, String)>,
    },
    /// The same at the end of the block.
    Whole {
        numbers: Numbers,
        given: bool,
        beyond: Option<(usize, String)>,
    },
    /// A cell is no number, and none are kept.
    Failed,
    /// Categories.
    Text(PartText<'a>),
}

/// Texts of a column in a block.
#[derive(Default)]
struct PartText<'a> {
    known: HashMap<Cow<'a, str>, usize, RandomState>,
    texts: Vec<Cow<'a, str>>,
    codes: Vec<Option<usize>>,
}

impl<'a> PartText<'a> {
    #[expect(
        clippy::ptr_arg,
        reason = "what is borrowed from the block outlives the cell"
    )]
    fn push(&mut self, cell: &Cow<'a, str>, manner: &Manner) {
        let own = match cell {
            Cow::Borrowed(text) => Cow::Borrowed(plain_cell(text)),
            Cow::Owned(text) => Cow::Owned(plain_cell(text).to_owned()),
        };
        let code = (!manner.is_missing(&own)).then(|| match self.known.get(&*own) {
            Some(code) => *code,
            None => {
                self.known.insert(own.clone(), self.texts.len());
                self.texts.push(own);
                self.texts.len() - 1
            }
        });
        self.codes.push(code);
    }
}

fn part<'a>(form: &Form, block: &'a Block, manner: &Manner, held: &[Held]) -> Part<'a> {
    let lines_guess = block.bytes.len() / 64;
    let cells = held.iter().map(|own| match own {
        Held::Nothing => PartCells::Nothing,
        Held::Numbers { .. } => PartCells::Numbers {
            values: Vec::with_capacity(lines_guess),
            given: false,
            beyond: None,
        },
        Held::Text(_) => PartCells::Text(PartText::default()),
    });
    let mut cells: Vec<PartCells> = cells.collect();
    let (mut lines, mut left_out) = (Runs::default(), 0);
    let read = each_row(form, block, |line, row| {
        if !manner.counts(row) {
            left_out += 1;
            return;
        }
        lines.push(line);
        for (own, cell) in cells.iter_mut().zip(row) {
            own.push(line, cell, manner);
        }
    });
    let whole = cells.into_iter().zip(held).enumerate();
    let whole = whole.map(|(column, (own, held))| match (own, held) {
        (
            PartCells::Numbers {
                values,
                given,
                beyond,
            },
            _,
        ) => PartCells::Whole {
            numbers: Numbers::compact(&values),
            given,
            beyond,
        },
        // A column that turned out to hold text is read once more, while the block is here.
        (PartCells::Failed, Held::Numbers { or_text: true, .. }) => {
            PartCells::Text(texts(form, block, manner, column))
        }
        (own, _) => own,
    });
    Part {
        cells: whole.collect(),
        lines,
        left_out,
        fault: read.err(),
    }
}

impl<'a> PartCells<'a> {
    #[inline]
    #[expect(
        clippy::ptr_arg,
        reason = "what is borrowed from the block outlives the cell"
    )]
    fn push(&mut self, line: usize, cell: &Cow<'a, str>, manner: &Manner) {
        match self {
            Self::Nothing | Self::Whole { .. } | Self::Failed => (),
            Self::Text(text) => text.push(cell, manner),
            Self::Numbers {
                values,
                given,
                beyond,
            } => match manner.number(cell) {
                None => *self = Self::Failed,
                Some(value) => {
                    if value.abs() > LARGEST && beyond.is_none() {
                        *beyond = Some((line, plain_cell(cell).to_owned()));
                    }
                    *given |= !value.is_nan();
                    values.push(value);
                }
            },
        }
    }
}

/// The texts of a column in the rows of a block that can be read.
fn texts<'a>(form: &Form, block: &'a Block, manner: &Manner, column: usize) -> PartText<'a> {
    let mut found = PartText::default();
    // What ends the rows is told with the other columns.
    let _ = each_row(form, block, |_, row| {
        if manner.counts(row) {
            found.push(&row[column], manner);
        }
    });
    found
}

/// Appends a block to what was read before it.
fn append(
    columns: &mut Columns,
    part: Part,
    form: &Form,
    block: &Block,
    manner: &Manner,
) -> Result<(), Error> {
    let mut beyond: Option<(usize, usize, String)> = None;
    let own = columns.cells.iter_mut().zip(part.cells).enumerate();
    for (column, (held, cells)) in own {
        match (&mut *held, cells) {
            (
                Held::Numbers { numbers, given, .. },
                PartCells::Whole {
                    numbers: more,
                    given: some,
                    beyond: first,
                },
            ) => {
                numbers.append(&more);
                *given |= some;
                if let Some((line, text)) = first
                    && beyond.as_ref().is_none_or(|own| line < own.0)
                {
                    beyond = Some((line, column, text));
                }
            }
            (Held::Numbers { given: true, .. }, PartCells::Text(_)) => {
                columns.again.push(column);
                *held = Held::Nothing;
            }
            (Held::Numbers { numbers, .. }, PartCells::Text(text)) => {
                let mut levels = LevelCodes::default();
                numbers.iter().for_each(|_| levels.push(None));
                levels.append(&text.texts, &text.codes);
                *held = Held::Text(levels);
            }
            (Held::Text(levels), PartCells::Text(text)) => {
                levels.append(&text.texts, &text.codes);
            }
            // A block before this one, of the same time, was the first to hold text.
            (Held::Text(levels), _) => {
                let text = texts(form, block, manner, column);
                levels.append(&text.texts, &text.codes);
            }
            (Held::Numbers { .. }, _) => *held = Held::Nothing,
            (Held::Nothing, _) => (),
        }
    }
    if let Some((line, column, text)) = beyond {
        return Err(Error::CellNotFinite {
            place: Place::at(&form.path, line),
            column: form.columns[column].clone(),
            text,
        });
    }
    columns.lines.append(&part.lines);
    columns.left_out += part.left_out;
    part.fault.map_or(Ok(()), Err)
}
