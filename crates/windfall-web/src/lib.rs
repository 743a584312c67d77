//! The local web application of windfall: an HTTP interface over the workflows of the
//! crate `windfall`, and the page that uses it.
//!
//! What is done in the page is done to the files of a campaign, so that the command line
//! sees it; the page is built from `page/` and lies ready in `assets/`.

mod about;
mod api;
mod app;
mod asset;
mod contour_map;
mod described;
mod given;
mod guard;
pub mod interrupt;
mod job;
mod openapi;
mod problem;
pub mod serve;
