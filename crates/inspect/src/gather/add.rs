//! `windfall add`: further recordings of a campaign.

use crate::gather::names::{NamePattern, NamedRecording};
use crate::gather::new::{files_in, name_of};
use itertools::Itertools;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use windfall_campaign::recording::digests::campaign_text;
use windfall_campaign::settings::edit_table::add_rows;
use windfall_campaign::settings::template::is_template_file;
use windfall_files::confined::Arriving;
use windfall_files::error::Error;
use windfall_files::inputs::check_regular;
use windfall_files::option_value::unusable;
use windfall_files::table::csv::{Table, column_index, read_table};
use windfall_files::write_file::edit_file;

/// Bytes that are copied at once.
const CHUNK: usize = 1 << 20;

/// Recordings that were added.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Added {
    /// Ids of the new impacts.
    pub impacts: Vec<String>,
    /// Ids of specimens that were not known.
    pub specimens: Vec<String>,
    /// Files that were left out, and why.
    pub left_out: Vec<String>,
}

/// Lists further recordings in impacts.csv, and their specimens in specimens.csv.
///
/// * `files`: recordings that are copied into raw/; none for those that lie there and are not
///   listed yet
/// * `names`: pattern of their names, in place of `[files] names`
///
/// # Errors
/// The campaign's tables cannot be read or written, or the pattern is wrong.
pub fn add_recordings(
    directory: &Path,
    files: &[PathBuf],
    names: Option<&str>,
) -> Result<Added, Error> {
    let text = campaign_text(directory)?;
    let settings: toml::Table = toml::from_str(&text).unwrap_or_default();
    let of_files = |key: &str| settings.get("files")?.get(key)?.as_str();
    if of_files("directory").is_some_and(|own| own != "raw") {
        let problem = "recordings are added to the directory raw, and [files] directory is another";
        return Err(unusable("windfall add", problem));
    }
    let pattern = names
        .or(of_files("names"))
        .map(NamePattern::parse)
        .transpose()?;
    let impacts = directory.join("impacts.csv");
    let table = read_table(&impacts)?;
    let listed: BTreeSet<String> = match is_template_file(&impacts) {
        true => BTreeSet::new(),
        false => column(&table, "file")?,
    };
    let mut added = Added::default();
    let new = match files.is_empty() {
        true => files_in(&directory.join("raw"))?
            .iter()
            .map(|file| name_of(file))
            .collect(),
        false => copied(directory, files, &mut added),
    };
    let mut rows = Vec::new();
    for name in new {
        if listed.contains(&name) {
            continue;
        }
        let read = match &pattern {
            None => Some(own_specimen(&name)),
            Some(pattern) => pattern.read(&name),
        };
        match read {
            Some(read) => rows.push((name, read)),
            None => added
                .left_out
                .push(format!("{name}: not of the pattern of names")),
        }
    }
    if rows.is_empty() {
        return Ok(added);
    }
    // Specimens first: stopped in between, the campaign still knows all that it names.
    let specimens = directory.join("specimens.csv");
    if specimens.exists() {
        let known = match is_template_file(&specimens) {
            true => BTreeSet::new(),
            false => column(&read_table(&specimens)?, "id")?,
        };
        let new = rows
            .iter()
            .map(|(_, read)| read)
            .unique_by(|read| &read.specimen);
        let new: Vec<&NamedRecording> =
            new.filter(|read| !known.contains(&read.specimen)).collect();
        let cells = new
            .iter()
            .map(|read| row(&[("id", &read.specimen)], &read.of_specimen));
        let cells: Vec<BTreeMap<String, String>> = cells.collect();
        if !cells.is_empty() {
            edit_file(&specimens, &add_rows(&specimens, &cells)?)?;
        }
        added
            .specimens
            .extend(new.iter().map(|read| read.specimen.clone()));
    }
    let cells = rows.iter().map(|(name, read)| {
        let own = [
            ("id", &read.id),
            ("specimen", &read.specimen),
            ("file", name),
        ];
        row(&own, &read.of_impact)
    });
    let cells: Vec<BTreeMap<String, String>> = cells.collect();
    edit_file(&impacts, &add_rows(&impacts, &cells)?)?;
    added
        .impacts
        .extend(rows.into_iter().map(|(_, read)| read.id));
    Ok(added)
}

/// Copies recordings into a campaign; their names there.
fn copied(directory: &Path, files: &[PathBuf], added: &mut Added) -> Vec<String> {
    let mut names = Vec::new();
    for file in files {
        match copy(file, directory) {
            Ok(_) => names.push(name_of(file)),
            Err(error) => added.left_out.push(format!("{}: {error}", name_of(file))),
        }
    }
    names
}

/// Copies a recording into the campaign.
fn copy(file: &Path, directory: &Path) -> Result<PathBuf, Error> {
    check_regular(file)?;
    let failed = |source| Error::access(file, "read", source);
    let mut from = File::open(file).map_err(failed)?;
    let mut arriving = Arriving::begin(directory, &format!("raw/{}", name_of(file)))?;
    let mut chunk = vec![0; CHUNK];
    loop {
        match from.read(&mut chunk).map_err(failed)? {
            0 => return arriving.end(),
            read => arriving.take(&chunk[..read])?,
        }
    }
}

/// A recording of a specimen of its own.
fn own_specimen(name: &str) -> NamedRecording {
    let stem = name
        .rsplit_once('.')
        .map_or(name, |(stem, _)| stem)
        .to_owned();
    NamedRecording {
        id: stem.clone(),
        specimen: stem,
        of_specimen: Vec::new(),
        of_impact: Vec::new(),
    }
}

/// Cells of a column.
fn column(table: &Table, name: &str) -> Result<BTreeSet<String>, Error> {
    let index = column_index(table, name)?;
    Ok(table
        .rows
        .iter()
        .map(|row| row.cells[index].clone())
        .collect())
}

fn row(own: &[(&str, &String)], more: &[(String, String)]) -> BTreeMap<String, String> {
    let own = own
        .iter()
        .map(|(name, cell)| ((*name).to_owned(), (*cell).clone()));
    more.iter().cloned().chain(own).collect()
}
