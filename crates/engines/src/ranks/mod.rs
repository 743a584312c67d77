//! Contacts found inside of the ranks of LAMMPS, where its atoms are, and put together afterwards.

pub(crate) mod begin;
pub(crate) mod checkpoint;
pub mod follow;
pub(crate) mod following;
pub(crate) mod library;
pub(crate) mod merge;
pub(crate) mod part;
