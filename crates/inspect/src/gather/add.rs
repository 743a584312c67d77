//! `windfall add`: further recordings of a campaign.

use crate::gather::channels::{campaign_text as guessed_text, remarks};
use crate::gather::folder::{files_in, name_of};
use crate::gather::names::{KnownSpecimens, NamePattern, NamedRecording, unfit_name};
use crate::gather::rows::{ImpactRow, Rows};
use crate::run::{InspectRequest, inspect_recording};
use itertools::Itertools;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use windfall_campaign::recording::digests::campaign_text;
use windfall_campaign::settings::edit_table::add_rows;
use windfall_campaign::settings::kind::{CAMPAIGN_FILE, CampaignKind, campaign_kind};
use windfall_campaign::settings::template::{TEMPLATES, TemplateKind, is_template_file, template};
use windfall_files::confined::Arriving;
use windfall_files::error::Error;
use windfall_files::inputs::check_regular;
use windfall_files::option_value::unusable;
use windfall_files::table::csv::{Table, column_index, read_table};
use windfall_files::write_file::edit_file;

/// Bytes that are copied at once.
const CHUNK: usize = 1 << 20;

/// Recordings that were added.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, utoipa::ToSchema)]
pub struct Added {
    /// Ids of the new impacts.
    pub impacts: Vec<String>,
    /// Ids of specimens that were not known.
    pub specimens: Vec<String>,
    /// Recordings that are listed already.
    pub known: usize,
    /// What was assumed.
    pub assumed: Vec<String>,
    /// What a person has to write into campaign.toml, which was a template until now.
    pub missing: Vec<String>,
    /// Files that were left out, and why.
    pub left_out: Vec<String>,
}

/// Lists further recordings in impacts.csv, a row for each contact in them, and their
/// specimens in specimens.csv.
///
/// * `files`: recordings, or folders of them, that are copied into raw/; none for those that
///   lie there and are not listed yet
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
    let untouched = is_template_file(&impacts);
    let (listed, taken) = match untouched {
        true => (BTreeSet::new(), BTreeSet::new()),
        false => (column(&table, "file")?, column(&table, "id")?),
    };
    // Before a file is copied: can the tables be written?
    add_rows(&impacts, &[])?;
    let specimens = directory.join("specimens.csv");
    if specimens.exists() {
        add_rows(&specimens, &[])?;
    }
    let mut added = Added::default();
    let raw = directory.join("raw");
    let found = match files.is_empty() {
        true => files_in(&raw)?,
        false => files_of(files)?,
    };
    let read_of = |name: &str| match &pattern {
        None => Some(own_specimen(name)),
        Some(pattern) => pattern.read(name),
    };
    let mut specimens = KnownSpecimens::default();
    for (name, read) in listed
        .iter()
        .filter_map(|name| Some((name, read_of(name)?)))
    {
        // What is listed stands.
        let _ = specimens.take(name, &read);
    }
    let mut new: Vec<(PathBuf, NamedRecording)> = Vec::new();
    for file in found {
        let name = name_of(&file);
        let read = read_of(&name);
        let clash = |read| specimens.take(&name, read);
        let unlisted = read.as_ref().filter(|_| !listed.contains(&name));
        if let Some(problem) = unfit_name(&name).or_else(|| unlisted.and_then(clash)) {
            added.left_out.push(problem);
            continue;
        }
        // A recording that is listed may be of another pattern, and be told again.
        let arrived = match (&read, files.is_empty()) {
            (_, true) => Ok(raw.join(&name)),
            (None, _) => Ok(file),
            (Some(_), false) => copied(&file, directory),
        };
        match (arrived, read) {
            (Err(error), _) => added.left_out.push(format!("{name}: {error}")),
            (Ok(_), _) if listed.contains(&name) => added.known += 1,
            (Ok(_), None) => added
                .left_out
                .push(format!("{name}: not of the pattern of names")),
            (Ok(path), Some(read)) => new.push((path, read)),
        }
    }
    if new.is_empty() {
        return Ok(added);
    }
    // Rows that a person wrote go with the values of the template that stand above them.
    let text = match kind_of_template(&text).filter(|_| untouched) {
        Some(kind) => written_channels(directory, kind, (&new[0].0, names), &mut added)?,
        None => text,
    };
    // Specimens first: stopped in between, the campaign still knows all that it names.
    added.specimens = add_specimens(directory, &new)?;
    let of_impacts = campaign_kind(directory).is_ok_and(|kind| kind == CampaignKind::Impacts);
    let mut rows = Rows::begin(directory, of_impacts.then_some(text.as_str()), taken);
    let rows_of = |(path, read): &(PathBuf, NamedRecording)| rows.of(path, read);
    let new: Vec<ImpactRow> = new.iter().flat_map(rows_of).collect();
    added.assumed.extend(rows.assumed());
    let cells = new.iter().map(|own| {
        let places = [
            ("id", &own.id),
            ("specimen", &own.specimen),
            ("file", &own.file),
        ];
        row(&places, &own.cells)
    });
    let cells: Vec<BTreeMap<String, String>> = cells.collect();
    edit_file(&impacts, &add_rows(&impacts, &cells)?)?;
    added.impacts.extend(new.into_iter().map(|own| own.id));
    Ok(added)
}

