//! Many fruit at once: spheres that fall, roll and strike each other and walls, under the
//! very force law that was fitted.
//!
//! A [`Scene`](scene::Scene) says what is there; a [`Simulation`](motion::simulation::Simulation)
//! takes it from step to step and hands out each contact as an
//! [`Event`](event::Event) when it ends.
//!
//! This crate knows no instrument and no file, and reads no clock.

pub mod annuli;
pub mod binary;
pub mod bruise;
mod contacts;
pub mod draws;
pub mod energy;
pub mod error;
pub mod event;
pub mod follow;
pub mod interaction;
mod line;
pub mod motion;
pub mod periods;
pub mod population;
pub mod reach;
pub mod room;
pub mod scene;
pub mod shape;
pub mod share;
pub mod share_state;
pub mod state;
pub mod vector;
