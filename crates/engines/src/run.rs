//! A scene on another engine: its deck, its run and its results.

use crate::deck::{Deck, Task};
use crate::lammps::deck::lammps_deck;
use crate::liggghts::deck::liggghts_deck;
use crate::motion::Frames;
use crate::program::{Program, find_program, wrong};
use crate::ranks::checkpoint::{Kept, check_states, parts_with_deck, read_kept};
use crate::ranks::library::{find_library, unusable};
use crate::ranks::merge::{Pulses, start_ranks};
use crate::ranks::part::{part_name, scene_of};
use crate::simplify::{check_open, simplified};
use serde::Serialize;
use std::path::{Path, PathBuf};
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::inputs::protect;
use windfall_files::on_threads::on_threads;
use windfall_files::option_value::unusable as unusable_option;
use windfall_files::progress::Progress;
use windfall_files::write_file::write_whole;
use windfall_scene_run::file::engine_kind::Engine;
use windfall_scene_run::file::read::{ScenePlan, read_scene};
use windfall_scene_run::file_error::make_directory;
use windfall_scene_run::run::advance::Mover;
use windfall_scene_run::run::checkpoint::{ENGINE_FOLDER, Parts};
use windfall_scene_run::run::outcome::{SceneOutcome, StepOutcome};
use windfall_scene_run::run::stopped::{Keeper, SceneStart, goes_on};
use windfall_scene_run::run::workflow::{
    Moved, SceneRequest, directory_of, run_moved, run_scene, time_step,
};

/// Another engine, and how it runs.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct EngineRequest {
    /// The engine that moves the fruit
    #[cfg_attr(feature = "clap", arg(long, value_enum, default_value_t))]
    pub engine: Engine,
    /// For LAMMPS and LIGGGHTS: ranks of MPI
    #[cfg_attr(feature = "clap", arg(long, value_name = "N", default_value_t = 1))]
    pub ranks: usize,
    /// For LAMMPS and LIGGGHTS: the program, if it is not on the path as lmp or liggghts
    #[cfg_attr(feature = "clap", arg(long, value_name = "FILE", value_hint = clap::ValueHint::FilePath))]
    pub engine_program: Option<PathBuf>,
    /// For LAMMPS: its library, if it is neither beside the program nor where the system looks
    #[cfg_attr(feature = "clap", arg(long, value_name = "FILE", value_hint = clap::ValueHint::FilePath, conflicts_with_all = ["frames", "pulses"]))]
    pub engine_library: Option<PathBuf>,
    /// For LAMMPS: read where all fruit are every few steps, and find contacts outside of its ranks
    #[cfg_attr(feature = "clap", arg(long, conflicts_with_all = ["frames", "pulses", "engine_library"]))]
    pub engine_frames: bool,
    /// For LAMMPS: pulses that the ranks of an earlier run found, by the directory of its deck, instead
    /// of a new run
    #[cfg_attr(feature = "clap", arg(long, value_name = "DIR", value_hint = clap::ValueHint::DirPath, conflicts_with = "frames"))]
    pub pulses: Option<PathBuf>,
    /// windfall itself, which each rank of LAMMPS starts; without it contacts are found outside of
    /// the ranks.
    #[cfg_attr(feature = "clap", arg(skip))]
    pub windfall: Option<PathBuf>,
    /// For LAMMPS and LIGGGHTS: frames that an earlier run of the scene's deck wrote, instead of a new
    /// run
    #[cfg_attr(feature = "clap", arg(long, value_name = "FILE", value_hint = clap::ValueHint::FilePath))]
    pub frames: Option<PathBuf>,
    /// Its deck.
    #[cfg_attr(feature = "clap", command(flatten))]
    pub deck: DeckRequest,
}

/// Options of a deck.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct DeckRequest {
    /// For LAMMPS and LIGGGHTS: classes of size of one material at most, each with coefficients of
    /// its own
    #[cfg_attr(feature = "clap", arg(long, value_name = "N", default_value_t = crate::classes::MOST))]
    pub classes: usize,
    /// For LAMMPS and LIGGGHTS: steps between frames, of which contacts are made; a contact lasts 40
    /// frames of LAMMPS or 80 of LIGGGHTS at least if left out
    #[cfg_attr(feature = "clap", arg(long, value_name = "N"))]
    pub frame_steps: Option<u64>,
}

