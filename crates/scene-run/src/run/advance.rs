//! A scene from its beginning or a checkpoint to its end.

use crate::bruise::scene::Blows;
use crate::file::read::ScenePlan;
use crate::run::checkpoint::{
    CheckpointHead, Parts, changed_parts, checkpoint_path, damaged, parts_of, read_checkpoint,
    remove_checkpoint, write_checkpoint,
};
use crate::run::frames::SceneRecorder;
use crate::run::outcome::Tally;
use crate::run::sensors::watch::Sensors;
use crate::run::start::{begin_at, end_path};
use crate::run::stopped::{Keeper, SceneStart, goes_on};
use crate::run::tables::EventFile;
use crate::run_error::{SceneRunError, stopped_scene};
use std::io::{Read, Result as IoResult};
use std::path::{Path, PathBuf};
use windfall_files::error::Error;
use windfall_files::progress::Progress;
use windfall_files::write_file::check_target;
use windfall_scene::binary::Binary;
use windfall_scene::energy::Energy;
use windfall_scene::event::Event;
use windfall_scene::motion::simulation::Simulation;
use windfall_scene::state::State;

/// What moves the fruit of a scene.
pub trait Mover: Send {
    /// One step on, or one frame; with the energies at its beginning.
    fn step(&mut self, simulation: &mut Simulation) -> Result<Energy, Error>;

    /// So many steps or frames on.
    fn run(&mut self, simulation: &mut Simulation, steps: u64) -> Result<(), Error> {
        (0..steps).try_for_each(|_| self.step(simulation).map(|_| ()))
    }

    /// Contacts that are still there at the end, as if they ended then.
    fn lasting(&mut self, simulation: &Simulation) -> Vec<Event> {
        simulation.lasting()
    }

    /// Its own time steps in one.
    fn steps(&self) -> u64;

    /// Whether the run makes checkpoints of what it moves.
    fn goes_on(&self) -> bool;

    /// Time up to which it has made checkpoints of its own; s.
    fn kept(&self) -> Option<f64> {
        None
    }

    /// All results are written: what it has kept is not needed any more.
    fn finish(&mut self) {}
}

/// The engine of this program.
pub(crate) struct Own;

impl Mover for Own {
    fn step(&mut self, simulation: &mut Simulation) -> Result<Energy, Error> {
        simulation.step_with_energy().map_err(stopped_scene)
    }

    fn run(&mut self, simulation: &mut Simulation, steps: u64) -> Result<(), Error> {
        simulation.run(steps).map_err(stopped_scene)
    }

    fn steps(&self) -> u64 {
        1
    }

    fn goes_on(&self) -> bool {
        true
    }
}

/// Steps between looks at events and progress.
const CHUNK: u64 = 64;

/// A scene that runs, and what is kept of it.
pub struct SceneRun {
    /// The scene now.
    pub simulation: Simulation,
    /// Every contact.
    pub table: EventFile,
    /// Recorded frames.
    pub frames: SceneRecorder,
    /// What looks at the fruit.
    pub sensors: Sensors,
    /// What happened.
    pub tally: Tally,
    /// Contacts that may bruise.
    pub blows: Option<Blows>,
    /// Steps that the scene had made when it began.
    pub before: u64,
    /// What the energy account lacked at the first step; J.
    pub first_closure: f64,
    checkpoint: PathBuf,
    parts: Parts,
    /// Steps in all, and those between two checkpoints.
    all: u64,
    every: Option<u64>,
    end: f64,
    /// Time of the last checkpoint; s.
    kept: Option<f64>,
}

