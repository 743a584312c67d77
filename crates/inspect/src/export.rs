//! Every sample of a recording as CSV, or as a structured array of NumPy.
//!
//! Rows are written as they come: memory grows only where a file holds one channel after
//! the other.

use crate::run::{InspectRequest, shown_channels};
use std::collections::VecDeque;
use std::fs::File;
use std::io::{BufWriter, Seek, SeekFrom, Write};
use std::path::Path;
use windfall_campaign::settings::open_options::open_options;
use windfall_files::error::Error;
use windfall_files::inputs::protect;
use windfall_files::npy::npy_header;
use windfall_files::option_value::unusable;
use windfall_files::table::write::csv_header;
use windfall_files::write_file::write_streamed;
use windfall_formats::contents::{Contents, TimeBase};
use windfall_formats::open::open;
use windfall_formats::reader::{Sink, is_missing};

/// What is written.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Csv,
    Npy,
}

/// A column of the table.
enum Column {
    /// Samples of a channel of the file.
    Samples(VecDeque<f64>),
    /// Times of the channels on its right.
    Times { start: f64, interval: f64 },
}

/// Writes the samples of a recording as they were read: CSV or .npy, by the ending of the name.
///
/// Channels sampled evenly get a column of times on their left. Channels of different
/// lengths are filled up: blank cells in CSV, NaN in an array. Missing samples are NaN.
///
/// # Errors
/// The name ends otherwise, the recording cannot be read, holds a cell that is no number,
/// or the file cannot be written.
pub fn export_recording(file: &Path, path: &Path, request: &InspectRequest) -> Result<(), Error> {
    let kind = match path.extension().and_then(|extension| extension.to_str()) {
        Some("csv") => Kind::Csv,
        Some("npy") => Kind::Npy,
        _ => {
            return Err(unusable(
                format!("--export {}", path.display()),
                "samples are written as CSV or NumPy array; give a name that ends in \".csv\" or \
                 \".npy\"",
            ));
        }
    };
    protect(file);
    let mut reader = open(file, &open_options(&request.open)?).map_err(Error::Format)?;
    let contents = reader.contents();
    let mut wanted = shown_channels(contents, &request.channels, file)?;
    let times = wanted
        .iter()
        .filter_map(|&channel| match contents.channels[channel].time {
            TimeBase::Channel(at) => Some(at),
            _ => None,
        });
    wanted.extend(times.collect::<Vec<_>>());
    wanted.sort_unstable();
    wanted.dedup();
    write_streamed(path, |file| {
        let (names, columns) = columns_of(reader.contents(), &wanted);
        let mut table = Table {
            kind,
            columns,
            rows: 0,
            out: BufWriter::with_capacity(1 << 20, file),
            failed: None,
        };
        let failed = |source| Error::access(path, "write", source);
        table.begin(&names).map_err(failed)?;
        let read = reader.read(&wanted, &mut table);
        if let Some(source) = table.failed.take() {
            return Err(failed(source));
        }
        read.map_err(Error::Format)?;
        table.end(&names).map_err(failed)
    })
}

/// Names with units, and columns; those of samples in the order of `wanted`.
fn columns_of(contents: &Contents, wanted: &[usize]) -> (Vec<String>, Vec<Column>) {
    let (mut names, mut columns) = (Vec::new(), Vec::new());
    let mut base = None;
    let mut clocks = 0;
    for &index in wanted {
        let channel = &contents.channels[index];
        if let TimeBase::Uniform { start, interval } = channel.time
            && base != Some((start, interval))
        {
            base = Some((start, interval));
            clocks += 1;
            names.push(match clocks {
                1 => "time [s]".to_owned(),
                more => format!("time {more} [s]"),
            });
            columns.push(Column::Times { start, interval });
        }
        names.push(match &channel.unit {
            Some(unit) => format!("{} [{unit}]", channel.name),
            None => channel.name.clone(),
        });
        columns.push(Column::Samples(VecDeque::new()));
    }
    (names, columns)
}

struct Table<'a> {
    kind: Kind,
    columns: Vec<Column>,
    rows: u64,
    out: BufWriter<&'a mut File>,
    /// Why a row could not be written.
    failed: Option<std::io::Error>,
}

