//! A campaign as the page shows it, whatever it measures.

use crate::campaign_files::{CAMPAIGN_FILES, campaign_version, read_any};
use crate::table_origin::outdated;
use crate::undo::{History, StepView};
use serde::Serialize;
use std::path::Path;
use std::time::SystemTime;
use windfall_campaign::recording::digests::campaign_text;
use windfall_campaign::settings::fit::{ENDS, INTERVALS, NOISES, TREATMENTS, WEIGHTS};
use windfall_campaign::settings::kind::{STORE_FILE, UNDO_FILE};
use windfall_campaign::settings::model::ImpactCampaign;
use windfall_files::confined::path_inside;
use windfall_files::error::Error;
use windfall_files::inputs::check_regular;
use windfall_files::name::Name;
use windfall_files::option_value::word_of;
use windfall_files::text::quote::{command, path_word};
use windfall_files::write_file::sweep;
use windfall_identify::fit::problem::FitOptions;
use windfall_report::run::REPORT_DIRECTORY;
use windfall_report::stored_card::CARD_FILE;

/// Directory of tables for regressions and surfaces in a campaign directory.
pub const TABLES_DIRECTORY: &str = "tables";

/// Table of the campaign's own results in a campaign directory.
pub const RESULTS_TABLE: &str = "tables/results.csv";

/// A table of text.
#[derive(Clone, Debug, Default, PartialEq, Serialize, utoipa::ToSchema)]
pub struct TableView {
    /// Names of the columns.
    pub columns: Vec<String>,
    /// Cells, row by row.
    pub rows: Vec<Vec<String>>,
}

/// A channel as campaign.toml has it.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct ChannelView {
    /// What it holds.
    pub quantity: String,
    /// Column in the files.
    pub column: String,
    /// Its unit, what one unit of it stands for ("-1 N"), or the sensitivity of its
    /// sensor; with the channel's sign.
    pub unit: String,
}

/// Options of the fit, in the words of the command line.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct FitOptionsView {
    /// Quantities of the cost.
    pub quantities: Vec<String>,
    /// Weights.
    pub weights: String,
    /// Noise.
    pub noise: String,
    /// Intervals.
    pub intervals: String,
    /// Time of first touch.
    pub onset: String,
    /// Velocity at first touch.
    pub initial_velocity: String,
    /// Zero of the displacement.
    pub displacement_offset: String,
    /// End of contact.
    pub end: String,
    /// Parameters that are estimated although they have a value.
    pub free: Vec<String>,
}

/// What the files of a campaign say.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct CampaignView {
    /// Name of the directory.
    pub id: String,
    /// Digest of the files of the campaign.
    pub version: String,
    /// Title.
    pub title: String,
    /// What it measures.
    pub kind: &'static str,
    /// Label of simulated recordings.
    pub simulated: Option<String>,
    /// Lines of `[rig]`: key and value.
    pub rig: Vec<(String, String)>,
    /// Why nothing is calculated until somebody says what the rig is; `None` once it was said.
    pub rig_asked: Option<String>,
    /// Channels.
    pub channels: Vec<ChannelView>,
    /// Column of times that `[files]` names.
    pub time: Option<String>,
    /// Sampling rate that `[files]` gives.
    pub rate: Option<String>,
    /// Laws as expressions.
    pub laws: Vec<String>,
    /// Options of the fit, where single impacts are fitted.
    pub options: Option<FitOptionsView>,
    /// Column by which results are grouped.
    pub group: Option<String>,
    /// specimens.csv.
    pub specimens: TableView,
    /// impacts.csv.
    pub impacts: TableView,
    /// campaign.toml, word for word.
    pub text: String,
    /// Tables for regressions and surfaces.
    pub tables: Vec<String>,
    /// Whether the table of results is of other results, or of other tables, than there are now.
    pub results_table_outdated: bool,
    /// Whether a report was written.
    pub report: bool,
    /// The command that fits the campaign.
    pub command: String,
    /// The note on the campaign.
    pub note: Option<String>,
    /// The newest change of the page, which can be undone.
    pub undo: Option<StepView>,
    /// The change that was undone last, and can be done again.
    pub redo: Option<StepView>,
}