impl SceneRun {
    /// Begins or resumes a run.
    ///
    /// * `plan`: with its time step, and with fruit in the order in which they come
    ///
    /// # Errors
    /// There is a run that could go on, or none that is to; the scene cannot begin; the
    /// directory cannot be written.
    pub(crate) fn begin(
        plan: &ScenePlan,
        directory: &Path,
        start: SceneStart,
        mover: &mut dyn Mover,
    ) -> Result<Self, Error> {
        let checkpoint = checkpoint_path(directory);
        let events = directory.join("events.csv");
        let keeper = match mover.goes_on() {
            true => Keeper::Run,
            false => Keeper::Engine,
        };
        let resumes = goes_on(directory, start, keeper)?;
        let parts = parts_of(plan);
        if resumes && mover.goes_on() {
            return Self::resumed(plan, (checkpoint, &events), directory, parts);
        }
        let (simulation, left) = match &plan.start {
            Some(start) => begin_at(plan, start)?,
            None => {
                let new = Simulation::new(plan.scene.clone()).map_err(stopped_scene)?;
                (new, Vec::new())
            }
        };
        remove_checkpoint(&checkpoint)?;
        if mover.goes_on() {
            remove_checkpoint(&Keeper::Engine.path(directory))?;
        }
        check_target(&end_path(directory))?;
        let table = EventFile::create(&events, &plan.scene, plan.least_peak_force)?;
        let frames = SceneRecorder::create(plan, directory)?;
        let sensors = Sensors::open(plan, directory, None)?;
        let files = (table, frames, sensors);
        let mut own = Self::new(plan, simulation, files, (checkpoint, parts));
        left.iter().for_each(|gone| own.tally.leave(gone));
        own.look().map_err(|error| own.told(error))?;
        if !mover.goes_on() {
            own.every = None;
        }
        let first = mover.step(&mut own.simulation)?;
        own.first_closure = first.closure();
        let seen = own.sensors.take(&own.simulation);
        seen.map_err(|error| own.told(error))?;
        Ok(own)
    }

    fn new(
        plan: &ScenePlan,
        simulation: Simulation,
        (table, frames, sensors): (EventFile, SceneRecorder, Sensors),
        (checkpoint, parts): (PathBuf, Parts),
    ) -> Self {
        let step = plan.scene.time_step;
        let begun = plan.start.as_ref().map_or(0.0, |own| own.time);
        let bruise = plan.bruise.as_ref();
        Self {
            simulation,
            table,
            frames,
            sensors,
            tally: Tally::new(plan),
            blows: bruise.map(|own| {
                let is_probe = |fruit| plan.sensors.is_probe(fruit);
                Blows::new(own, &plan.scene, &plan.fruit_shares, is_probe)
            }),
            before: (begun / step).round() as u64,
            first_closure: 0.0,
            checkpoint,
            parts,
            all: (plan.end / step).ceil() as u64,
            every: plan.checkpoint_steps(),
            end: plan.end,
            kept: None,
        }
    }

    fn resumed(
        plan: &ScenePlan,
        (checkpoint, events): (PathBuf, &Path),
        directory: &Path,
        parts: Parts,
    ) -> Result<Self, Error> {
        let path = checkpoint.clone();
        read_checkpoint(&path, |head, from| {
            let changed = changed_parts(&head.parts, &parts);
            if !changed.is_empty() {
                let path = path.clone();
                return Err(Error::from(SceneRunError::Changed { path, changed }));
            }
            let unread =
                |error: std::io::Error| damaged(&path, format!("the checkpoint is {error}"));
            let (length, written) = Binary::read(from).map_err(unread)?;
            let frames = Binary::read(from).map_err(unread)?;
            let sensors = Binary::read(from).map_err(unread)?;
            let closure = f64::read(from).map_err(unread)?;
            let state = State::read(from).map_err(unread)?;
            let simulation = Simulation::resume(plan.scene.clone(), &state)
                .map_err(|error| damaged(&path, error.to_string()))?;
            drop(state);
            let least = plan.least_peak_force;
            let table = EventFile::resume(events, &plan.scene, least, (length, written))?;
            let frames = SceneRecorder::resume(plan, directory, frames)?;
            let sensors = Sensors::open(plan, directory, Some(sensors))?;
            let files = (table, frames, sensors);
            let mut own = Self::new(plan, simulation, files, (checkpoint, parts));
            own.take_counts(from).map_err(unread)?;
            (own.first_closure, own.kept) = (closure, Some(head.time));
            Ok(own)
        })
    }

    fn take_counts(&mut self, from: &mut dyn Read) -> IoResult<()> {
        self.tally.take_up(from)?;
        self.sensors.take_up(from)?;
        self.blows.iter_mut().try_for_each(|own| own.take_up(from))
    }

    /// Steps up to the end; contacts that last are not counted.
    ///
    /// # Errors
    /// The result would mean nothing from there on; it was cancelled; a file cannot be
    /// written. What was done up to the last checkpoint is kept in the latter two.
    pub(crate) fn run_to_end(
        &mut self,
        mover: &mut dyn Mover,
        progress: Progress,
    ) -> Result<(), Error> {
        // By one of those who work, who need not be woken for every step.
        let done = rayon::scope(|_| self.steps_to_end(mover, progress));
        if let Err(error) = &done
            && let Some(SceneRunError::Failed(_)) = error.of_room()
        {
            // It would be stopped there again.
            self.leave_nothing();
        }
        self.kept = self.kept.or_else(|| mover.kept());
        if self.kept.is_some() {
            self.table.keep(true);
        }
        done.map_err(|error| self.told(error))
    }

