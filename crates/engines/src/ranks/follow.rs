//! The program on each rank: it opens LAMMPS, runs the deck, and is called back where fruit are.

use crate::deck::LOG;
use crate::program::wrong;
use crate::ranks::library::VERSION;
use crate::ranks::part::{End, Head, PartWriter, Record, name_parts, scene_of};
use crate::running::make_room;
use crate::simplify::simplified;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use windfall_files::error::Error;
use windfall_files::on_threads::on_threads;
use windfall_lammps::mpi::Ranks;
use windfall_lammps::run::{Atoms, Lammps, Library};
use windfall_scene::binary::Binary;
use windfall_scene::energy::Energy;
use windfall_scene::share::{Answer, Offer, Seen, Share};
use windfall_scene_run::file::engine_kind::Engine;
use windfall_scene_run::file::read::{ScenePlan, read_scene};
use windfall_scene_run::file_error::access;
use windfall_scene_run::run::workflow::time_step;
use windfall_scene_run::stopped_scene as stopped;

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
    /// Only open the library, and print its version
    #[cfg_attr(feature = "clap", arg(long = "try"))]
    pub try_library: bool,
}

/// The longest that a reader waits for a sign of a rank that finds nothing.
const MARK: Duration = Duration::from_millis(200);
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
    let (frame_steps, [before, after]) =
        split(&deck).ok_or_else(|| failed(format!("{} is no deck of windfall", path.display())))?;
    let mut plan = read_scene(file)?;
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
    let ranks = &lammps.ranks;
    let head = Head {
        rank: ranks.rank,
        ranks: ranks.size,
        engine: lammps.version(),
        frame_steps,
        scene: if ranks.rank == 0 { scene } else { Vec::new() },
    };
    let done = Following::begin(&plan, (ranks, &head), &directory)
        .and_then(|following| run(&lammps, following, (before, after)));
    match done {
        Ok(()) => {}
        Err(error) if ranks.size > 1 => give_up(ranks, &error),
        Err(error) => return Err(error),
    }
    lammps.end();
    Ok(())
}

/// Steps between frames of a deck, and its commands: up to the one that would write these, and
/// from there on.
fn split(deck: &str) -> Option<(u64, [&str; 2])> {
    let from = deck.find(&format!("\n{DUMP}"))? + 1;
    let (before, after) = deck.split_at(from);
    let (line, after) = after.split_once('\n')?;
    let steps = line.strip_prefix(DUMP)?.split(' ').next()?;
    let steps = steps.parse().ok().filter(|own| *own > 0)?;
    Some((steps, [before, after]))
}

fn run(
    lammps: &Lammps,
    mut following: Following,
    (before, after): (&str, &str),
) -> Result<(), Error> {
    let failed = |problem: String| wrong(Engine::Lammps, problem);
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

/// The fruit of a rank, and its part.
struct Following<'a> {
    ranks: &'a Ranks,
    share: Share,
    part: PartWriter,
    directory: PathBuf,
    frame_steps: u64,
    /// The last frame.
    all: u64,
    ended: bool,
    /// When a record was written last.
    marked: Instant,
}

impl<'a> Following<'a> {
    fn begin(
        plan: &ScenePlan,
        (ranks, head): (&'a Ranks, &Head),
        directory: &Path,
    ) -> Result<Self, Error> {
        Ok(Self {
            ranks,
            share: Share::new(plan.scene.clone(), head.frame_steps).map_err(stopped)?,
            part: PartWriter::create(directory, head)?,
            directory: directory.to_path_buf(),
            frame_steps: head.frame_steps,
            all: (plan.end / plan.scene.time_step).ceil() as u64,
            ended: false,
            marked: Instant::now(),
        })
    }

    /// A frame on.
    fn take(&mut self, atoms: &Atoms) -> Result<(), Error> {
        let frame = self.share.frames();
        // A run that begins anew tells its first step again.
        if self.ended || frame > 0 && atoms.step == (frame - 1) * self.frame_steps {
            return Ok(());
        }
        let wanted = frame * self.frame_steps;
        if atoms.step != wanted {
            let problem = format!("it is at step {} where {wanted} is to be", atoms.step);
            return Err(wrong(Engine::Lammps, problem));
        }
        let seen = Seen {
            local: atoms.local,
            numbers: atoms.numbers,
            place: atoms.place,
            velocity: atoms.velocity,
            spin: atoms.spin,
        };
        self.exchange(&seen)?;
        let with_energy = frame == 0 || frame == self.all;
        let energy = self.share.follow(&seen, with_energy).map_err(stopped)?;
        self.record(frame, energy)
    }

    /// Hands over fruit that belong to other ranks now.
    fn exchange(&mut self, seen: &Seen) -> Result<(), Error> {
        let differs = self.share.differs(seen).map_err(stopped)?;
        let all = self.gather(&differs)?;
        if !all.contains(&true) {
            return Ok(());
        }
        let offers: Vec<Offer> = self.gather(&self.share.offer())?;
        let answers: Vec<Answer> = self.gather(&self.share.answer(&offers))?;
        self.share.settle(seen, &offers, &answers).map_err(stopped)
    }

    /// A value of each rank.
    fn gather<T: Binary>(&self, own: &T) -> Result<Vec<T>, Error> {
        let failed = |problem: String| wrong(Engine::Lammps, problem);
        let mut bytes = Vec::new();
        let unread = |error: std::io::Error| failed(format!("ranks do not agree: {error}"));
        own.write(&mut bytes).map_err(unread)?;
        let all = self.ranks.gather(&bytes).map_err(failed)?;
        let read = all.iter().map(|own| T::read(&mut &own[..]));
        read.collect::<Result<_, _>>().map_err(unread)
    }

    fn record(&mut self, frame: u64, energy: Energy) -> Result<(), Error> {
        let (first, last) = (frame == 0, frame == self.all);
        let record = Record {
            frame,
            events: self.share.take_events(),
            left: self.share.take_leavings(),
            energy: (first || last).then_some(energy),
            end: last.then(|| End {
                lasting: self.share.lasting(),
                fruit: self.share.fruit(),
            }),
        };
        let due = self.marked.elapsed() > MARK;
        let found = !record.events.is_empty() || !record.left.is_empty();
        if !(first || last || found || due) {
            return Ok(());
        }
        self.part.write(&record)?;
        if first || last || due {
            self.part.flush()?;
            self.marked = Instant::now();
        }
        self.ended = last;
        Ok(())
    }

    /// Gives the parts their names, when those of all ranks are whole.
    fn finish(self) -> Result<(), Error> {
        if !self.ended {
            let frame = self.share.frames();
            let problem = format!(
                "its deck ends at step {}, before the scene does",
                frame.saturating_sub(1) * self.frame_steps
            );
            return Err(wrong(Engine::Lammps, problem));
        }
        self.part.finish()?;
        let whole = self.ranks.gather(&[1]);
        whole.map_err(|problem| wrong(Engine::Lammps, problem))?;
        if self.ranks.rank > 0 {
            return Ok(());
        }
        name_parts(&self.directory, self.ranks.size)
    }
}
