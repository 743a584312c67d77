//! `windfall new KIND DIR --from FOLDER`: a campaign of the recordings in a folder.

use crate::gather::channels::campaign_text;
use crate::gather::names::{NamePattern, NamedRecording};
use crate::gather::preset::{Preset, inspect_by};
use crate::run::InspectRequest;
use itertools::Itertools;
use serde::Serialize;
use std::path::{Path, PathBuf};
use windfall_campaign::settings::kind::CAMPAIGN_FILE;
use windfall_campaign::settings::template::{TemplateKind, template};
use windfall_files::confined::path_inside;
use windfall_files::error::Error;
use windfall_files::inputs::check_regular;
use windfall_files::option_value::unusable;
use windfall_files::scratch::NewDirectory;
use windfall_files::table::write::csv_text;
use windfall_formats::open::{OpenOptions, open};

/// A campaign that was made of recordings.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Gathered {
    /// Files written.
    pub written: Vec<PathBuf>,
    /// Recordings that were copied.
    pub recordings: usize,
    /// Specimens among them.
    pub specimens: usize,
    /// What was assumed.
    pub assumed: Vec<String>,
    /// What a person has to write into campaign.toml.
    pub missing: Vec<String>,
    /// Files that were left out, and why.
    pub left_out: Vec<String>,
}

/// Makes a campaign of the recordings in a folder, which are copied.
///
/// * `names`: pattern of their names; without one, each file has a specimen of its own
/// * `preset`: what their columns are called, where that is known
///
/// # Errors
/// There is something in the directory already; no file of the folder is of the pattern; the
/// first of them cannot be read; a file cannot be written.
pub fn gather(
    kind: TemplateKind,
    directory: &Path,
    from: &Path,
    names: Option<&str>,
    preset: Option<&Preset>,
) -> Result<Gathered, Error> {
    let files = files_in(from)?;
    let pattern = match names {
        Some(text) => NamePattern::parse(text)?,
        None => own_pattern(&files)?,
    };
    let mut gathered = Gathered::default();
    let mut recordings: Vec<(&PathBuf, NamedRecording)> = Vec::new();
    for file in &files {
        let name = name_of(file);
        match pattern.read(&name) {
            Some(read) => recordings.push((file, read)),
            None => gathered
                .left_out
                .push(format!("{name}: not of the pattern {}", pattern.text())),
        }
    }
    let Some((first, _)) = recordings.first() else {
        let problem = format!(
            "none of the {} files in {} is of this pattern; the first is called {}",
            files.len(),
            from.display(),
            files.first().map_or_else(String::new, |file| name_of(file))
        );
        return Err(unusable(format!("--names {}", pattern.text()), problem));
    };
    let seen = inspect_by(first, &InspectRequest::default(), preset)?;
    gathered.assumed.extend(other_columns(first, &recordings));
    let group = recordings[0].1.of_specimen.iter().map(|(name, _)| name);
    let group = group
        .clone()
        .find(|name| !["fruit", "sample"].contains(&name.as_str()));
    let guessed = campaign_text(
        template(kind),
        &seen,
        group.map(String::as_str),
        pattern.text(),
    );
    gathered.assumed.extend(guessed.assumed.iter().cloned());
    gathered.missing = guessed.missing;
    let new = NewDirectory::begin(directory)?;
    let mut copied = Vec::new();
    for (file, read) in &recordings {
        let name = format!("raw/{}", name_of(file));
        let plain = path_inside(directory, &name).and_then(|_| check_regular(file));
        match plain.and_then(|()| new.copy(&name, file)) {
            Ok(path) => {
                gathered.written.push(path);
                copied.push((name_of(file), read));
            }
            Err(error) => gathered
                .left_out
                .push(format!("{}: {error}", name_of(file))),
        }
    }
    gathered.recordings = copied.len();
    let remarks = guessed
        .assumed
        .iter()
        .map(|assumed| format!("# Assumed: {assumed}\n"));
    let text = remarks.collect::<String>() + &guessed.text;
    let (specimens, impacts) = tables(&copied)?;
    gathered.specimens = specimens.lines().count() - 1;
    for (name, text) in [
        (CAMPAIGN_FILE, text),
        ("specimens.csv", specimens),
        ("impacts.csv", impacts),
    ] {
        gathered.written.push(new.write(name, text.as_bytes())?);
    }
    new.end(CAMPAIGN_FILE)?;
    Ok(gathered)
}

