//! Zip archives of tables of text: recordings of phones (phyphox, Sensor Logger).

use crate::contents::{Format, Note};
use crate::tables::bundle::{Bundle, Part};
use crate::tables::stacked::open_parts;
use crate::text::options::TextOptions;
use crate::zip::entries::{Entry, check_sizes, open_archive, read_entry};
use windfall_source::error::Error;
use windfall_source::source::Source;

const ENDINGS: [&str; 4] = [".csv", ".txt", ".tsv", ".dat"];

/// Whether an entry is a table of text, by its name.
pub fn is_text(name: &str) -> bool {
    let lower = name.to_lowercase();
    ENDINGS.iter().any(|ending| lower.ends_with(ending)) && !is_hidden(name)
}

/// Copies of names that macOS adds, and folders.
fn is_hidden(name: &str) -> bool {
    name.starts_with("__MACOSX/") || name.ends_with('/') || file_name(name).starts_with('.')
}

fn file_name(name: &str) -> &str {
    name.rsplit(['/', '\\']).next().unwrap_or(name)
}

/// Opens an archive of tables.
///
/// # Errors
/// It is damaged, too large, or has no table of numbers.
pub fn open_zip(source: Source, options: &TextOptions) -> Result<Bundle, Error> {
    let (archive, entries) = open_archive(source)?;
    let texts: Vec<&Entry> = entries
        .iter()
        .filter(|entry| is_text(&entry.name))
        .collect();
    check_sizes(&archive, &texts)?;
    let left_out = |name: &str, why: &str| Note::LeftOut {
        what: format!("\"{name}\""),
        why: why.to_owned(),
    };
    let (mut parts, mut notes) = (Vec::new(), Vec::new());
    let mut failure = None;
    let mut read = 0;
    for entry in &entries {
        let name = &entry.name;
        if is_hidden(name) {
            continue;
        }
        if !is_text(name) {
            notes.push(left_out(name, "it is not a text by its name"));
            continue;
        }
        // phyphox describes the phone and the clock there.
        if name.starts_with("meta/") {
            notes.push(left_out(
                name,
                "it describes the recording and holds no samples",
            ));
            continue;
        }
        let path = format!("{}/{name}", archive.get_ref().path().display());
        let text = Source::from_bytes(&path, read_entry(&archive, entry)?);
        match open_parts(text, options) {
            Ok(tables) => {
                let stem = name
                    .rsplit_once('.')
                    .map_or(name.as_str(), |(stem, _)| stem);
                parts.extend(tables.into_iter().map(|part| Part {
                    before: format!("{stem}/"),
                    ..part
                }));
                read += 1;
            }
            Err(error @ (Error::UnknownFormat { .. } | Error::Empty { .. })) => {
                notes.push(left_out(name, "it has no table of numbers"));
                failure.get_or_insert(error);
            }
            Err(error) => return Err(error),
        }
    }
    if parts.is_empty() {
        return Err(failure.unwrap_or_else(|| {
            archive.get_ref().unknown(
                "this zip archive holds no recording that windfall reads",
                "unpack it and name the recording",
            )
        }));
    }
    if read == 1 {
        for part in &mut parts {
            part.before.clear();
        }
    }
    let variant = format!("{read} table(s) of text");
    Ok(Bundle::new(Format::Zip, variant, parts, notes))
}
