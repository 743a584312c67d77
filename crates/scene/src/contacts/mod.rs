//! Which bodies touch, what a contact remembers, and its force.

pub(crate) mod ball;
pub(crate) mod bodies;
pub(crate) mod cells;
pub(crate) mod clump_contacts;
pub(crate) mod contact;
pub(crate) mod law_column;
pub(crate) mod memory;
mod mesh_contacts;
pub(crate) mod neighbours;
pub(crate) mod pair_contacts;
pub(crate) mod pair_forces;
pub(crate) mod pulse;
pub(crate) mod react;
pub(crate) mod store;
pub(crate) mod wall_contacts;
pub(crate) mod wall_forces;
