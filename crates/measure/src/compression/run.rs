//! Slow compressions as a measurement: curves → laws, and laws over all curves of a fruit.

use crate::compression::evaluate::{
    evaluate_compression, fitted_part, loading_curve, parameters_of, radii_of_entry,
};
use crate::compression::figure::figure_of_compression;
use crate::compression::methods::methods_of_compression;
use crate::compression::read::{CompressionCampaign, read_compression};
use crate::kind::{FoundItems, MeasuredResults, Measurement};
use crate::measured::{MeasuredItem, MeasuredItems, ShownTables, ShownValue, plain_value, shown};
use std::path::Path;
use windfall_campaign::pipeline::request::{
    FitRequest, apply_request_to_measurement, laws_and_free,
};
use windfall_campaign::recording::read::read_recording;
use windfall_campaign::settings::model::{Campaign, ImpactEntry};
use windfall_compression::fit::fit_compression;
use windfall_draw::files::{NamedFigure, file_name};
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::named::{Named, grouped};
use windfall_signal::recording::Recording;

const SHOWN: [ShownValue; 12] = [
    shown("k", "k (SI)", 1.0),
    shown("n", "n", 1.0),
    shown("c", "c (SI)", 1.0),
    shown("apparent_modulus", "apparent modulus (MPa)", 1e-6),
    shown("stiffness", "stiffness (N/mm)", 1e-3),
    shown("bioyield_force", "bioyield (N)", 1.0),
    shown("bioyield_deformation", "at (mm)", 1e3),
    shown("softening_force", "softening (N)", 1.0),
    shown("softening_deformation", "at (mm) ", 1e3),
    shown("energy_to_yield", "energy to yield (mJ)", 1e3),
    shown("fitted_force", "fitted to (N)", 1.0),
    shown("deformation_rate", "rate (mm/s)", 1e3),
];

impl Measurement for CompressionCampaign {
    type Found = MeasuredItems;

    const SHOWN: ShownTables = ShownTables {
        items: &SHOWN,
        parts: &[],
        specimens: SHOWN.split_at(3).0,
    };

    fn read(directory: &Path) -> Result<Self, Error> {
        read_compression(directory)
    }

    fn shared(&self) -> &Campaign {
        &self.shared
    }

    fn shared_mut(&mut self) -> &mut Campaign {
        &mut self.shared
    }

    fn apply(&mut self, request: &FitRequest) -> Result<(), Error> {
        apply_request_to_measurement(&mut self.shared, request)?;
        laws_and_free(&mut self.laws, &mut self.free, &[], request)
    }

    fn depends_on(&self, entry: &ImpactEntry) -> String {
        let laws: Vec<String> = self.laws.iter().map(|law| format!("{law:?}")).collect();
        format!(
            "{:?} {:?} {} {} {:?} {laws:?} {:?} {:?} {:?}",
            self.options,
            self.fit_to,
            self.plates,
            self.poisson_ratio,
            self.indenter,
            self.free,
            radii_of_entry(self, entry).ok(),
            self.shared.group_of(entry),
        )
    }

    fn evaluate(&self, entry: &ImpactEntry, recording: &Recording) -> Result<MeasuredItems, Error> {
        evaluate_compression(self, entry, recording)
    }

    fn results(&self, found: &FoundItems<Self>) -> Result<MeasuredResults, Error> {
        let items = found.iter().flat_map(|(_, found)| found.items.clone());
        Ok(MeasuredResults {
            specimens: joint_fits(self),
            ..MeasuredResults::of(items.collect())
        })
    }

    fn methods(&self) -> Vec<String> {
        methods_of_compression(self)
    }

    fn figure(
        &self,
        entry: &ImpactEntry,
        _: Option<&MeasuredItems>,
        _: &MeasuredResults,
    ) -> Result<Option<NamedFigure>, Error> {
        let curve = read_recording(&self.shared.files, entry)
            .and_then(|recording| loading_curve(self, entry, &recording));
        let Ok(curve) = curve else { return Ok(None) };
        let fit = |law| {
            let part = fitted_part(self, &curve, law);
            let fit = fit_compression(std::slice::from_ref(&part), law, &self.free).ok()?;
            Some((part, fit))
        };
        let fits: Vec<_> = self.laws.iter().filter_map(fit).collect();
        Ok(Some(NamedFigure {
            name: file_name(&entry.id),
            caption: format!(
                "{}: loading curve with bioyield and softening where it shows them, and the fitted \
                 laws over the part that they were fitted to.",
                entry.id
            ),
            figure: figure_of_compression(&entry.id, &curve, &fits),
        }))
    }
}

/// One law for all compressions of a specimen, so that different rates tell its damping.
fn joint_fits(campaign: &CompressionCampaign) -> Vec<MeasuredItem> {
    let entries = campaign.shared.entries.iter();
    let mut items = Vec::new();
    for (specimen, entries) in grouped(entries.map(|entry| (entry.specimen.as_str(), entry))) {
        if entries.len() < 2 {
            continue;
        }
        // One that cannot be read is reported with its recording.
        let curve = |entry: &&ImpactEntry| {
            let recording = read_recording(&campaign.shared.files, entry).ok()?;
            loading_curve(campaign, entry, &recording).ok()
        };
        let curves: Vec<_> = entries.iter().filter_map(curve).collect();
        if curves.len() < 2 {
            continue;
        }
        for law in &campaign.laws {
            let parts = curves.iter().map(|curve| fitted_part(campaign, curve, law));
            let parts: Vec<_> = parts.collect();
            let Ok(fit) = fit_compression(&parts, law, &campaign.free) else {
                continue;
            };
            let mut findings = Vec::new();
            if !fit.converged {
                let message = "the fit of all curves together did not converge";
                findings.push(FindingOutcome::new("fit_not_converged", message));
            }
            items.push(MeasuredItem {
                file: format!("{} recordings together", curves.len()),
                words: Named::of([("recordings", curves.len().to_string())]),
                parameters: parameters_of(&fit),
                derived: Named::of([("residual_rms", plain_value(fit.rms, "N"))]),
                findings,
                ..MeasuredItem::named(specimen, law.kind.name())
            });
        }
    }
    items
}
