//! `windfall scene`: arguments.

use crate::args::format::Format;
use crate::args::scene_view::{ScenePictureArguments, SceneTableArguments, SceneVtkArguments};
use clap::{Args, Subcommand, ValueEnum, ValueHint};
use std::path::PathBuf;
use windfall_engines::ranks::follow::RankRequest;
use windfall_engines::run::{DeckRequest, EngineRequest};
use windfall_scene_run::run::workflow::SceneRequest;
use windfall_scene_run::study::run::StudyRequest;

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
    /// Write a table of a scene that has run as Parquet, Arrow or CSV
    Table(SceneTableArguments),
    /// One rank of LAMMPS: runs the deck of a scene, and writes the pulses that it finds
    #[command(hide = true)]
    Rank(RankRequest),
    /// Write a scene as a complete deck for LAMMPS or LIGGGHTS, or its contacts for others
    Export(SceneExportArguments),
}

/// An engine that a scene, or its contacts, are written for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ExportName {
    /// A deck for LAMMPS of 29 Sep 2021 or newer
    Lammps,
    /// A deck for LIGGGHTS-PUBLIC 3.8
    Liggghts,
    /// The contacts as IMPACT statements of Adams
    Adams,
    /// The contacts for YADE
    Yade,
    /// The contacts as species of MercuryDPM
    Mercurydpm,
    /// The contacts as tables of EDEM
    Edem,
    /// The contacts as materials of Chrono
    Chrono,
}

/// `windfall scene export`
#[derive(Debug, Args)]
#[command(
    after_help = "Writes a directory beside FILE, or that of --out. LAMMPS or LIGGGHTS run the deck there, on one \
machine or on many, and write frames.bin; `windfall scene run FILE --engine … --frames frames.bin` makes \
contacts, fruit and bruises of it. For other engines it writes the contact of each pair of materials in \
their own terms, and says what of it is the law itself.

Examples:
  windfall scene export my-scene/scene.toml --engine lammps
  windfall scene export my-scene/scene.toml --engine liggghts --out deck
  windfall scene export my-scene/scene.toml --engine adams --speed 2"
)]
pub struct SceneExportArguments {
    /// The scene
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub file: PathBuf,
    /// The engine
    #[arg(long, value_enum)]
    pub engine: ExportName,
    /// For the others: impact speed in m/s at which damping that is not the law's takes as much energy
    /// [default: the middle of the range of the law's card, in all of which it must hold; 1 without a card]
    #[arg(long, value_name = "SPEED")]
    pub speed: Option<f64>,
    /// Directory to write into
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub out: Option<PathBuf>,
    #[command(flatten)]
    pub deck: DeckRequest,
    /// How the result is shown
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
}

/// `windfall scene run`
#[derive(Debug, Args)]
#[command(
    after_help = "Writes beside FILE, into FILE without its ending and with .run: events.csv (every contact: when, \
where in space and on the fruit, impact speed, peak force, largest displacement, duration, absorbed energy), \
fruit.csv (every fruit with its hardest contact), tables sensor_….csv of [[sensors]], and scene.json (what is \
printed). Units are in the names of \
the columns; SI.

A run that was stopped, by Ctrl-C, a full disk or a cut of power, goes on from its last checkpoint with --resume, \
and gives the same files to the last digit; `checkpoint` in [scene] says how often one is made. On LAMMPS it may go \
on with another number of --ranks, whose pulses differ by rounding.

Examples:
  windfall new scene my-scene
  windfall scene run my-scene/scene.toml
  windfall scene run my-scene/scene.toml --out first-try --threads 2 --format json
  windfall scene run my-scene/scene.toml --set fruit.apples.count=20 --set scene.seed=7 --out second-try
  windfall scene run my-scene/scene.toml --resume
  windfall scene run my-scene/scene.toml --engine lammps --ranks 4"
)]
pub struct SceneRunArguments {
    /// The scene
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub file: PathBuf,
    #[command(flatten)]
    pub request: SceneRequest,
    /// Go on with a run that was stopped, from its last checkpoint
    #[arg(long, conflicts_with = "restart")]
    pub resume: bool,
    /// Begin anew where a run was stopped
    #[arg(long)]
    pub restart: bool,
    #[command(flatten)]
    pub engine: EngineRequest,
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
    #[command(flatten)]
    pub request: StudyRequest,
    /// How the result is shown
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
}
