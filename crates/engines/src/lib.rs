//! Scenes on other engines: decks, runs, and laws in their terms.

mod classes;
pub mod contacts;
mod deck;
pub mod delivered;
mod frames;
mod hertz;
mod lammps;
mod law;
mod liggghts;
mod motion;
mod pair;
pub mod parameters;
mod program;
pub mod ranks;
pub mod run;
mod running;
mod simplify;
pub mod text;
mod walls;
