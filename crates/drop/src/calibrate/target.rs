//! What a calibration works on: features of every drop, the rig they fell on, and
//! the first peak and interval at one height that are the target.

use crate::calibrate::outcome::{DropOutcome, TargetOutcome};
use crate::calibrate_settings::{CalibrateSettings, Target};
use windfall_contact::law::EndRule;
use windfall_drop_rig::feature_problem::{
    FeatureProblem, MeasuredDrop, MeasuredFeature, RigUncertainty,
};
use windfall_drop_rig::measured::{DropFeature, FeatureKind};
use windfall_drop_rig::rig::DropRig;
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::named::Named;
use windfall_files::text::number::plain;
use windfall_measure::measured::{MeasuredValue, value_with_sd};
use windfall_signal::uncertain::Uncertain;
use windfall_tables::regress::findings::finding;

/// The first peak of the force in the support.
pub(crate) const PEAK: DropFeature = DropFeature {
    kind: FeatureKind::PeakSupportForce,
    impact: 0,
};

/// From the first onset to the second.
pub(crate) const INTERVAL: DropFeature = DropFeature {
    kind: FeatureKind::Interval,
    impact: 0,
};

/// One drop with what was read off it.
#[derive(Clone, Debug, PartialEq)]
pub struct DropData {
    /// Id in impacts.csv.
    pub id: String,
    /// The fruit.
    pub specimen: String,
    /// Mass of the fruit; kg.
    pub mass: Uncertain,
    /// Drop height; m.
    pub height: Uncertain,
    /// Features.
    pub features: Vec<MeasuredFeature>,
}

/// The rig of a campaign, its plate known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CalibrateRig {
    /// The rig, with the mass of the target's fruit.
    pub rig: DropRig,
    /// How well it is known.
    pub sd: RigUncertainty,
}

/// The condition whose first peak and interval are to be met.
#[derive(Clone, Debug, PartialEq)]
pub struct TargetCondition {
    /// Mass of the fruit; kg.
    pub mass: Uncertain,
    /// Drop height; m.
    pub height: Uncertain,
    /// First peak and interval: means with their uncertainty.
    pub features: Vec<MeasuredFeature>,
    /// For people.
    pub outcome: TargetOutcome,
}

/// Heights this close are one setting; relative.
const SAME_HEIGHT: f64 = 1e-6;

/// Whether two heights are one.
pub fn same_height(one: f64, other: f64) -> bool {
    (one - other).abs() <= SAME_HEIGHT * one.abs().max(other.abs())
}

/// Heights of the drops, lowest first.
pub fn heights_of(drops: &[DropData]) -> Vec<f64> {
    let mut heights: Vec<f64> = drops.iter().map(|drop| drop.height.value).collect();
    heights.sort_by(f64::total_cmp);
    heights.dedup_by(|a, b| same_height(*a, *b));
    heights
}

/// The condition that a calibration aims at, and what is to be said of it.
///
/// # Errors
/// No drop of the target shows a first peak and an interval.
pub fn target_condition(
    settings: &CalibrateSettings,
    drops: &[DropData],
) -> Result<(TargetCondition, Vec<FindingOutcome>), Error> {
    let mut findings = Vec::new();
    let heights = heights_of(drops);
    let highest = heights.last().copied().unwrap_or(0.0);
    let from = |height: f64| {
        let own = drops
            .iter()
            .filter(|drop| same_height(drop.height.value, height));
        (own.collect(), format!("drops from {} m", plain(height)))
    };
    let (own, of): (Vec<&DropData>, String) = match &settings.target {
        Target::Drop(id) => {
            let own = drops.iter().filter(|drop| drop.id == *id);
            (own.collect(), format!("drop {id}"))
        }
        Target::Height(height) => from(*height),
        Target::All => {
            if heights.len() > 1 {
                let message = format!(
                    "one height is the target of design and family: {} m, the largest; another: \
                     [calibrate] target_height",
                    plain(highest)
                );
                findings.push(finding("target-chosen", message));
            }
            from(highest)
        }
    };
    let features = [PEAK, INTERVAL].into_iter();
    let features = features.filter_map(|feature| mean_feature(&own, feature));
    let features: Vec<MeasuredFeature> = features.collect();
    if features.len() < 2 {
        let missing = format!("no first peak and interval could be read off the {of}");
        let advice = "add recordings of such drops with two impacts or more, or name others with \
                      target_height or target_drop";
        return Err(Error::not_known(
            "[calibrate] of campaign.toml",
            missing,
            advice,
        ));
    }
    let mass = mean_known(own.iter().map(|drop| drop.mass));
    let height = mean_known(own.iter().map(|drop| drop.height));
    let outcome = TargetOutcome {
        of,
        drops: own.len(),
        mass: mass.value,
        height: height.value,
        features: named_features(&features),
    };
    let condition = TargetCondition {
        mass,
        height,
        features,
        outcome,
    };
    Ok((condition, findings))
}

