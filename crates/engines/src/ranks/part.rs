//! What a rank found, as a file: it grows with the loads that ended, not with the steps.
//!
//! The file begins with `MAGIC`, the version of its shape, that of windfall and a [`Head`];
//! each record follows behind its length in bytes.

use std::fs::File;
use std::io::{BufWriter, ErrorKind, Read, Result as IoResult, Seek, Write};
use std::path::{Path, PathBuf};
use windfall_files::error::Error;
use windfall_files::provenance::VERSION;
use windfall_files::write_file::check_target;
use windfall_files::written::{check_plain, list_written_as};
use windfall_scene::binary;
use windfall_scene::binary::{Binary, no_value};
use windfall_scene::energy::Energy;
use windfall_scene::event::Event;
use windfall_scene::motion::simulation::{FruitState, Leaving};
use windfall_scene_run::file::read::ScenePlan;
use windfall_scene_run::file_error::access;
use windfall_scene_run::run::checkpoint::{Parts, parts_of};

/// How a part begins.
const MAGIC: [u8; 8] = *b"WFPULSE\n";
/// Version of its shape.
const SHAPE: u32 = 2;
/// Bytes that are read at a time.
const BLOCK: usize = 1 << 18;

/// Whose part it is.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Head {
    /// Its number among the ranks that run together, and how many these are.
    pub rank: usize,
    pub ranks: usize,
    /// Bytes that count of each part that was written before the run went on from a checkpoint.
    pub before: Vec<u64>,
    /// Version of LAMMPS as year, month and day.
    pub engine: u32,
    /// Steps between frames.
    pub frame_steps: u64,
    /// Digests of the scene; of the first rank alone.
    pub scene: Parts,
}

/// What a rank found in a frame. Frames without one found nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Record {
    pub frame: u64,
    /// Loads that ended.
    pub events: Vec<Event>,
    pub left: Vec<Leaving>,
    /// In the first frame and in the last.
    pub energy: Option<Energy>,
    /// In the last frame.
    pub end: Option<End>,
}

/// What is there at the end.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct End {
    /// Loads that last.
    pub lasting: Vec<Event>,
    /// The rank's own fruit.
    pub fruit: Vec<FruitState>,
}

impl Head {
    /// Number of its part.
    pub fn number(&self) -> usize {
        self.before.len() + self.rank
    }
}

binary!(Head {
    rank,
    ranks,
    before,
    engine,
    frame_steps,
    scene
});
binary!(Record {
    frame,
    events,
    left,
    energy,
    end
});
binary!(End { lasting, fruit });

/// What pulses depend on. A scene without a title is named after its file, which may have moved.
pub(crate) fn scene_of(plan: &ScenePlan) -> Parts {
    let mut parts = parts_of(plan);
    parts.retain(|(name, _)| name != "the title");
    parts
}

/// Name of a part. A run that goes on from a checkpoint has more parts, behind those of before.
pub(crate) fn part_name(rank: usize) -> String {
    format!("pulses.{rank}.bin")
}

/// Where a part grows until all are whole.
pub(crate) fn partial_name(rank: usize) -> String {
    format!("{}.partial", part_name(rank))
}

/// Removes the parts of an earlier run. What has such a name and is no file is left to who writes
/// there.
///
/// * `from`: the first that is removed
///
/// # Errors
/// A file of that name is of somebody else, or cannot be removed.
pub(crate) fn remove_parts(directory: &Path, from: usize) -> Result<(), Error> {
    for entry in std::fs::read_dir(directory).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let rank = name.to_str().and_then(|own| {
            let own = own.strip_prefix("pulses.")?;
            let own = own.strip_suffix(".partial").unwrap_or(own);
            own.strip_suffix(".bin")?.parse().ok()
        });
        let path = entry.path();
        let Some(rank) = rank.filter(|own| *own >= from && check_plain(&path).is_ok()) else {
            continue;
        };
        check_target(&directory.join(part_name(rank)))?;
        check_partial(&directory.join(partial_name(rank)))?;
        std::fs::remove_file(&path).map_err(access(&path, "replace"))?;
    }
    Ok(())
}

/// Refuses to replace a file of somebody else that has the name of a part that is not whole.
fn check_partial(path: &Path) -> Result<(), Error> {
    let mut start = Vec::new();
    let mut file = match File::open(path) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(()),
        file => file
            .map_err(access(path, "read"))?
            .take(2 * MAGIC.len() as u64),
    };
    file.read_to_end(&mut start).map_err(access(path, "read"))?;
    // Behind the length of the first record.
    match start.is_empty() || start.ends_with(&MAGIC) {
        true => Ok(()),
        false => Err(Error::AlreadyThere {
            path: path.to_path_buf(),
        }),
    }
}

