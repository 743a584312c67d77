//! The schema of scene.toml, version 1.

use schemars::JsonSchema;
use serde::Deserialize;
use std::collections::BTreeMap;
use windfall_files::text::file_quantity::QuantityText;
use windfall_files::text::spanned::Spanned;

/// The whole file.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SceneFile {
    /// Version of the shape of this file.
    pub format: Option<Spanned<i64>>,
    /// Title, gravity, time.
    #[serde(default)]
    pub scene: SceneSection,
    /// Names of the materials.
    pub materials: Spanned<Vec<Spanned<String>>>,
    /// What pairs of materials do to each other.
    #[serde(default)]
    pub contacts: Vec<Spanned<ContactFile>>,
    /// Kinds of fruit, and how they come.
    #[serde(default)]
    pub fruit: Vec<Spanned<FruitFile>>,
    /// Walls.
    #[serde(default)]
    pub walls: Vec<Spanned<crate::file::walls::WallFile>>,
    /// What walls do, and when.
    #[serde(default)]
    pub moves: Vec<Spanned<crate::file::moves::MoveFile>>,
    /// Where fruit leave.
    #[serde(default)]
    pub sinks: Vec<Spanned<SinkFile>>,
    pub air: Option<Spanned<AirFile>>,
    /// What is recorded.
    #[serde(default)]
    pub events: EventsFile,
    /// Recorded frames.
    #[serde(default)]
    pub record: crate::file::record::RecordFile,
    /// What looks at the fruit.
    #[serde(default)]
    pub sensors: Vec<Spanned<crate::file::sensors::SensorFile>>,
    /// How contacts bruise.
    pub bruise: Option<Spanned<BruiseFile>>,
}

/// `[scene]`
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SceneSection {
    pub title: Option<String>,
    /// The run at whose end this one begins.
    pub start: Option<Spanned<String>>,
    /// Seed of all draws.
    pub seed: Option<u64>,
    /// Gravity: downward, or a vector.
    pub gravity: Option<Spanned<GravityFile>>,
    /// Time step, or "auto".
    pub time_step: Option<Spanned<QuantityText>>,
    /// Error of the peak force that an automatic time step may make.
    pub time_step_error: Option<Spanned<QuantityText>>,
    /// When the scene ends.
    pub end: Option<Spanned<QuantityText>>,
    /// Axes along which the scene repeats.
    pub periodic: Option<Spanned<PeriodicFile>>,
    /// Time of the scene between checkpoints, or "never".
    pub checkpoint: Option<Spanned<QuantityText>>,
}

/// `periodic`: both ends along an axis, the lower one first; m.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PeriodicFile {
    pub x: Option<Spanned<[f64; 2]>>,
    pub y: Option<Spanned<[f64; 2]>>,
    pub z: Option<Spanned<[f64; 2]>>,
}

/// Gravity in a file.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum GravityFile {
    /// Against z.
    Down(QuantityText),
    /// In any direction; m/s².
    Vector([f64; 3]),
}

/// `[[contacts]]`
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ContactFile {
    /// The two materials.
    pub between: Option<Spanned<[String; 2]>>,
    /// A law card.
    pub card: Option<Spanned<String>>,
    /// A law, where there is no card.
    pub law: Option<Spanned<String>>,
    /// R* that the law was found with.
    pub effective_radius: Option<Spanned<QuantityText>>,
    /// Coefficient of sliding friction.
    pub friction: Option<Spanned<f64>>,
    /// Poisson's ratio, for the tangential stiffness.
    pub poisson: Option<Spanned<f64>>,
    /// Tangential over normal stiffness, in its place.
    pub tangential_ratio: Option<Spanned<f64>>,
    /// Tangential over normal damping.
    pub tangential_damping: Option<Spanned<f64>>,
    /// Annuli of the contact area that stick or slip each for itself.
    pub annuli: Option<Spanned<usize>>,
    /// Coefficient of rolling friction.
    pub rolling: Option<Spanned<f64>>,
    /// Part of the absorbed energy that a fruit takes.
    pub fruit_share: Option<Spanned<f64>>,
}

