//! Frames that LAMMPS and LIGGGHTS write: the binary form of `dump custom`.

use std::io::{ErrorKind, Read};
use windfall_scene::motion::simulation::FruitState;
use windfall_scene::vector::UNTURNED;

/// One frame: where all fruit are.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    pub step: u64,
    /// Fruit, in the order of the file.
    pub fruit: Vec<FruitState>,
}

/// Columns: number of the fruit, place, velocity, angular velocity.
const COLUMNS: usize = 10;

/// Frames one after the other from a file or a pipe.
pub struct FrameReader<R> {
    from: R,
    most: usize,
}

impl<R: Read> FrameReader<R> {
    /// * `most`: fruit in the scene; a frame with more is none
    pub fn new(from: R, most: usize) -> Self {
        Self { from, most }
    }

    /// The next frame; none at the end.
    ///
    /// # Errors
    /// What does not look like a frame of a deck of windfall.
    pub fn next_frame(&mut self) -> Result<Option<Frame>, String> {
        let Some(first) = self.first()? else {
            return Ok(None);
        };
        let mut step = first;
        let mut revision = 0;
        if first < 0 {
            // Newer versions begin with minus the length of a name.
            let length = usize::try_from(-first).unwrap_or(usize::MAX);
            let name = self.bytes(length, 64)?;
            if name != b"DUMPCUSTOM" {
                return Err("it is no dump of the style custom".to_owned());
            }
            let order = self.int()?;
            if order != 1 {
                return Err("it was written on a machine with another order of bytes".to_owned());
            }
            revision = self.int()?;
            step = self.long()?;
        }
        let rows = self.long()?;
        let tilted = self.int()?;
        self.bytes(6 * 4 + 6 * 8, 72)?;
        if tilted != 0 {
            self.bytes(3 * 8, 24)?;
        }
        let columns = self.int()?;
        if columns as usize != COLUMNS || rows < 0 || rows as usize > self.most {
            return Err(format!(
                "it is no dump of a deck of windfall: a frame has {rows} rows of {columns} columns, where up to {} of {COLUMNS} are to be",
                self.most
            ));
        }
        if revision > 1 {
            self.text()?;
            if self.bytes(1, 1)? != [0] {
                self.bytes(8, 8)?;
            }
            self.text()?;
        }
        let fruit = self.rows(rows as usize)?;
        let step = u64::try_from(step).map_err(|_| format!("a frame of the step {step}"))?;
        Ok(Some(Frame { step, fruit }))
    }

    fn rows(&mut self, rows: usize) -> Result<Vec<FruitState>, String> {
        let mut fruit = Vec::with_capacity(rows);
        for _ in 0..self.int()? {
            let values = self.int()?;
            let room = (rows - fruit.len()) * COLUMNS;
            let values = usize::try_from(values).unwrap_or(usize::MAX);
            if values > room || values % COLUMNS != 0 {
                return Err("a frame has more rows than it says".to_owned());
            }
            let bytes = self.bytes(8 * values, 8 * room)?;
            for row in bytes.chunks_exact(8 * COLUMNS) {
                fruit.push(state_of(row, self.most)?);
            }
        }
        match fruit.len() == rows {
            true => Ok(fruit),
            false => Err("a frame has fewer rows than it says".to_owned()),
        }
    }

    /// The first number of a frame; none where the file is at its end.
    fn first(&mut self) -> Result<Option<i64>, String> {
        let mut bytes = [0; 8];
        let mut read = 0;
        while read < 8 {
            match self.from.read(&mut bytes[read..]) {
                Ok(0) if read == 0 => return Ok(None),
                Ok(0) => return Err("the last frame is cut short".to_owned()),
                Ok(more) => read += more,
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return Err(error.to_string()),
            }
        }
        Ok(Some(i64::from_le_bytes(bytes)))
    }

    fn bytes(&mut self, length: usize, most: usize) -> Result<Vec<u8>, String> {
        if length > most {
            return Err("it is no dump of the style custom".to_owned());
        }
        let mut bytes = vec![0; length];
        let read = self.from.read_exact(&mut bytes);
        read.map_err(|error| match error.kind() {
            ErrorKind::UnexpectedEof => "the last frame is cut short".to_owned(),
            _ => error.to_string(),
        })?;
        Ok(bytes)
    }