/// Gives all parts their names.
///
/// # Errors
/// They cannot be renamed.
pub(crate) fn name_parts(directory: &Path, count: usize) -> Result<(), Error> {
    for number in 0..count {
        let [part, partial] = [part_name(number), partial_name(number)];
        let [part, partial] = [part, partial].map(|name| directory.join(name));
        if part.exists() && !partial.exists() {
            // Of a run that was stopped in its last moment.
            continue;
        }
        list_written_as(&part, &partial)?;
        std::fs::rename(&partial, &part).map_err(access(&part, "write"))?;
    }
    Ok(())
}

/// A part that grows.
pub(crate) struct PartWriter {
    path: PathBuf,
    to: BufWriter<File>,
}

impl PartWriter {
    /// A part without records.
    pub fn create(directory: &Path, head: &Head) -> Result<Self, Error> {
        let path = directory.join(partial_name(head.number()));
        check_target(&directory.join(part_name(head.number())))?;
        check_plain(&path)?;
        check_partial(&path)?;
        let file = File::create(&path).map_err(access(&path, "write"))?;
        let mut own = Self {
            path,
            to: BufWriter::new(file),
        };
        let mut bytes = Vec::new();
        let written = begin(head, &mut bytes);
        own.failed(written)?;
        own.put(&bytes)?;
        own.flush()?;
        Ok(own)
    }

    fn failed(&self, done: IoResult<()>) -> Result<(), Error> {
        done.map_err(access(&self.path, "write"))
    }

    fn put(&mut self, bytes: &[u8]) -> Result<(), Error> {
        let done = (bytes.len() as u64)
            .write(&mut self.to)
            .and_then(|()| self.to.write_all(bytes));
        self.failed(done)
    }

    /// Adds a record.
    pub fn write(&mut self, record: &Record) -> Result<(), Error> {
        let mut bytes = Vec::new();
        let done = record.write(&mut bytes);
        self.failed(done)?;
        self.put(&bytes)
    }

    /// Lets readers see all so far.
    pub fn flush(&mut self) -> Result<(), Error> {
        let done = self.to.flush();
        self.failed(done)
    }

    /// Brings all so far to the disk; its length in bytes.
    pub fn sync(&mut self) -> Result<u64, Error> {
        self.flush()?;
        let file = self.to.get_mut();
        let length = file.sync_all().and_then(|()| file.stream_position());
        length.map_err(access(&self.path, "write"))
    }
}

fn begin(head: &Head, to: &mut dyn Write) -> IoResult<()> {
    MAGIC.write(to)?;
    SHAPE.write(to)?;
    VERSION.to_owned().write(to)?;
    head.write(to)
}

/// A part that is read, while it grows or later.
pub(crate) struct PartReader {
    file: File,
    /// Bytes that were read, and how many of them are used.
    bytes: Vec<u8>,
    used: usize,
    /// Bytes of the file that count and were not read yet.
    left: u64,
    /// Whose part it is.
    pub head: Head,
}

impl PartReader {
    /// Opens a part; none where it is not begun yet.
    ///
    /// * `length`: bytes of it that count; all if left out
    ///
    /// # Errors
    /// It is none, or one of another windfall.
    pub fn open(path: &Path, length: Option<u64>) -> Result<Option<Self>, String> {
        let Ok(file) = File::open(path) else {
            return Ok(None);
        };
        let mut own = Self {
            file,
            bytes: Vec::new(),
            used: 0,
            left: length.unwrap_or(u64::MAX),
            head: Head::default(),
        };
        let Some(range) = own.next_range()? else {
            return Ok(None);
        };
        own.head = head_of(&mut &own.bytes[range])?;
        Ok(Some(own))
    }

    /// The next record; none where there is none yet.
    ///
    /// # Errors
    /// What does not look like a record.
    pub fn next_record(&mut self) -> Result<Option<Record>, String> {
        let Some(range) = self.next_range()? else {
            return Ok(None);
        };
        let mut from = &self.bytes[range];
        let record = Record::read(&mut from).map_err(|error| format!("it is damaged: {error}"))?;
        match from.is_empty() {
            true => Ok(Some(record)),
            false => Err("it is damaged: a record is longer than it says".to_owned()),
        }
    }

    /// Where the next record stands among the bytes that were read.
    fn next_range(&mut self) -> Result<Option<std::ops::Range<usize>>, String> {
        loop {
            let left = &self.bytes[self.used..];
            let mut wanted = 8;
            if let Some((length, _)) = left.split_first_chunk::<8>() {
                let length = u64::from_le_bytes(*length);
                let all = usize::try_from(length)
                    .ok()
                    .and_then(|own| own.checked_add(8));
                let room = self.file.metadata().map_or(u64::MAX, |own| own.len());
                wanted = all.ok_or("it is damaged: a record has no length")?;
                if left.len() >= wanted {
                    let start = self.used + 8;
                    self.used += wanted;
                    return Ok(Some(start..self.used));
                }
                // A damaged length asks for no memory.
                if length > room {
                    return Ok(None);
                }
            }
            self.bytes.drain(..self.used);
            self.used = 0;
            let before = self.bytes.len();
            let most = ((wanted - before).max(BLOCK) as u64).min(self.left);
            let read = (&self.file).take(most).read_to_end(&mut self.bytes);
            match read {
                Ok(0) => return Ok(None),
                Ok(read) => self.left -= read as u64,
                Err(error) => return Err(format!("cannot read: {error}")),
            }
        }
    }
}