/// `[[fruit]]`
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FruitFile {
    /// Name of the kind.
    pub name: Option<Spanned<String>>,
    pub material: Option<Spanned<String>>,
    /// How many.
    pub count: Option<Spanned<usize>>,
    /// Mean diameter.
    pub diameter: Option<Spanned<QuantityText>>,
    /// Mean length, of ovate fruit.
    pub length: Option<Spanned<QuantityText>>,
    /// Number of spheres that make up an ovate fruit.
    pub spheres: Option<Spanned<usize>>,
    /// Standard deviation of the diameter between fruit.
    pub diameter_sd: Option<Spanned<QuantityText>>,
    pub density: Option<Spanned<QuantityText>>,
    /// All there at the beginning, on a lattice in a box.
    pub lattice: Option<Spanned<LatticeFile>>,
    /// Poured at a rate through a box.
    pub pour: Option<Spanned<PourFile>>,
    /// One after the other from one place.
    pub drop: Option<Spanned<DropOneFile>>,
    /// From a tree: at random places in a box, at random times.
    pub tree: Option<Spanned<TreeFile>>,
    /// What else the fruit have that a regression of bruises asks for, in its units.
    #[serde(default)]
    pub properties: BTreeMap<String, Spanned<PropertyFile>>,
}

/// A property of fruit: temperature, firmness.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PropertyFile {
    pub mean: f64,
    /// Its standard deviation between fruit.
    #[serde(default)]
    pub sd: f64,
}

/// `lattice`
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LatticeFile {
    /// Lowest corner of the box; m.
    pub low: [f64; 3],
    /// Highest corner; m.
    pub high: [f64; 3],
    /// Velocity; m/s.
    #[serde(default)]
    pub velocity: [f64; 3],
}

/// `pour`
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PourFile {
    /// Lowest corner of the box; m.
    pub low: [f64; 3],
    /// Highest corner; m.
    pub high: [f64; 3],
    /// Velocity; m/s.
    #[serde(default)]
    pub velocity: [f64; 3],
    /// Fruit per second.
    pub rate: Spanned<QuantityText>,
    /// When it begins.
    pub from: Option<Spanned<QuantityText>>,
}

/// `drop`
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DropOneFile {
    /// From where; m.
    pub place: [f64; 3],
    /// Velocity; m/s.
    #[serde(default)]
    pub velocity: [f64; 3],
    /// Time from one to the next.
    pub interval: Option<Spanned<QuantityText>>,
    /// When the first comes.
    pub from: Option<Spanned<QuantityText>>,
}

/// `tree`
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TreeFile {
    /// Lowest corner of the box of the crown; m.
    pub low: [f64; 3],
    /// Highest corner; m.
    pub high: [f64; 3],
    /// Over which time they come off.
    pub over: Option<Spanned<QuantityText>>,
}

/// `[[sinks]]`
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SinkFile {
    pub name: Option<String>,
    /// Lowest corner; m.
    pub low: [f64; 3],
    /// Highest corner; m.
    pub high: [f64; 3],
}

/// `[air]`
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AirFile {
    pub density: Option<Spanned<QuantityText>>,
    /// Drag coefficient of a sphere.
    pub drag_coefficient: Option<Spanned<f64>>,
}

/// `[events]`
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EventsFile {
    /// Contacts with a smaller peak force are counted, not written.
    pub least_peak_force: Option<Spanned<QuantityText>>,
}

/// `[bruise]`
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BruiseFile {
    /// "absorbed energy" or "peak force".
    pub predictor: Option<Spanned<String>>,
    /// Below this nothing bruises.
    pub threshold: Option<Spanned<QuantityText>>,
    /// Its standard uncertainty.
    pub threshold_sd: Option<Spanned<QuantityText>>,
    /// How it differs from fruit to fruit.
    pub threshold_between_fruit: Option<Spanned<QuantityText>>,
    /// Volume per unit of the predictor above the threshold.
    pub susceptibility: Option<Spanned<QuantityText>>,
    /// Its standard uncertainty.
    pub susceptibility_sd: Option<Spanned<QuantityText>>,
    /// A regression of bruise volumes, in place of a susceptibility.
    pub regression: Option<Spanned<String>>,
    /// What the columns of the regression are, where their names do not tell it.
    #[serde(default)]
    pub columns: BTreeMap<String, String>,
    /// Smaller bruises are none.
    pub least_volume: Option<Spanned<QuantityText>>,
    /// "largest" or "sum".
    pub same_spot: Option<Spanned<String>>,
    /// Volumes of the largest bruise above which a fruit counts as bruised.
    #[serde(default)]
    pub limits: Vec<Spanned<QuantityText>>,
}
