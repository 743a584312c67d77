//! `windfall laws`: arguments.

use crate::args::format::Shown;
use clap::{Args, ValueHint};
use std::path::PathBuf;
use windfall_draw::files::FigureFolder;

/// `windfall laws`
#[derive(Debug, Args)]
#[command(
    after_help = "Fits each law to each impact, all with the same noise, and ranks them by AICc, by BIC, \
and by how well parameters found at some velocities predict the others. Velocity levels are those \
of the column `level` of impacts.csv, or groups of like velocities. Nothing is written but figures.

Examples:
  windfall laws my-campaign
  windfall laws my-campaign --law kuwabara-kono --law hunt-crossley --law 'power-law(n=1.5)' --free p
  windfall laws my-campaign --format csv
  windfall laws my-campaign --figures figures"
)]
pub struct LawsArguments {
    /// The campaign directory
    #[arg(default_value = ".", value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub directory: PathBuf,
    /// A law to compare; may be repeated. None: the campaign's, if it names two or more, else one of each form
    #[arg(long = "law", value_name = "LAW")]
    pub laws: Vec<String>,
    /// A parameter to estimate although it has a usual value; may be repeated
    #[arg(long = "free", value_name = "PARAMETER")]
    pub free: Vec<String>,
    /// Quantities in the cost function in place of the campaign's
    #[arg(long, value_delimiter = ',', value_name = "NAME,…")]
    pub quantities: Vec<String>,
    /// The comparison, and one impact with the best fit of each law
    #[command(flatten)]
    pub figures: Option<FigureFolder>,
    /// Find the answer anew, even where nothing has changed since it was found
    #[arg(long)]
    pub refit: bool,
    /// Threads; all cores if left out
    #[arg(long, value_name = "N")]
    pub threads: Option<usize>,
    #[command(flatten)]
    pub shown: Shown,
}
