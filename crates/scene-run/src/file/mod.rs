//! scene.toml and the files that it names.

pub mod bruise;
pub mod bruise_expression;
pub mod card;
pub mod engine_kind;
pub mod fruit;
pub mod key;
pub mod mesh;
pub mod properties;
pub mod read;
pub mod record;
pub mod regression;
pub mod room;
pub mod scene;
pub mod step;
pub mod stl;
pub mod walls;
