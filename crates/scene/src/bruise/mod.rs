//! Bruise from the impacts of a scene.

pub mod damage;
pub mod regression;
