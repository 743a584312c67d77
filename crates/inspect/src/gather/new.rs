//! `windfall new KIND DIR --from FOLDER`: a campaign of the recordings in a folder.

use crate::gather::channels::{campaign_text, remarks};
use crate::gather::folder::{files_in, name_of};
use crate::gather::names::{KnownSpecimens, NamePattern, NamedRecording, unfit_name};
use crate::gather::preset::{Preset, inspect_by};
use crate::gather::rows::{ImpactRow, Rows};
use crate::run::InspectRequest;
use itertools::Itertools;
use serde::Serialize;
use std::collections::BTreeSet;
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
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, utoipa::ToSchema)]
pub struct Gathered {
    /// Files written.
    #[schema(value_type = Vec<String>)]
    pub written: Vec<PathBuf>,
    /// Recordings that were copied.
    pub recordings: usize,
    /// Impacts in them.
    pub impacts: usize,
    /// Specimens among them.
    pub specimens: usize,
    /// What was assumed.
    pub assumed: Vec<String>,
    /// What a person has to write into campaign.toml.
    pub missing: Vec<String>,
    /// Files that were left out, and why.
    pub left_out: Vec<String>,
}

/// What a drop must have that names of recordings may tell: begin of the column, and where else
/// it may stand.
const DROP_NEEDS: [(&str, &str); 2] = [
    (
        "mass",
        "[rig] mass, if it is one for all; else a column mass_g in specimens.csv",
    ),
    (
        "drop_height",
        "[rig] height, if it is one for all; else a column drop_height_mm in impacts.csv \
         (in names: {drop_height_mm})",
    ),
];

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
        if let Some(problem) = unfit_name(&name) {
            gathered.left_out.push(problem);
            continue;
        }
        match pattern.read(&name) {
            Some(read) => recordings.push((file, read)),
            None => gathered
                .left_out
                .push(format!("{name}: not of the pattern {}", pattern.text())),
        }
    }
    let Some((first, _)) = recordings.first() else {
        let folder = from.display();
        let problem = match files.first() {
            None => format!("there is no file in {folder}"),
            Some(file) => format!(
                "none of the {} files in {folder} is of this pattern; the first is called {}",
                files.len(),
                name_of(file)
            ),
        };
        return Err(unusable(format!("--names {}", pattern.text()), problem));
    };
    let mut known = KnownSpecimens::default();
    let mut clashes = recordings.iter();
    if let Some(problem) = clashes.find_map(|(file, read)| known.take(&name_of(file), read)) {
        return Err(unusable(format!("--names {}", pattern.text()), problem));
    }
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
    if kind == TemplateKind::Drop {
        gathered.missing.extend(needs_of_drop(&recordings[0].1));
    }
    let new = NewDirectory::begin(directory)?;
    let mut copied = Vec::new();
    for (file, read) in &recordings {
        let name = format!("raw/{}", name_of(file));
        let plain = path_inside(directory, &name).and_then(|_| check_regular(file));
        match plain.and_then(|()| new.copy(&name, file)) {
            Ok(path) => {
                gathered.written.push(path);
                copied.push((*file, read));
            }
            Err(error) => gathered
                .left_out
                .push(format!("{}: {error}", name_of(file))),
        }
    }
    let of_impacts = matches!(kind, TemplateKind::Pendulum | TemplateKind::Carriage);
    let text = of_impacts.then_some(guessed.text.as_str());
    let mut rows = Rows::begin(from, text, BTreeSet::new());
    let impacts = copied.iter().flat_map(|(file, read)| rows.of(file, read));
    let impacts: Vec<ImpactRow> = impacts.collect();
    gathered.assumed.extend(rows.assumed());
    gathered.recordings = copied.len();
    gathered.impacts = impacts.len();
    let text = remarks(&gathered.assumed) + &guessed.text;
    let specimens = specimens_text(&copied)?;
    gathered.specimens = specimens.lines().count() - 1;
    for (name, text) in [
        (CAMPAIGN_FILE, text),
        ("specimens.csv", specimens),
        ("impacts.csv", impacts_text(&impacts)?),
    ] {
        gathered.written.push(new.write(name, text.as_bytes())?);
    }
    new.end(CAMPAIGN_FILE)?;
    Ok(gathered)
}

/// What the names of drops do not tell.
fn needs_of_drop(named: &NamedRecording) -> impl Iterator<Item = String> {
    let columns = named.of_specimen.iter().chain(&named.of_impact);
    let columns: Vec<&String> = columns.map(|(column, _)| column).collect();
    let unknown = move |need: &&(&str, &str)| !columns.iter().any(|own| own.starts_with(need.0));
    DROP_NEEDS
        .iter()
        .filter(unknown)
        .map(|need| need.1.to_owned())
}

/// A specimen for each file, with the ending of the first.
fn own_pattern(files: &[PathBuf]) -> Result<NamePattern, Error> {
    let ending = files.first().and_then(|file| file.extension());
    let ending = ending.map_or_else(String::new, |own| format!(".{}", own.to_string_lossy()));
    NamePattern::parse(&format!("{{specimen}}{ending}"))
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

/// specimens.csv.
fn specimens_text(recordings: &[(&PathBuf, &NamedRecording)]) -> Result<String, Error> {
    let specimens = recordings.iter().unique_by(|(_, read)| &read.specimen);
    let specimens: Vec<&NamedRecording> = specimens.map(|(_, read)| *read).collect();
    let mut header = vec!["id".to_owned()];
    let named = specimens.first().map(|read| &read.of_specimen);
    header.extend(named.into_iter().flatten().map(|(name, _)| name.clone()));
    let rows = specimens.iter().map(|read| {
        let cells = read.of_specimen.iter().map(|(_, cell)| cell);
        std::iter::once(&read.specimen)
            .chain(cells)
            .cloned()
            .collect()
    });
    csv_text(&header, rows.collect::<Vec<Vec<String>>>())
}

/// impacts.csv.
fn impacts_text(impacts: &[ImpactRow]) -> Result<String, Error> {
    let cells = impacts.iter().flat_map(|row| &row.cells);
    let further: Vec<&String> = cells.map(|(name, _)| name).unique().collect();
    let own = ["id", "specimen", "file"].map(str::to_owned);
    let header: Vec<String> = own.iter().chain(further.iter().copied()).cloned().collect();
    let rows = impacts.iter().map(|row| {
        let cell = |name: &&String| {
            let mut cells = row.cells.iter();
            let found = cells.find(|(own, _)| own == *name);
            found.map_or_else(String::new, |(_, cell)| cell.clone())
        };
        let own = [&row.id, &row.specimen, &row.file].map(Clone::clone);
        own.into_iter().chain(further.iter().map(cell)).collect()
    });
    csv_text(&header, rows.collect::<Vec<Vec<String>>>())
}
