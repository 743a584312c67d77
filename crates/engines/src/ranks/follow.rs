//! The program on each rank: it opens LAMMPS, runs the deck, and is called back where fruit are.

use crate::deck::LOG;
use crate::lammps::deck::RESUME;
use crate::program::wrong;
use crate::ranks::checkpoint::parts_with_deck;
use crate::ranks::following::{Following, Task};
use crate::ranks::library::VERSION;
use crate::ranks::part::scene_of;
use crate::running::make_room;
use crate::simplify::{check_open, simplified};
use std::io::Write;
use std::path::PathBuf;
use windfall_files::error::Error;
use windfall_files::on_threads::on_threads;
use windfall_lammps::mpi::Ranks;
use windfall_lammps::run::{Atoms, Lammps, Library};
use windfall_scene_run::file::engine_kind::Engine;
use windfall_scene_run::file::read::read_scene;
use windfall_scene_run::file_error::access;
use windfall_scene_run::run::checkpoint::CheckpointHead;
use windfall_scene_run::run::stopped::SceneStart;
use windfall_scene_run::run::workflow::time_step;

/// What a rank is to do.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct RankRequest {
    /// The scene
    #[cfg_attr(feature = "clap", arg(value_name = "FILE", required_unless_present = "try_library", value_hint = clap::ValueHint::FilePath))]
    pub file: Option<PathBuf>,
    /// Directory of its deck, where the pulses go
    #[cfg_attr(feature = "clap", arg(long, value_name = "DIR", required_unless_present = "try_library", value_hint = clap::ValueHint::DirPath))]
    pub deck: Option<PathBuf>,
    /// The library of LAMMPS, by its path or by a name that the system knows
    #[cfg_attr(feature = "clap", arg(long, value_name = "FILE", default_value = "liblammps.so.0", value_hint = clap::ValueHint::FilePath))]
    pub library: PathBuf,
    /// Go on from the checkpoint in the directory of the deck
    #[cfg_attr(feature = "clap", arg(long, conflicts_with = "restart"))]
    pub resume: bool,
    /// Begin anew where a run was stopped
    #[cfg_attr(feature = "clap", arg(long))]
    pub restart: bool,
    /// Leave the last checkpoint there at the end
    #[cfg_attr(feature = "clap", arg(long))]
    pub keep: bool,
    /// Only open the library, and print its version
    #[cfg_attr(feature = "clap", arg(long = "try"))]
    pub try_library: bool,
}

impl RankRequest {
    fn start(&self) -> SceneStart {
        match (self.resume, self.restart) {
            (true, _) => SceneStart::Resume,
            (false, true) => SceneStart::Restart,
            (false, false) => SceneStart::Fresh,
        }
    }
}

/// How the line of a deck begins that writes frames.
const DUMP: &str = "dump frames all custom ";
/// The fix that calls back.
const FIX: &str = "windfall";

/// Follows the fruit of a rank to the end of the scene.
///
/// # Errors
/// The library, the scene or the deck cannot be used; the pulses cannot be written. Where other
/// ranks wait it says so and ends them all.
pub fn run_rank(request: &RankRequest) -> Result<(), Error> {
    // Every core has a rank of its own; threads that wait for work would take it from them.
    on_threads(Some(1), || run_alone(request))
}

fn run_alone(request: &RankRequest) -> Result<(), Error> {
    let failed = |problem: String| wrong(Engine::Lammps, problem);
    let path = &request.library;
    let told = |problem: String| failed(format!("{}: {problem}", path.display()));
    let library = Library::open(path).map_err(told)?;
    if request.try_library {
        let lammps = Lammps::begin(library, &["-log", "none", "-screen", "none"]);
        let lammps = lammps.map_err(told)?;
        let said = format!("{VERSION}{}\n", lammps.version());
        lammps.end();
        // Who asked reads it.
        let _ = std::io::stdout().write_all(said.as_bytes());
        return Ok(());
    }
    let (Some(file), Some(directory)) = (&request.file, &request.deck) else {
        return Err(failed("a rank needs a scene and its deck".to_owned()));
    };
    let path = directory.join("in.scene");
    let deck = std::fs::read_to_string(&path).map_err(access(&path, "read"))?;
    let (frame_steps, commands) =
        split(&deck).ok_or_else(|| failed(format!("{} is no deck of windfall", path.display())))?;
    let mut plan = read_scene(file)?;
    check_open(&plan, Engine::Lammps)?;
    time_step(&mut plan)?;
    let scene = scene_of(&plan);
    simplified(&mut plan, Engine::Lammps);
    plan.scene.time_step *= frame_steps as f64;
    let directory = std::path::absolute(directory).map_err(access(directory, "read"))?;
    // LAMMPS would replace a file of that name, whoever wrote it.
    make_room(&directory, &[LOG])?;
    // The deck names its files from there.
    std::env::set_current_dir(&directory).map_err(access(&directory, "read"))?;
    let lammps = Lammps::begin(library, &["-log", LOG]).map_err(told)?;
    let task = Task {
        plan: &plan,
        head: CheckpointHead {
            time: 0.0,
            end: plan.end,
            parts: parts_with_deck(&scene, &deck),
        },
        scene,
        directory: &directory,
        frame_steps,
    };
    let done = Following::begin(&lammps, task, (request.start(), request.keep))
        .and_then(|following| run(&lammps, following, commands));
    match done {
        Ok(()) => {}
        Err(error) if lammps.ranks.size > 1 => give_up(&lammps.ranks, &error),
        Err(error) => return Err(error),
    }
    lammps.end();
    Ok(())
}

/// Steps between frames of a deck, and its commands: up to the one that would write these, and
/// from there on.
fn split(deck: &str) -> Option<(u64, (&str, &str))> {
    // It must be able to go on from a checkpoint.
    deck.find(RESUME)?;
    let from = deck.find(&format!("\n{DUMP}"))? + 1;
    let (before, after) = deck.split_at(from);
    let (line, after) = after.split_once('\n')?;
    let steps = line.strip_prefix(DUMP)?.split(' ').next()?;
    let steps = steps.parse().ok().filter(|own| *own > 0)?;
    Some((steps, (before, after)))
}

fn run(
    lammps: &Lammps,
    mut following: Following,
    (before, after): (&str, &str),
) -> Result<(), Error> {
    let failed = |problem: String| wrong(Engine::Lammps, problem);
    lammps.commands(&following.words).map_err(failed)?;
    lammps.commands(before).map_err(failed)?;
    // It adds no forces.
    let fix = format!(
        "fix {FIX} all external pf/callback {} 1000000000",
        following.frame_steps
    );
    lammps.commands(&fix).map_err(failed)?;
    let mut told = |atoms: Atoms| {
        if let Err(error) = following.take(&atoms) {
            give_up(&lammps.ranks, &error);
        }
    };
    let done = lammps.run(after, (FIX, "i_fruit"), &mut told);
    done.map_err(failed)?;
    following.finish()
}

/// Says what is wrong, and ends all ranks: others would wait for this one.
fn give_up(ranks: &Ranks, error: &Error) -> ! {
    let cause = std::error::Error::source(error);
    let cause = cause.map_or(String::new(), |own| format!(": {own}"));
    let said = format!("ERROR on rank {}: {error}{cause}\n", ranks.rank);
    let _ = std::io::stderr().write_all(said.as_bytes());
    ranks.abort(1)
}