/// Checks that the own files of a campaign lie in its directory.
///
/// # Errors
/// One is a symbolic link, or no regular file.
pub fn check_confined(directory: &Path) -> Result<(), Error> {
    for name in CAMPAIGN_FILES
        .iter()
        .chain(&[STORE_FILE, UNDO_FILE, CARD_FILE])
    {
        check_regular(&path_inside(directory, name)?)?;
    }
    Ok(())
}

/// Checks where work on a campaign writes besides the files of the campaign.
///
/// # Errors
/// Results would be written through a symbolic link.
pub fn check_work(directory: &Path) -> Result<(), Error> {
    path_inside(directory, &format!("{REPORT_DIRECTORY}/figures")).map(|_| ())
}

/// What the files of a campaign say.
///
/// # Errors
/// A file of the campaign is missing or does not say what it must.
pub fn view_campaign(directory: &Path) -> Result<CampaignView, Error> {
    // A file may change between two reads. If it keeps changing, the version is outdated, never
    // wrong.
    let mut version = campaign_version(directory)?;
    for _ in 0..3 {
        let view = view_version(directory, version)?;
        version = campaign_version(directory)?;
        if version == view.version {
            return Ok(view);
        }
    }
    view_version(directory, version)
}

fn view_version(directory: &Path, version: String) -> Result<CampaignView, Error> {
    let (campaign, impacts) = read_any(directory)?;
    let text = campaign_text(directory)?;
    let tables: toml::Table = toml::from_str(&text).unwrap_or_default();
    let id = name_of(directory);
    let (undo, redo) = History::read(directory).views();
    let untitled = directory.display().to_string();
    Ok(CampaignView {
        version,
        title: match campaign.title == untitled {
            true => id.clone(),
            false => campaign.title,
        },
        kind: campaign.kind.name(),
        simulated: campaign.simulated,
        rig: lines_of(&tables, "rig"),
        rig_asked: campaign.rig_asked.map(|asked| asked.problem),
        channels: channels_of(&tables),
        time: files_key(&tables, "time"),
        rate: files_key(&tables, "rate"),
        laws: match &impacts {
            Some(impacts) => impacts.fit.laws.iter().map(ToString::to_string).collect(),
            None => laws_written(&tables),
        },
        options: impacts.as_ref().map(options_of),
        group: campaign.group,
        specimens: table_of(campaign.specimens.iter().map(|specimen| &specimen.cells)),
        impacts: table_of(campaign.entries.iter().map(|entry| &entry.cells)),
        text,
        tables: tables_of(directory)?,
        results_table_outdated: outdated(directory),
        report: directory
            .join(REPORT_DIRECTORY)
            .join("report.html")
            .is_file(),
        command: command(&["fit", &path_word(&id)]),
        note: campaign.note,
        undo,
        redo,
        id,
    })
}

/// What changes when the files of a campaign or its store do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CampaignStamp {
    /// Digest of the files of the campaign.
    pub version: String,
    /// Size and time of change of its store.
    pub store: Option<(u64, Option<SystemTime>)>,
}

/// What changes when the files of a campaign or its store do.
///
/// # Errors
/// A file of the campaign cannot be read.
pub fn campaign_stamp(directory: &Path) -> Result<CampaignStamp, Error> {
    let store = std::fs::metadata(directory.join(STORE_FILE));
    Ok(CampaignStamp {
        version: campaign_version(directory)?,
        store: store.ok().map(|data| (data.len(), data.modified().ok())),
    })
}

/// The last part of the path of a directory.
pub fn name_of(directory: &Path) -> String {
    let name = directory.file_name().unwrap_or(directory.as_os_str());
    name.to_string_lossy().into_owned()
}

/// Laws of campaigns whose readers differ, as the file has them.
fn laws_written(tables: &toml::Table) -> Vec<String> {
    let law = |table: &str, key: &str| match tables.get(table)?.get(key)? {
        toml::Value::Array(laws) => {
            let texts = laws.iter().filter_map(toml::Value::as_str);
            Some(texts.map(str::to_owned).collect())
        }
        value => value.as_str().map(|law| vec![law.to_owned()]),
    };
    let places = [("fit", "laws"), ("fit", "law"), ("calibrate", "law")];
    let found = places.iter().find_map(|(table, key)| law(table, key));
    found.unwrap_or_default()
}