/// Mean of values whose errors are shared.
fn mean_known(values: impl Iterator<Item = Uncertain>) -> Uncertain {
    let all: Vec<Uncertain> = values.collect();
    let count = all.len().max(1) as f64;
    Uncertain {
        value: all.iter().map(|known| known.value).sum::<f64>() / count,
        sd: all.iter().map(|known| known.sd).fold(0.0, f64::max),
    }
}

/// Mean of a feature over drops; the larger of scatter and own uncertainty is its own.
pub fn mean_feature(drops: &[&DropData], feature: DropFeature) -> Option<MeasuredFeature> {
    let all: Vec<&MeasuredFeature> = drops
        .iter()
        .flat_map(|drop| drop.features.iter().filter(|own| own.feature == feature))
        .collect();
    let count = all.len() as f64;
    if all.is_empty() {
        return None;
    }
    let value = all.iter().map(|own| own.value).sum::<f64>() / count;
    let own = all.iter().map(|own| own.sd * own.sd).sum::<f64>() / count;
    let scatter = match all.len() {
        1 => 0.0,
        _ => {
            all.iter()
                .map(|own| (own.value - value).powi(2))
                .sum::<f64>()
                / (count - 1.0)
        }
    };
    Some(MeasuredFeature {
        feature,
        value,
        sd: (own.max(scatter) / count).sqrt(),
    })
}

/// Features under their names.
pub fn named_features(features: &[MeasuredFeature]) -> Named<MeasuredValue> {
    let named = features.iter().map(|measured| {
        let feature = measured.feature;
        let value = value_with_sd(measured.value, measured.sd, feature.unit());
        (feature.name(), value)
    });
    named.collect()
}

/// Drops as JSON shows them.
pub fn drop_outcomes(drops: &[DropData]) -> Vec<DropOutcome> {
    let outcome = |drop: &DropData| DropOutcome {
        id: drop.id.clone(),
        specimen: drop.specimen.clone(),
        mass: value_with_sd(drop.mass.value, drop.mass.sd, "kg"),
        height: value_with_sd(drop.height.value, drop.height.sd, "m"),
        features: named_features(&drop.features),
    };
    drops.iter().map(outcome).collect()
}

/// The plate as JSON shows it; empty for one that does not move.
pub fn plate_outcome(rig: &CalibrateRig) -> Named<MeasuredValue> {
    let mut values = Named::default();
    let mut add = |name: &str, value: f64, sd: f64, unit: &str| {
        let sd = if sd > 0.0 { sd } else { f64::NAN };
        values.push(name, value_with_sd(value, sd, unit));
    };
    if let Some(plate) = &rig.rig.plate {
        add("mass", plate.mass, rig.sd.plate_mass, "kg");
        add("stiffness", plate.stiffness, rig.sd.plate_stiffness, "N/m");
        add("damping", plate.damping, rig.sd.plate_damping, "N s/m");
    }
    if rig.rig.effective_mass_factor != 1.0 {
        let (factor, sd) = (rig.rig.effective_mass_factor, rig.sd.effective_mass_factor);
        add("effective_mass_factor", factor, sd, "1");
    }
    values
}

/// All drops as one least-squares problem: drops of one specimen share the error of
/// its mass, drops from one height that of its setting.
pub fn problem_of(rig: &CalibrateRig, drops: &[DropData], end: EndRule) -> FeatureProblem {
    let mut fruits: Vec<(&str, Uncertain)> = Vec::new();
    let mut heights: Vec<Uncertain> = Vec::new();
    let mut measured = Vec::new();
    for drop in drops {
        let known = fruits
            .iter()
            .position(|(name, mass)| *name == drop.specimen && *mass == drop.mass);
        let fruit = known.unwrap_or_else(|| {
            fruits.push((&drop.specimen, drop.mass));
            fruits.len() - 1
        });
        let same = |other: &Uncertain| {
            same_height(other.value, drop.height.value) && other.sd == drop.height.sd
        };
        let height = heights.iter().position(same).unwrap_or_else(|| {
            heights.push(drop.height);
            heights.len() - 1
        });
        measured.push(MeasuredDrop {
            fruit,
            height,
            features: drop.features.clone(),
        });
    }
    FeatureProblem {
        rig: rig.rig,
        rig_sd: rig.sd,
        fruits: fruits.into_iter().map(|(_, mass)| mass).collect(),
        heights,
        drops: measured,
        priors: Vec::new(),
        end,
    }
}

/// The target alone as a least-squares problem.
pub fn target_problem(
    rig: &CalibrateRig,
    target: &TargetCondition,
    end: EndRule,
) -> FeatureProblem {
    FeatureProblem {
        rig: rig.rig,
        rig_sd: rig.sd,
        fruits: vec![target.mass],
        heights: vec![target.height],
        drops: vec![MeasuredDrop {
            fruit: 0,
            height: 0,
            features: target.features.clone(),
        }],
        priors: Vec::new(),
        end,
    }
}
