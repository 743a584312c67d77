//! `windfall scene`: what may be asked for.

use crate::args_format::Format;
use crate::args_scene_view::{ScenePictureArguments, SceneVtkArguments};
use clap::{Args, Subcommand, ValueHint};
use std::path::PathBuf;

/// `windfall scene …`
#[derive(Debug, Subcommand)]
pub enum SceneCommand {
    /// Run a scene, and write every contact and every fruit
    Run(SceneRunArguments),
    /// Draw a scene that has run: walls, and fruit coloured by their largest impact
    Picture(ScenePictureArguments),
    /// Write the frames of a scene that has run for ParaView
    Vtk(SceneVtkArguments),
}

/// `windfall scene run`
#[derive(Debug, Args)]
#[command(
    after_help = "Writes beside FILE, into FILE without its ending and with .run: events.csv (every contact: when, \
where in space and on the fruit, impact speed, peak force, largest displacement, duration, absorbed energy), \
fruit.csv (every fruit with its hardest contact) and scene.json (what is printed). Units are in the names of \
the columns; SI.

Examples:
  windfall new scene my-scene
  windfall scene run my-scene/scene.toml
  windfall scene run my-scene/scene.toml --out first-try --threads 2 --format json"
)]
pub struct SceneRunArguments {
    /// The scene
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub file: PathBuf,
    /// Directory to write into
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub out: Option<PathBuf>,
    /// Number of threads; all cores if left out. It never changes a result
    #[arg(long, value_name = "N")]
    pub threads: Option<usize>,
    /// How the result is shown
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
}
