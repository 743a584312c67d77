//! Changes of a campaign's files from the page: comments and layout stay, the resulting
//! campaign is checked before it replaces the old one, and a change based on an outdated
//! version is refused.

use crate::campaign_files::check_changed;
use crate::campaign_view::{CampaignView, signed_unit, view_campaign};
use crate::undo::{Way, check_version, keep_before, step};
use crate::workspace::recordings_inside;
use itertools::Itertools;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::io::Write;
use std::path::Path;
use std::sync::{Mutex, PoisonError};
use toml_edit::{Array, DocumentMut, Item, Table, value};
use windfall_campaign::recording::digests::campaign_text;
use windfall_campaign::result::counted::NOTE_COLUMN;
use windfall_campaign::settings::channels::{KINDS, parse_scale};
use windfall_campaign::settings::edit_table::{add_rows, set_cells};
use windfall_campaign::settings::kind::CAMPAIGN_FILE;
use windfall_campaign::settings::tables::read_specimens;
use windfall_campaign::settings::template::is_template_file;
use windfall_files::confined::path_inside;
use windfall_files::error::{Error, Place};
use windfall_files::option_value::unusable;
use windfall_files::table::data::EXCLUDE_COLUMN;
use windfall_files::text::column_role::unit_of;
use windfall_files::write_file::replace_file;

/// Serialises changes: of two based on the same version, the second is refused.
static CHANGING: Mutex<()> = Mutex::new(());

/// What is changed.
#[derive(Clone, Debug)]
pub enum Change {
    /// The whole campaign.toml.
    Text(String),
    /// The part of the recording that an impact uses; s.
    Window {
        /// Id of the impact.
        impact: String,
        /// Its begin; none where it has no bound.
        from: Option<f64>,
        /// Its end.
        to: Option<f64>,
    },
    /// Whether an impact counts.
    Exclusion {
        /// Id of the impact.
        impact: String,
        /// Whether it is left out.
        excluded: bool,
        /// Why; what there is stays where this is blank.
        note: String,
    },
    /// A note on an impact, whether it counts or not; a blank one takes it away.
    Note {
        /// Id of the impact.
        impact: String,
        /// The note.
        note: String,
    },
    /// The note on the campaign; a blank one takes it away.
    CampaignNote(String),
    /// Keys of `[fit]`, and the column to group by.
    Options(OptionsChange),
    /// Keys of `[rig]` by their text; a key of no text is removed.
    Rig(BTreeMap<String, String>),
    /// Where the channels are in the files.
    Channels(ChannelsChange),
    /// Further impacts; their specimens are added where specimens.csv lacks them.
    Impacts(Vec<NewImpact>),
}

/// Keys of `[fit]` and of `[summary]` that change; what is `None` stays.
#[derive(Clone, Debug, Default)]
pub struct OptionsChange {
    /// Lists: laws, free, quantities.
    pub lists: BTreeMap<String, Vec<String>>,
    /// Words: weights, noise, intervals, onset …
    pub words: BTreeMap<String, String>,
    /// Column to group by; an empty name for none.
    pub group: Option<String>,
}

/// The columns of the channels.
#[derive(Clone, Debug, Default, Deserialize, utoipa::ToSchema)]
#[serde(deny_unknown_fields)]
#[schema(as = ChannelsGiven)]
pub struct ChannelsChange {
    /// Channels.
    pub channels: Vec<ChannelChange>,
    /// Column of times.
    pub time: Option<String>,
    /// Sampling rate.
    pub rate: Option<String>,
}

/// A channel.
#[derive(Clone, Debug, Deserialize, utoipa::ToSchema)]
#[serde(deny_unknown_fields)]
#[schema(as = ChannelGiven)]
pub struct ChannelChange {
    /// "force", "position", …
    pub quantity: String,
    /// Column in the files.
    pub column: String,
    /// Its unit, or the sensitivity of its sensor.
    pub unit: String,
}

/// A row of impacts.csv.
#[derive(Clone, Debug, Default, Deserialize, utoipa::ToSchema)]
#[serde(deny_unknown_fields)]
#[schema(as = ImpactGiven)]
pub struct NewImpact {
    /// Id.
    pub id: String,
    /// Specimen.
    pub specimen: String,
    /// Recording.
    pub file: String,
    /// Other columns.
    #[serde(default)]
    pub cells: BTreeMap<String, String>,
}

