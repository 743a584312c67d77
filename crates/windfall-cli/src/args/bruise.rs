//! `windfall bruise`: arguments.

use crate::args::format::Shown;
use clap::{Args, ValueHint};
use std::path::PathBuf;

/// `windfall bruise`
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  windfall bruise --widths '16 mm, 15 mm' --depth '5 mm' --radius '40 mm'
  windfall bruise --table bruises.csv > volumes.csv

A table has the columns bruise_width_mm (or bruise_width_1_mm and bruise_width_2_mm) and bruise_depth_mm, \
and radius_mm of the fruit where that is known, in any unit that their names say. It is written again with \
the volumes beside it, for `windfall regress`. The three geometries differ by a fifth: keep to one.")]
pub struct BruiseArguments {
    /// Its widths across; one where it is round
    #[arg(long, value_name = "A[, B]", required_unless_present = "table")]
    pub widths: Option<String>,
    /// Its depth below the plane through its edge
    #[arg(long, value_name = "LENGTH", requires = "widths")]
    pub depth: Option<String>,
    /// Radius of the fruit there, for the cap above that plane
    #[arg(long, value_name = "LENGTH", requires = "widths")]
    pub radius: Option<String>,
    /// A table of bruises (CSV)
    #[arg(long, value_name = "FILE", conflicts_with = "widths", value_hint = ValueHint::FilePath)]
    pub table: Option<PathBuf>,
    #[command(flatten)]
    pub shown: Shown,
}
