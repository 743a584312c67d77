//! `windfall scene picture`, `windfall scene vtk` and `windfall scene table`: arguments.

use crate::args::format::Format;
use clap::{Args, ValueHint};
use std::path::PathBuf;
use windfall_draw::theme::FigureTheme;
use windfall_draw::width::Width;
use windfall_scene_run::run::columns::SceneTable;

/// `windfall scene picture`
#[derive(Debug, Args)]
#[command(
    after_help = "The scene must have been run with frames: [record] frames = \"20 ms\" in its file. Fruit have \
the colour of the largest peak force of their contacts so far.

Examples:
  windfall scene picture my-scene/scene.run
  windfall scene picture my-scene/scene.run --time \"1.2 s\" --from \"-30 deg,35 deg\" --out bin.svg
  windfall scene picture my-scene/scene.run --largest-force \"100 N\" --theme dark --out bin.png"
)]
pub struct ScenePictureArguments {
    /// Directory that `windfall scene run` wrote into, or the scene file beside it
    #[arg(value_name = "RUN", value_hint = ValueHint::AnyPath)]
    pub run: PathBuf,
    /// When, as "1.2 s"; the end if left out
    #[arg(long, value_name = "TIME")]
    pub time: Option<String>,
    /// From where: azimuth from x towards y and elevation, as "-62 deg,24 deg"
    #[arg(long, value_name = "ANGLES", allow_hyphen_values = true)]
    pub from: Option<String>,
    /// Force of the last colour, as "100 N"; the largest of the scene if left out
    #[arg(long, value_name = "FORCE")]
    pub largest_force: Option<String>,
    /// Colours
    #[arg(long, value_enum, default_value_t = FigureTheme::Light)]
    pub theme: FigureTheme,
    /// Width in print, as a journal asks for it: 84mm, 174mm; letters are 8 pt at that size
    #[arg(long, value_name = "LENGTH")]
    pub width: Option<Width>,
    /// An .svg, .png (300 dots per inch) or .pdf; picture.svg and picture.png in RUN if left out
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub out: Option<PathBuf>,
    /// How the result is shown
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
}

/// `windfall scene vtk`
#[derive(Debug, Args)]
#[command(
    after_help = "Writes fruit_*.vtp (points with radius, velocity, largest_peak_force, orientation and number of \
the fruit), walls.vtp (or walls_*.vtp where walls move) and scene.pvd, which lists them with their times: open \
that one in ParaView, and show the fruit as glyphs (sphere, scaled by radius, factor 2).

Example:
  windfall scene vtk my-scene/scene.run"
)]
pub struct SceneVtkArguments {
    /// Directory that `windfall scene run` wrote into, or the scene file beside it
    #[arg(value_name = "RUN", value_hint = ValueHint::AnyPath)]
    pub run: PathBuf,
    /// Directory to write into; RUN/vtk if left out
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub out: Option<PathBuf>,
    /// How the result is shown
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
}

/// `windfall scene table`
#[derive(Debug, Args)]
#[command(
    after_help = "The ending of FILE says what is written: .parquet or .arrow for pandas, polars, DuckDB, R and others \
that read columns, .csv for the rest. Columns have their unit in their name, and unit and meaning in the metadata; \
the file says which version of the table it holds.

Examples:
  windfall scene table my-scene/scene.run events --out events.parquet
  windfall scene table my-scene/scene.run frames --out frames.arrow"
)]
pub struct SceneTableArguments {
    /// Directory that `windfall scene run` wrote into, or the scene file beside it
    #[arg(value_name = "RUN", value_hint = ValueHint::AnyPath)]
    pub run: PathBuf,
    /// Which table; frames need [record] frames in the scene
    #[arg(value_enum, value_name = "TABLE")]
    pub table: SceneTable,
    /// File to write: .parquet, .arrow or .csv
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub out: PathBuf,
    /// How the result is shown
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
}
