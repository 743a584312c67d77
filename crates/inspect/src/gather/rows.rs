//! Recordings → rows of impacts.csv: one for each contact that a recording holds.

use crate::gather::folder::name_of;
use crate::gather::names::NamedRecording;
use itertools::Itertools;
use std::collections::BTreeSet;
use std::path::Path;
use windfall_campaign::recording::parts::{Part, PartPlan};
use windfall_campaign::result::counted::NOTE_COLUMN;
use windfall_campaign::settings::template::UNWRITTEN;

/// More recordings than this are counted, not named.
const NAMED: usize = 3;

/// A row of impacts.csv.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct ImpactRow {
    pub id: String,
    pub specimen: String,
    pub file: String,
    /// Further columns.
    pub cells: Vec<(String, String)>,
}

/// Finds the contacts of recordings, and remembers which hold several.
pub(crate) struct Rows {
    plan: Result<PartPlan, String>,
    taken: BTreeSet<String>,
    recordings: usize,
    several: Vec<(String, usize)>,
}

impl Rows {
    /// * `text`: that of campaign.toml; `None` where a row is a recording, whatever it holds
    /// * `taken`: ids that impacts.csv has already
    pub fn begin(directory: &Path, text: Option<&str>, taken: BTreeSet<String>) -> Self {
        let plan = match text {
            // Without a rate nothing says when a sample was.
            Some(text) if text.contains(&format!("{UNWRITTEN}rate")) => {
                Err("[files] rate is not written yet".to_owned())
            }
            Some(text) => PartPlan::read(directory, text).map_err(|error| error.to_string()),
            None => Err(String::new()),
        };
        Self {
            plan,
            taken,
            recordings: 0,
            several: Vec::new(),
        }
    }

    /// The rows of a recording; one that shows no contact has one, of which the fit will say
    /// what is wrong.
    pub fn of(&mut self, path: &Path, read: &NamedRecording) -> Vec<ImpactRow> {
        self.recordings += 1;
        let file = name_of(path);
        let plan = self.plan.as_ref().ok();
        let cells = read.of_impact.iter();
        let cells: Vec<_> = cells
            .map(|(name, cell)| (name.into(), cell.clone()))
            .collect();
        let parts = plan.and_then(|plan| plan.parts(path, &cells).ok());
        let parts = parts.unwrap_or_else(|| vec![Part::default()]);
        let count = parts.len();
        if count > 1 {
            self.several.push((file.clone(), count));
        }
        let row = |(number, part): (usize, Part)| {
            let mut cells = read.of_impact.clone();
            let mut wanted = read.id.clone();
            if count > 1 {
                wanted = format!("{wanted}-{number}");
                let note = format!("contact {number} of {count} in {file}");
                let own = [
                    ("from_s", part.from),
                    ("to_s", part.to),
                    (NOTE_COLUMN, note),
                ];
                cells.extend(own.map(|(name, cell)| (name.to_owned(), cell)));
            }
            ImpactRow {
                id: self.new_id(wanted),
                specimen: read.specimen.clone(),
                file: file.clone(),
                cells,
            }
        };
        parts
            .into_iter()
            .zip(1..)
            .map(|(part, n)| (n, part))
            .map(row)
            .collect()
    }

    /// An id that no other impact has.
    fn new_id(&mut self, wanted: String) -> String {
        let further = (2..).map(|number| format!("{wanted}-{number}"));
        let mut ids = std::iter::once(wanted.clone()).chain(further);
        let id = ids.find(|id| !self.taken.contains(id)).unwrap_or(wanted);
        self.taken.insert(id.clone());
        id
    }

    /// What was assumed about the contacts.
    pub fn assumed(&self) -> Option<String> {
        match &self.plan {
            Err(why) if !why.is_empty() && self.recordings > 0 => Some(format!(
                "each recording holds one contact: they could not be counted, as {why}"
            )),
            _ if self.several.is_empty() => None,
            _ => {
                let named = self.several.iter().take(NAMED);
                let named = named
                    .map(|(file, count)| format!("{count} in {file}"))
                    .join(", ");
                let further = match self.several.len() > NAMED {
                    true => ", …",
                    false => "",
                };
                Some(format!(
                    "every contact is an impact of its own, of the specimen of its recording: {} of \
                     {} recordings hold several ({named}{further}), told apart by from_s and to_s in \
                     impacts.csv",
                    self.several.len(),
                    self.recordings
                ))
            }
        }
    }
}
