//! How a table is read: what stands for a missing value, which order levels have.

use crate::design::file::read_coding;
#[cfg(feature = "clap")]
use crate::option_words::trimmed;
use std::path::Path;
use windfall_files::error::{Error, Place};
use windfall_files::option_value::{parts, plain_name, unusable};
use windfall_files::table::data::{Data, DataFile, MISSING, Wanted, open_data};
use windfall_statistics::table::Cells;

/// How a table is read.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct ReadingOptions {
    /// Words that stand for a missing value, separated by commas; a blank cell always does
    #[cfg_attr(feature = "clap", arg(long = "missing", value_name = "WORDS", value_delimiter = ',', value_parser = trimmed, default_value = MISSING))]
    pub missing: Vec<String>,
    /// The levels of a column in their order, the reference first: 'dose=low,medium,high'; may be
    /// repeated; a level with a comma stands in backticks; as the header of a design says if left out
    #[cfg_attr(feature = "clap", arg(long = "levels", value_name = "COLUMN=LEVEL,…"))]
    pub levels: Vec<String>,
}

impl Default for ReadingOptions {
    fn default() -> Self {
        Self {
            missing: vec![MISSING.to_owned()],
            levels: Vec::new(),
        }
    }
}

impl ReadingOptions {
    /// Reads a table.
    ///
    /// # Errors
    /// It cannot be read; a column whose levels are declared is not there, has another level, or
    /// lacks one.
    pub fn read(&self, path: &Path) -> Result<Data, Error> {
        self.read_some(open_data(path)?, Wanted::all())
    }

    /// Reads some columns of a table, and those whose levels are declared.
    ///
    /// # Errors
    /// As [`ReadingOptions::read`].
    pub fn read_some(&self, file: DataFile, mut wanted: Wanted) -> Result<Data, Error> {
        for text in &self.levels {
            wanted.named.push(declared(text)?.0);
        }
        let mut data = file.read(&self.missing, &wanted)?;
        // A header that cannot be read, or a design of which only some levels were run, leaves
        // the levels in the order of the alphabet.
        let factors = read_coding(&data.comments).ok().flatten();
        for factor in factors.into_iter().flatten() {
            let _ = declare(&mut data, &factor.name, &factor.categories);
        }
        for text in &self.levels {
            let (column, levels) = declared(text)?;
            declare(&mut data, &column, &levels)?;
        }
        Ok(data)
    }
}

/// `COLUMN=LEVEL,LEVEL`.
fn declared(text: &str) -> Result<(String, Vec<String>), Error> {
    let wrong = |problem: &str| unusable(format!("--levels '{text}'"), problem);
    let column = parts(text, '=').next().unwrap_or_default();
    let levels = text[column.len()..]
        .strip_prefix('=')
        .ok_or_else(|| wrong("expected a column and its levels: dose=low,medium,high"))?;
    let levels: Vec<String> = parts(levels, ',').map(plain_name).collect();
    if levels.len() < 2 || levels.iter().any(String::is_empty) {
        return Err(wrong("expected two levels or more, separated by commas"));
    }
    if let Some(place) = (1..levels.len()).find(|place| levels[..*place].contains(&levels[*place]))
    {
        return Err(wrong(&format!("\"{}\" stands there twice", levels[place])));
    }
    Ok((plain_name(column), levels))
}

/// Gives the levels of a column the order that was declared.
fn declare(data: &mut Data, name: &str, levels: &[String]) -> Result<(), Error> {
    if levels.is_empty() {
        return Ok(());
    }
    let column = data.table.column(name).map_err(|error| data.told(error))?;
    let found = column.cells.categories().declared(levels);
    let found = found.map_err(|(row, text)| Error::Refused {
        place: Place::at(&data.path, data.line(row - 1)),
        problem: format!(
            "\"{text}\" is none of the levels declared for {name:?}: {}; correct the cell, or \
             declare this level too",
            levels.join(", ")
        ),
    })?;
    let occurs = |place: usize| found.codes.contains(&Some(place));
    if let Some(absent) = (0..levels.len()).find(|place| !occurs(*place)) {
        let problem = format!(
            "no row of {} has the level \"{}\"; take it out, or see how it is written",
            data.path.display(),
            levels[absent]
        );
        return Err(unusable(format!("--levels {name}"), problem));
    }
    for column in &mut data.table.columns {
        if column.name == name {
            column.cells = Cells::Categories(found);
            return Ok(());
        }
    }
    Ok(())
}
