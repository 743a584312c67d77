//! Streams that a person pipes in: `-`, `/dev/stdin`, `<(…)`, a named pipe.
//!
//! A stream can be read once, and programs open a file more than once: what came out of a
//! stream is kept in memory under its name.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{Error, ErrorKind, Read, Result};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// Standard input, as it is named on the command line.
pub const STANDARD_INPUT: &str = "-";

/// Longest stream; bytes.
const LONGEST: u64 = 1 << 31;

/// What the streams of this program held, by their names.
static STREAMS: Mutex<BTreeMap<PathBuf, Arc<[u8]>>> = Mutex::new(BTreeMap::new());

/// Whether a name stands for a stream, and not for a file or directory. A device is one too:
/// who reads it decides whether that is welcome.
pub fn is_stream(path: &Path) -> bool {
    let standard = path == Path::new(STANDARD_INPUT);
    standard || std::fs::metadata(path).is_ok_and(|found| !found.is_file() && !found.is_dir())
}

/// Everything that a stream holds, to its end.
///
/// # Errors
/// It cannot be read, or is longer than 2 GiB.
pub fn stream_bytes(path: &Path) -> Result<Arc<[u8]>> {
    let mut streams = STREAMS.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(known) = streams.get(path) {
        return Ok(Arc::clone(known));
    }
    let mut bytes = Vec::new();
    match path == Path::new(STANDARD_INPUT) {
        true => std::io::stdin().take(LONGEST + 1).read_to_end(&mut bytes)?,
        false => File::open(path)?
            .take(LONGEST + 1)
            .read_to_end(&mut bytes)?,
    };
    if bytes.len() as u64 > LONGEST {
        let told = "the stream is longer than 2 GiB; write it into a file and name the file";
        return Err(Error::new(ErrorKind::FileTooLarge, told));
    }
    let bytes: Arc<[u8]> = bytes.into();
    streams.insert(path.to_path_buf(), Arc::clone(&bytes));
    Ok(bytes)
}

/// Forgets what the streams held: the next who reads one waits for what comes out of it then.
pub fn forget_streams() {
    STREAMS
        .lock()
        .unwrap_or_else(PoisonError::into_inner)
        .clear();
}

#[cfg(test)]
mod tests {
    #[cfg(unix)]
    use super::*;

    #[cfg(unix)]
    #[test]
    fn repeats_what_came_out_of_a_pipe() {
        use std::io::Write;

        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("pipe");
        let made = std::process::Command::new("mkfifo").arg(&pipe).status();
        assert!(made.unwrap().success());
        assert!(is_stream(&pipe) && !is_stream(folder.path()));
        let write = |text: &'static [u8]| {
            let other = pipe.clone();
            std::thread::spawn(move || {
                let mut file = File::options().write(true).open(other).unwrap();
                file.write_all(text).unwrap();
            })
        };
        let writer = write(b"a,b\n1,2\n");
        assert_eq!(&stream_bytes(&pipe).unwrap()[..], b"a,b\n1,2\n");
        writer.join().unwrap();
        // Nobody writes any more.
        assert_eq!(&stream_bytes(&pipe).unwrap()[..], b"a,b\n1,2\n");
        forget_streams();
        let writer = write(b"a,b\n3,4\n");
        assert_eq!(&stream_bytes(&pipe).unwrap()[..], b"a,b\n3,4\n");
        writer.join().unwrap();
    }
}
