//! Campaigns that fit no impacts: what their kinds share.

use crate::settings::file::{FilesFile, SummaryFile, TitleFile};
use crate::settings::files::{check_group, check_placeholders, file_plan};
use crate::settings::kind::CampaignKind;
use crate::settings::model::{ChannelPlan, FilePlan, ImpactEntry, Specimen};
use crate::settings::tables::{read_impacts, read_specimens};
use std::path::{Path, PathBuf};
use windfall_files::error::Error;
use windfall_files::text::toml_source::TomlSource;

/// A campaign whose items are evaluated one recording at a time.
#[derive(Clone, Debug)]
pub struct ItemCampaign {
    /// The campaign directory.
    pub directory: PathBuf,
    /// What it measures.
    pub kind: CampaignKind,
    /// Title of tables and reports.
    pub title: String,
    /// Label shown with every result when the recordings are simulated.
    pub simulated: Option<String>,
    /// How recordings are read.
    pub files: FilePlan,
    /// Column of specimens.csv or impacts.csv by which results are grouped.
    pub group: Option<String>,
    /// Specimens, in the order of specimens.csv; none where there is no such file.
    pub specimens: Vec<Specimen>,
    /// Rows of impacts.csv, one for each recording or part of one.
    pub entries: Vec<ImpactEntry>,
}

/// Tables of campaign.toml that all kinds share.
pub struct SharedFile<'a> {
    /// `[campaign]`
    pub campaign: &'a TitleFile,
    /// `[files]`
    pub files: &'a FilesFile,
    /// `[summary]`
    pub summary: &'a SummaryFile,
}

/// Reads what all kinds share, with specimens.csv and impacts.csv.
///
/// # Errors
/// A file of the campaign is missing or does not say what it must.
pub fn read_item_campaign(
    source: &TomlSource,
    directory: &Path,
    kind: CampaignKind,
    shared: &SharedFile,
    channels: Vec<ChannelPlan>,
) -> Result<ItemCampaign, Error> {
    let files = file_plan(source, directory, shared.files, channels)?;
    let specimens_file = directory.join("specimens.csv");
    let specimens = match specimens_file.exists() {
        true => Some(read_specimens(&specimens_file)?),
        false => None,
    };
    let entries = read_impacts(&directory.join("impacts.csv"), specimens.as_deref())?;
    let specimens = specimens.unwrap_or_default();
    let group = shared.summary.group.as_ref();
    check_group(source, group, &specimens, &entries)?;
    check_placeholders(source, &files, &entries)?;
    let title = shared.campaign.title.clone();
    Ok(ItemCampaign {
        directory: directory.to_path_buf(),
        kind,
        title: title.unwrap_or_else(|| directory.display().to_string()),
        simulated: shared.campaign.simulated.clone(),
        files,
        group: group.map(|group| group.get_ref().clone()),
        specimens,
        entries,
    })
}

/// The specimen of an entry, where specimens.csv has it.
#[must_use]
pub fn specimen_of<'a>(campaign: &'a ItemCampaign, entry: &ImpactEntry) -> Option<&'a Specimen> {
    campaign
        .specimens
        .iter()
        .find(|specimen| specimen.id == entry.specimen)
}

/// The group of an entry, where the campaign has groups.
#[must_use]
pub fn group_of(campaign: &ItemCampaign, entry: &ImpactEntry) -> Option<String> {
    let column = campaign.group.as_ref()?;
    let specimen = specimen_of(campaign, entry).map_or(&[][..], |specimen| &specimen.cells);
    let mut cells = specimen.iter().chain(&entry.cells);
    let (_, cell) = cells.find(|(name, _)| name == column)?;
    Some(cell.clone())
}
