//! What all kinds of campaigns share: `format`, `[files]`, `[summary]`, and the
//! placeholders in names of columns.

use crate::error::CampaignError;
use crate::settings::file::{FORMAT, FilesFile, MissingText};
use crate::settings::model::{ChannelPlan, FilePlan, ImpactEntry, Specimen, TimePlan};
use crate::settings::open_options::{DECIMALS, ENCODINGS, SEPARATORS, THOUSANDS};
use crate::settings::template::is_template_file;
use std::path::{Path, PathBuf};
use windfall_files::confined::named_file;
use windfall_files::error::{Error, Place};
use windfall_files::name::Name;
use windfall_files::text::spanned::Spanned;
use windfall_files::text::toml_source::{
    Needed, TomlSource, choice, missing, place_at, positive_quantity, refused, suggestion,
};
use windfall_formats::contents::Format;
use windfall_formats::open::OpenOptions;
use windfall_formats::text::options::TextOptions;
use windfall_numerics::unit::quantity::parse_unit;

/// Whether this windfall knows the shape of the file.
///
/// # Errors
/// The version is left out or is another one.
pub fn check_format(source: &TomlSource, format: Option<&Spanned<i64>>) -> Result<(), Error> {
    let Some(format) = format else {
        let needed = Needed {
            table: "the file",
            key: "format",
            meaning: "version of the shape of this file",
            unit: "",
            example: "format = 1",
        };
        return Err(missing(source, &(0..0), &needed, needed.table.to_owned()));
    };
    if *format.get_ref() == FORMAT {
        return Ok(());
    }
    Err(Error::from(CampaignError::CampaignFormat {
        place: place_at(source, &format.span()),
        found: *format.get_ref(),
        expected: FORMAT,
    }))
}

/// How the recordings of a campaign are read.
///
/// * `channels`: those of the campaign; each may have a time column of its own
///
/// # Errors
/// The directory, the times or their unit cannot be used.
pub fn file_plan(
    source: &TomlSource,
    directory: &Path,
    files: &FilesFile,
    channels: Vec<ChannelPlan>,
) -> Result<FilePlan, Error> {
    let (recordings, within) = recordings_directory(source, directory, files)?;
    if let Some(names) = &files.names {
        let text = names.get_ref();
        if !text.contains('{') || text.chars().any(char::is_control) {
            let problem = "a pattern has a placeholder for each part that varies, as in \
                           \"{variety}_f{fruit}_{rep}.csv\""
                .to_owned();
            return Err(refused(source, names, ("[files]", "names"), problem));
        }
    }
    Ok(FilePlan {
        directory: recordings,
        within: Some(within),
        held: None,
        open: open_plan(source, files)?,
        time: match channels.iter().all(|channel| channel.time.is_some()) {
            true => TimePlan::OfChannels,
            false => time_plan(source, files)?,
        },
        time_scale: time_scale(source, files)?,
        channels,
    })
}

/// How files are read that do not say it themselves.
fn open_plan(source: &TomlSource, files: &FilesFile) -> Result<OpenOptions, Error> {
    let text = TextOptions {
        separator: named(source, files.separator.as_ref(), "separator", &SEPARATORS)?,
        decimal: named(source, files.decimal.as_ref(), "decimal", &DECIMALS)?,
        thousands: named(source, files.thousands.as_ref(), "thousands", &THOUSANDS)?,
        encoding: named(source, files.encoding.as_ref(), "encoding", &ENCODINGS)?,
        header_line: files.header_line.as_ref().map(|line| *line.get_ref()),
        comment: files.comment.as_ref().map(|text| text.get_ref().clone()),
        missing: files.missing.iter().map(missing_word).collect(),
        footer: files.footer,
        lines_above: 0,
    };
    Ok(OpenOptions {
        format: named(source, files.format.as_ref(), "format", &Format::NAMES)?,
        text,
    })
}

fn missing_word(text: &MissingText) -> String {
    match text {
        MissingText::Word(word) => word.clone(),
        MissingText::Number(number) => number.to_string(),
    }
}

