//! The tables of campaign.toml that every kind has, with specimens.csv and impacts.csv.

use crate::settings::file::{FilesFile, SummaryFile, TitleFile};
use crate::settings::files::{check_group, check_placeholders, file_plan};
use crate::settings::kind::{CAMPAIGN_FILE, CampaignKind, STORE_FILE, UNDO_FILE};
use crate::settings::model::{Campaign, ChannelPlan};
use crate::settings::rig_given::rig_asked;
use crate::settings::tables::{read_impacts, read_specimens};
use std::path::Path;
use windfall_files::error::{Error, Place};
use windfall_files::inputs::{protect, protect_campaign};
use windfall_files::text::toml_source::TomlSource;
use windfall_files::write_file::sweep;

/// Files of a campaign that no result may replace, whether they are there or not.
const OWN_FILES: [&str; 7] = [
    CAMPAIGN_FILE,
    "specimens.csv",
    "impacts.csv",
    STORE_FILE,
    UNDO_FILE,
    "results.sqlite-journal",
    "results.sqlite-wal",
];

/// `[campaign]`, `[files]` and `[summary]`, which all kinds share.
pub type SharedFile<'a> = (&'a TitleFile, &'a FilesFile, &'a SummaryFile);

/// Reads what all kinds share, with specimens.csv and impacts.csv.
///
/// # Errors
/// A file of the campaign is missing or does not say what it must.
pub fn read_shared(
    source: &TomlSource,
    directory: &Path,
    kind: CampaignKind,
    (titles, files, summary): SharedFile,
    channels: Vec<ChannelPlan>,
) -> Result<Campaign, Error> {
    let noisy = channels.iter().find(|own| own.noise_sd.is_some());
    if let (Some(channel), true) = (noisy, kind != CampaignKind::Impacts) {
        return Err(Error::ValueInvalid {
            place: Place {
                file: source.path.clone(),
                line: channel.line,
            },
            key: format!("{} noise_sd", channel.table),
            text: channel.column.clone(),
            problem: "noise is given for impacts only; remove the line".to_owned(),
        });
    }
    let files = file_plan(source, directory, files, channels)?;
    protect(&directory.join(STORE_FILE));
    for folder in [directory, &files.directory] {
        sweep(&folder.join(STORE_FILE));
    }
    protect_campaign(directory, &OWN_FILES, &files.directory);
    let specimens_file = directory.join("specimens.csv");
    let specimens = match specimens_file.exists() {
        true => Some(read_specimens(&specimens_file)?),
        false => None,
    };
    let entries = read_impacts(&directory.join("impacts.csv"), specimens.as_deref())?;
    let specimens = specimens.unwrap_or_default();
    let group = summary.group.as_ref();
    check_group(source, group, &specimens, &entries)?;
    check_placeholders(source, &files, &entries)?;
    let title = titles.title.clone();
    Ok(Campaign {
        directory: directory.to_path_buf(),
        kind,
        title: title.unwrap_or_else(|| directory.display().to_string()),
        simulated: titles.simulated.clone(),
        note: titles.note.clone(),
        rig_asked: rig_asked(source),
        files,
        group: group.map(|group| group.get_ref().clone()),
        specimens,
        entries,
    })
}
