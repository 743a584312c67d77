//! `windfall surface`

use crate::args::surface::SurfaceArguments;
use crate::show::show;
use windfall_tables::surface::run::surface;
use windfall_tables::surface::text::{csv_of_surface, text_of_surface};

/// Response surfaces of a table of runs.
pub fn run(arguments: &SurfaceArguments) -> anyhow::Result<()> {
    let work = || surface(&arguments.request);
    show(&arguments.shown, work, text_of_surface, csv_of_surface)?;
    Ok(())
}
