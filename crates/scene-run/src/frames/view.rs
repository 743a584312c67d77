//! Seeing a scene that has run: a picture, files for ParaView.

use crate::frames::figure::{FROM, scene_painting};
use crate::frames::read::{SceneFrames, frames_absent, frames_file};
use crate::frames::vtk::write_vtk;
use serde::Serialize;
use std::path::{Path, PathBuf};
use windfall_draw::files::FigureFormat;
use windfall_draw::theme::FigureTheme;
use windfall_draw::width::Width;
use windfall_files::error::Error;
use windfall_files::option_value::unusable;
use windfall_files::progress::Progress;
use windfall_files::write_file::{check_outputs, write_whole};
use windfall_scene::vector::length;

/// Options of a picture.
#[derive(Clone, Debug, Default)]
pub struct PictureRequest {
    /// When; the end where it is left out; s.
    pub time: Option<f64>,
    /// From where: azimuth from x towards y, elevation above the ground; rad.
    pub from: Option<[f64; 2]>,
    /// Force of the last colour; the largest of the scene where it is left out; N.
    pub most: Option<f64>,
    /// Colours.
    pub theme: FigureTheme,
    /// On paper; as wide as a screen shows it where it is left out.
    pub width: Option<Width>,
    /// An SVG, PNG or PDF; the first two in the directory of the results where it is left out.
    pub out: Option<PathBuf>,
}

/// What was drawn.
#[derive(Clone, Debug, Serialize, utoipa::ToSchema)]
pub struct PictureOutcome {
    /// When; s.
    pub time: f64,
    /// Fruit in the scene then.
    pub fruit: usize,
    /// What stands below it.
    pub caption: String,
    /// Files written.
    #[schema(value_type = Vec<String>)]
    pub files: Vec<PathBuf>,
}

/// Files for ParaView.
#[derive(Clone, Debug, Serialize, utoipa::ToSchema)]
pub struct VtkOutcome {
    /// Frames.
    pub frames: usize,
    /// The file to be opened.
    #[schema(value_type = String)]
    pub collection: PathBuf,
    /// Files beside it.
    pub files: usize,
}

/// Where the results of a scene lie: in the directory that is given, or beside the scene file.
pub fn run_directory(path: &Path) -> PathBuf {
    match path.extension().is_some_and(|ending| ending == "toml") {
        true => path.with_extension("run"),
        false => path.to_path_buf(),
    }
}

/// Opens the frames of a scene that has run, or runs.
///
/// # Errors
/// There are none, or they cannot be read.
pub fn open_frames(path: &Path) -> Result<SceneFrames, Error> {
    let directory = run_directory(path);
    if !directory.is_dir() {
        return Err(Error::FileAbsent {
            path: directory,
            advice: "give the directory that `windfall scene run FILE` wrote into, or the file"
                .to_owned(),
        });
    }
    SceneFrames::open(&frames_file(&directory)?)
}

/// Draws a scene.
///
/// * `path`: directory of the results, or the scene file beside it
///
/// # Errors
/// There are no frames, a file cannot be read or written, or an option cannot be used.
pub fn draw_scene(path: &Path, request: &PictureRequest) -> Result<PictureOutcome, Error> {
    let out = request.out.as_deref();
    let ending = out.and_then(Path::extension).and_then(|own| own.to_str());
    if out.is_some() && !matches!(ending, Some("svg" | "png" | "pdf")) {
        return Err(unusable(
            "--out",
            "give a file that ends in .svg, .png or .pdf",
        ));
    }
    let mut frames = open_frames(path)?;
    let directory = run_directory(path);
    let Some(last) = frames.frames.len().checked_sub(1) else {
        return Err(frames_absent(&directory));
    };
    let files = match out {
        Some(file) => vec![file.to_path_buf()],
        None => ["svg", "png"]
            .map(|ending| directory.join(format!("picture.{ending}")))
            .to_vec(),
    };
    check_outputs(files.iter().map(|file| Some(file.as_path())))?;
    if let Some(time) = request.time {
        let end = frames.frames[last].time;
        let within = time >= 0.0 && time <= end + frames.about.interval;
        if !within {
            let problem =
                format!("{time} s is not within the scene, which has frames from 0 to {end} s");
            return Err(unusable("--time", problem));
        }
    }
    let number = request.time.and_then(|time| frames.nearest(time));
    let frame = frames.frame(number.unwrap_or(last))?;
    let most = match request.most {
        Some(most) => most,
        None => largest_values(&mut frames)?.force,
    };
    let from = request.from.unwrap_or(FROM);
    let painting = scene_painting(&frames, &frame, from, most, request.width)?;
    let drawing = painting.picture.drawing(request.width);
    let svg = drawing.svg(request.theme.colours());
    for file in &files {
        let format = match file.extension().and_then(|own| own.to_str()) {
            Some("png") => FigureFormat::Png,
            Some("pdf") => FigureFormat::Pdf,
            _ => FigureFormat::Svg,
        };
        write_whole(file, &format.of_svg(&svg)?)?;
    }
    Ok(PictureOutcome {
        time: frame.time,
        fruit: frame.fruit.len(),
        caption: painting.caption,
        files,
    })
}

/// Frames sampled for the largest values, besides the last.
const LOOKS: usize = 16;

/// Ends of scales of colours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Largest {
    /// Largest peak force of a fruit; N.
    pub force: f64,
    /// Largest speed of a fruit; m/s.
    pub speed: f64,
}

/// The largest values of fruit in a sample of the frames. Forces only grow, but fruit leave:
/// frames between are looked at as well. Between these a fruit can be faster.
///
/// # Errors
/// The frames cannot be read.
pub fn largest_values(frames: &mut SceneFrames) -> Result<Largest, Error> {
    let count = frames.frames.len();
    let (mut force, mut speed) = (0.0_f64, 0.0_f64);
    for number in (0..count).rev().step_by(count.div_ceil(LOOKS).max(1)) {
        for own in frames.frame(number)?.fruit {
            force = force.max(own.peak_force.into());
            speed = speed.max(length(own.velocity.map(f64::from)));
        }
    }
    // Where nothing has touched or moved yet any scale will do.
    let end = |value: f64| if value > 0.0 { value } else { 1.0 };
    Ok(Largest {
        force: end(force),
        speed: end(speed),
    })
}

/// Writes the frames of a scene for ParaView.
///
/// * `out`: a directory; "vtk" in that of the results where it is left out
///
/// # Errors
/// There are no frames, or a file cannot be read or written.
pub fn vtk_of_scene(
    path: &Path,
    out: Option<&Path>,
    progress: Progress,
) -> Result<VtkOutcome, Error> {
    let mut frames = open_frames(path)?;
    let directory = match out {
        Some(own) => own.to_path_buf(),
        None => run_directory(path).join("vtk"),
    };
    let (collection, files) = write_vtk(&mut frames, &directory, progress)?;
    Ok(VtkOutcome {
        frames: frames.frames.len(),
        collection,
        files,
    })
}
