//! Frames of a scene for ParaView: VTK's XML files of poly data, and their times.

use crate::file_error::make_directory;
use crate::frames::camera::posed;
use crate::frames::read::SceneFrames;
use crate::run::frame_format::{Frame, WallFrame};
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use windfall_files::error::Error;
use windfall_files::progress::Progress;
use windfall_files::write_file::write_whole;

/// Name of the file that lists all others with their times.
pub const COLLECTION: &str = "scene.pvd";

/// Writes every frame: fruit as points, walls as faces, and the list of both.
///
/// Returns the list and the number of files beside it.
///
/// # Errors
/// A frame cannot be read, or a file cannot be written; it was cancelled.
pub fn write_vtk(
    frames: &mut SceneFrames,
    directory: &Path,
    progress: Progress,
) -> Result<(PathBuf, usize), Error> {
    make_directory(directory)?;
    let moves = frames.walls.iter().any(|wall| wall.about.moves);
    let all = frames.frames.len();
    let mut sets = String::new();
    let mut files = 0;
    for number in 0..all {
        let frame = frames.frame(number)?;
        let fruit = format!("fruit_{number:06}.vtp");
        write_whole(
            &directory.join(&fruit),
            fruit_vtp(frames, &frame).as_bytes(),
        )?;
        files += 1;
        // Walls that stay are written once.
        let walls = match moves {
            true => format!("walls_{number:06}.vtp"),
            false => "walls.vtp".to_owned(),
        };
        if !frames.walls.is_empty() {
            if moves || number == 0 {
                let text = walls_vtp(frames, &frame.walls);
                write_whole(&directory.join(&walls), text.as_bytes())?;
                files += 1;
            }
            let _ = writeln!(
                sets,
                r#"    <DataSet timestep="{}" part="1" name="walls" file="{walls}"/>"#,
                frame.time
            );
        }
        let _ = writeln!(
            sets,
            r#"    <DataSet timestep="{}" part="0" name="fruit" file="{fruit}"/>"#,
            frame.time
        );
        if progress(number + 1, all).is_break() {
            return Err(Error::Cancelled);
        }
    }
    let list = directory.join(COLLECTION);
    let text = format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" \
         byte_order=\"LittleEndian\">\n  <Collection>\n{sets}  </Collection>\n</VTKFile>\n"
    );
    write_whole(&list, text.as_bytes())?;
    Ok((list, files))
}

/// Fruit as points with radius, velocity, largest peak force, number and orientation.
fn fruit_vtp(frames: &SceneFrames, frame: &Frame) -> String {
    let count = frame.fruit.len();
    let radius = |fruit: u32| {
        let own = frames.radii.get((fruit as usize).wrapping_sub(1));
        own.copied().unwrap_or(0.0)
    };
    let floats = |name, parts, of: &dyn Fn(&crate::run::frame_format::FruitFrame) -> Vec<f32>| {
        let values: Vec<f32> = frame.fruit.iter().flat_map(of).collect();
        float_array(name, parts, &values)
    };
    let point_data = [
        floats("radius", 1, &|own| vec![radius(own.fruit)]),
        floats("velocity", 3, &|own| own.velocity.to_vec()),
        floats("largest_peak_force", 1, &|own| vec![own.peak_force]),
        floats("orientation", 4, &|own| own.turn.to_vec()),
        int_array("fruit", frame.fruit.iter().map(|own| own.fruit as i32)),
    ]
    .concat();
    let points = floats("Points", 3, &|own| own.place.to_vec());
    let vertices = [
        int_array("connectivity", 0..count as i32),
        int_array("offsets", 1..=count as i32),
    ]
    .concat();
    let piece = format!(
        "    <Piece NumberOfPoints=\"{count}\" NumberOfVerts=\"{count}\" NumberOfLines=\"0\" \
         NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n      <PointData Scalars=\"largest_peak_force\" \
         Vectors=\"velocity\">\n{point_data}      </PointData>\n      <Points>\n{points}      \
         </Points>\n      <Verts>\n{vertices}      </Verts>\n    </Piece>\n"
    );
    poly_data(&piece)
}

/// Faces of all walls, each with the number of its wall; names are in the field data.
fn walls_vtp(frames: &SceneFrames, poses: &[WallFrame]) -> String {
    let (mut points, mut corners) = (Vec::new(), Vec::new());
    let (mut offsets, mut numbers) = (Vec::new(), Vec::new());
    for (number, (wall, pose)) in frames.walls.iter().zip(poses).enumerate() {
        let first = (points.len() / 3) as i32;
        for vertex in &wall.vertices {
            points.extend(posed(*vertex, pose).map(|own| own as f32));
        }
        for face in wall.faces.chunks_exact(wall.about.corners) {
            corners.extend(face.iter().map(|own| first + *own as i32));
            offsets.push(corners.len() as i32);
            numbers.push(number as i32);
        }
    }
    let names = frames.walls.iter().map(|wall| wall.about.name.as_str());
    let cells = offsets.len();
    let piece = format!(
        "{}    <Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"0\" \
         NumberOfStrips=\"0\" NumberOfPolys=\"{cells}\">\n      <CellData \
         Scalars=\"wall\">\n{}      </CellData>\n      <Points>\n{}      </Points>\n      \
         <Polys>\n{}{}      </Polys>\n    </Piece>\n",
        string_array("names", names),
        points.len() / 3,
        int_array("wall", numbers),
        float_array("Points", 3, &points),
        int_array("connectivity", corners),
        int_array("offsets", offsets),
    );
    poly_data(&piece)
}

fn poly_data(piece: &str) -> String {
    format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" \
         byte_order=\"LittleEndian\" header_type=\"UInt64\">\n  <PolyData>\n{piece}  \
         </PolyData>\n</VTKFile>\n"
    )
}

fn float_array(name: &str, parts: usize, values: &[f32]) -> String {
    let bytes = values.iter().flat_map(|own| own.to_le_bytes());
    data_array("Float32", name, parts, bytes.collect())
}

fn int_array(name: &str, values: impl IntoIterator<Item = i32>) -> String {
    let bytes = values.into_iter().flat_map(i32::to_le_bytes);
    data_array("Int32", name, 1, bytes.collect())
}

fn data_array(kind: &str, name: &str, parts: usize, bytes: Vec<u8>) -> String {
    let mut whole = (bytes.len() as u64).to_le_bytes().to_vec();
    whole.extend(bytes);
    format!(
        "        <DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{parts}\" \
         format=\"binary\">{}</DataArray>\n",
        BASE64_STANDARD.encode(&whole)
    )
}

/// Texts as VTK writes them: codes of their characters, each text ended by 0.
fn string_array<'a>(name: &str, texts: impl Iterator<Item = &'a str>) -> String {
    let mut count = 0;
    let mut codes = String::new();
    for text in texts {
        count += 1;
        for code in text.bytes().chain([0]) {
            let _ = write!(codes, "{code} ");
        }
    }
    format!(
        "    <FieldData>\n      <Array type=\"String\" Name=\"{name}\" NumberOfTuples=\"{count}\" \
         format=\"ascii\">{}</Array>\n    </FieldData>\n",
        codes.trim_end()
    )
}
