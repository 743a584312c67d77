//! Frames of a scene, written while it runs.

use crate::file::read::ScenePlan;
use crate::geometry::geometry_of;
use crate::run::frame_format::{
    FRAMES_FILE, Frame, FramesAbout, FruitFrame, MAGIC, VERSION, WallFrame, encode_frame,
};
use crate::run::growing::{GrowingFile, remove_earlier, take_back};
use crate::run::outcome::Tally;
use std::path::{Path, PathBuf};
use windfall_files::error::Error;
use windfall_files::written::check_written;
use windfall_scene::event::Partner;
use windfall_scene::motion::simulation::Simulation;

/// Frames of a run, where the scene asks for them.
pub struct SceneRecorder(Option<FrameFile>);

/// A file of frames that grows with the scene.
struct FrameFile {
    file: GrowingFile,
    interval: f64,
    /// When the scene begins; s.
    start: f64,
    /// Frames so far, and the step of the last one.
    frames: u64,
    last: u64,
    bytes: Vec<u8>,
}

impl SceneRecorder {
    /// A file without frames, where the scene asks for them.
    pub fn create(plan: &ScenePlan, out: &Path) -> Result<Self, Error> {
        let Some(interval) = plan.record.frames else {
            return Ok(Self(None));
        };
        let start = start_of(plan, interval)?;
        let mut own = FrameFile::open(out, (interval, begins(plan)), [0; 3])?;
        own.file.write(start)?;
        Ok(Self(Some(own)))
    }

    /// How far the file is, on the disk: bytes, frames, and the step of the last one.
    pub fn sync(&mut self) -> Result<[u64; 3], Error> {
        match &mut self.0 {
            Some(own) => Ok([own.file.sync()?, own.frames, own.last]),
            None => Ok([0; 3]),
        }
    }

    /// Resumes the file of a run that was stopped.
    ///
    /// * `kept`: what [`SceneRecorder::sync`] said
    ///
    /// # Errors
    /// It is shorter than it was, or cannot be written.
    pub fn resume(plan: &ScenePlan, out: &Path, kept: [u64; 3]) -> Result<Self, Error> {
        let Some(interval) = plan.record.frames else {
            return Ok(Self(None));
        };
        let path = out.join(FRAMES_FILE);
        take_back(&path)?;
        GrowingFile::check_length(&path, "the file of frames", kept[0])?;
        Ok(Self(Some(FrameFile::open(
            out,
            (interval, begins(plan)),
            kept,
        )?)))
    }

    /// Whether what is not finished stays.
    pub fn keep(&mut self, keep: bool) {
        if let Some(own) = &mut self.0 {
            own.file.keep = keep;
        }
    }

    /// Steps until the next frame, but no more than `most`, and one at least.
    pub fn steps(&self, simulation: &Simulation, most: u64) -> u64 {
        let due = self.0.as_ref().map(|own| own.due(simulation));
        let left = due.map_or(most, |due| due.saturating_sub(simulation.steps()));
        left.clamp(1, most.max(1))
    }

    /// Writes a frame if it is due.
    pub fn take(&mut self, simulation: &Simulation, tally: &Tally) -> Result<(), Error> {
        match &mut self.0 {
            Some(own) if simulation.steps() >= own.due(simulation) => own.write(simulation, tally),
            _ => Ok(()),
        }
    }

    /// Writes a frame of the end, and gives the file its name; which it is.
    pub fn whole(
        &mut self,
        simulation: &Simulation,
        tally: &Tally,
    ) -> Result<Option<PathBuf>, Error> {
        let Some(own) = &mut self.0 else {
            return Ok(None);
        };
        if own.frames == 0 || own.last + 1 < simulation.steps() {
            own.write(simulation, tally)?;
        }
        own.file.finish().map(Some)
    }
}

/// Removes the frames of an earlier run where this one has none.
///
/// # Errors
/// They are not windfall's, or cannot be removed.
pub fn remove_frames(out: &Path) -> Result<(), Error> {
    let path = out.join(FRAMES_FILE);
    check_written(&path, None)?;
    remove_earlier(&path)
}

