//! frames.bin, frame by frame.

use crate::file_error::{SceneFileError, access};
use crate::geometry::WallGeometry;
use crate::run::frame_format::{
    FRAME_HEADER, FRAMES_FILE, Frame, FramesAbout, MAGIC, VERSION, decode_frame,
    decode_frame_header, floats, frame_size,
};
use std::fs::File;
use std::io::{BufReader, ErrorKind, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use windfall_files::error::Error;
use windfall_files::inputs::{check_regular, protect};

/// Longest JSON that is read; bytes.
const MOST_ABOUT: u64 = 1 << 26;

/// Position of a frame in its file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameEntry {
    /// First byte.
    pub at: u64,
    /// Bytes.
    pub size: u64,
    /// When; s.
    pub time: f64,
    /// Fruit in the scene.
    pub fruit: u32,
}

/// An open file of frames.
pub struct SceneFrames {
    path: PathBuf,
    file: BufReader<File>,
    /// What it is about.
    pub about: FramesAbout,
    /// Radius of each fruit; m.
    pub radii: Vec<f32>,
    /// Walls at rest.
    pub walls: Vec<WallGeometry>,
    /// Whole frames; one that is still being written is left out.
    pub frames: Vec<FrameEntry>,
}

/// The file of frames of a run: the whole one, or the one that is being written.
pub fn frames_file(directory: &Path) -> Result<PathBuf, Error> {
    let whole = directory.join(FRAMES_FILE);
    if whole.is_file() {
        return Ok(whole);
    }
    let entries = std::fs::read_dir(directory).into_iter().flatten().flatten();
    let growing = entries.map(|entry| entry.path()).filter(|path| {
        let name = path.file_name().and_then(|name| name.to_str());
        name.is_some_and(|name| name.starts_with(FRAMES_FILE) && name.ends_with(".partial"))
    });
    growing.max().ok_or_else(|| frames_absent(directory))
}

/// That a run has no frames, and why.
pub(crate) fn frames_absent(directory: &Path) -> Error {
    let problem = match directory.join(SUMMARY).exists() {
        true => {
            "no frames were recorded; add to the scene: [record] frames = \"20 ms\", and run it again"
        }
        false => {
            "no run of this scene came to its end, so there are no frames; mend what stopped it, and \
             run it again"
        }
    };
    Error::from(SceneFileError::FramesAbsent {
        path: directory.to_path_buf(),
        problem,
    })
}

/// Results of a run, which are written at its end.
const SUMMARY: &str = "scene.json";

impl SceneFrames {
    /// Opens a file of frames, also while it grows.
    ///
    /// # Errors
    /// It cannot be read, is no file of frames, or is damaged.
    pub fn open(path: &Path) -> Result<Self, Error> {
        check_regular(path)?;
        protect(path);
        let file = File::open(path).map_err(access(path, "read"))?;
        let length = file.metadata().map_err(access(path, "read"))?.len();
        let mut start = Start {
            path,
            file: BufReader::new(file),
            at: 0,
            length,
        };
        let magic: [u8; 8] = start.array()?;
        if magic != MAGIC {
            return Err(damaged(path, 0, "this is no file of frames"));
        }
        let version = u32::from_le_bytes(start.array()?);
        if version != VERSION {
            let path = path.to_path_buf();
            return Err(Error::from(SceneFileError::FramesNewer {
                path,
                found: version,
                known: VERSION,
            }));
        }
        let size = u64::from(u32::from_le_bytes(start.array()?));
        if size > MOST_ABOUT {
            return Err(damaged(path, 12, "its description cannot be so long"));
        }
        let json = start.bytes(size)?;
        let about: FramesAbout = serde_json::from_slice(&json)
            .map_err(|_| damaged(path, 16, "its description cannot be read"))?;
        let radii = start.floats(about.fruit as u64)?;
        let mut walls = Vec::new();
        for own in &about.walls {
            let vertices: Vec<[f32; 3]> = start
                .floats(3 * own.vertices as u64)?
                .chunks_exact(3)
                .map(|own| [own[0], own[1], own[2]])
                .collect();
            let at = start.at;
            let words = (own.corners as u64).saturating_mul(own.faces as u64);
            let faces = start.bytes(words.saturating_mul(4))?;
            let faces: Vec<u32> = faces
                .chunks_exact(4)
                .map(|own| u32::from_le_bytes([own[0], own[1], own[2], own[3]]))
                .collect();
            let known = faces.iter().all(|own| (*own as usize) < vertices.len());
            if !known || !(3..=4).contains(&own.corners) {
                return Err(damaged(path, at, "a wall has a face without its vertices"));
            }
            walls.push(WallGeometry {
                about: own.clone(),
                vertices,
                faces,
            });
        }
        let (file, at) = (start.file, start.at);
        let mut frames = Self {
            path: path.to_path_buf(),
            file,
            about,
            radii,
            walls,
            frames: Vec::new(),
        };
        frames.list(at, length)?;
        Ok(frames)
    }