    fn text(&mut self) -> Result<Vec<u8>, String> {
        let length = usize::try_from(self.int()?).unwrap_or(usize::MAX);
        self.bytes(length, 4096)
    }

    fn int(&mut self) -> Result<i32, String> {
        let bytes = self.bytes(4, 4)?;
        Ok(bytes.try_into().map_or(0, i32::from_le_bytes))
    }

    fn long(&mut self) -> Result<i64, String> {
        let bytes = self.bytes(8, 8)?;
        Ok(bytes.try_into().map_or(0, i64::from_le_bytes))
    }
}

fn state_of(row: &[u8], most: usize) -> Result<FruitState, String> {
    let mut values = [0.0; COLUMNS];
    for (value, bytes) in values.iter_mut().zip(row.chunks_exact(8)) {
        *value = bytes.try_into().map_or(f64::NAN, f64::from_le_bytes);
    }
    let [number, x, y, z, u, v, w, a, b, c] = values;
    if values.iter().any(|own| !own.is_finite()) {
        return Err(format!(
            "fruit {number} has a place or a velocity that is no number: the time step may be too \
             long"
        ));
    }
    if number < 1.0 || number > most as f64 || number.fract() != 0.0 {
        return Err(format!(
            "a frame has a fruit {number}, and the scene has {most}"
        ));
    }
    Ok(FruitState {
        fruit: number as u32 - 1,
        place: [x, y, z],
        velocity: [u, v, w],
        spin: [a, b, c],
        turn: UNTURNED,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A frame as the manual's `binary2txt` reads it.
    fn written(step: i64, rows: &[[f64; 10]], newer: bool) -> Vec<u8> {
        let mut bytes = Vec::new();
        if newer {
            bytes.extend((-10_i64).to_le_bytes());
            bytes.extend(b"DUMPCUSTOM");
            bytes.extend(1_i32.to_le_bytes());
            bytes.extend(2_i32.to_le_bytes());
        }
        bytes.extend(step.to_le_bytes());
        bytes.extend((rows.len() as i64).to_le_bytes());
        bytes.extend([0; 4 + 24 + 48]);
        bytes.extend(10_i32.to_le_bytes());
        if newer {
            bytes.extend(0_i32.to_le_bytes());
            bytes.push(0);
            bytes.extend(2_i32.to_le_bytes());
            bytes.extend(b"id");
        }
        bytes.extend((rows.len() as i32).to_le_bytes());
        for row in rows {
            bytes.extend(10_i32.to_le_bytes());
            row.iter().for_each(|own| bytes.extend(own.to_le_bytes()));
        }
        bytes
    }

    #[test]
    fn frames_of_both_generations() {
        let row = |n: f64| [n, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0];
        for newer in [false, true] {
            let mut bytes = written(0, &[], newer);
            bytes.extend(written(50, &[row(2.0), row(1.0)], newer));
            let mut reader = FrameReader::new(&bytes[..], 2);
            assert_eq!(reader.next_frame().unwrap().unwrap().fruit, []);
            let frame = reader.next_frame().unwrap().unwrap();
            assert_eq!((frame.step, frame.fruit[0].fruit), (50, 1));
            assert_eq!(frame.fruit[1].spin, [7.0, 8.0, 9.0]);
            assert_eq!(reader.next_frame().unwrap(), None);
            // Cut anywhere it is no frame, and no panic.
            let whole = written(50, &[row(2.0), row(1.0)], newer);
            for end in 1..whole.len() {
                let mut reader = FrameReader::new(&whole[..end], 2);
                assert!(reader.next_frame().is_err(), "{end}");
            }
        }
    }

    #[test]
    fn rejects_what_is_no_frame() {
        let row = [3.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0];
        let problem = |bytes: &[u8]| FrameReader::new(bytes, 2).next_frame().unwrap_err();
        assert!(problem(&written(0, &[row], true)).contains("fruit 3"));
        let mut lost = row;
        (lost[0], lost[4]) = (1.0, f64::NAN);
        assert!(problem(&written(0, &[lost], true)).contains("time step"));
        assert!(problem(&written(0, &[row, row, row], false)).contains("3 rows"));
        assert!(
            problem(b"ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n").contains("no dump")
                || problem(b"ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n").contains("cut short")
        );
    }
}