impl FrameFile {
    /// A file of which some is there; what is behind is cut off.
    fn open(
        out: &Path,
        (interval, start): (f64, f64),
        [length, frames, last]: [u64; 3],
    ) -> Result<Self, Error> {
        let mut file = GrowingFile::open(&out.join(FRAMES_FILE))?;
        file.cut(length)?;
        Ok(Self {
            file,
            interval,
            start,
            frames,
            last,
            bytes: Vec::new(),
        })
    }

    /// The step of the next frame.
    fn due(&self, simulation: &Simulation) -> u64 {
        let time = self.start + self.frames as f64 * self.interval;
        // A step that falls on the time but for rounding is the one.
        (time / simulation.scene.time_step - 1e-6).ceil() as u64
    }

    fn write(&mut self, simulation: &Simulation, tally: &Tally) -> Result<(), Error> {
        self.bytes.clear();
        encode_frame(&frame_of(simulation, tally), &mut self.bytes);
        self.file.write(&self.bytes)?;
        // Whoever watches the run sees whole frames.
        self.file.flush()?;
        self.frames += 1;
        self.last = simulation.steps();
        Ok(())
    }
}

/// When a scene begins; s.
fn begins(plan: &ScenePlan) -> f64 {
    plan.start.as_ref().map_or(0.0, |own| own.time)
}

/// What stands before the frames.
fn start_of(plan: &ScenePlan, interval: f64) -> Result<Vec<u8>, Error> {
    let (walls, bounds) = geometry_of(&plan.scene);
    let about = FramesAbout {
        title: plan.title.clone(),
        end: plan.end,
        interval,
        fruit: plan.scene.fruit.len(),
        walls: walls.iter().map(|wall| wall.about.clone()).collect(),
        bounds,
        periods: plan
            .scene
            .periodic
            .map(|own| own.map_or(0.0, |[low, high]| high - low)),
    };
    let mut json = serde_json::to_vec(&about).map_err(|error| Error::ResultUnwritable {
        item: plan.title.clone(),
        detail: error.to_string(),
    })?;
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut bytes = Vec::from(MAGIC);
    bytes.extend(VERSION.to_le_bytes());
    bytes.extend((json.len() as u32).to_le_bytes());
    bytes.extend(json);
    for fruit in &plan.scene.fruit {
        bytes.extend((fruit.mean_radius() as f32).to_le_bytes());
    }
    for wall in &walls {
        for number in wall.vertices.as_flattened() {
            bytes.extend(number.to_le_bytes());
        }
        for vertex in &wall.faces {
            bytes.extend(vertex.to_le_bytes());
        }
    }
    Ok(bytes)
}

fn frame_of(simulation: &Simulation, tally: &Tally) -> Frame {
    let time = simulation.time();
    let hardest = |own: &crate::run::outcome::FruitTally| {
        own.hardest
            .as_ref()
            .map_or(0.0, |event| event.peak_force as f32)
    };
    let mut peaks: Vec<f32> = tally.fruit.iter().map(hardest).collect();
    // Ongoing contacts count by their peak so far.
    for event in simulation.lasting() {
        let mut reach = |fruit: u32| {
            if let Some(own) = peaks.get_mut(fruit as usize) {
                *own = own.max(event.peak_force as f32);
            }
        };
        reach(event.fruit);
        if let Partner::Fruit(other) = event.partner {
            reach(other);
        }
    }
    let walls = simulation.scene.walls.iter().map(|wall| {
        let (turn, shift) = wall.motion.pose(time);
        WallFrame {
            turn: turn.map(|own| own as f32),
            shift: shift.map(|own| own as f32),
        }
    });
    let fruit = simulation.fruit().into_iter().map(|own| FruitFrame {
        fruit: own.fruit + 1,
        place: own.place.map(|x| x as f32),
        turn: own.turn.map(|x| x as f32),
        velocity: own.velocity.map(|x| x as f32),
        peak_force: peaks.get(own.fruit as usize).copied().unwrap_or(0.0),
    });
    Frame {
        time,
        walls: walls.collect(),
        fruit: fruit.collect(),
    }
}
