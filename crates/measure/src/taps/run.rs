//! Taps as a measurement: resonances of each tap → first mode and stiffness of each fruit.

use crate::kind::{FoundItems, MeasuredResults, Measurement};
use crate::measured::{ShownTables, ShownValue, groups_of, shown, spread_of};
use crate::taps::document::TapsDocument;
use crate::taps::evaluate::{evaluate_taps, taps_of_entry};
use crate::taps::figure::figure_of_taps;
use crate::taps::methods::methods_of_taps;
use crate::taps::read::{AcousticCampaign, read_acoustic};
use crate::taps::specimen::{METHOD, TapsOfEntry, acoustic_results};
use std::path::Path;
use windfall_campaign::recording::read::read_recording;
use windfall_campaign::settings::model::{Campaign, ImpactEntry};
use windfall_draw::files::{NamedFigure, file_name};
use windfall_files::error::Error;
use windfall_signal::recording::Recording;

const SHOWN: [ShownValue; 3] = [
    shown("acoustic_frequency", "frequency (Hz)", 1.0),
    shown("quality", "Q", 1.0),
    shown("level", "part of highest", 1.0),
];

const SHOWN_OF_SPECIMENS: [ShownValue; 4] = [
    shown("acoustic_frequency", "frequency (Hz)", 1.0),
    shown(
        "acoustic_stiffness",
        "stiffness (10^6 Hz^2 g^(2/3))",
        windfall_signal::tap::acoustic_stiffness::MEGAHERTZ_GRAM,
    ),
    shown("acoustic_stiffness_with_density", "stiffness (MPa)", 1e-6),
    shown("quality", "Q", 1.0),
];

impl Measurement for AcousticCampaign {
    type Found = TapsDocument;

    const SHOWN: ShownTables = ShownTables {
        items: &SHOWN,
        parts: &[],
        specimens: &SHOWN_OF_SPECIMENS,
    };

    fn read(directory: &Path) -> Result<Self, Error> {
        read_acoustic(directory)
    }

    fn shared(&self) -> &Campaign {
        &self.shared
    }

    fn shared_mut(&mut self) -> &mut Campaign {
        &mut self.shared
    }

    fn depends_on(&self, _: &ImpactEntry) -> String {
        format!("{:?} {:?}", self.taps, self.resonances)
    }

    fn evaluate(&self, entry: &ImpactEntry, recording: &Recording) -> Result<TapsDocument, Error> {
        evaluate_taps(self, entry, recording)
    }

    fn results(&self, found: &FoundItems<Self>) -> Result<MeasuredResults, Error> {
        let entries = found.iter().map(|(position, taps)| TapsOfEntry {
            entry: &self.shared.entries[*position],
            taps,
        });
        let results = acoustic_results(self, &entries.collect::<Vec<_>>())?;
        // A tap is no fruit: fruit have a spread.
        Ok(MeasuredResults {
            summary: spread_of(&results.specimens, METHOD, None).values,
            groups: groups_of(&results.specimens),
            specimens: results.specimens,
            ..MeasuredResults::of(results.taps)
        })
    }

    fn methods(&self) -> Vec<String> {
        methods_of_taps(self)
    }

    fn figure(
        &self,
        entry: &ImpactEntry,
        found: Option<&TapsDocument>,
        results: &MeasuredResults,
    ) -> Result<Option<NamedFigure>, Error> {
        let Some(found) = found else { return Ok(None) };
        let mut specimens = results.specimens.iter();
        let specimen = specimens.find(|item| item.id == entry.specimen);
        let recording = read_recording(&self.shared.files, entry)?;
        let (channel, taps) = taps_of_entry(self, entry, &recording)?;
        let sounds: Vec<&[f64]> = taps
            .taps
            .iter()
            .map(|tap| &channel.samples[tap.ringing.clone()])
            .collect();
        let band = (self.taps.low, self.taps.high);
        let accepted = specimen.and_then(|item| item.derived.get("acoustic_frequency"));
        let figure = figure_of_taps(
            &entry.id,
            &sounds,
            taps.interval,
            band,
            (found, accepted.map(|value| value.value)),
        );
        Ok(Some(NamedFigure {
            name: file_name(&entry.id),
            caption: format!(
                "{}: spectrum of each tap with its resonances, and the one taken for the first \
                 spheroidal mode of the fruit.",
                entry.id
            ),
            figure,
        }))
    }
}
