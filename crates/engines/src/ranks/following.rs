//! The fruit of a rank from frame to frame: their pulses, and checkpoints with all other ranks.

use crate::lammps::deck::restart_name;
use crate::program::wrong;
use crate::ranks::begin::{kept_of, make_way};
use crate::ranks::checkpoint::{Kept, read_states, remove_kept, write_kept, write_state};
use crate::ranks::part::{End, Head, PartWriter, Record, name_parts};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use windfall_files::error::Error;
use windfall_lammps::mpi::Ranks;
use windfall_lammps::run::{Atoms, Lammps};
use windfall_scene::binary::Binary;
use windfall_scene::energy::Energy;
use windfall_scene::share::{Answer, Offer, Seen, Share};
use windfall_scene_run::file::engine_kind::Engine;
use windfall_scene_run::file::read::ScenePlan;
use windfall_scene_run::run::checkpoint::{CheckpointHead, Parts};
use windfall_scene_run::run::stopped::SceneStart;
use windfall_scene_run::stopped_scene as stopped;

/// The longest that a reader waits for a sign of a rank that finds nothing.
const MARK: Duration = Duration::from_millis(200);

/// What a rank follows.
pub(crate) struct Task<'a> {
    pub plan: &'a ScenePlan,
    /// Digests of the scene, and the head of its checkpoints.
    pub scene: Parts,
    pub head: CheckpointHead,
    pub directory: &'a Path,
    pub frame_steps: u64,
}

/// The fruit of a rank, and its part.
pub(crate) struct Following<'a> {
    lammps: &'a Lammps,
    share: Share,
    part: PartWriter,
    directory: PathBuf,
    pub frame_steps: u64,
    /// The last frame.
    all: u64,
    ended: bool,
    /// When a record was written last.
    marked: Instant,
    /// What the deck is told before it begins.
    pub words: String,
    checkpoints: Checkpoints,
}

/// Checkpoints of a rank.
struct Checkpoints {
    /// Frames between them, where there are any.
    every: Option<u64>,
    head: CheckpointHead,
    step: f64,
    /// Bytes of the parts of before.
    before: Vec<u64>,
    /// Bytes of the own part in the checkpoint that LAMMPS has not written yet, and its turn.
    waits: Option<(u64, u64)>,
    /// Whether the last one stays.
    stays: bool,
}

impl<'a> Following<'a> {
    /// Begins anew, or from a checkpoint.
    pub fn begin(
        lammps: &'a Lammps,
        task: Task,
        (start, stays): (SceneStart, bool),
    ) -> Result<Self, Error> {
        let (ranks, directory) = (&lammps.ranks, task.directory);
        let version = lammps.version();
        let kept = kept_of(directory, start, (&task.head.parts, version))?;
        // All have looked before the first removes anything, and write when it has.
        together(ranks)?;
        if ranks.rank == 0 {
            make_way(directory, kept.as_ref())?;
        }
        together(ranks)?;
        let head = Head {
            rank: ranks.rank,
            ranks: ranks.size,
            before: kept.as_ref().map_or(Vec::new(), |own| own.parts.clone()),
            engine: version,
            frame_steps: task.frame_steps,
            scene: match ranks.rank {
                0 => task.scene,
                _ => Vec::new(),
            },
        };
        let plan = task.plan;
        let mut share = Share::new(plan.scene.clone(), head.frame_steps).map_err(stopped)?;
        if let Some(kept) = &kept {
            let states = read_states(directory, kept, (ranks.rank, ranks.size))?;
            share.resume(kept.frames, &states).map_err(stopped)?;
        }
        let every = plan.checkpoint_steps();
        Ok(Self {
            lammps,
            share,
            part: PartWriter::create(directory, &head)?,
            directory: directory.to_path_buf(),
            frame_steps: head.frame_steps,
            all: (plan.end / plan.scene.time_step).ceil() as u64,
            ended: false,
            marked: Instant::now(),
            words: words(every.unwrap_or(0) * head.frame_steps, kept.as_ref()),
            checkpoints: Checkpoints {
                every,
                head: task.head,
                step: plan.scene.time_step,
                before: head.before,
                waits: None,
                stays,
            },
        })
    }

