//! `windfall bounces`

use crate::args::bounces::BouncesArguments;
use crate::show::show;
use windfall_drop::intervals::run::bounces;
use windfall_drop::intervals::text::{csv_of_bounces, text_of_bounces};

/// Restitution from the times between impacts.
pub fn run(arguments: &BouncesArguments) -> anyhow::Result<()> {
    let work = || bounces(&arguments.request);
    show(&arguments.shown, work, text_of_bounces, csv_of_bounces)?;
    Ok(())
}