/// Files of a folder in the order of their names, hidden ones left out.
pub(crate) fn files_in(folder: &Path) -> Result<Vec<PathBuf>, Error> {
    let entries = std::fs::read_dir(folder);
    let entries = entries.map_err(|source| Error::access(folder, "read", source))?;
    let mut files = Vec::new();
    for entry in entries {
        let entry = entry.map_err(|source| Error::access(folder, "read", source))?;
        if entry.path().is_file() && !name_of(&entry.path()).starts_with('.') {
            files.push(entry.path());
        }
    }
    files.sort();
    Ok(files)
}

/// A specimen for each file, with the ending of the first.
fn own_pattern(files: &[PathBuf]) -> Result<NamePattern, Error> {
    let ending = files.first().and_then(|file| file.extension());
    let ending = ending.map_or_else(String::new, |own| format!(".{}", own.to_string_lossy()));
    NamePattern::parse(&format!("{{specimen}}{ending}"))
}

/// The name of a file, as text.
pub(crate) fn name_of(file: &Path) -> String {
    let name = file.file_name().unwrap_or_default();
    name.to_string_lossy().into_owned()
}

/// Recordings whose channels are not those of the first.
fn other_columns(first: &Path, recordings: &[(&PathBuf, NamedRecording)]) -> Option<String> {
    let columns = |file: &Path| {
        let reader = open(file, &OpenOptions::default()).ok()?;
        let channels = reader.contents().channels.iter();
        Some(
            channels
                .map(|channel| channel.name.clone())
                .collect::<Vec<_>>(),
        )
    };
    let usual = columns(first)?;
    let other = recordings
        .iter()
        .map(|(file, _)| *file)
        .filter(|file| columns(file).as_ref() != Some(&usual));
    let other: Vec<&PathBuf> = other.collect();
    let one = other.first()?;
    Some(format!(
        "the channels are those of {}; {} of {} recordings have others, or cannot be read, {} first",
        name_of(first),
        other.len(),
        recordings.len(),
        name_of(one)
    ))
}

/// specimens.csv and impacts.csv.
fn tables(recordings: &[(String, &NamedRecording)]) -> Result<(String, String), Error> {
    let specimens = recordings.iter().unique_by(|(_, read)| &read.specimen);
    let specimens: Vec<&NamedRecording> = specimens.map(|(_, read)| *read).collect();
    let names =
        |pairs: &[(String, String)]| pairs.iter().map(|(name, _)| name.clone()).collect_vec();
    let cells =
        |pairs: &[(String, String)]| pairs.iter().map(|(_, cell)| cell.clone()).collect_vec();
    let first = specimens.first();
    let mut header = vec!["id".to_owned()];
    header.extend(first.map_or(Vec::new(), |read| names(&read.of_specimen)));
    let rows = specimens.iter().map(|read| {
        let mut row = vec![read.specimen.clone()];
        row.extend(cells(&read.of_specimen));
        row
    });
    let of_specimens = csv_text(&header, rows)?;
    let mut header = ["id", "specimen", "file"].map(str::to_owned).to_vec();
    header.extend(first.map_or(Vec::new(), |read| names(&read.of_impact)));
    let rows = recordings.iter().map(|(file, read)| {
        let mut row = vec![read.id.clone(), read.specimen.clone(), file.clone()];
        row.extend(cells(&read.of_impact));
        row
    });
    Ok((of_specimens, csv_text(&header, rows)?))
}