fn options_of(campaign: &ImpactCampaign) -> FitOptionsView {
    let options: &FitOptions = &campaign.fit.options;
    let quantities = options.quantities.names().into_iter();
    FitOptionsView {
        quantities: quantities.map(str::to_owned).collect(),
        weights: word_of(&WEIGHTS, options.weighting),
        noise: word_of(&NOISES, options.noise),
        intervals: word_of(&INTERVALS, options.intervals.method),
        onset: word_of(&TREATMENTS, options.onset),
        initial_velocity: match options.known_velocity {
            Some(velocity) => format!("{velocity} m/s"),
            None => word_of(&TREATMENTS, options.initial_velocity),
        },
        displacement_offset: word_of(&TREATMENTS, options.displacement_offset),
        end: word_of(&ENDS, options.end),
        free: campaign.fit.free.clone(),
    }
}

/// The table of named cells; columns in the order of the first row.
fn table_of<'a>(rows: impl Iterator<Item = &'a Vec<(Name, String)>>) -> TableView {
    let mut table = TableView::default();
    for cells in rows {
        if table.columns.is_empty() {
            table.columns = cells.iter().map(|(name, _)| name.to_string()).collect();
        }
        let row = cells.iter().map(|(_, cell)| cell.clone());
        table.rows.push(row.collect());
    }
    table
}

fn lines_of(tables: &toml::Table, name: &str) -> Vec<(String, String)> {
    let lines = tables.get(name).and_then(toml::Value::as_table);
    let lines = lines.into_iter().flatten();
    lines
        .map(|(key, value)| (key.clone(), text_of(value)))
        .collect()
}

fn files_key(tables: &toml::Table, key: &str) -> Option<String> {
    tables.get("files")?.get(key).map(text_of)
}

fn text_of(value: &toml::Value) -> String {
    match value {
        toml::Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}

fn channels_of(tables: &toml::Table) -> Vec<ChannelView> {
    let channels = tables.get("channels").and_then(toml::Value::as_table);
    let channels = channels.into_iter().flatten();
    channels
        .map(|(quantity, channel)| {
            let key = |name: &str| channel.get(name).map(text_of);
            let unit = key("sensitivity")
                .or_else(|| key("unit"))
                .unwrap_or_default();
            let sign = channel.get("sign").and_then(toml::Value::as_integer);
            ChannelView {
                quantity: quantity.clone(),
                column: key("column").unwrap_or_default(),
                unit: signed_unit(&unit, sign),
            }
        })
        .collect()
}

/// A unit or sensitivity with the sign of its channel: "N" turned round is "-1 N".
pub(crate) fn signed_unit(unit: &str, sign: Option<i64>) -> String {
    let number = unit.starts_with(|c: char| c.is_ascii_digit() || c == '.');
    match sign == Some(-1) && !unit.is_empty() {
        true if number => format!("-{unit}"),
        true => match unit.strip_prefix(['-', '−']) {
            Some(positive) => positive.to_owned(),
            None => format!("-1 {unit}"),
        },
        false => unit.to_owned(),
    }
}

/// Names of the CSV files that regressions and surfaces can use.
fn tables_of(directory: &Path) -> Result<Vec<String>, Error> {
    let mut found = Vec::new();
    for (prefix, folder) in [
        ("", directory.to_path_buf()),
        ("tables/", directory.join(TABLES_DIRECTORY)),
    ] {
        // What killed uploads have left.
        sweep(&folder.join(TABLES_DIRECTORY));
        let own = names_in(&folder)?.into_iter().filter(|name| {
            let csv = name.to_lowercase().ends_with(".csv");
            csv && !(prefix.is_empty() && CAMPAIGN_FILES.contains(&name.as_str()))
        });
        found.extend(own.map(|name| format!("{prefix}{name}")));
    }
    Ok(found)
}

/// Sorted names of the plain files in a directory; none without a directory.
///
/// # Errors
/// It cannot be read.
pub(crate) fn names_in(folder: &Path) -> Result<Vec<String>, Error> {
    let unreadable = |source| Error::access(folder, "read", source);
    let entries = match std::fs::read_dir(folder) {
        Ok(entries) => entries,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(Vec::new()),
        Err(source) => return Err(unreadable(source)),
    };
    let mut names = Vec::new();
    for entry in entries {
        let entry = entry.map_err(unreadable)?;
        let plain = entry.file_type().is_ok_and(|kind| kind.is_file());
        if let (true, Ok(name)) = (plain, entry.file_name().into_string())
            && !name.starts_with('.')
        {
            names.push(name);
        }
    }
    names.sort();
    Ok(names)
}
