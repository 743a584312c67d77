//! Motions as JSON shows them.

use crate::drop::SimulatedDrop;
use crate::eccentric::SimulatedEccentricDrop;
use crate::impact::SimulatedImpact;
use serde::Serialize;
use utoipa::ToSchema;
use windfall_files::named::Named;

/// Samples of a motion; SI.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
#[serde(untagged)]
pub enum MotionOutcome {
    /// A body strikes a fruit.
    Impact(MovingImpact),
    /// A fruit falls and bounces.
    Drop(MovingDrop),
    /// A planar body falls, turns and bounces.
    Body(MovingBody),
}

/// The motion of one impact; SI.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct MovingImpact {
    /// That it was not measured.
    pub simulated: bool,
    /// The impact in numbers.
    pub impact: SimulatedImpact,
    /// `time` (s), `displacement` (m), `rate` (m/s), `force` (N) and `acceleration` (m/s²),
    /// sample by sample.
    pub motion: Samples,
}

/// The motion of a drop; SI.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct MovingDrop {
    /// The drop in numbers.
    #[serde(flatten)]
    pub drop: SimulatedDrop,
    /// `time` (s), `contact_force` and `support_force` (N), `height` (m) and `velocity` (m/s) of
    /// the fruit, and those of the plate, sample by sample.
    pub motion: Samples,
}

/// The motion of a planar body; SI.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct MovingBody {
    /// The drop in numbers.
    #[serde(flatten)]
    pub drop: SimulatedEccentricDrop,
    /// As for a drop, and how the body turns and slides, sample by sample; null after it has come
    /// to stay on the plate.
    pub motion: Samples,
}

/// Columns of samples by name; not a number where there is no value, which is null in JSON.
#[derive(Clone, Debug, Default, PartialEq, Serialize, ToSchema)]
#[serde(transparent)]
#[schema(value_type = std::collections::BTreeMap<String, Vec<Option<f64>>>)]
pub struct Samples(pub Named<Vec<f64>>);