/// The kind of a campaign.toml that nobody has touched.
fn kind_of_template(text: &str) -> Option<TemplateKind> {
    let mut kinds = TEMPLATES.iter();
    let found = kinds.find(|(_, kind)| template(*kind) == text);
    found.map(|(_, kind)| *kind)
}

/// Writes the channels of a recording into a campaign.toml that is still its template, as a
/// campaign of a folder has them; the new text.
fn written_channels(
    directory: &Path,
    kind: TemplateKind,
    (first, names): (&Path, Option<&str>),
    added: &mut Added,
) -> Result<String, Error> {
    let seen = inspect_recording(first, &InspectRequest::default());
    let Ok(seen) = seen else {
        return Ok(template(kind).to_owned());
    };
    let ending = first.extension().unwrap_or_default().to_string_lossy();
    let own = format!("{{specimen}}.{ending}");
    let guessed = guessed_text(template(kind), &seen, None, names.unwrap_or(&own));
    let text = remarks(&guessed.assumed) + &guessed.text;
    edit_file(&directory.join(CAMPAIGN_FILE), &text)?;
    added.assumed.extend(guessed.assumed);
    added.missing = guessed.missing;
    Ok(text)
}

/// Lists specimens that specimens.csv lacks, where there is such a table; their ids.
fn add_specimens(
    directory: &Path,
    new: &[(PathBuf, NamedRecording)],
) -> Result<Vec<String>, Error> {
    let specimens = directory.join("specimens.csv");
    if !specimens.exists() {
        return Ok(Vec::new());
    }
    let known = match is_template_file(&specimens) {
        true => BTreeSet::new(),
        false => column(&read_table(&specimens)?, "id")?,
    };
    let new = new.iter().map(|(_, read)| read);
    let new = new.unique_by(|read| &read.specimen);
    let new: Vec<&NamedRecording> = new.filter(|read| !known.contains(&read.specimen)).collect();
    let cells = new
        .iter()
        .map(|read| row(&[("id", &read.specimen)], &read.of_specimen));
    let cells: Vec<BTreeMap<String, String>> = cells.collect();
    if !cells.is_empty() {
        edit_file(&specimens, &add_rows(&specimens, &cells)?)?;
    }
    Ok(new.iter().map(|read| read.specimen.clone()).collect())
}

/// Files, and those in folders.
fn files_of(given: &[PathBuf]) -> Result<Vec<PathBuf>, Error> {
    let mut files = Vec::new();
    for path in given {
        match path.is_dir() {
            true => files.extend(files_in(path)?),
            false => files.push(path.clone()),
        }
    }
    Ok(files)
}

/// Where a recording lies in the campaign, into which it is copied unless it is there already.
fn copied(file: &Path, directory: &Path) -> Result<PathBuf, Error> {
    check_regular(file)?;
    let there = directory.join("raw").join(name_of(file));
    if there.is_file() && same_bytes(file, &there)? {
        return Ok(there);
    }
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

/// Whether two files hold the same bytes.
fn same_bytes(one: &Path, other: &Path) -> Result<bool, Error> {
    let open = |path: &Path| {
        let file = File::open(path).map_err(|source| Error::access(path, "read", source))?;
        let length = file.metadata();
        let length = length.map_err(|source| Error::access(path, "read", source))?;
        Ok::<_, Error>((BufReader::with_capacity(CHUNK, file), length.len()))
    };
    let ((mut first, of_first), (mut second, of_second)) = (open(one)?, open(other)?);
    if of_first != of_second {
        return Ok(false);
    }
    loop {
        let failed = |source| Error::access(one, "read", source);
        let (ours, theirs) = (
            first.fill_buf().map_err(failed)?,
            second.fill_buf().map_err(failed)?,
        );
        let length = ours.len().min(theirs.len());
        if ours[..length] != theirs[..length] {
            return Ok(false);
        }
        if length == 0 {
            return Ok(ours.len() == theirs.len());
        }
        first.consume(length);
        second.consume(length);
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