/// A deck that was written.
#[derive(Clone, Debug, Serialize, utoipa::ToSchema)]
pub struct DeckOutcome {
    /// Engine.
    pub engine: String,
    /// Files, the first of which the engine is given.
    #[schema(value_type = Vec<String>)]
    pub files: Vec<PathBuf>,
    /// Steps.
    pub steps: u64,
    /// Time step; s.
    pub time_step: f64,
    /// Steps between frames.
    pub frame_steps: u64,
    /// What the engine does otherwise.
    pub findings: Vec<FindingOutcome>,
}

/// Frames in the shortest contact that is expected, at least; of LAMMPS, whose ranks are followed
/// while they run, as many as cost less than its own steps do.
const FRAMES_IN_CONTACT: f64 = 80.0;
const FRAMES_OF_RANKS: f64 = 40.0;
/// Lack of the energy account that is worth a word; 1.
const LARGE_CLOSURE: f64 = 0.02;

/// A scene made ready for an engine.
struct Ready {
    plan: ScenePlan,
    /// Digests of the scene as it was read.
    scene: Parts,
    step: StepOutcome,
    deck: Deck,
    frame_steps: u64,
}

fn ready(path: &Path, engine: Engine, request: &DeckRequest) -> Result<Ready, Error> {
    let mut plan = read_scene(path)?;
    let step = time_step(&mut plan)?;
    if let Some(start) = &plan.start {
        let problem = format!(
            "it cannot begin at the end of another run ([scene] start = \"{}\"); --engine windfall can",
            start.name
        );
        return Err(wrong(engine, problem));
    }
    check_open(&plan, engine)?;
    if plan.scene.fruit.iter().any(|fruit| fruit.clump.is_some()) {
        let problem = "it cannot represent this scene (--engine windfall can): its ovate fruit touch \
                       a partner once, where the deepest of their spheres does, and the engine's \
                       clumps with every sphere";
        return Err(wrong(engine, problem.to_owned()));
    }
    let scene = scene_of(&plan);
    let findings = simplified(&mut plan, engine);
    let frames = match engine {
        Engine::Lammps => FRAMES_OF_RANKS,
        _ => FRAMES_IN_CONTACT,
    };
    let every = step.contact_duration / (frames * step.time_step);
    let frame_steps = request.frame_steps.unwrap_or((every as u64).max(1)).max(1);
    let frames = (plan.end / (frame_steps as f64 * step.time_step)).ceil() as u64;
    let task = Task::new(
        &plan.scene,
        &plan.title,
        request.classes,
        frames * frame_steps,
        frame_steps,
        step.speed,
    );
    let deck = match engine {
        Engine::Windfall => Err(vec!["it is this program and needs no deck".to_owned()]),
        Engine::Lammps => lammps_deck(&task),
        Engine::Liggghts => liggghts_deck(&task),
    };
    let mut deck = deck.map_err(|reasons| {
        let list = reasons.join("\n  - ");
        wrong(
            engine,
            format!("it cannot represent this scene (--engine windfall can):\n  - {list}"),
        )
    })?;
    deck.findings.splice(..0, findings);
    Ok(Ready {
        plan,
        scene,
        step,
        deck,
        frame_steps,
    })
}

fn write_deck(deck: &Deck, directory: &Path) -> Result<Vec<PathBuf>, Error> {
    make_directory(directory)?;
    let mut files = Vec::new();
    for (name, text) in &deck.files {
        let path = directory.join(name);
        write_whole(&path, text.as_bytes())?;
        files.push(path);
    }
    Ok(files)
}

/// Writes the deck of a scene.
///
/// * `out`: directory to write into; beside the file where it is left out
///
/// # Errors
/// The scene cannot be used, or not on this engine; the directory cannot be written.
pub fn export_deck(
    path: &Path,
    engine: Engine,
    request: &DeckRequest,
    out: Option<&Path>,
) -> Result<DeckOutcome, Error> {
    let ready = ready(path, engine, request)?;
    let beside = path.with_extension(engine.name());
    let files = write_deck(&ready.deck, out.unwrap_or(&beside))?;
    Ok(DeckOutcome {
        engine: engine.title().to_owned(),
        files,
        steps: ready.deck.steps,
        time_step: ready.step.time_step,
        frame_steps: ready.frame_steps,
        findings: ready.deck.findings,
    })
}

