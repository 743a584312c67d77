//! Pulses of all ranks put together: as if one had found them.

use crate::deck::LOG;
use crate::program::{Launch, Program, wrong};
use crate::ranks::begin::make_way;
use crate::ranks::checkpoint::{Kept, present_part, remove_kept};
use crate::ranks::part::{End, PartReader, Record, part_name, partial_name, remove_parts};
use crate::running::{Running, SCREEN, make_room};
use std::path::{Path, PathBuf};
use std::time::Duration;
use windfall_files::error::Error;
use windfall_files::inputs::protect;
use windfall_scene::energy::Energy;
use windfall_scene::event::Event;
use windfall_scene::motion::simulation::Simulation;
use windfall_scene_run::file::engine_kind::Engine;
use windfall_scene_run::file::read::ScenePlan;
use windfall_scene_run::run::advance::Mover;
use windfall_scene_run::run::checkpoint::{Parts, changed_parts, checkpoint_head, checkpoint_path};

/// Time between looks whether a rank has found more.
const LOOK: Duration = Duration::from_millis(20);

/// Starts windfall on every rank: it opens the library of LAMMPS, and runs the deck of a directory.
///
/// * `task`: the scene, windfall itself, and the library
/// * `kept`: where they go on
///
/// # Errors
/// It does not start; somebody else's files are in the directory.
pub(crate) fn start_ranks(
    (program, launch): (&Program, &Launch),
    (scene, windfall, library): (&Path, &Path, &Path),
    (directory, kept): (&Path, Option<&Kept>),
) -> Result<Running, Error> {
    make_room(directory, &[SCREEN, LOG])?;
    make_way(directory, kept)?;
    let absolute = |path: &Path| {
        let path = std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf());
        path.display().to_string()
    };
    let mut words = launch.command.clone();
    words.pop();
    words.push(absolute(windfall));
    words.extend(["scene", "rank"].map(str::to_owned));
    words.extend([absolute(scene), "--deck".to_owned(), absolute(directory)]);
    words.extend(["--library".to_owned(), library.display().to_string()]);
    let start = match kept {
        Some(_) => "--resume",
        None => "--restart",
    };
    words.extend(["--keep", start].map(str::to_owned));
    let command = program.started(&words, directory);
    Running::start(program, (command, &launch.name), directory)
}

/// Pulses that ranks find, while they run or from an earlier run.
pub(crate) struct Pulses {
    directory: PathBuf,
    running: Option<Running>,
    ranks: Vec<Rank>,
    scene: Parts,
    frame_steps: u64,
    /// The next frame, and the last.
    next: u64,
    all: u64,
    lasting: Vec<Event>,
    /// Whether the results are written.
    finished: bool,
}

/// A rank's part, and the record that comes next.
struct Rank {
    part: PartReader,
    waits: Option<Record>,
    /// Whether it ends where the run went on from a checkpoint.
    earlier: bool,
}

/// Frame of a part that has no more.
const NEVER: u64 = u64::MAX;

impl Pulses {
    /// Pulses of ranks that have just been started in a directory, or of an earlier run.
    ///
    /// * `plan`: with the time between frames as its time step
    /// * `ranks`: how many were started, and the bytes that count of each part of before; read from
    ///   the parts if left out
    /// * `frame_steps`: steps between frames
    pub fn new(
        (directory, running): (&Path, Option<Running>),
        plan: &ScenePlan,
        scene: Parts,
        (ranks, frame_steps): (Option<(usize, Vec<u64>)>, u64),
    ) -> Result<Self, Error> {
        let mut own = Self {
            directory: directory.to_path_buf(),
            running,
            ranks: Vec::new(),
            scene,
            frame_steps,
            next: 0,
            all: (plan.end / plan.scene.time_step).ceil() as u64,
            lasting: Vec::new(),
            finished: false,
        };
        let (ranks, before) = match ranks {
            Some(known) => known,
            None => own.last_run()?,
        };
        for number in 0..before.len() + ranks {
            let length = before.get(number).copied();
            let part = own.open(number, length)?;
            own.ranks.push(Rank {
                part,
                waits: None,
                earlier: length.is_some(),
            });
        }
        own.check(before.len(), ranks)?;
        Ok(own)
    }

