//! Columns of the tables of a scene.

use windfall_files::sheet::Kind::{Count, Flag, Number, Single, Text};
use windfall_files::sheet::{Kind, Schema, titled};

/// Raised when a column of one of the tables goes or changes its meaning.
const VERSION: u32 = 1;

/// Columns of events.csv.
const EVENTS: [(&str, Kind, &str); 23] = [
    ("fruit", Count, "number of the fruit"),
    ("partner", Text, "the wall, or \"fruit\""),
    ("partner_fruit", Count, "number of the other fruit"),
    ("time_s", Number, "beginning of the load"),
    ("duration_s", Number, "how long it lasted"),
    (
        "lasting",
        Flag,
        "whether it was still there when the scene ended",
    ),
    ("x_m", Number, "where"),
    ("y_m", Number, "where"),
    ("z_m", Number, "where"),
    (
        "spot_x",
        Number,
        "where on the fruit: direction from its centre, fixed to it",
    ),
    ("spot_y", Number, "where on the fruit"),
    ("spot_z", Number, "where on the fruit"),
    (
        "partner_spot_x",
        Number,
        "where on the other fruit, or the wall at rest",
    ),
    (
        "partner_spot_y",
        Number,
        "where on the other fruit, or the wall at rest",
    ),
    (
        "partner_spot_z",
        Number,
        "where on the other fruit, or the wall at rest",
    ),
    ("normal_speed_m_s", Number, "normal speed of approach"),
    (
        "tangential_speed_m_s",
        Number,
        "tangential speed at the beginning",
    ),
    ("peak_force_N", Number, "largest normal force"),
    ("largest_displacement_m", Number, "largest overlap"),
    (
        "absorbed_energy_J",
        Number,
        "energy that the normal contact kept",
    ),
    ("friction_energy_J", Number, "energy that friction took"),
    ("static", Flag, "whether the load is static"),
    ("load", Count, "number of the load in its contact"),
];

/// Columns of fruit.csv.
const FRUIT: [(&str, Kind, &str); 21] = [
    ("fruit", Count, "number of the fruit"),
    ("material", Text, "its material"),
    ("diameter_m", Number, "its diameter"),
    ("mass_kg", Number, "its mass"),
    ("released_s", Number, "when it came"),
    ("left_s", Number, "when it left"),
    ("sink", Text, "where it left"),
    ("x_m", Number, "where it is at the end"),
    ("y_m", Number, "where it is at the end"),
    ("z_m", Number, "where it is at the end"),
    ("contacts", Count, "impacts"),
    (
        "largest_peak_force_N",
        Number,
        "largest peak force of an impact",
    ),
    ("partner_of_it", Text, "what it touched then"),
    ("time_of_it_s", Number, "when"),
    (
        "impact_speed_of_it_m_s",
        Number,
        "normal speed of approach then",
    ),
    (
        "largest_absorbed_energy_J",
        Number,
        "largest energy that an impact absorbed",
    ),
    (
        "absorbed_energy_J",
        Number,
        "energy that all impacts absorbed",
    ),
    ("bruises", Count, "bruises"),
    ("largest_bruise_mm3", Number, "volume of the largest bruise"),
    ("static_loads", Count, "static loads"),
    (
        "largest_static_force_N",
        Number,
        "largest force of a static load",
    ),
];

/// Columns of frames: one row for each fruit in each of them.
const FRAMES: [(&str, Kind, &str); 14] = [
    ("time_s", Number, "time of the frame"),
    ("fruit", Count, "number of the fruit"),
    ("x_m", Single, "where its centre is"),
    ("y_m", Single, "where its centre is"),
    ("z_m", Single, "where its centre is"),
    ("turn_w", Single, "orientation, as a quaternion"),
    ("turn_x", Single, "orientation, as a quaternion"),
    ("turn_y", Single, "orientation, as a quaternion"),
    ("turn_z", Single, "orientation, as a quaternion"),
    ("velocity_x_m_s", Single, "velocity"),
    ("velocity_y_m_s", Single, "velocity"),
    ("velocity_z_m_s", Single, "velocity"),
    ("radius_m", Single, "radius of the fruit"),
    ("largest_peak_force_N", Single, "largest peak force so far"),
];

/// A table of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum SceneTable {
    /// Every load of every fruit, as in events.csv
    Events,
    /// Every fruit, as in fruit.csv
    Fruit,
    /// Every fruit in every frame
    Frames,
}

impl SceneTable {
    /// Its columns.
    pub fn schema(self) -> Schema {
        let (table, columns): (_, &[(&str, Kind, &str)]) = match self {
            Self::Events => ("events", &EVENTS),
            Self::Fruit => ("fruit", &FRUIT),
            Self::Frames => ("frames", &FRAMES),
        };
        let column = |own: &(&str, Kind, &str)| titled(own.0, own.1, own.2);
        Schema {
            table,
            version: VERSION,
            columns: columns.iter().map(column).collect(),
            notes: Vec::new(),
        }
    }
}