    /// A frame on.
    pub fn take(&mut self, atoms: &Atoms) -> Result<(), Error> {
        let frame = self.share.frames();
        if self.ended {
            return Ok(());
        }
        // A run that begins anew tells its first step again, after LAMMPS's part of a checkpoint.
        if frame > 0 && atoms.step == (frame - 1) * self.frame_steps {
            return self.keep();
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
        self.record(frame, energy)?;
        self.save(frame)
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
        let all = self.lammps.ranks.gather(&bytes).map_err(failed)?;
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

    /// Writes what the rank remembers, where a checkpoint is due; LAMMPS writes its own part at
    /// the end of the step.
    fn save(&mut self, frame: u64) -> Result<(), Error> {
        let own = &mut self.checkpoints;
        let due = |every: u64| frame > 0 && frame < self.all && frame.is_multiple_of(every);
        let Some(every) = own.every.filter(|every| due(*every)) else {
            return Ok(());
        };
        let turn = frame / every % 2;
        own.head.time = frame as f64 * own.step;
        let state = self.share.checkpoint().map_err(stopped)?;
        // What the checkpoint counts on is on the disk before it.
        let length = self.part.sync()?;
        let rank = self.lammps.ranks.rank;
        write_state(&self.directory, (turn, rank), &own.head, &state)?;
        own.waits = Some((length, turn));
        Ok(())
    }

    /// Makes a checkpoint of what all ranks and LAMMPS have written, where one waits.
    fn keep(&mut self) -> Result<(), Error> {
        let Some((length, turn)) = self.checkpoints.waits.take() else {
            return Ok(());
        };
        let lengths: Vec<u64> = self.gather(&length)?;
        let ranks = &self.lammps.ranks;
        if ranks.rank > 0 {
            return Ok(());
        }
        let number = |name| self.lammps.variable(name).map(|own| own as u64);
        let (Some(coming), Some(next)) = (number(c"coming"), number(c"to")) else {
            let problem = "its deck does not say which fruit comes next".to_owned();
            return Err(wrong(Engine::Lammps, problem));
        };
        let kept = Kept {
            engine: self.lammps.version(),
            ranks: ranks.size,
            frames: self.share.frames(),
            turn,
            restart: String::new(),
            parts: [&self.checkpoints.before[..], &lengths].concat(),
            coming,
            next,
        };
        write_kept(&self.directory, &self.checkpoints.head, kept)
    }

    /// Gives the parts their names, when those of all ranks are whole.
    pub fn finish(mut self) -> Result<(), Error> {
        if !self.ended {
            let frame = self.share.frames();
            let problem = format!(
                "its deck ends at step {}, before the scene does",
                frame.saturating_sub(1) * self.frame_steps
            );
            return Err(wrong(Engine::Lammps, problem));
        }
        self.part.sync()?;
        let ranks = &self.lammps.ranks;
        together(ranks)?;
        if ranks.rank > 0 {
            return Ok(());
        }
        name_parts(&self.directory, self.checkpoints.before.len() + ranks.size)?;
        match self.checkpoints.stays {
            true => Ok(()),
            false => remove_kept(&self.directory),
        }
    }
}

/// What a deck is told of checkpoints.
///
/// * `steps`: between them; 0 where there are none
/// * `kept`: where it goes on
fn words(steps: u64, kept: Option<&Kept>) -> String {
    let mut words = format!("variable keep string {steps}\n");
    if let Some(kept) = kept {
        words += &format!(
            "variable from string {}\nvariable first string {}\nvariable next string {}\n",
            restart_name(kept.turn),
            kept.coming,
            kept.next
        );
    }
    words
}

/// Waits for all ranks.
fn together(ranks: &Ranks) -> Result<(), Error> {
    let whole = ranks.gather(&[1]);
    whole
        .map(|_| ())
        .map_err(|problem| wrong(Engine::Lammps, problem))
}
