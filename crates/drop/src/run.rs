//! Drops as a measurement: bounces of each drop, and the ringing of the plate.

use crate::evaluate::{bounce_options, bounce_train, evaluate_drop};
use crate::figure::figure_of_drop;
use crate::measured::MeasuredDrop;
use crate::methods::methods_of_drops;
use crate::plate_ringing::plate_items;
use crate::read::{DropCampaign, drop_of, read_drop};
use std::path::Path;
use windfall_campaign::recording::read::read_recording;
use windfall_campaign::settings::model::{Campaign, ImpactEntry};
use windfall_draw::files::{NamedFigure, file_name};
use windfall_files::error::Error;
use windfall_measure::kind::{FoundItems, MeasuredResults, Measurement};
use windfall_measure::measured::{ShownTables, ShownValue, shown};
use windfall_signal::recording::Recording;

/// What the table of drops shows.
const SHOWN: [ShownValue; 7] = [
    shown("drop_height", "height (mm)", 1e3),
    shown("mass", "mass (g)", 1e3),
    shown("peak_force", "peak (N)", 1.0),
    shown("peak_force_2", "2nd peak (N)", 1.0),
    shown("interval", "interval (ms)", 1e3),
    shown("restitution", "restitution", 1.0),
    shown("restitution_by_impulse", "by impulse", 1.0),
];

/// What the table of bounces shows.
const SHOWN_OF_BOUNCES: [ShownValue; 6] = [
    shown("impact_velocity", "speed (m/s)", 1.0),
    shown("restitution", "restitution", 1.0),
    shown("restitution_by_impulse", "by impulse", 1.0),
    shown("contact_duration", "contact (ms)", 1e3),
    shown("peak_force", "peak (N)", 1.0),
    shown("impulse", "impulse (mN s)", 1e3),
];

/// What the tables of the plate show.
const SHOWN_OF_PLATE: [ShownValue; 10] = [
    shown("damping_ratio_by_decrement", "damping ratio by peaks", 1.0),
    shown("damping_ratio_by_decrement_spread", "SD", 1.0),
    shown("damping_ratio", "damping ratio by fit", 1.0),
    shown("damping_ratio_spread", "SD ", 1.0),
    shown("damped_period", "period (ms)", 1e3),
    shown("damped_period_spread", "SD  ", 1e3),
    shown("plate_mass", "mass (kg)", 1.0),
    shown("natural_frequency", "undamped (rad/s)", 1.0),
    shown("plate_stiffness", "stiffness (N/mm)", 1e-3),
    shown("plate_damping", "damping (N s/m)", 1.0),
];

impl Measurement for DropCampaign {
    type Found = MeasuredDrop;

    const SHOWN: ShownTables = ShownTables {
        items: &SHOWN,
        parts: &SHOWN_OF_BOUNCES,
        specimens: &SHOWN_OF_PLATE,
    };

    fn read(directory: &Path) -> Result<Self, Error> {
        read_drop(directory)
    }

    fn shared(&self) -> &Campaign {
        &self.shared
    }

    fn shared_mut(&mut self) -> &mut Campaign {
        &mut self.shared
    }

    fn depends_on(&self, entry: &ImpactEntry) -> String {
        format!(
            "{:?} {:?} {:?} {:?}",
            bounce_options(self, entry).ok(),
            (self.rig.gravity, self.bounces.ringing_cycles),
            drop_of(self, entry).ok(),
            self.shared.group_of(entry),
        )
    }

    fn evaluate(&self, entry: &ImpactEntry, recording: &Recording) -> Result<MeasuredDrop, Error> {
        evaluate_drop(self, entry, recording)
    }

    fn results(&self, found: &FoundItems<Self>) -> Result<MeasuredResults, Error> {
        let drops: Vec<MeasuredDrop> = found.iter().map(|(_, drop)| drop.clone()).collect();
        let items = drops.iter().map(|drop| drop.item.clone());
        Ok(MeasuredResults {
            parts: drops.iter().flat_map(|drop| drop.parts.clone()).collect(),
            whole: plate_items(self, &drops),
            ..MeasuredResults::of(items.collect())
        })
    }

    fn methods(&self) -> Vec<String> {
        methods_of_drops(self)
    }

    fn figure(
        &self,
        entry: &ImpactEntry,
        _: Option<&MeasuredDrop>,
        _: &MeasuredResults,
    ) -> Result<Option<NamedFigure>, Error> {
        let train = read_recording(&self.shared.files, entry)
            .and_then(|recording| bounce_train(self, entry, &recording));
        let (Ok(train), Ok(drop)) = (train, drop_of(self, entry)) else {
            return Ok(None);
        };
        Ok(Some(NamedFigure {
            name: file_name(&entry.id),
            caption: format!(
                "{}: force on the plate with the contacts that were found, and the ringing of the \
                 plate between them.",
                entry.id
            ),
            figure: figure_of_drop(&entry.id, &drop, &train),
        }))
    }
}
