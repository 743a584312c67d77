//! The commands: each calls one workflow and shows what it returns.

pub(crate) mod add;
pub(crate) mod bounces;
pub mod bruise;
pub(crate) mod calibrate;
pub(crate) mod card;
pub(crate) mod compare;
pub(crate) mod design;
pub(crate) mod explain;
pub(crate) mod fit;
pub(crate) mod geometry;
pub(crate) mod inspect;
pub(crate) mod laws;
pub(crate) mod licences;
pub(crate) mod man;
pub mod new;
pub(crate) mod plan;
pub(crate) mod population;
pub(crate) mod regress;
pub(crate) mod report;
pub(crate) mod scene;
pub(crate) mod scene_view;
pub(crate) mod schema;
pub(crate) mod serve;
pub(crate) mod simulate;
pub(crate) mod simulate_drop;
pub(crate) mod surface;
