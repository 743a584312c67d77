//! Features of a drop: what people read off a recorded bounce train, and what a
//! simulated one has to say about each, with derivatives.

use crate::rig::DropRig;
pub use crate::sensitivity::RigQuantity;
use crate::sensitivity::{DropQuantity, FEATURE_ACCURACY, drop_features};
use crate::simulate::{DropSummary, simulate_drop_within};
use windfall_contact::law::EndRule;
use windfall_contact::laws::kind::Law;
use windfall_identify::error::Error;

/// What is read off a recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum FeatureKind {
    /// Largest force in the support of the plate, which is the contact force for a
    /// plate that does not move; N.
    PeakSupportForce,
    /// Largest contact force; N.
    PeakContactForce,
    /// From the onset of this impact to that of the next; s.
    Interval,
    /// From the onset to where the force is zero again; s.
    ContactDuration,
}

/// A feature of one impact of a drop.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct DropFeature {
    /// What it is.
    pub kind: FeatureKind,
    /// Of which impact, from 0.
    pub impact: usize,
}

impl DropFeature {
    /// Its name: "peak_force_1", "interval_1", counted from 1.
    pub fn name(&self) -> String {
        let kind = match self.kind {
            FeatureKind::PeakSupportForce => "peak_support_force",
            FeatureKind::PeakContactForce => "peak_contact_force",
            FeatureKind::Interval => "interval",
            FeatureKind::ContactDuration => "contact_duration",
        };
        format!("{kind}_{}", self.impact + 1)
    }

    /// SI unit.
    pub fn unit(&self) -> &'static str {
        match self.kind {
            FeatureKind::PeakSupportForce | FeatureKind::PeakContactForce => "N",
            FeatureKind::Interval | FeatureKind::ContactDuration => "s",
        }
    }

    /// Value in a simulated drop; SI. `None` where the drop does not get so far.
    pub fn of(&self, summary: &DropSummary) -> Option<f64> {
        let impact = summary.impacts.get(self.impact);
        match self.kind {
            FeatureKind::PeakSupportForce => impact.map(|i| i.peak_support_force),
            FeatureKind::PeakContactForce => impact.map(|i| i.peak_contact_force),
            FeatureKind::Interval => {
                let next = summary.impacts.get(self.impact + 1);
                let next = next.map(|i| i.onset_time).or(summary.next_onset)?;
                impact.map(|i| next - i.onset_time)
            }
            FeatureKind::ContactDuration => impact.map(|i| i.force_end_time - i.onset_time),
        }
    }
}

/// Impacts that must be simulated for some features.
fn impacts_of_features(features: &[DropFeature]) -> usize {
    let needed = features.iter().map(|feature| feature.impact + 1);
    needed.max().unwrap_or(0)
}

/// Values of features.
///
/// # Errors
/// The drop cannot be simulated; [`Error::FeatureMissing`] where it comes to rest
/// before.
pub fn feature_values(
    law: &Law,
    rig: &DropRig,
    height: f64,
    features: &[DropFeature],
    end: EndRule,
) -> Result<Vec<f64>, Error> {
    let impacts = impacts_of_features(features);
    let summary = simulate_drop_within(FEATURE_ACCURACY, law, rig, height, impacts, end)?;
    let values = features.iter().map(|feature| {
        feature.of(&summary).ok_or_else(|| Error::FeatureMissing {
            feature: feature.name(),
            height,
            impacts: summary.impacts.len(),
        })
    });
    values.collect()
}

/// Values of features with their derivatives; SI.
#[derive(Clone, Debug, PartialEq)]
pub struct FeatureSensitivity {
    /// Values.
    pub values: Vec<f64>,
    /// By the law's parameters: a row for each feature.
    pub by_parameter: Vec<Vec<f64>>,
    /// By the quantities of the rig, in the order of [`RigQuantity::ALL`]; zero for
    /// those of a plate that is not there.
    pub by_rig: Vec<[f64; RigQuantity::ALL.len()]>,
}

/// Values of features with their exact derivatives.
///
/// * `wanted`: positions of the law's parameters that derivatives are wanted for;
///   the others get zero
/// * `quantities`: the same of the rig
///
/// # Errors
/// As [`feature_values`].
pub fn feature_sensitivity(
    law: &Law,
    rig: &DropRig,
    height: f64,
    features: &[DropFeature],
    end: EndRule,
    (wanted, quantities): (&[usize], &[RigQuantity]),
) -> Result<FeatureSensitivity, Error> {
    let known = quantities.iter().copied();
    let known = known.filter(|quantity| quantity.get(rig, height).is_some());
    let of_law = wanted.iter().map(|position| DropQuantity::Law(*position));
    let free: Vec<DropQuantity> = of_law.chain(known.map(DropQuantity::Rig)).collect();
    let mut found = FeatureSensitivity {
        values: vec![0.0; features.len()],
        by_parameter: vec![vec![0.0; law.parameters().len()]; features.len()],
        by_rig: vec![[0.0; RigQuantity::ALL.len()]; features.len()],
    };
    let exact = drop_features(law, rig, height, impacts_of_features(features), end, &free)?;
    for (row, feature) in features.iter().enumerate() {
        let of_impact = exact.impacts.get(feature.impact);
        let own = match feature.kind {
            FeatureKind::PeakSupportForce => of_impact.map(|i| &i.peak_support_force),
            FeatureKind::PeakContactForce => of_impact.map(|i| &i.peak_contact_force),
            FeatureKind::Interval => exact.intervals.get(feature.impact),
            FeatureKind::ContactDuration => of_impact.and_then(|i| i.contact_duration.as_ref()),
        };
        let own = own.ok_or_else(|| Error::FeatureMissing {
            feature: feature.name(),
            height,
            impacts: exact.impacts.len(),
        })?;
        found.values[row] = own.value;
        for (quantity, slope) in free.iter().zip(&own.by) {
            match *quantity {
                DropQuantity::Law(position) => found.by_parameter[row][position] = *slope,
                DropQuantity::Rig(quantity) => found.by_rig[row][quantity as usize] = *slope,
                DropQuantity::Gravity => {}
            }
        }
    }
    Ok(found)
}
