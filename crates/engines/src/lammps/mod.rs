//! LAMMPS.

pub(crate) mod deck;
mod terms;
pub(crate) mod walls;
