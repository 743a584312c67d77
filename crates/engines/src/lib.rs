//! Scenes on other engines: decks, runs, and laws in their terms.

mod classes;
pub mod contacts;
mod deck;
mod frames;
mod lammps;
mod law;
mod liggghts;
mod motion;
pub mod parameters;
mod program;
pub mod run;
pub mod text;
mod walls;
