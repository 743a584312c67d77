//! Shapes of fruit and walls.

pub mod beyond;
pub mod clump;
pub(crate) mod facet_tree;
pub mod mesh;
pub mod motion;
pub(crate) mod placed;
pub mod spheroid;
pub mod surface;
pub mod wall;