    /// How many ranks ran to the end, and the bytes that count of each part of before.
    fn last_run(&mut self) -> Result<(usize, Vec<u64>), Error> {
        let mut last = self.open(0, None)?.head;
        loop {
            let next = last.before.len() + last.ranks;
            if !self.directory.join(part_name(next)).is_file() {
                return Ok((last.ranks, last.before));
            }
            let head = self.open(next, None)?.head;
            if head.before.len() != next || head.rank > 0 {
                return Ok((last.ranks, last.before));
            }
            last = head;
        }
    }

    /// Version of the engine that wrote the parts.
    pub fn engine(&self) -> u32 {
        self.ranks.first().map_or(0, |own| own.part.head.engine)
    }

    /// How many ranks ran to the end.
    pub fn count(&self) -> usize {
        self.ranks.iter().filter(|own| !own.earlier).count()
    }

    /// A part, under the name that it has while ranks run, or afterwards.
    fn path(&self, number: usize) -> PathBuf {
        match self.running {
            Some(_) if number < self.ranks.len() && self.ranks[number].earlier => {
                present_part(&self.directory, number)
            }
            Some(_) => self.directory.join(partial_name(number)),
            None => self.directory.join(part_name(number)),
        }
    }

    /// The part of a rank, which may not have begun it yet.
    ///
    /// * `length`: bytes of it that count, where it is one of before
    fn open(&mut self, rank: usize, length: Option<u64>) -> Result<PartReader, Error> {
        let path = match (&self.running, length) {
            (Some(_), Some(_)) => present_part(&self.directory, rank),
            _ => self.path(rank),
        };
        if self.running.is_none() {
            protect(&path);
        }
        loop {
            let over = self.running.as_mut().is_none_or(Running::is_over);
            let part = PartReader::open(&path, length);
            match part.map_err(|problem| self.wrong(rank, &problem))? {
                Some(part) => return Ok(part),
                None if over => return Err(self.ended(rank)),
                None => std::thread::sleep(LOOK),
            }
        }
    }

    /// Whether the parts are of this scene and of one run.
    fn check(&self, before: usize, ranks: usize) -> Result<(), Error> {
        for (number, own) in self.ranks.iter().enumerate() {
            let head = &own.part.head;
            let other = !own.earlier && (head.ranks != ranks || head.before.len() != before);
            let problem = if head.number() != number || other {
                format!(
                    "it is of rank {} of {}, where one of rank {} of {ranks} is to be",
                    head.rank,
                    head.ranks,
                    number.saturating_sub(before)
                )
            } else if head.frame_steps != self.frame_steps {
                format!(
                    "it was found every {} steps, where {} are to be: say --frame-steps {0} as then",
                    head.frame_steps, self.frame_steps
                )
            } else if head.rank == 0 && head.scene != self.scene {
                let changed = changed_parts(&head.scene, &self.scene);
                format!("it is of another scene: {} changed", changed.join(", "))
            } else {
                continue;
            };
            return Err(self.wrong(number, &problem));
        }
        Ok(())
    }

    fn wrong(&self, rank: usize, problem: &str) -> Error {
        let path = self.path(rank);
        wrong(Engine::Lammps, format!("{}: {problem}", path.display()))
    }

    /// The ranks failed.
    fn failed(&mut self, problem: &str, step: u64) -> Option<Error> {
        let error = self.running.as_mut()?.failed(problem, step);
        let (Some(kept), Error::Engine { engine, problem }) = (self.kept(), &error) else {
            return Some(error);
        };
        Some(Error::Engine {
            engine,
            problem: format!(
                "{problem}. What was done up to {kept:.6} s is kept: the same command with --resume \
                 goes on from there"
            ),
        })
    }

