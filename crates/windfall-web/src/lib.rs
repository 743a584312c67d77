//! The local web application of windfall: an HTTP interface over the workflows of the
//! crate `windfall`, and the page that uses it.
//!
//! The page works on the files of a campaign, as the command line does. It is built from
//! `page/` into `assets/`.

mod about;
mod api;
mod app;
mod asset;
mod connections;
mod contour_map;
mod described;
mod given;
mod guard;
pub mod interrupt;
mod job;
mod openapi;
mod problem;
pub mod serve;