fn named<T: Copy>(
    source: &TomlSource,
    value: Option<&Spanned<String>>,
    key: &'static str,
    known: &[(&'static str, T)],
) -> Result<Option<T>, Error> {
    choice(source, value, ("[files]", key), known)
}

/// The directory of the recordings, and the one in which they must lie: that of the campaign,
/// or what a variable of the environment names, which the user has set.
fn recordings_directory(
    source: &TomlSource,
    directory: &Path,
    files: &FilesFile,
) -> Result<(PathBuf, PathBuf), Error> {
    let Some(text) = &files.directory else {
        return Ok((directory.join("raw"), directory.to_path_buf()));
    };
    let name = with_variables(source, text)?;
    if text.get_ref().starts_with("${") {
        let recordings = directory.join(name);
        return Ok((recordings.clone(), recordings));
    }
    let recordings = named_file(directory, &name, directory)
        .map_err(|problem| refused(source, text, ("[files]", "directory"), problem))?;
    Ok((recordings, directory.to_path_buf()))
}

/// Replaces `${NAME}` by the environment variable NAME.
fn with_variables(source: &TomlSource, text: &Spanned<String>) -> Result<String, Error> {
    let mut rest = text.get_ref().as_str();
    let mut whole = String::new();
    while let Some((before, after)) = rest.split_once("${") {
        let Some((name, behind)) = after.split_once('}') else {
            let problem = "a \"${\" is not closed by \"}\"".to_owned();
            return Err(refused(source, text, ("[files]", "directory"), problem));
        };
        let value = std::env::var(name).map_err(|_| {
            Error::from(CampaignError::VariableUnset {
                place: place_at(source, &text.span()),
                key: "[files] directory".to_owned(),
                variable: name.to_owned(),
            })
        })?;
        whole.push_str(before);
        whole.push_str(&value);
        rest = behind;
    }
    Ok(whole + rest)
}

fn time_plan(source: &TomlSource, files: &FilesFile) -> Result<TimePlan, Error> {
    let rate_key = Needed {
        table: "[files]",
        key: "rate",
        meaning: "sampling rate, where neither the file nor a column tells the times",
        unit: "Hz",
        example: "rate = \"200 kHz\"",
    };
    let rate = positive_quantity(source, files.rate.as_ref(), &rate_key)?;
    match (&files.time, rate, &files.rate) {
        (Some(_), _, Some(rate)) => {
            let problem = "the times are given by a column too; keep one of `time` and `rate`";
            Err(refused(source, rate, ("[files]", "rate"), problem))
        }
        (Some(column), ..) => Ok(TimePlan::Column(column.get_ref().clone())),
        (None, Some(rate), _) => Ok(TimePlan::Rate(rate)),
        (None, None, _) => Ok(TimePlan::OfFile),
    }
}

fn time_scale(source: &TomlSource, files: &FilesFile) -> Result<f64, Error> {
    let Some(unit) = &files.time_unit else {
        return Ok(1.0);
    };
    let at = ("[files]", "time_unit");
    let parsed =
        parse_unit(unit.get_ref()).map_err(|error| refused(source, unit, at, error.to_string()))?;
    let second = parse_unit("s").map_or(parsed.dimension, |second| second.dimension);
    if parsed.dimension.matches(&second) {
        return Ok(parsed.si_from(1.0));
    }
    let problem = "expected a unit of time, such as \"s\" or \"ms\"".to_owned();
    Err(refused(source, unit, at, problem))
}

/// Whether the column to group by exists.
///
/// # Errors
/// Neither table has it.
pub fn check_group(
    source: &TomlSource,
    group: Option<&Spanned<String>>,
    specimens: &[Specimen],
    entries: &[ImpactEntry],
) -> Result<(), Error> {
    let Some(group) = group else { return Ok(()) };
    let specimen_cells = specimens.first().map_or(&[][..], |s| &s.cells);
    let impact_cells = entries.first().map_or(&[][..], |i| &i.cells);
    let names = || {
        let cells = specimen_cells.iter().chain(impact_cells);
        cells.map(|(name, _)| name.as_str())
    };
    if names().any(|name| name == group.get_ref()) {
        return Ok(());
    }
    let problem = format!(
        "neither specimens.csv nor impacts.csv has this column{}; they have: {}",
        suggestion(group.get_ref(), names()),
        names().collect::<Vec<_>>().join(", ")
    );
    Err(refused(source, group, ("[summary]", "group"), problem))
}

/// Whether every `{name}` in the columns of a campaign is a column of impacts.csv; one
/// that still holds the examples of a template is yet to be written.
///
/// # Errors
/// One is not.
pub fn check_placeholders(
    source: &TomlSource,
    files: &FilePlan,
    entries: &[ImpactEntry],
) -> Result<(), Error> {
    let Some(first) = entries.first() else {
        return Ok(());
    };
    if is_template_file(&source.path.with_file_name("impacts.csv")) {
        return Ok(());
    }
    for channel in &files.channels {
        for text in [Some(&channel.column), channel.time.as_ref()]
            .into_iter()
            .flatten()
        {
            fill_placeholders(text, &first.cells).map_err(|name| {
                Error::from(CampaignError::PlaceholderUnknown {
                    place: Place::at(&source.path, channel.line),
                    text: text.clone(),
                    name,
                })
            })?;
        }
    }
    Ok(())
}

/// Replaces every `{name}` by the cell of that column.
///
/// # Errors
/// The name of a placeholder that is no column.
pub fn fill_placeholders(text: &str, cells: &[(Name, String)]) -> Result<String, String> {
    let mut rest = text;
    let mut whole = String::new();
    while let Some((before, after)) = rest.split_once('{') {
        let Some((name, behind)) = after.split_once('}') else {
            break;
        };
        let cell = cells.iter().find(|(column, _)| column == name);
        whole.push_str(before);
        whole.push_str(&cell.ok_or_else(|| name.to_owned())?.1);
        rest = behind;
    }
    Ok(whole + rest)
}
