//! LAMMPS.

pub mod deck;
mod terms;
pub mod walls;