/// Changes a campaign that is of that version, and shows what it is then.
///
/// * `version`: as [`crate::campaign_files::campaign_version`] gives it; "*" for whatever it is now
///
/// # Errors
/// [`Error::ChangedMeanwhile`]; the change makes no campaign that can be read; a file
/// cannot be written. Then all is as it was.
pub fn change_campaign(
    directory: &Path,
    version: &str,
    change: &Change,
) -> Result<CampaignView, Error> {
    let _one = CHANGING.lock().unwrap_or_else(PoisonError::into_inner);
    check_version(directory, version)?;
    let files = changed_files(directory, change)?;
    check_changed(directory, &files)?;
    // Kept first: there is no moment at which the text of before is nowhere.
    keep_before(directory, change.words(), &files)?;
    write_files(directory, &files)?;
    view_campaign(directory)
}

/// Undoes the newest change of a campaign that is of that version, or does the one again that
/// was undone last, and shows what the campaign is then.
///
/// # Errors
/// Those of [`change_campaign`]; there is no such change; [`Error::ChangedSince`]. Then all is
/// as it was.
pub fn undo_change(directory: &Path, version: &str, way: Way) -> Result<CampaignView, Error> {
    let _one = CHANGING.lock().unwrap_or_else(PoisonError::into_inner);
    check_version(directory, version)?;
    let stepped = step(directory, way)?;
    check_changed(directory, &stepped.files)?;
    write_files(directory, &stepped.files)?;
    stepped.write_history(directory)?;
    view_campaign(directory)
}

fn write_files(directory: &Path, files: &[(&'static str, String)]) -> Result<(), Error> {
    files.iter().try_for_each(|(name, text)| {
        let text = text.as_bytes();
        replace_file(&directory.join(name), |file| file.write_all(text))
    })
}

impl Change {
    /// What it does, as it is named where it can be undone: "excluded apple-07".
    fn words(&self) -> String {
        match self {
            Self::Text(_) => "changed campaign.toml".to_owned(),
            Self::Window { impact, .. } => format!("changed the window of {impact}"),
            Self::Exclusion {
                impact,
                excluded: true,
                ..
            } => format!("excluded {impact}"),
            Self::Exclusion { impact, .. } => format!("counted {impact} again"),
            Self::Note { impact, .. } => format!("changed the note on {impact}"),
            Self::CampaignNote(_) => "changed the note on the campaign".to_owned(),
            Self::Options(_) => "changed laws and options".to_owned(),
            Self::Rig(_) => "changed the rig".to_owned(),
            Self::Channels(_) => "changed channels".to_owned(),
            Self::Impacts(rows) => match rows.as_slice() {
                [one] => format!("added {}", one.id),
                _ => format!("added {} impacts", rows.len()),
            },
        }
    }
}

/// Names and texts of the files that a change writes.
fn changed_files(directory: &Path, change: &Change) -> Result<Vec<(&'static str, String)>, Error> {
    let impacts = directory.join("impacts.csv");
    match change {
        Change::Text(text) => Ok(vec![(CAMPAIGN_FILE, text.clone())]),
        Change::Window { impact, from, to } => {
            let cell = |time: &Option<f64>| time.map_or_else(String::new, |time| time.to_string());
            let cells = [("from_s", cell(from)), ("to_s", cell(to))];
            Ok(vec![("impacts.csv", set_cells(&impacts, impact, &cells)?)])
        }
        Change::Exclusion {
            impact,
            excluded,
            note,
        } => {
            let mut cells = vec![(
                EXCLUDE_COLUMN,
                if *excluded { "yes" } else { "" }.to_owned(),
            )];
            if !note.trim().is_empty() {
                cells.push((NOTE_COLUMN, note.trim().to_owned()));
            }
            Ok(vec![("impacts.csv", set_cells(&impacts, impact, &cells)?)])
        }
        Change::Note { impact, note } => {
            let cells = [(NOTE_COLUMN, note.trim().to_owned())];
            Ok(vec![("impacts.csv", set_cells(&impacts, impact, &cells)?)])
        }
        Change::CampaignNote(note) => {
            let mut document = document(directory)?;
            let campaign = table(&mut document, "campaign")?;
            match note.trim() {
                "" => {
                    campaign.remove("note");
                }
                note => set(campaign, "note", value(note)),
            }
            Ok(vec![(CAMPAIGN_FILE, document.to_string())])
        }
        Change::Options(options) => {
            let mut document = document(directory)?;
            change_options(&mut document, options)?;
            Ok(vec![(CAMPAIGN_FILE, document.to_string())])
        }
        Change::Rig(keys) => {
            let mut document = document(directory)?;
            change_rig(&mut document, keys)?;
            Ok(vec![(CAMPAIGN_FILE, document.to_string())])
        }
        Change::Channels(channels) => {
            let mut document = document(directory)?;
            change_channels(&mut document, channels)?;
            Ok(vec![(CAMPAIGN_FILE, document.to_string())])
        }
        Change::Impacts(rows) => new_impacts(directory, rows),
    }
}

fn document(directory: &Path) -> Result<DocumentMut, Error> {
    let text = campaign_text(directory)?;
    text.parse().map_err(|error: toml_edit::TomlError| {
        let line = error.span().map_or(0, |span| {
            1 + text[..span.start].bytes().filter(|b| *b == b'\n').count()
        });
        let file = directory.join(CAMPAIGN_FILE);
        Error::CampaignSyntax {
            place: Place { file, line },
            message: error.message().to_owned(),
        }
    })
}

/// The table of that name, made where it is not there.
///
/// # Errors
/// The key is no table.
fn table<'a>(document: &'a mut Table, name: &str) -> Result<&'a mut Table, Error> {
    let item = document
        .entry(name)
        .or_insert_with(|| Item::Table(Table::new()));
    // A table within one line has keys like any other.
    if item.is_inline_table() {
        let inline = std::mem::take(item).into_table();
        *item = inline.map_or_else(|other| other, Item::Table);
    }
    item.as_table_mut().ok_or_else(|| Error::ChangeRefused {
        problem: format!("{name} in campaign.toml is no table"),
    })
}

