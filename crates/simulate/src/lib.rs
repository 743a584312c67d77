//! `windfall simulate`: impacts, drops and whole campaigns as a bench would record them.

pub mod campaign;
pub mod compression;
pub mod drop;
pub mod drop_text;
pub mod drops;
pub mod eccentric;
pub mod eccentric_text;
pub mod example;
pub mod figure;
pub mod files;
pub mod impact;
pub mod motion;
mod new_campaign;
pub mod repeats;
pub mod request;
pub mod taps;
pub mod text;
mod wav;