    fn steps_to_end(&mut self, mover: &mut dyn Mover, progress: Progress) -> Result<(), Error> {
        while self.simulation.steps() < self.all {
            let steps = self.simulation.steps();
            let to_checkpoint = self.every.map_or(u64::MAX, |every| every - steps % every);
            let most = CHUNK.min(self.all - steps).min(to_checkpoint);
            let steps = self.frames.steps(&self.simulation, most);
            let steps = self.sensors.steps(&self.simulation, steps);
            if let Err(error) = mover.run(&mut self.simulation, steps) {
                // An engine may be interrupted by the same key.
                let steps = self.simulation.steps();
                return match progress(steps as usize, self.all as usize).is_break() {
                    true => Err(self.interrupted(mover)),
                    false => Err(error),
                };
            }
            for event in self.simulation.take_events() {
                self.count(&event)?;
            }
            for leaving in self.simulation.take_leavings() {
                self.tally.leave(&leaving);
                self.sensors.leave(&leaving)?;
            }
            self.look()?;
            let steps = self.simulation.steps();
            if self.every.is_some_and(|every| steps.is_multiple_of(every)) && steps < self.all {
                self.save()?;
            }
            if progress(steps as usize, self.all as usize).is_break() {
                return Err(self.interrupted(mover));
            }
        }
        Ok(())
    }

    /// Writes a frame, and what sensors see, where they are due.
    fn look(&mut self) -> Result<(), Error> {
        self.frames.take(&self.simulation, &self.tally)?;
        self.sensors.take(&self.simulation)
    }

    /// Counts a load. One that does not come and go does not bruise as a blow does.
    pub fn count(&mut self, event: &Event) -> Result<(), Error> {
        let scene = &self.simulation.scene;
        let lasted = self.tally.count(scene, event);
        self.sensors.load(event);
        if let Some(blows) = self.blows.as_mut().filter(|_| !lasted) {
            blows.count(scene, event);
        }
        self.table.write(event, lasted)
    }

    fn save(&mut self) -> Result<(), Error> {
        let time = self.simulation.time();
        let state = self.simulation.checkpoint();
        // What the checkpoint counts on is on the disk before it.
        let table = (self.table.sync()?, self.table.written());
        let frames = self.frames.sync()?;
        let sensors = self.sensors.sync()?;
        let head = CheckpointHead {
            time,
            end: self.end,
            parts: std::mem::take(&mut self.parts),
        };
        let saved = write_checkpoint(&self.checkpoint, &head, |to| {
            table.write(to)?;
            frames.write(to)?;
            sensors.write(to)?;
            self.first_closure.write(to)?;
            state.write(to)?;
            self.tally.save(to)?;
            self.sensors.save(to)?;
            self.blows.iter().try_for_each(|own| own.save(to))
        });
        self.parts = head.parts;
        saved?;
        self.table.keep(true);
        self.frames.keep(true);
        self.sensors.keep(true);
        self.kept = Some(time);
        Ok(())
    }

    fn interrupted(&self, mover: &dyn Mover) -> Error {
        let (now, end) = (self.simulation.time(), self.end);
        match self.kept.or_else(|| mover.kept()) {
            Some(kept) => Error::from(SceneRunError::Stopped { now, end, kept }),
            None => Error::Cancelled,
        }
    }

    /// What went wrong, with what is kept.
    pub fn told(&self, error: Error) -> Error {
        match error {
            Error::FileAccess { path, source, .. } => Error::from(SceneRunError::Unwritable {
                path,
                source,
                kept: self.kept,
            }),
            other => other,
        }
    }

    /// Whether states of it are kept.
    pub(crate) fn keeps_states(&self) -> bool {
        self.every.is_some()
    }

    /// Ends the run: renames the table and removes the checkpoint.
    pub fn finish(self) -> Result<(), Error> {
        self.table.finish()?;
        // One that is left without its table is taken for what it is: of a run that is over.
        let _ = remove_checkpoint(&self.checkpoint);
        Ok(())
    }

    fn leave_nothing(&mut self) {
        self.table.keep(false);
        self.frames.keep(false);
        self.sensors.keep(false);
        let _ = remove_checkpoint(&self.checkpoint);
        self.kept = None;
    }
}