/// Runs a scene on an engine. Of another one the frames are followed, and the contacts and
/// the fruit written as [`run_scene`] does.
///
/// # Errors
/// The engine is absent, cannot represent the scene, or fails; and those of [`run_scene`].
pub fn run_on_engine(
    path: &Path,
    request: &SceneRequest,
    own: &EngineRequest,
    progress: Progress,
) -> Result<SceneOutcome, Error> {
    check_options(own)?;
    if own.engine == Engine::Windfall {
        return run_scene(path, request, progress);
    }
    if !request.set.is_empty() {
        let problem =
            "an engine is given the file as it is; change it there, or use --engine windfall";
        return Err(unusable_option("--set", problem));
    }
    let mut ready = ready(path, own.engine, &own.deck)?;
    let out = directory_of(path, request);
    let outside = own.frames.is_some() || own.pulses.is_some() || own.engine_frames;
    if request.start == SceneStart::Resume && (own.engine != Engine::Lammps || outside) {
        return Err(wrong(own.engine, UNRESUMED.to_owned()));
    }
    let resumes = goes_on(&out, request.start, Keeper::Engine)?;
    let steps = ready.frame_steps;
    let steps_time = steps as f64 * ready.plan.scene.time_step;
    if let Some(probe) = ready.plan.sensors.probe() {
        let problem = format!(
            "its frames say where fruit are, not what they feel: the probe \"{}\" of [[sensors]] needs \
             --engine windfall; planes, plates and boxes work here too",
            probe.name
        );
        return Err(wrong(own.engine, problem));
    }
    ready.plan.sensors.check_step(steps_time)?;
    // Between two frames is one step of who follows.
    ready.plan.scene.time_step = steps_time;
    let (mut mover, engine) = mover_of((path, resumes), own, &mut ready, &out)?;
    let moved = Moved {
        mover: &mut *mover,
        step: ready.step,
        engine,
        findings: ready.deck.findings,
        large_closure: Some(LARGE_CLOSURE),
    };
    let plan = &ready.plan;
    on_threads(request.threads, || {
        // What was stopped there is dealt with, and the engine goes on with it or without.
        Ok(run_moved(plan, moved, &out, SceneStart::Restart, progress)?.outcome)
    })
}

/// Why a run does not go on from a checkpoint.
const UNRESUMED: &str = "a run on it cannot go on from a checkpoint: begin anew with --restart";

