#![cfg_attr(not(test), warn(clippy::disallowed_methods, clippy::disallowed_types))]
//! Many fruit at once: spheres that fall, roll and strike each other and walls, under the
//! very force law that was fitted.
//!
//! A [`Scene`](scene::Scene) says what is there; a [`Simulation`](simulation::Simulation)
//! takes it from step to step and hands out each contact as an
//! [`Event`](event::Event) when it ends.
//!
//! This crate knows no instrument and no file, and reads no clock.

pub mod annuli;
pub mod binary;
pub mod bruise;
pub mod bruise_regression;
pub mod clump;
mod clump_contacts;
mod clump_motion;
mod contact;
pub mod draws;
pub mod energy;
pub mod error;
pub mod event;
mod facet_tree;
pub mod follow;
mod gather;
pub mod interaction;
mod law_column;
mod line;
pub mod mesh;
mod mesh_contacts;
mod neighbours;
mod pair_contacts;
mod pair_forces;
pub mod population;
pub mod reach;
mod react;
mod relist;
pub mod room;
pub mod scene;
pub mod simulation;
pub mod state;
mod store;
mod sweep;
pub mod time_step;
mod traffic;
pub mod vector;
mod vector_of;
pub mod wall;
mod wall_contacts;
mod wall_forces;
