//! Features of the drops of a campaign: from columns of impacts.csv where someone
//! has read them off already, and the rig that they fell on.

use crate::calibrate::target::{CalibrateRig, DropData};
use crate::measured::{Known, MeasuredDrop};
use crate::plate_ringing::PlateEstimate;
use crate::read::{Drop, DropCampaign, drop_of};
use windfall_campaign::settings::model::ImpactEntry;
use windfall_drop_rig::feature_problem::{MeasuredFeature, RigUncertainty};
use windfall_drop_rig::measured::{DropFeature, FeatureKind};
use windfall_drop_rig::rig::{DropRig, Plate};
use windfall_files::error::{Error, Place};
use windfall_files::text::cell_quantity::cell_quantity;
use windfall_signal::uncertain::Uncertain;

/// Columns of impacts.csv that hold features, counted from 1: "peak_force_1_N".
const COLUMNS: [(&str, FeatureKind); 3] = [
    ("peak_force", FeatureKind::PeakSupportForce),
    ("interval", FeatureKind::Interval),
    ("contact_duration", FeatureKind::ContactDuration),
];

/// Features of the impacts that are used, from the columns of an entry; none without them.
///
/// One without a standard uncertainty ("peak_force_1_sd_N") gets half of the
/// tolerance of the targets.
///
/// # Errors
/// A cell is no positive number.
pub fn written_features(
    campaign: &DropCampaign,
    entry: &ImpactEntry,
) -> Result<Vec<MeasuredFeature>, Error> {
    let file = campaign.shared.directory.join("impacts.csv");
    let place = Place::at(&file, entry.line);
    let mut features = Vec::new();
    for (name, kind) in COLUMNS {
        for impact in 0..campaign.calibrate.bounces {
            let feature = DropFeature { kind, impact };
            let name = format!("{name}_{}", impact + 1);
            let cell = |name: &str| cell_quantity(&entry.cells, name, feature.unit(), &place);
            if let Some(value) = cell(&name)? {
                let sd = cell(&format!("{name}_sd"))?;
                let usual = 0.5 * campaign.calibrate.tolerance * value;
                features.push(MeasuredFeature {
                    feature,
                    value,
                    sd: sd.unwrap_or(usual),
                });
            }
        }
    }
    Ok(features)
}

/// A drop with its features.
///
/// # Errors
/// Mass or height is not known.
pub fn drop_data(
    campaign: &DropCampaign,
    entry: &ImpactEntry,
    features: Vec<MeasuredFeature>,
) -> Result<DropData, Error> {
    let Drop { mass, height } = drop_of(campaign, entry)?;
    Ok(DropData {
        id: entry.id.clone(),
        specimen: entry.specimen.clone(),
        mass,
        height,
        features,
    })
}

/// Peaks and intervals between onsets of the bounces of a recorded drop that are used.
pub fn recorded_features(drop: &MeasuredDrop, bounces: usize) -> Vec<MeasuredFeature> {
    let mut features = Vec::new();
    let mut add = |kind, impact, value: &Known| {
        if value.value.is_finite() && value.sd.is_finite() && value.sd > 0.0 {
            features.push(MeasuredFeature {
                feature: DropFeature { kind, impact },
                value: value.value,
                sd: value.sd,
            });
        }
    };
    let used = drop.bounces.iter().take(bounces).enumerate();
    for (impact, bounce) in used {
        if bounce.complete && !bounce.clipped {
            add(FeatureKind::PeakSupportForce, impact, &bounce.peak);
        }
    }
    // An interval needs the bounce after it too.
    let intervals = drop.intervals.iter().take(bounces.saturating_sub(1).max(1));
    for (impact, interval) in intervals.enumerate() {
        add(FeatureKind::Interval, impact, interval);
    }
    features
}

/// The rig of a campaign with its plate.
pub fn calibrate_rig(campaign: &DropCampaign, plate: Option<&PlateEstimate>) -> CalibrateRig {
    let plan = &campaign.rig;
    let sd = |of: fn(&PlateEstimate) -> Uncertain| plate.map_or(0.0, |plate| of(plate).sd);
    CalibrateRig {
        rig: DropRig {
            // Replaced by that of each fruit.
            mass: 1.0,
            effective_mass_factor: plan.effective_mass_factor,
            gravity: plan.gravity,
            plate: plate.map(|plate| Plate::from(*plate)),
        },
        sd: RigUncertainty {
            effective_mass_factor: 0.0,
            plate_mass: sd(|plate| plate.mass),
            plate_stiffness: sd(|plate| plate.stiffness),
            plate_damping: sd(|plate| plate.damping),
        },
    }
}
