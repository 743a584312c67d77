//! Frames of a scene, written while it runs.

use crate::file::read::ScenePlan;
use crate::geometry::geometry_of;
use crate::run::checkpoint::damaged;
use crate::run::frame_format::{
    FRAMES_FILE, Frame, FramesAbout, FruitFrame, MAGIC, VERSION, WallFrame, encode_frame,
};
use crate::run::outcome::Tally;
use std::fs::File;
use std::io::{BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use windfall_files::error::Error;
use windfall_scene::event::Partner;
use windfall_scene::motion::simulation::Simulation;

/// Frames as they are asked for; nothing where they are not.
pub struct SceneRecorder(Option<FrameFile>);

/// A file of frames that grows with the scene; it has its name when it is whole.
struct FrameFile {
    path: PathBuf,
    partial: PathBuf,
    file: BufWriter<File>,
    interval: f64,
    /// Frames so far, and the step of the last one.
    frames: u64,
    last: u64,
    bytes: Vec<u8>,
    /// Bytes so far.
    length: u64,
    /// Whether what is not finished stays: a checkpoint goes on from it.
    keep: bool,
}

impl SceneRecorder {
    /// A file without frames, where the scene asks for them.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn create(plan: &ScenePlan, out: &Path) -> Result<Self, Error> {
        let Some(interval) = plan.record.frames else {
            return Ok(Self(None));
        };
        let start = start_of(plan, interval)?;
        let mut own = FrameFile::open(out, interval, [0; 3])?;
        let written = own.file.write_all(&start);
        written.map_err(|source| access(&own.path, source))?;
        own.length = start.len() as u64;
        Ok(Self(Some(own)))
    }

    /// How far the file is, on the disk: bytes, frames, and the step of the last one.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn sync(&mut self) -> Result<[u64; 3], Error> {
        let Some(own) = &mut self.0 else {
            return Ok([0; 3]);
        };
        let done = own
            .file
            .flush()
            .and_then(|()| own.file.get_ref().sync_all());
        done.map_err(|source| access(&own.path, source))?;
        Ok([own.length, own.frames, own.last])
    }

    /// A file that goes on from where it was.
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
        let partial = partial_of(&path);
        // A run that was stopped on its last steps had given the file its name already.
        if !partial.exists() && path.is_file() {
            let renamed = std::fs::rename(&path, &partial);
            renamed.map_err(|source| access(&path, source))?;
        }
        let there = std::fs::metadata(&partial).map_or(0, |own| own.len());
        if there < kept[0] {
            let problem = format!(
                "the file of frames has {there} bytes, and the checkpoint goes on behind {} of \
                 them",
                kept[0]
            );
            return Err(damaged(&partial, problem));
        }
        Ok(Self(Some(FrameFile::open(out, interval, kept)?)))
    }

    /// Whether what is not finished stays.
    pub fn keep(&mut self, keep: bool) {
        if let Some(own) = &mut self.0 {
            own.keep = keep;
        }
    }

    /// Steps until the next frame, but no more than `most`, and one at least.
    #[must_use]
    pub fn steps(&self, simulation: &Simulation, most: u64) -> u64 {
        let due = self.0.as_ref().map(|own| own.due(simulation));
        let left = due.map_or(most, |due| due.saturating_sub(simulation.steps()));
        left.clamp(1, most.max(1))
    }

    /// Writes a frame if it is due.
    ///
    /// # Errors
    /// It cannot be written, such as where the disk is full.
    pub fn take(&mut self, simulation: &Simulation, tally: &Tally) -> Result<(), Error> {
        match &mut self.0 {
            Some(own) if simulation.steps() >= own.due(simulation) => own.write(simulation, tally),
            _ => Ok(()),
        }
    }

    /// Writes a frame of the end, and gives the file its name; which it is.
    ///
    /// # Errors
    /// It cannot be written.
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
        let done = own
            .file
            .flush()
            .and_then(|()| own.file.get_ref().sync_all());
        done.and_then(|()| std::fs::rename(&own.partial, &own.path))
            .map_err(|source| access(&own.path, source))?;
        Ok(Some(own.path.clone()))
    }
}

/// Where the frames stand until they are whole.
fn partial_of(path: &Path) -> PathBuf {
    path.with_extension("bin.partial")
}

impl FrameFile {
    /// A file of which some is there; what is behind is cut off.
    fn open(out: &Path, interval: f64, [length, frames, last]: [u64; 3]) -> Result<Self, Error> {
        let path = out.join(FRAMES_FILE);
        let partial = partial_of(&path);
        let failed = |source| access(&path, source);
        let mut file = File::options()
            .create(true)
            .truncate(false)
            .write(true)
            .open(&partial)
            .map_err(failed)?;
        file.set_len(length).map_err(failed)?;
        file.seek(SeekFrom::End(0)).map_err(failed)?;
        Ok(Self {
            path,
            partial,
            file: BufWriter::new(file),
            interval,
            frames,
            last,
            bytes: Vec::new(),
            length,
            keep: length > 0,
        })
    }

    /// The step of the next frame.
    fn due(&self, simulation: &Simulation) -> u64 {
        let time = self.frames as f64 * self.interval;
        // A step that falls on the time but for rounding is the one.
        (time / simulation.scene().time_step - 1e-6).ceil() as u64
    }

    fn write(&mut self, simulation: &Simulation, tally: &Tally) -> Result<(), Error> {
        self.bytes.clear();
        encode_frame(&frame_of(simulation, tally), &mut self.bytes);
        let written = self.file.write_all(&self.bytes);
        // Whoever watches the run sees whole frames.
        written
            .and_then(|()| self.file.flush())
            .map_err(|source| access(&self.path, source))?;
        self.length += self.bytes.len() as u64;
        self.frames += 1;
        self.last = simulation.steps();
        Ok(())
    }
}

/// What was not finished leaves nothing behind.
impl Drop for FrameFile {
    fn drop(&mut self) {
        if !self.keep {
            let _ = std::fs::remove_file(&self.partial);
        }
    }
}

fn access(path: &Path, source: std::io::Error) -> Error {
    Error::FileAccess {
        path: path.to_path_buf(),
        action: "write",
        source,
    }
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
    // Contacts that go on count by what they reached so far.
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
    let walls = simulation.scene().walls.iter().map(|wall| {
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