/// Sets a key and keeps the remark behind it.
fn set(table: &mut Table, key: &str, new: Item) {
    match (table.get_mut(key), new) {
        (Some(Item::Value(old)), Item::Value(mut new)) => {
            *new.decor_mut() = old.decor().clone();
            *old = new;
        }
        (_, new) => {
            table.insert(key, new);
        }
    }
}

fn change_options(document: &mut DocumentMut, options: &OptionsChange) -> Result<(), Error> {
    let fit = table(document, "fit")?;
    for (key, texts) in &options.lists {
        let list: Array = texts.iter().map(String::as_str).collect();
        set(fit, key, value(list));
        if key == "laws" {
            fit.remove("law");
        }
    }
    for (key, word) in &options.words {
        set(fit, key, value(word.as_str()));
    }
    match options.group.as_deref() {
        None => {}
        Some("") => {
            table(document, "summary")?.remove("group");
        }
        Some(group) => set(table(document, "summary")?, "group", value(group)),
    }
    Ok(())
}

/// Sets keys of the rig. What stood behind a value was said of the example that it replaces.
fn change_rig(document: &mut DocumentMut, keys: &BTreeMap<String, String>) -> Result<(), Error> {
    let rig = table(document, "rig")?;
    for (key, text) in keys {
        let text = text.trim();
        if text.is_empty() {
            rig.remove(key);
            continue;
        }
        // A number alone is one, also where the key takes no text.
        let new = match text.parse::<i64>() {
            Ok(whole) => value(whole),
            Err(_) => match text.parse::<f64>() {
                Ok(number) if number.is_finite() => value(number),
                _ => value(text),
            },
        };
        rig.insert(key, new);
    }
    Ok(())
}

fn change_channels(document: &mut DocumentMut, change: &ChannelsChange) -> Result<(), Error> {
    let known = |name: &str| KINDS.iter().any(|kind| kind.name() == name);
    let mut channels = change.channels.iter();
    if let Some(ChannelChange { quantity, .. }) = channels.find(|c| !known(&c.quantity)) {
        let names: Vec<&str> = KINDS.iter().map(|kind| kind.name()).collect();
        let problem = format!("expected one of {}", names.join(", "));
        return Err(unusable(format!("channel {quantity}"), problem));
    }
    let channels = table(document, "channels")?;
    channels.set_implicit(true);
    for kind in &KINDS {
        let mut wanted = change.channels.iter();
        let Some(wanted) = wanted.find(|channel| channel.quantity == kind.name()) else {
            channels.remove(kind.name());
            continue;
        };
        let channel = table(channels, kind.name())?;
        set(channel, "column", value(wanted.column.as_str()));
        set_unit(channel, kind.unit, &wanted.unit);
    }
    let files = table(document, "files")?;
    let before = files.get("time").and_then(Item::as_str);
    if before != change.time.as_deref() {
        // The unit of another column is the one in its name, as for every channel.
        match change.time.as_deref().and_then(unit_of) {
            Some(unit) => set(files, "time_unit", value(unit)),
            None => {
                files.remove("time_unit");
            }
        }
    }
    for (key, text) in [("time", &change.time), ("rate", &change.rate)] {
        match text {
            Some(text) => set(files, key, value(text.as_str())),
            None => {
                files.remove(key);
            }
        }
    }
    Ok(())
}

