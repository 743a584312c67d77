//! What a kind of campaign that fits no impacts must provide.

use crate::measured::{MeasuredGroup, MeasuredItem, ShownTables, groups_of, laws_of, spread_of};
use std::path::Path;
use windfall_campaign::pipeline::evaluate::Document;
use windfall_campaign::pipeline::request::{FitRequest, apply_request_to_measurement};
use windfall_campaign::settings::model::{Campaign, ImpactEntry};
use windfall_draw::files::NamedFigure;
use windfall_files::error::Error;
use windfall_files::found::{FailureOutcome, FindingOutcome, SpreadOutcome};
use windfall_files::named::Named;
use windfall_signal::recording::Recording;

/// A kind of campaign whose recordings are evaluated one at a time.
pub trait Measurement: Sized + Send + Sync {
    /// What is found in one recording, and kept.
    type Found: Document;

    /// Columns of the tables that people read.
    const SHOWN: ShownTables;

    /// Reads a campaign directory.
    ///
    /// # Errors
    /// A file of the campaign is missing or does not say what it must.
    fn read(directory: &Path) -> Result<Self, Error>;

    /// What all kinds share.
    fn shared(&self) -> &Campaign;

    /// What all kinds share, to be overridden by options.
    fn shared_mut(&mut self) -> &mut Campaign;

    /// Overrides settings with options.
    ///
    /// # Errors
    /// An option that the kind does not have, or one that cannot be used.
    fn apply(&mut self, request: &FitRequest) -> Result<(), Error> {
        apply_request_to_measurement(self.shared_mut(), request)
    }

    /// Everything besides recording, channels and time range that the result on an entry
    /// depends on, as text with all digits: settings, cells used.
    fn depends_on(&self, entry: &ImpactEntry) -> String;

    /// Evaluates one recording.
    ///
    /// # Errors
    /// It does not show what it should.
    fn evaluate(&self, entry: &ImpactEntry, recording: &Recording) -> Result<Self::Found, Error>;

    /// Results of the campaign from those of its recordings.
    ///
    /// # Errors
    /// A cell of a table cannot be used.
    fn results(&self, found: &FoundItems<Self>) -> Result<MeasuredResults, Error>;

    /// Paragraphs that say how the results came about.
    fn methods(&self) -> Vec<String>;

    /// The figure of a recording; `None` of one without a result, which is reported as a
    /// failure, and of kinds that draw the whole.
    ///
    /// * `found`: in the recording, where it could be evaluated
    ///
    /// # Errors
    /// The recording can no longer be read.
    fn figure(
        &self,
        entry: &ImpactEntry,
        found: Option<&Self::Found>,
        results: &MeasuredResults,
    ) -> Result<Option<NamedFigure>, Error>;
}

/// Position in the campaign's entries, and what was found there.
pub type FoundItems<K> = [(usize, <K as Measurement>::Found)];

/// Results of a campaign, as its kind makes them.
#[derive(Clone, Debug)]
pub struct MeasuredResults {
    /// One entry per recording and law.
    pub items: Vec<MeasuredItem>,
    /// Parts of recordings: the bounces of a drop.
    pub parts: Vec<MeasuredItem>,
    /// Results on whole specimens, from all their recordings.
    pub specimens: Vec<MeasuredItem>,
    /// Results on the whole campaign.
    pub whole: Vec<MeasuredItem>,
    /// Spread over all recordings, of the first law.
    pub summary: Named<SpreadOutcome>,
    /// Spread per group and law.
    pub groups: Vec<MeasuredGroup>,
    /// Recordings that were evaluated and could not be used after all.
    pub failed: Vec<FailureOutcome>,
    /// What a reader of the whole must know.
    pub findings: Vec<FindingOutcome>,
    /// Figures of the whole, and what they show, of kinds that draw no single recordings.
    pub figures: Option<(String, Vec<NamedFigure>)>,
}

impl MeasuredResults {
    /// Results of recordings with their spread.
    pub fn of(items: Vec<MeasuredItem>) -> Self {
        let law = laws_of(&items).first().map_or("", |law| *law).to_owned();
        Self {
            summary: spread_of(&items, &law, None).values,
            groups: groups_of(&items),
            items,
            parts: Vec::new(),
            specimens: Vec::new(),
            whole: Vec::new(),
            failed: Vec::new(),
            findings: Vec::new(),
            figures: None,
        }
    }
}
