//! Results of the sensors of a scene.

use serde::Serialize;

/// What a sensor saw: one of `flow`, `space` and `probe`.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct SensorOutcome {
    /// Name.
    pub name: String,
    /// Time between looks at the fruit, a whole number of time steps; s.
    pub look: f64,
    /// Time between rows of the table, a whole number of time steps; of a plane the time over which the
    /// largest flow is counted; s.
    pub interval: f64,
    /// Of a plane or a plate.
    pub flow: Option<FlowOutcome>,
    /// Of a box.
    pub space: Option<SpaceOutcome>,
    /// Of a probe.
    pub probe: Option<ProbeOutcome>,
}

/// Fruit that passed a plane or a plate with their centres.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct FlowOutcome {
    /// Passes in the direction of the normal.
    pub forward: u64,
    /// Passes against it.
    pub backward: u64,
    /// Mass of the fruit that passed forward, once for each pass; kg.
    pub mass_forward: f64,
    /// First pass forward; s.
    pub first: Option<f64>,
    /// Last pass forward; s.
    pub last: Option<f64>,
    /// Passes forward after the first, over the time from the first to the last; 1/s.
    pub mean_flow: Option<f64>,
    /// The same of their mass; kg/s.
    pub mean_mass_flow: Option<f64>,
    /// Most passes forward within an interval, over the interval; 1/s.
    pub largest_flow: f64,
    /// The same of their mass; kg/s.
    pub largest_mass_flow: f64,
}

/// Fruit whose centres were in a box.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct SpaceOutcome {
    /// Fruit that were in it at some time.
    pub entered: u64,
    /// Fruit in it at the end.
    pub inside: u64,
    /// Their mass; kg.
    pub mass: f64,
    /// Share of the volume of the box that they are at the end; 1.
    pub fruit_share: f64,
    /// Height z of the highest top of them; m.
    pub level: Option<f64>,
    /// Most fruit in it at a row of the table, or at the end.
    pub most: u64,
    /// Largest mass in it then; kg.
    pub largest_mass: f64,
    /// Largest level then; m.
    pub largest_level: Option<f64>,
    /// Times from first entry to last exit of the fruit that are no longer in it.
    pub residence: Option<ResidenceOutcome>,
}

/// Times that fruit spent in a box.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct ResidenceOutcome {
    /// Fruit that came and left.
    pub fruit: u64,
    /// Mean; s.
    pub mean: f64,
    /// Median; s.
    pub median: f64,
    /// Largest; s.
    pub largest: f64,
}

/// What an accelerometer at the centre of fruit felt.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct ProbeOutcome {
    /// Fruit that are probes and came into the scene.
    pub fruit: usize,
    /// Threshold of an impact; m/s².
    pub least_acceleration: f64,
    /// Largest acceleration of all, also below the threshold; m/s².
    pub largest_acceleration: Option<f64>,
    /// Impacts.
    pub impacts: u64,
    /// Peak accelerations that half and 95 % of the impacts stay below, and the largest; m/s².
    pub peak_acceleration: Option<[f64; 3]>,
    /// The same of velocity changes; m/s.
    pub velocity_change: Option<[f64; 3]>,
    /// The impact with the largest peak.
    pub hardest: Option<ProbeImpactOutcome>,
}

/// An impact on a probe.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct ProbeImpactOutcome {
    /// Number of the fruit.
    pub fruit: u32,
    /// When the acceleration rose above the threshold; s.
    pub time: f64,
    /// For how long it stayed there; s.
    pub duration: f64,
    /// Largest mean acceleration of a sample; m/s².
    pub peak_acceleration: f64,
    /// Acceleration above the threshold, integrated over time; m/s.
    pub velocity_change: f64,
    /// What was struck: a wall, or "fruit"; of several that with the largest force.
    pub struck: Option<String>,
    /// Its number, where it is a fruit.
    pub struck_fruit: Option<u32>,
    /// Whether it was still there when the scene ended, or when the fruit left.
    pub lasting: bool,
}
