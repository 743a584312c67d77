//! scene.toml and the files that it names.

pub(crate) mod bruise;
pub(crate) mod bruise_expression;
pub(crate) mod card;
pub(crate) mod change;
pub(crate) mod columns;
mod contacts;
pub mod engine_kind;
pub(crate) mod fruit;
pub(crate) mod key;
pub(crate) mod mesh;
pub(crate) mod moves;
pub(crate) mod periodic;
pub(crate) mod properties;
pub mod read;
pub(crate) mod record;
pub(crate) mod regression;
pub(crate) mod room;
pub(crate) mod scene;
pub mod sensors;
pub(crate) mod step;
pub(crate) mod stl;
pub(crate) mod walls;
