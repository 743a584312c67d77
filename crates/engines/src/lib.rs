//! Scenes on other engines: decks, runs, and laws in their terms.

pub mod classes;
pub mod contacts;
pub mod deck;
pub mod frames;
pub mod lammps;
pub mod law;
pub mod liggghts;
pub mod motion;
pub mod parameters;
pub mod program;
pub mod run;
pub mod text;
pub mod walls;
