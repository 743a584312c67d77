//! frames.bin: what is where at which time, version 1.
//!
//! All numbers are little-endian, all values SI.
//!
//! | part | what |
//! |---|---|
//! | 8 bytes | "wfframes" |
//! | u32 | version, 1 |
//! | u32 | length of the next part, a multiple of 4 |
//! | JSON | [`FramesAbout`], filled up with blanks |
//! | f32 × fruit | radius of each fruit, by number |
//! | of each wall | f32 × 3 per vertex, then u32 × corners per face: numbers of vertices |
//! | of each frame | "frme", u32 number of fruit in it, f64 time, then 7 f32 per wall, then 48 bytes per fruit |
//!
//! A wall's seven numbers are a rotation (quaternion w, x, y, z) and a shift (m): a point of
//! it at rest is turned, then shifted. A fruit's record is its number (u32, as in fruit.csv),
//! place (3), orientation (quaternion w, x, y, z), velocity (3) and the largest peak force so
//! far (1), in f32. Fruit that are not in the scene at that time are left out.

use crate::geometry::{Bounds, WallAbout};
use serde::{Deserialize, Serialize};

/// Name of the file in a directory of results.
pub const FRAMES_FILE: &str = "frames.bin";

/// First bytes of the file.
pub const MAGIC: [u8; 8] = *b"wfframes";

/// Version of its shape.
pub const VERSION: u32 = 1;

/// First bytes of a frame.
pub const FRAME: [u8; 4] = *b"frme";

/// Bytes before the fruit and walls of a frame.
pub const FRAME_HEADER: usize = 16;

/// Bytes of a fruit in a frame.
pub const FRUIT_BYTES: usize = 48;

/// Bytes of a wall in a frame.
pub const WALL_BYTES: usize = 28;

/// What the file is about, in its JSON.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema, Deserialize)]
pub struct FramesAbout {
    /// Title of the scene.
    pub title: String,
    /// When the scene ends; s.
    pub end: f64,
    /// Time from frame to frame; s.
    pub interval: f64,
    /// Fruit in all.
    pub fruit: usize,
    /// Walls, in the order of their faces.
    pub walls: Vec<WallAbout>,
    /// The box around walls at rest and the places at which fruit come; m.
    pub bounds: Bounds,
    /// Length after which the scene repeats along each axis, 0 along an open one; m.
    #[serde(default)]
    #[schema(required = true, value_type = (f64, f64, f64))]
    pub periods: [f64; 3],
}

/// A fruit in a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FruitFrame {
    /// Its number, as in fruit.csv.
    pub fruit: u32,
    /// Where; m.
    pub place: [f32; 3],
    /// Orientation, as a quaternion w, x, y, z.
    pub turn: [f32; 4],
    /// Velocity; m/s.
    pub velocity: [f32; 3],
    /// Largest peak force so far; N.
    pub peak_force: f32,
}

/// Where a wall is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WallFrame {
    /// Rotation, as a quaternion w, x, y, z.
    pub turn: [f32; 4],
    /// Shift after it; m.
    pub shift: [f32; 3],
}

/// What is where at a time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frame {
    /// When; s.
    pub time: f64,
    /// Every wall.
    pub walls: Vec<WallFrame>,
    /// Fruit in the scene, by number.
    pub fruit: Vec<FruitFrame>,
}

/// Bytes of a frame.
pub fn frame_size(walls: usize, fruit: usize) -> u64 {
    (FRAME_HEADER + walls * WALL_BYTES) as u64 + fruit as u64 * FRUIT_BYTES as u64
}

/// A frame as bytes, behind those that are there.
pub fn encode_frame(frame: &Frame, bytes: &mut Vec<u8>) {
    bytes.extend(FRAME);
    bytes.extend((frame.fruit.len() as u32).to_le_bytes());
    bytes.extend(frame.time.to_le_bytes());
    let put = |bytes: &mut Vec<u8>, values: &[f32]| {
        bytes.extend(values.iter().flat_map(|own| own.to_le_bytes()));
    };
    for wall in &frame.walls {
        put(bytes, &wall.turn);
        put(bytes, &wall.shift);
    }
    for own in &frame.fruit {
        bytes.extend(own.fruit.to_le_bytes());
        put(bytes, &own.place);
        put(bytes, &own.turn);
        put(bytes, &own.velocity);
        put(bytes, &[own.peak_force]);
    }
}

/// A frame from its bytes; `None` where they are not those of a frame of so many walls.
pub fn decode_frame(bytes: &[u8], walls: usize) -> Option<Frame> {
    let (header, rest) = bytes.split_at_checked(FRAME_HEADER)?;
    let (count, time) = decode_frame_header(header.try_into().ok()?)?;
    if bytes.len() as u64 != frame_size(walls, count as usize) {
        return None;
    }
    let (walls, fruit) = rest.split_at_checked(walls * WALL_BYTES)?;
    let wall = |own: &[u8]| WallFrame {
        turn: floats(own, 0),
        shift: floats(own, 4),
    };
    let one = |own: &[u8]| FruitFrame {
        fruit: u32::from_le_bytes(word(own, 0)),
        place: floats(own, 1),
        turn: floats(own, 4),
        velocity: floats(own, 8),
        peak_force: f32::from_le_bytes(word(own, 11)),
    };
    Some(Frame {
        time,
        walls: walls.chunks_exact(WALL_BYTES).map(wall).collect(),
        fruit: fruit.chunks_exact(FRUIT_BYTES).map(one).collect(),
    })
}

/// Number of fruit and time of a frame.
pub fn decode_frame_header(bytes: [u8; FRAME_HEADER]) -> Option<(u32, f64)> {
    let time: [u8; 8] = bytes[8..].try_into().ok()?;
    let time = f64::from_le_bytes(time);
    let count = u32::from_le_bytes(word(&bytes, 1));
    (bytes.starts_with(&FRAME) && time.is_finite()).then_some((count, time))
}

/// Four bytes at a word of 32 bits.
fn word(bytes: &[u8], at: usize) -> [u8; 4] {
    std::array::from_fn(|k| bytes[4 * at + k])
}

/// Numbers from a word of 32 bits on.
pub fn floats<const N: usize>(bytes: &[u8], at: usize) -> [f32; N] {
    std::array::from_fn(|k| f32::from_le_bytes(word(bytes, at + k)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_frames_come_back_from_their_bytes() {
        let fruit = FruitFrame {
            fruit: 7,
            place: [1.0, -2.0, 0.5],
            turn: [0.5, -0.5, 0.5, 0.5],
            velocity: [0.0, 3.0, -4.0],
            peak_force: 81.25,
        };
        let wall = WallFrame {
            turn: [1.0, 0.0, 0.0, 0.0],
            shift: [0.25, 0.0, -1.0],
        };
        let frame = Frame {
            time: 0.1,
            walls: vec![wall; 2],
            fruit: vec![fruit; 3],
        };
        let mut bytes = Vec::new();
        encode_frame(&frame, &mut bytes);
        assert_eq!(bytes.len() as u64, frame_size(2, 3));
        assert_eq!(decode_frame(&bytes, 2), Some(frame));
        // Place, by the table above: behind header, two walls and the number.
        let at = 16 + 2 * 28 + 4;
        assert_eq!(bytes[at..at + 4], 1.0_f32.to_le_bytes());
        for length in 0..bytes.len() {
            assert_eq!(decode_frame(&bytes[..length], 2), None);
        }
        assert_eq!(decode_frame(&bytes, 1), None);
        bytes[0] = b'x';
        assert_eq!(decode_frame(&bytes, 2), None);
    }
}