impl Table<'_> {
    fn begin(&mut self, names: &[String]) -> std::io::Result<()> {
        match self.kind {
            Kind::Csv => {
                let header = csv_header(names).map_err(std::io::Error::other)?;
                self.out.write_all(header.as_bytes())
            }
            // Its place is taken until the number of rows is known.
            Kind::Npy => self.out.write_all(&npy_header(names, 0)),
        }
    }

    fn end(&mut self, names: &[String]) -> std::io::Result<()> {
        // Shorter channels are filled up.
        let longest = self.columns.iter().filter_map(|column| match column {
            Column::Samples(samples) => Some(samples.len()),
            Column::Times { .. } => None,
        });
        for _ in 0..longest.max().unwrap_or(0) {
            self.row()?;
        }
        if self.kind == Kind::Npy {
            self.out.seek(SeekFrom::Start(0))?;
            self.out.write_all(&npy_header(names, self.rows))?;
        }
        self.out.flush()
    }

    fn row(&mut self) -> std::io::Result<()> {
        for (place, column) in self.columns.iter_mut().enumerate() {
            let value = match column {
                Column::Samples(samples) => samples.pop_front(),
                Column::Times { start, interval } => Some(*start + self.rows as f64 * *interval),
            };
            match self.kind {
                Kind::Npy => {
                    let value = value.unwrap_or(f64::NAN);
                    let value = if value.is_nan() { f64::NAN } else { value };
                    self.out.write_all(&value.to_le_bytes())?;
                }
                Kind::Csv => {
                    let comma = if place > 0 { "," } else { "" };
                    match value {
                        Some(value) if is_missing(value) => write!(self.out, "{comma}NaN")?,
                        Some(value) if !value.is_nan() => write!(self.out, "{comma}{value:?}")?,
                        _ => write!(self.out, "{comma}")?,
                    }
                }
            }
        }
        self.rows += 1;
        match self.kind {
            Kind::Csv => writeln!(self.out),
            Kind::Npy => Ok(()),
        }
    }
}

impl Sink for Table<'_> {
    fn take(&mut self, position: usize, samples: &[f64]) -> Result<(), windfall_formats::Error> {
        let mut channels = self.columns.iter_mut().filter_map(|column| match column {
            Column::Samples(samples) => Some(samples),
            Column::Times { .. } => None,
        });
        if let Some(channel) = channels.nth(position) {
            channel.extend(samples);
        }
        let shortest = self.columns.iter().filter_map(|column| match column {
            Column::Samples(samples) => Some(samples.len()),
            Column::Times { .. } => None,
        });
        for _ in 0..shortest.min().unwrap_or(0) {
            if self.failed.is_none()
                && let Err(error) = self.row()
            {
                self.failed = Some(error);
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is written of a file with these contents.
    fn exported(name: &str, contents: &[u8], out: &str) -> Result<Vec<u8>, Error> {
        let dir = tempfile::tempdir().unwrap();
        let (file, path) = (dir.path().join(name), dir.path().join(out));
        std::fs::write(&file, contents).unwrap();
        let written = export_recording(&file, &path, &InspectRequest::default());
        let files = std::fs::read_dir(dir.path()).unwrap().count();
        // The recording; the export and the list of what was written.
        assert_eq!(files, 1 + 2 * usize::from(written.is_ok()));
        written.map(|()| std::fs::read(&path).unwrap())
    }

    #[test]
    fn closed_form_csv_tells_blank_cells_from_missing_samples() {
        let text = b"t;\"F, left\"\n[s];[N]\n0;1,5\n0,5;NaN\n1;\n1,5;1e-30\n";
        let written = exported("r.txt", text, "r.csv").unwrap();
        assert_eq!(
            String::from_utf8(written).unwrap(),
            "t [s],\"F, left [N]\"\n0.0,1.5\n0.5,NaN\n1.0,\n1.5,1e-30\n"
        );
    }

    #[test]
    fn closed_form_channels_of_a_sound_get_their_times() {
        let mut sound = b"RIFF\x28\0\0\0WAVEfmt \x10\0\0\0\x01\0\x01\0\x02\0\0\0\x04\0\0\0\x02\0\x10\0data\x04\0\0\0".to_vec();
        sound.extend(16_384_i16.to_le_bytes());
        sound.extend((-8192_i16).to_le_bytes());
        let written = exported("r.wav", &sound, "r.csv").unwrap();
        assert_eq!(
            String::from_utf8(written).unwrap(),
            "time [s],channel 1\n0.0,0.5\n0.5,-0.25\n"
        );
        let written = exported("r.wav", &sound, "r.npy").unwrap();
        let (header, data) = written.split_at(written.len() - 32);
        assert!(header.starts_with(b"\x93NUMPY\x03\0") && header.len() % 64 == 0);
        let text = String::from_utf8_lossy(&header[12..]);
        let expected = "{'descr': [(\"time [s]\", '<f8'), (\"channel 1\", '<f8')], \
                        'fortran_order': False, 'shape': (                   2,), }";
        assert_eq!(text.trim_end(), expected);
        let numbers: Vec<f64> = data
            .chunks_exact(8)
            .map(|bytes| f64::from_le_bytes(bytes.try_into().unwrap()))
            .collect();
        assert_eq!(numbers, [0.0, 0.5, 0.5, -0.25]);
    }

    #[test]
    fn rejects_other_endings_and_cells_that_are_no_numbers() {
        let told = exported("r.txt", b"t,F\n0,1\n", "r.xlsx")
            .unwrap_err()
            .to_string();
        assert!(
            told.contains("give a name that ends in \".csv\" or \".npy\""),
            "{told}"
        );
        let told = exported("r.txt", b"t,F\n0,1\n1,x\n2,3\n", "r.csv")
            .unwrap_err()
            .to_string();
        assert!(told.contains("line 3, column \"F\": \"x\""), "{told}");
    }
}