    /// A rank has stopped before its end.
    fn ended(&mut self, rank: usize) -> Error {
        let step = self.next * self.frame_steps;
        let failed = self.failed(&format!("rank {rank} found no more"), step);
        failed.unwrap_or_else(|| {
            self.wrong(
                rank,
                "it is not there, or not whole: every rank of the run must have ended, and all parts \
                 must lie in one directory",
            )
        })
    }

    /// The next record of a rank; waits for it.
    fn fill(&mut self, rank: usize) -> Result<u64, Error> {
        loop {
            if let Some(own) = &self.ranks[rank].waits {
                return Ok(own.frame);
            }
            // First whether it is over, then whether it left something.
            let over = self.running.as_mut().is_none_or(Running::is_over);
            let record = self.ranks[rank].part.next_record();
            match record.map_err(|problem| self.wrong(rank, &problem))? {
                Some(record) => self.ranks[rank].waits = Some(record),
                None if self.ranks[rank].earlier => return Ok(NEVER),
                None if over => return Err(self.ended(rank)),
                None => std::thread::sleep(LOOK),
            }
        }
    }
}

impl Mover for Pulses {
    fn step(&mut self, simulation: &mut Simulation) -> Result<Energy, Error> {
        let mut energy = Energy::default();
        let (mut events, mut left) = (Vec::new(), Vec::new());
        let mut ends = Vec::new();
        for rank in 0..self.ranks.len() {
            // Several records of one frame may be there.
            while self.fill(rank)? <= self.next {
                let Some(record) = self.ranks[rank].waits.take() else {
                    break;
                };
                events.extend(record.events);
                left.extend(record.left);
                energy = record.energy.map_or(energy, |own| energy.plus(&own));
                if let Some(end) = record.end {
                    ends.push(end);
                    break;
                }
            }
        }
        let key = |own: &Event| (own.fruit, own.partner, own.number);
        events.sort_by_key(key);
        left.sort_by_key(|own| own.fruit);
        simulation.take_told(events, left);
        if self.next == self.all {
            self.stand(simulation, ends)?;
        }
        self.next += 1;
        Ok(energy)
    }

    fn lasting(&mut self, _: &Simulation) -> Vec<Event> {
        std::mem::take(&mut self.lasting)
    }

    fn goes_on(&self) -> bool {
        false
    }

    fn steps(&self) -> u64 {
        self.frame_steps
    }

    fn kept(&self) -> Option<f64> {
        let head = checkpoint_head(&checkpoint_path(&self.directory));
        self.running.is_some().then_some(head?.time)
    }

    fn finish(&mut self) {
        self.finished = true;
    }
}

impl Pulses {
    /// The end of all ranks.
    fn stand(&mut self, simulation: &mut Simulation, ends: Vec<End>) -> Result<(), Error> {
        if ends.len() < self.count() {
            let problem = "it has no end where the scene has: it is of another deck";
            return Err(self.wrong(self.ranks.len() - self.count() + ends.len(), problem));
        }
        let mut fruit = Vec::new();
        for end in ends {
            self.lasting.extend(end.lasting);
            fruit.extend(end.fruit);
        }
        fruit.sort_by_key(|own| own.fruit);
        self.lasting
            .sort_by_key(|own| (own.fruit, own.partner, own.number));
        simulation.stand(&fruit);
        let Some(running) = &mut self.running else {
            return Ok(());
        };
        while !running.is_over() {
            std::thread::sleep(LOOK);
        }
        match running.is_done() {
            true => Ok(()),
            false => {
                let failed = self.failed("it failed at its end", self.all * self.frame_steps);
                failed.map_or(Ok(()), Err)
            }
        }
    }
}

impl Drop for Pulses {
    /// Parts of a run of its own are not needed any more, unless it can go on from a checkpoint.
    fn drop(&mut self) {
        let kept = self.kept().is_some() && !self.finished;
        if self.running.take().is_none() || kept {
            return;
        }
        let _ = remove_kept(&self.directory);
        let _ = remove_parts(&self.directory, 0);
    }
}
