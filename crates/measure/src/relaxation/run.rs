//! Stress relaxation as a measurement.

use crate::kind::{FoundItems, MeasuredResults, Measurement};
use crate::measured::{MeasuredItems, ShownTables, ShownValue, laws_of, shown};
use crate::relaxation::evaluate::{PELEG, evaluate_relaxation, relaxed};
use crate::relaxation::figure::figure_of_relaxation;
use crate::relaxation::methods::methods_of_relaxation;
use crate::relaxation::read::{RelaxationCampaign, read_relaxation};
use std::path::Path;
use windfall_campaign::recording::read::read_recording;
use windfall_campaign::settings::model::{Campaign, ImpactEntry};
use windfall_draw::files::{NamedFigure, file_name};
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_signal::recording::Recording;

const SHOWN: [ShownValue; 13] = [
    shown("residual_fraction", "residual", 1.0),
    shown("fraction_1", "fraction 1", 1.0),
    shown("relaxation_time_1", "time 1 (s)", 1.0),
    shown("fraction_2", "fraction 2", 1.0),
    shown("relaxation_time_2", "time 2 (s)", 1.0),
    shown("fraction_3", "fraction 3", 1.0),
    shown("relaxation_time_3", "time 3 (s)", 1.0),
    shown("peleg_k1", "Peleg k1 (s)", 1.0),
    shown("peleg_k2", "Peleg k2", 1.0),
    shown("initial_force", "initial force (N)", 1.0),
    shown("relaxed_fraction", "relaxed", 1.0),
    shown("hold_duration", "hold (s)", 1.0),
    shown("ramp_duration", "ramp (s)", 1.0),
];

impl Measurement for RelaxationCampaign {
    type Found = MeasuredItems;

    const SHOWN: ShownTables = ShownTables {
        items: &SHOWN,
        parts: &[],
        specimens: &[],
    };

    fn read(directory: &Path) -> Result<Self, Error> {
        read_relaxation(directory)
    }

    fn shared(&self) -> &Campaign {
        &self.shared
    }

    fn shared_mut(&mut self) -> &mut Campaign {
        &mut self.shared
    }

    fn depends_on(&self, entry: &ImpactEntry) -> String {
        format!(
            "{:?} {:?} {:?} {} {:?}",
            self.touch_force,
            self.elements,
            self.ramp,
            self.exponent,
            self.shared.group_of(entry)
        )
    }

    fn evaluate(&self, entry: &ImpactEntry, recording: &Recording) -> Result<MeasuredItems, Error> {
        evaluate_relaxation(self, entry, recording)
    }

    fn results(&self, found: &FoundItems<Self>) -> Result<MeasuredResults, Error> {
        let items = found.iter().flat_map(|(_, found)| found.items.clone());
        let mut results = MeasuredResults::of(items.collect());
        let laws = laws_of(&results.items).into_iter();
        let models: Vec<&str> = laws.filter(|law| *law != PELEG).collect();
        if models.len() > 1 {
            let told = format!(
                "recordings are described by {}: relaxation times of different models are different \
                 quantities, and each model has its own mean; for one model set `elements` in \
                 [relaxation]",
                models.join(" and ")
            );
            results
                .findings
                .push(FindingOutcome::new("elements_differ", told));
        }
        Ok(results)
    }

    fn methods(&self) -> Vec<String> {
        methods_of_relaxation(self)
    }

    fn figure(
        &self,
        entry: &ImpactEntry,
        _: Option<&MeasuredItems>,
        _: &MeasuredResults,
    ) -> Result<Option<NamedFigure>, Error> {
        let found = read_recording(&self.shared.files, entry)
            .and_then(|recording| relaxed(self, entry, &recording));
        let Ok(found) = found else { return Ok(None) };
        Ok(Some(NamedFigure {
            name: file_name(&entry.id),
            caption: format!(
                "{}: force before and during the hold, with the fitted models; below, what they leave.",
                entry.id
            ),
            figure: figure_of_relaxation(&entry.id, &found),
        }))
    }
}