/// Sets unit, or sensitivity if the unit is not that of the quantity, with the sign in it.
fn set_unit(channel: &mut Table, quantity: &str, unit: &str) {
    let own = |key: &str| channel.get(key).and_then(Item::as_str);
    let before = own("sensitivity")
        .or_else(|| own("unit"))
        .unwrap_or_default();
    let sign = channel.get("sign").and_then(Item::as_integer);
    if !unit.is_empty() && unit == signed_unit(before, sign) {
        return;
    }
    for key in ["unit", "sensitivity", "sign"] {
        if unit.is_empty() || quantity.is_empty() || key == "sign" {
            channel.remove(key);
        }
    }
    if unit.is_empty() || quantity.is_empty() {
        return;
    }
    // "11 mV/N" is a sensitivity, "-1 N" what one unit of the column stands for.
    let (used, other) = match parse_scale(unit, quantity) {
        Ok(_) => ("unit", "sensitivity"),
        Err(_) => ("sensitivity", "unit"),
    };
    channel.remove(other);
    set(channel, used, value(unit));
    if used == "unit" {
        // What only a sensor's volts have.
        channel.remove("gain");
        channel.remove("offset");
    }
}

fn new_impacts(directory: &Path, rows: &[NewImpact]) -> Result<Vec<(&'static str, String)>, Error> {
    let recordings = recordings_inside(directory)?.directory;
    for row in rows {
        path_inside(&recordings, &row.file)?;
    }
    let table = rows.iter().map(|row| {
        let own = [
            ("id", &row.id),
            ("specimen", &row.specimen),
            ("file", &row.file),
        ];
        let own = own.map(|(name, cell)| (name.to_owned(), cell.clone()));
        // What was checked stands, whatever the other columns are called.
        row.cells.clone().into_iter().chain(own).collect()
    });
    let table: Vec<BTreeMap<String, String>> = table.collect();
    let impacts = add_rows(&directory.join("impacts.csv"), &table)?;
    // Specimens first: stopped in between, the campaign still knows all that it names.
    let mut files = Vec::new();
    let specimens = directory.join("specimens.csv");
    if specimens.exists() {
        let known = match is_template_file(&specimens) {
            true => Vec::new(),
            false => read_specimens(&specimens)?,
        };
        let ids = rows.iter().map(|row| &row.specimen);
        let new = ids.filter(|id| known.iter().all(|specimen| specimen.id != **id));
        let cells = new
            .unique()
            .map(|id| BTreeMap::from([("id".to_owned(), id.clone())]));
        let new: Vec<_> = cells.collect();
        if !new.is_empty() {
            files.push(("specimens.csv", add_rows(&specimens, &new)?));
        }
    }
    files.push(("impacts.csv", impacts));
    Ok(files)
}

#[cfg(test)]
mod tests {
    use super::*;
    use windfall_campaign::settings::template::{TemplateKind, write_template};

    #[test]
    fn a_column_of_times_brings_its_unit_and_remarks_stay() {
        let folder = tempfile::tempdir().unwrap();
        let directory = folder.path().join("campaign");
        write_template(TemplateKind::Carriage, &directory).unwrap();
        let channel = |quantity: &str, column: &str, unit: &str| ChannelChange {
            quantity: quantity.to_owned(),
            column: column.to_owned(),
            unit: unit.to_owned(),
        };
        let channels = |time: &str| {
            Change::Channels(ChannelsChange {
                channels: vec![
                    channel("force", "Kraft [N]", "N"),
                    channel("position", "Weg [mm]", "mm"),
                ],
                time: Some(time.to_owned()),
                rate: None,
            })
        };
        let view = change_campaign(&directory, "*", &channels("Zeit [ms]")).unwrap();
        assert_eq!((view.time.as_deref(), view.rate), (Some("Zeit [ms]"), None));
        assert!(view.text.contains("time_unit = \"ms\""), "{}", view.text);
        assert!(
            view.text.contains("# Each channel names its column"),
            "{}",
            view.text
        );
        // Said once more it stays; another column has another unit.
        let view = change_campaign(&directory, &view.version, &channels("Zeit [ms]")).unwrap();
        assert!(view.text.contains("time_unit = \"ms\""));
        let view = change_campaign(&directory, &view.version, &channels("t")).unwrap();
        assert!(!view.text.contains("\ntime_unit"), "{}", view.text);
    }

