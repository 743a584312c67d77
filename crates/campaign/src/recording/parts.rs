//! The parts of a recording that hold one impact each, before anything is known of the rig.

use crate::recording::read::read_with_gaps;
use crate::settings::channels::channel_plans;
use crate::settings::contact::contact_plan;
use crate::settings::file::CampaignFile;
use crate::settings::files::file_plan;
use crate::settings::kind::CAMPAIGN_FILE;
use crate::settings::model::{FilePlan, ImpactEntry};
use crate::settings::rig::rig_plan;
use crate::settings::template::UNWRITTEN;
use std::path::Path;
use windfall_files::error::Error;
use windfall_files::name::Name;
use windfall_files::text::toml_source::{TomlSource, parse_source};
use windfall_signal::measure::Surroundings;
use windfall_signal::{ExtractOptions, impacts_in};

/// A boundary between two contacts is written to this part of the time between them; 1.
const CUT_DIGITS: f64 = 0.01;

/// What a campaign says about finding contacts, without its rig.
#[derive(Clone, Debug)]
pub struct PartPlan {
    files: FilePlan,
    contact: ExtractOptions,
}

/// A part of a recording, as `from_s` and `to_s` of impacts.csv say it; blank where it has
/// no bound.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Part {
    /// `from_s`; s.
    pub from: String,
    /// `to_s`; s.
    pub to: String,
}

impl PartPlan {
    /// Reads campaign.toml of a campaign of impacts. Lines that a person has not written yet
    /// stand for their examples: scales of rig and channels do not move a contact in time.
    ///
    /// * `directory`: that of the campaign, for messages and for `[files] directory`
    ///
    /// # Errors
    /// The text does not say what it must.
    pub fn read(directory: &Path, text: &str) -> Result<Self, Error> {
        let source = TomlSource {
            path: directory.join(CAMPAIGN_FILE),
            text: text.replace(UNWRITTEN, ""),
        };
        let file: CampaignFile = parse_source(&source)?;
        let (rig, _) = rig_plan(&source, file.rig.as_ref())?;
        let channels = channel_plans(&source, file.channels.as_ref())?;
        Ok(Self {
            contact: contact_plan(&source, &file, &rig)?,
            files: file_plan(&source, directory, &file.files, channels)?,
        })
    }

    /// The parts of a recording that hold one impact each; one without bounds where it holds
    /// a single one.
    ///
    /// * `path`: the recording, wherever it lies
    /// * `cells`: cells of its row, which names of columns may ask for
    ///
    /// # Errors
    /// The recording cannot be read, or shows no contact.
    pub fn parts(&self, path: &Path, cells: &[(Name, String)]) -> Result<Vec<Part>, Error> {
        let files = FilePlan {
            directory: path.parent().map_or_else(Default::default, Path::to_owned),
            within: None,
            ..self.files.clone()
        };
        let name = path.file_name().unwrap_or_default();
        let entry = ImpactEntry {
            id: String::new(),
            specimen: String::new(),
            file: name.to_string_lossy().into_owned(),
            line: 0,
            from: None,
            to: None,
            cells: cells.to_vec(),
        };
        let recording = read_with_gaps(&files, &entry)?;
        let places = impacts_in(&recording, &self.contact)
            .map_err(|source| Error::signal(path.to_path_buf(), source))?;
        Ok(match places.len() {
            1 => vec![Part::default()],
            _ => places.iter().map(part_of).collect(),
        })
    }
}

/// From half-way to the contact before up to half-way to the one behind.
fn part_of(place: &Surroundings) -> Part {
    Part {
        from: cut(place.from, place.onset),
        to: cut(place.end, place.until),
    }
}

/// A time half-way between two, with no more digits than it needs.
fn cut(before: f64, after: f64) -> String {
    let between = after - before;
    if !between.is_finite() {
        return String::new();
    }
    let digits = (-(CUT_DIGITS * between).log10()).ceil().clamp(0.0, 15.0) as usize;
    format!("{:.digits$}", f64::midpoint(before, after))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_cuts_between_contacts() {
        for (before, after, written) in [
            (f64::NEG_INFINITY, 0.3, ""),
            (0.3, f64::INFINITY, ""),
            (1.0, 2.0, "1.50"),
            (0.012_34, 0.112_36, "0.062"),
            (10.0, 10.000_02, "10.0000100"),
            (1000.0, 3000.0, "2000"),
        ] {
            assert_eq!(cut(before, after), written);
            if let Ok(time) = written.parse::<f64>() {
                assert!(before < time && time < after);
            }
        }
    }
}