/// Refuses options of another engine: a run without them would not be the one that was asked for.
fn check_options(own: &EngineRequest) -> Result<(), Error> {
    let of_both = [
        ("--ranks", own.ranks > 1),
        ("--engine-program", own.engine_program.is_some()),
        ("--frames", own.frames.is_some()),
        ("--frame-steps", own.deck.frame_steps.is_some()),
    ];
    let of_lammps = [
        ("--engine-library", own.engine_library.is_some()),
        ("--engine-frames", own.engine_frames),
        ("--pulses", own.pulses.is_some()),
    ];
    let refused = |options: &[(&'static str, bool)], engines: &str| {
        let first = options.iter().find(|(_, given)| *given);
        first.map_or(Ok(()), |(option, _)| {
            let problem = format!("it is not for {}: use {engines}", own.engine.title());
            Err(unusable_option(*option, problem))
        })
    };
    match own.engine {
        Engine::Lammps => Ok(()),
        Engine::Liggghts => refused(&of_lammps, "--engine lammps"),
        Engine::Windfall => refused(&of_both, "--engine lammps or --engine liggghts")
            .and_then(|()| refused(&of_lammps, "--engine lammps")),
    }
}

/// What moves the fruit, and its name with its version.
///
/// * `ready`: with the time between frames as its time step
/// * `resumes`: whether it goes on from a checkpoint
/// * `out`: where the results go
fn mover_of(
    (path, resumes): (&Path, bool),
    own: &EngineRequest,
    ready: &mut Ready,
    out: &Path,
) -> Result<(Box<dyn Mover>, String), Error> {
    let (fruit, steps) = (ready.plan.scene.fruit.len(), ready.frame_steps);
    let title = own.engine.title();
    if let Some(file) = &own.frames {
        if !file.is_file() {
            let advice = "--frames takes the frames that the deck of `windfall scene export` \
                          has written";
            return Err(Error::absent(file, advice));
        }
        protect(file);
        let frames = Frames::of_file(own.engine, file, fruit, steps);
        let name = format!("{title} ({})", file.display());
        return Ok((Box::new(frames), name));
    }
    if let Some(pulses) = &own.pulses {
        return pulses_of(own, ready, pulses);
    }
    let program = find_program(own.engine, own.engine_program.as_deref())?;
    let launch = program.launch(own.ranks.max(1))?;
    let directory = out.join(ENGINE_FOLDER);
    let ranks = match own.ranks {
        0 | 1 => String::new(),
        ranks => format!(", {ranks} ranks"),
    };
    let name = format!("{title} {}{ranks}", program.version);
    if let Some(library) = inside(&program, (own, resumes), ready)? {
        let windfall = own.windfall.clone().unwrap_or_default();
        let kept = match resumes {
            true => Some(kept_of(&directory, &program, ready)?),
            false => None,
        };
        write_deck(&ready.deck, &directory)?;
        let task = (path, windfall.as_path(), library.as_path());
        let running = start_ranks((&program, &launch), task, (&directory, kept.as_ref()))?;
        let scene = std::mem::take(&mut ready.scene);
        let before = kept.map_or(Vec::new(), |own| own.parts);
        let counts = (Some((own.ranks.max(1), before)), steps);
        let pulses = Pulses::new((&directory, Some(running)), &ready.plan, scene, counts)?;
        return Ok((Box::new(pulses), name));
    }
    write_deck(&ready.deck, &directory)?;
    let deck = (directory.as_path(), ready.deck.files[0].0.as_str());
    let frames = Frames::of_run((&program, &launch), deck, (fruit, steps))?;
    Ok((Box::new(frames), name))
}

/// The checkpoint from which a run goes on.
fn kept_of(directory: &Path, program: &Program, ready: &Ready) -> Result<Kept, Error> {
    let parts = parts_with_deck(&ready.scene, &ready.deck.files[0].1);
    let kept = read_kept(directory, &parts, program.date())?;
    check_states(directory, &kept)?;
    Ok(kept)
}

/// Pulses that the ranks of an earlier run found.
fn pulses_of(
    own: &EngineRequest,
    ready: &mut Ready,
    directory: &Path,
) -> Result<(Box<dyn Mover>, String), Error> {
    if let Some(key) = outside(&ready.plan) {
        let problem = format!(
            "pulses say nothing of where fruit are on their way: {key} needs the frames of the deck, with --frames"
        );
        return Err(wrong(own.engine, problem));
    }
    if !directory.join(part_name(0)).is_file() {
        let advice = "--pulses takes the directory of a deck in which `windfall scene rank` has run to its end";
        return Err(Error::absent(directory.join(part_name(0)), advice));
    }
    let scene = std::mem::take(&mut ready.scene);
    let counts = (None, ready.frame_steps);
    let pulses = Pulses::new((directory, None), &ready.plan, scene, counts)?;
    let name = format!(
        "{} {}, {} ranks ({})",
        own.engine.title(),
        pulses.engine(),
        pulses.count(),
        directory.display()
    );
    Ok((Box::new(pulses), name))
}

/// The key of a scene that asks where fruit are on their way, which only frames tell.
fn outside(plan: &ScenePlan) -> Option<&'static str> {
    match (plan.record.frames, plan.sensors.all.is_empty()) {
        (Some(_), _) => Some("[record]"),
        (_, false) => Some("[[sensors]]"),
        _ => None,
    }
}

/// The library with which contacts are found inside of the ranks of LAMMPS; none where that cannot be,
/// with a finding that says why. A run that goes on from a checkpoint cannot do without.
fn inside(
    program: &Program,
    (own, resumes): (&EngineRequest, bool),
    ready: &mut Ready,
) -> Result<Option<PathBuf>, Error> {
    let (Engine::Lammps, false, Some(windfall)) = (own.engine, own.engine_frames, &own.windfall)
    else {
        return Ok(None);
    };
    let given = own.engine_library.as_deref();
    let found = match outside(&ready.plan) {
        Some(key) => Err(format!("{key} asks where fruit are on their way")),
        None => find_library(program, windfall, given),
    };
    match found {
        Ok(library) => Ok(Some(library)),
        Err(problem) if given.is_some() || resumes => Err(unusable(program, &problem)),
        Err(problem) => {
            let message = format!(
                "contacts were found outside of LAMMPS's ranks, which takes longer: {problem}"
            );
            let finding = FindingOutcome::new("engine-outside", message);
            ready.deck.findings.push(finding);
            Ok(None)
        }
    }
}