    #[test]
    fn what_one_unit_of_a_column_stands_for_may_be_negative() {
        let folder = tempfile::tempdir().unwrap();
        let directory = folder.path().join("campaign");
        write_template(TemplateKind::Carriage, &directory).unwrap();
        let path = directory.join(CAMPAIGN_FILE);
        let change = |force: &str| {
            let channel = |quantity: &str, unit: &str| ChannelChange {
                quantity: quantity.to_owned(),
                column: quantity.to_owned(),
                unit: unit.to_owned(),
            };
            let change = ChannelsChange {
                channels: vec![channel("force", force), channel("position", "0.17 mm")],
                time: Some("t".to_owned()),
                rate: None,
            };
            let view = change_campaign(&directory, "*", &Change::Channels(change)).unwrap();
            let force = view.channels.iter().find(|own| own.quantity == "force");
            (force.unwrap().unit.clone(), view.text)
        };
        let (unit, text) = change("-1 N");
        assert_eq!(unit, "-1 N");
        assert!(
            text.contains("unit = \"-1 N\"") && text.contains("unit = \"0.17 mm\""),
            "{text}"
        );
        // A sign of its own is part of it, and stays where nothing is changed.
        std::fs::write(
            &path,
            text.replace("unit = \"-1 N\"", "unit = \"N\"\nsign = -1"),
        )
        .unwrap();
        let (unit, text) = change("-1 N");
        assert_eq!(unit, "-1 N");
        assert!(text.contains("\nsign = -1"), "{text}");
        let (unit, text) = change("-11 mV/N");
        assert_eq!(unit, "-11 mV/N");
        assert!(
            !text.contains("\nsign") && text.contains("sensitivity = \"-11 mV/N\""),
            "{text}"
        );
        let (unit, text) = change("N");
        assert_eq!(unit, "N");
        assert!(!text.contains("\nsensitivity = "), "{text}");
    }

    #[test]
    fn a_rig_that_is_given_is_no_longer_that_of_the_template() {
        let folder = tempfile::tempdir().unwrap();
        let directory = folder.path().join("campaign");
        write_template(TemplateKind::Carriage, &directory).unwrap();
        let given = |pairs: &[(&str, &str)]| {
            let pairs = pairs.iter();
            Change::Rig(
                pairs
                    .map(|(k, v)| ((*k).to_owned(), (*v).to_owned()))
                    .collect(),
            )
        };
        assert!(view_campaign(&directory).unwrap().rig_asked.is_some());
        // The value of the template itself, by somebody who says it.
        let change = given(&[("mass", "0.5 kg"), ("mass_sd", "")]);
        let view = change_campaign(&directory, "*", &change).unwrap();
        assert_eq!(view.rig_asked, None);
        assert!(view.text.contains("\nmass = \"0.5 kg\"\n"), "{}", view.text);
        assert!(!view.text.contains("\nmass_sd"), "{}", view.text);
        let change = given(&[("mass", "from impulse"), ("driving_acceleration", "1 g0")]);
        let view = change_campaign(&directory, "*", &change).unwrap();
        assert!(
            view.text.contains("mass = \"from impulse\""),
            "{}",
            view.text
        );
        let wrong = change_campaign(&directory, "*", &given(&[("mass", "3 mm")]));
        assert!(wrong.unwrap_err().to_string().contains("length"));
    }

    #[test]
    fn tables_within_a_line_keep_their_other_keys() {
        let folder = tempfile::tempdir().unwrap();
        let directory = folder.path().join("campaign");
        write_template(TemplateKind::Carriage, &directory).unwrap();
        let path = directory.join(CAMPAIGN_FILE);
        let text = std::fs::read_to_string(&path).unwrap();
        let begin = text.find("[fit]").unwrap();
        let text = format!(
            "summary = {{ group = \"variety\" }}\nfit = {{ laws = [\"hertz\"], noise = \"white\" }}\n{}",
            &text[..begin]
        );
        std::fs::write(&path, text).unwrap();
        let change = OptionsChange {
            words: BTreeMap::from([("end".to_owned(), "gap-zero".to_owned())]),
            ..OptionsChange::default()
        };
        let view = change_campaign(&directory, "*", &Change::Options(change)).unwrap();
        let options = view.options.unwrap();
        assert_eq!(
            (view.laws.as_slice(), view.group.as_deref()),
            (&["hertz".to_owned()][..], Some("variety"))
        );
        assert_eq!(
            (options.noise.as_str(), options.end.as_str()),
            ("white", "gap-zero")
        );
    }
}