    /// Lists the frames that lie whole between two places of the file.
    fn list(&mut self, mut at: u64, length: u64) -> Result<(), Error> {
        while at + FRAME_HEADER as u64 <= length {
            let mut header = [0; FRAME_HEADER];
            self.read_at(at, &mut header)?;
            let found = decode_frame_header(header);
            let found = found.filter(|(fruit, _)| *fruit as usize <= self.radii.len());
            let Some((fruit, time)) = found else {
                return Err(damaged(&self.path, at, "here should begin a frame"));
            };
            let size = frame_size(self.walls.len(), fruit as usize);
            if at + size > length {
                break;
            }
            self.frames.push(FrameEntry {
                at,
                size,
                time,
                fruit,
            });
            at += size;
        }
        Ok(())
    }

    fn read_at(&mut self, at: u64, bytes: &mut [u8]) -> Result<(), Error> {
        self.file
            .seek(SeekFrom::Start(at))
            .and_then(|_| self.file.read_exact(bytes))
            .map_err(access(&self.path, "read"))
    }

    /// A frame by its number, from 0.
    ///
    /// # Errors
    /// It cannot be read, or there is none of that number.
    pub fn frame(&mut self, number: usize) -> Result<Frame, Error> {
        let bytes = self.bytes(number, 1)?;
        let at = self.frames.get(number).map_or(0, |entry| entry.at);
        let frame = decode_frame(&bytes, self.walls.len());
        let known = frame.filter(|frame| {
            let mut fruit = frame.fruit.iter();
            fruit.all(|own| (1..=self.radii.len()).contains(&(own.fruit as usize)))
        });
        known.ok_or_else(|| damaged(&self.path, at, "a frame is of other fruit than the file"))
    }

    /// The bytes of frames from a number on: the first of them, and as many more as `most`
    /// bytes hold.
    pub fn bytes(&mut self, from: usize, most: u64) -> Result<Vec<u8>, Error> {
        let Some(first) = self.frames.get(from).copied() else {
            return Ok(Vec::new());
        };
        let ends = self.frames[from..].iter().map(|own| own.at + own.size);
        let end = ends
            .take_while(|end| end - first.at <= most)
            .last()
            .unwrap_or(first.at + first.size);
        let mut bytes = vec![0; (end - first.at) as usize];
        self.read_at(first.at, &mut bytes)?;
        Ok(bytes)
    }

    /// The number of the frame that is nearest to a time; `None` where there is no frame.
    pub fn nearest(&self, time: f64) -> Option<usize> {
        let away = |own: &FrameEntry| (own.time - time).abs();
        let numbers = 0..self.frames.len();
        numbers.min_by(|a, b| away(&self.frames[*a]).total_cmp(&away(&self.frames[*b])))
    }

    /// Where the file lies.
    pub fn path(&self) -> &Path {
        &self.path
    }
}

/// What stands before the frames, as it is read.
struct Start<'a> {
    path: &'a Path,
    file: BufReader<File>,
    at: u64,
    length: u64,
}

impl Start<'_> {
    fn array<const N: usize>(&mut self) -> Result<[u8; N], Error> {
        let bytes = self.bytes(N as u64)?;
        Ok(std::array::from_fn(|k| bytes[k]))
    }

    fn floats(&mut self, count: u64) -> Result<Vec<f32>, Error> {
        let bytes = self.bytes(count.saturating_mul(4))?;
        let numbers = bytes.chunks_exact(4).map(|own| floats::<1>(own, 0)[0]);
        Ok(numbers.collect())
    }

    fn bytes(&mut self, count: u64) -> Result<Vec<u8>, Error> {
        let ends = || {
            damaged(
                self.path,
                self.length,
                "the file ends before its first frame",
            )
        };
        // Room is made only for what can be there.
        if count > self.length - self.at {
            return Err(ends());
        }
        let mut bytes = vec![0; count as usize];
        let read = self.file.read_exact(&mut bytes);
        read.map_err(|source| match source.kind() {
            ErrorKind::UnexpectedEof => ends(),
            _ => access(self.path, "read")(source),
        })?;
        self.at += count;
        Ok(bytes)
    }
}

fn damaged(path: &Path, byte: u64, problem: &'static str) -> Error {
    let path = path.to_path_buf();
    Error::from(SceneFileError::FramesDamaged {
        path,
        byte,
        problem,
    })
}
