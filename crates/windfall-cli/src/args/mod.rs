//! Arguments of the commands.

pub mod bounces;
pub mod bruise;
pub mod calibrate;
pub(crate) mod common;
pub mod compare;
pub mod design;
pub mod fit;
pub(crate) mod format;
pub mod geometry;
pub mod groups;
pub(crate) mod kind;
pub mod laws;
pub mod plan;
pub mod population;
pub mod regress;
pub mod report;
pub mod scene;
pub(crate) mod scene_view;
pub(crate) mod schema;
pub mod serve;
pub mod simulate;
pub mod surface;
