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
    /// Run variants of a scene several times each, and compare who is bruised
    Study(SceneStudyArguments),
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

A run that was stopped, by Ctrl-C, a full disk or a cut of power, goes on from its last checkpoint with --resume, \
and gives the same files to the last digit; `checkpoint` in [scene] says how often one is made.

Examples:
  windfall new scene my-scene
  windfall scene run my-scene/scene.toml
  windfall scene run my-scene/scene.toml --out first-try --threads 2 --format json
  windfall scene run my-scene/scene.toml --resume"
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
    /// Go on with a run that was stopped, from its last checkpoint
    #[arg(long, conflicts_with = "restart")]
    pub resume: bool,
    /// Begin anew where a run was stopped
    #[arg(long)]
    pub restart: bool,
    /// How the result is shown
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
}

/// `windfall scene study`
#[derive(Debug, Args)]
#[command(
    after_help = "FILE names a scene and what is varied: [[vary]] with a name and levels, which set keys of the scene \
or move walls, sources and sinks. Every combination of levels is run as often as replicates says, with other \
seeds and with laws drawn from the uncertainty of their cards.

Writes beside FILE, into FILE without its ending and with .study: study.html (the page), study.csv, study.json, \
figures/, and variants/ with every run. What an earlier run of the study left there is replaced.

Examples:
  windfall new scene-study my-study
  windfall scene study my-study/study.toml"
)]
pub struct SceneStudyArguments {
    /// The study
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub file: PathBuf,
    /// Directory to write into
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub out: Option<PathBuf>,
    /// Number of threads, over which runs are spread; all cores if left out. It never changes a result
    #[arg(long, value_name = "N")]
    pub threads: Option<usize>,
    /// How the result is shown
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
}