fn head_of(from: &mut &[u8]) -> Result<Head, String> {
    let unread = |error: std::io::Error| format!("it holds no pulses of a rank ({error})");
    let mut begin = || -> IoResult<(u32, String)> {
        if <[u8; 8]>::read(from)? != MAGIC {
            return Err(no_value("pulses"));
        }
        Ok((u32::read(from)?, String::read(from)?))
    };
    let (shape, version) = begin().map_err(unread)?;
    if shape != SHAPE || version != VERSION {
        return Err(format!(
            "it was written by windfall {version}, and this is {VERSION}: the ranks and who puts \
             their pulses together must be of one version"
        ));
    }
    Head::read(from).map_err(unread)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_full_disk_is_told_with_the_name_of_the_part() {
        let file = File::options().write(true).open("/dev/full").unwrap();
        let mut writer = PartWriter {
            path: PathBuf::from("deck/pulses.3.bin.partial"),
            to: BufWriter::new(file),
        };
        writer.write(&Record::default()).unwrap();
        let problem = writer.flush().unwrap_err();
        let cause = std::error::Error::source(&problem).unwrap().to_string();
        assert!(problem.to_string().contains("pulses.3.bin"), "{problem}");
        assert!(cause.contains("No space left"), "{cause}");
    }

    #[test]
    fn a_part_is_read_while_it_grows_and_damage_is_told() {
        let name = format!("windfall-part-{}", std::process::id());
        let folder = std::env::temp_dir().join(name);
        std::fs::create_dir(&folder).unwrap();
        let head = Head {
            rank: 1,
            ranks: 2,
            before: Vec::new(),
            engine: 20_220_106,
            frame_steps: 3,
            scene: vec![("fruit".to_owned(), "ab".to_owned())],
        };
        let path = folder.join(partial_name(1));
        assert!(PartReader::open(&path, None).unwrap().is_none());
        let mut writer = PartWriter::create(&folder, &head).unwrap();
        let mut reader = PartReader::open(&path, None).unwrap().unwrap();
        assert_eq!(reader.head, head);
        assert_eq!(reader.next_record().unwrap(), None);
        let record = |frame: u64| Record {
            frame,
            left: vec![
                Leaving {
                    fruit: 4,
                    time: 0.5,
                    sink: 0
                };
                frame as usize
            ],
            ..Record::default()
        };
        for frame in 1..4 {
            writer.write(&record(frame)).unwrap();
        }
        writer.flush().unwrap();
        for frame in 1..4 {
            assert_eq!(reader.next_record().unwrap(), Some(record(frame)));
        }
        assert_eq!(reader.next_record().unwrap(), None);
        writer.write(&record(4)).unwrap();
        writer.sync().unwrap();
        assert_eq!(reader.next_record().unwrap(), Some(record(4)));
        // What a checkpoint does not count on is not there.
        let length = std::fs::metadata(&path).unwrap().len();
        let mut reader = PartReader::open(&path, Some(length - 1)).unwrap().unwrap();
        for frame in 1..4 {
            assert_eq!(reader.next_record().unwrap(), Some(record(frame)));
        }
        assert_eq!(reader.next_record().unwrap(), None);
        // Cut anywhere it is a part that is not whole yet; damaged at its beginning it is none.
        let whole = std::fs::read(&path).unwrap();
        for end in 0..whole.len() {
            std::fs::write(&path, &whole[..end]).unwrap();
            let Some(mut reader) = PartReader::open(&path, None).unwrap() else {
                continue;
            };
            let mut read = 0;
            while reader.next_record().unwrap().is_some() {
                read += 1;
            }
            assert!(read < 4);
        }
        PartWriter::create(&folder, &head).unwrap();
        let mut other = whole.clone();
        other[8] = b'X';
        std::fs::write(&path, &other).unwrap();
        // Somebody else's file is not replaced.
        assert!(PartWriter::create(&folder, &head).is_err());
        assert!(remove_parts(&folder, 0).is_err());
        assert_eq!(std::fs::read(&path).unwrap(), other);
        let problem = PartReader::open(&path, None).err().unwrap();
        std::fs::remove_dir_all(&folder).unwrap();
        assert!(problem.contains("no pulses"), "{problem}");
    }
}
