//! A scene as a picture: translucent walls, fruit coloured by their largest impact.

use crate::frames::camera::{Camera, Pane, posed};
use crate::frames::order::{Ball, Next, Pane3, middle_of, order};
use crate::frames::read::SceneFrames;
use crate::geometry::WallGeometry;
use crate::run::frame_format::Frame;
use std::collections::BTreeMap;
use windfall_draw::axis::{axis, unit_label};
use windfall_draw::colour_map::colour_of;
use windfall_draw::files::{Painting, Picture};
use windfall_draw::svg::{Anchor, Drawing, Ink};
use windfall_draw::text_width::cut_to;
use windfall_draw::width::Width;
use windfall_files::error::Error;
use windfall_files::table::write::csv_text;
use windfall_scene::vector::{Vector, cross, dot, length, subtract, unit};

/// Width of the drawing where none is asked for, and its height over its width; px.
const WIDTH: f64 = 760.0;
const HIGH: f64 = 540.0 / 760.0;

/// Room around the scene; px.
const LEFT: f64 = 24.0;
const TOP: f64 = 64.0;
const BESIDE: f64 = 100.0;
const BELOW: f64 = 24.0;

/// The bar of colours: its distance from the scene, its width and its greatest height; px.
const BAR: [f64; 3] = [16.0, 14.0, 250.0];

/// Steps of the bar of colours, and of those of fruit.
const STEPS: usize = 64;

/// Faces that meet at a smaller angle are one surface; cosine of 25°.
const SMOOTH: f64 = 0.906;

/// Opacity of a face, of one with fruit behind it (whose colours must stay readable), and of
/// edges; 1.
const FACE: f64 = 0.10;
const FRONT: f64 = 0.035;
const PLANE: f64 = 0.06;
const EDGE: f64 = 0.75;

/// How far beyond the walls fruit still count for what the camera sees, over the diagonal of
/// the scene; 1.
const AROUND: f64 = 0.15;

/// From where a scene is seen where nothing is said: azimuth and elevation; rad.
pub const FROM: [f64; 2] = [
    -62.0 * std::f64::consts::PI / 180.0,
    24.0 * std::f64::consts::PI / 180.0,
];

/// A scene at a frame.
///
/// * `from`: where the eye stands: azimuth from x towards y, elevation; rad
/// * `most`: force of the last colour; N
/// * `width`: on paper; as wide as a screen shows it if left out
pub fn scene_painting(
    frames: &SceneFrames,
    frame: &Frame,
    from: [f64; 2],
    most: f64,
    width: Option<Width>,
) -> Result<Painting, Error> {
    let sheet = Sheet::of(width);
    let camera = Camera::around(&looked_at(frames, frame), from, sheet.pane());
    let balls = balls_of(frames, frame, &camera, (most, &sheet));
    let mut faces: Vec<Pane3> = frames
        .walls
        .iter()
        .zip(&frame.walls)
        .flat_map(|(wall, pose)| {
            let points = wall.vertices.iter().map(|own| posed(*own, pose));
            faces_of(wall, &points.collect::<Vec<_>>(), &camera)
        })
        .collect();
    let mut drawing = Drawing::at_width(width, WIDTH, sheet.height);
    for next in order(&balls, &mut faces, &camera) {
        match next {
            Next::Ball(own) => {
                let ball = &balls[own];
                drawing.ball(ball.at, ball.size, step_colour(ball.value));
            }
            Next::Face(own) => draw_face(&mut drawing, &faces[own]),
        }
    }
    let title = frames.about.title.as_str();
    let short = cut_to(title, drawing.letters(15.0), sheet.width - LEFT);
    drawing.text((LEFT, 28.0), Anchor::Start, 15.0, &short);
    let words = format!("{} fruit at {} s", frame.fruit.len(), time_of(frame));
    drawing.text((LEFT, 47.0), Anchor::Start, 11.5, &words);
    draw_bar(&mut drawing, most, &sheet);
    draw_axes(&mut drawing, &camera, &sheet);
    Ok(Painting {
        name: "picture".to_owned(),
        caption: format!(
            "{title} at {} s; fruit in the colour of the largest peak force of their contacts so far.",
            time_of(frame)
        ),
        picture: Picture::Drawn(drawing),
        csv: csv_of(frames, frame)?,
    })
}

/// Time of a frame, without the part of a step that it is late; s.
fn time_of(frame: &Frame) -> f64 {
    (frame.time * 1e3).round() / 1e3
}

/// Size of the drawing; px.
struct Sheet {
    width: f64,
    height: f64,
}

impl Sheet {
    fn of(width: Option<Width>) -> Self {
        let width = width.map_or(WIDTH, Width::px);
        Self {
            width,
            height: HIGH * width,
        }
    }

    /// Right and lower end of the scene; px.
    fn ends(&self) -> (f64, f64) {
        (self.width - BESIDE, self.height - BELOW)
    }

    fn pane(&self) -> Pane {
        let (right, bottom) = self.ends();
        Pane {
            middle: (0.5 * (LEFT + right), 0.5 * (TOP + bottom)),
            half: (0.5 * (right - LEFT), 0.5 * (bottom - TOP)),
        }
    }
}

/// What the camera must see: walls, and fruit near them.
fn looked_at(frames: &SceneFrames, frame: &Frame) -> Vec<Vector> {
    let mut points = Vec::new();
    for (wall, pose) in frames.walls.iter().zip(&frame.walls) {
        points.extend(wall.vertices.iter().map(|own| posed(*own, pose)));
    }
    let bounds = &frames.about.bounds;
    let beside = AROUND * bounds.diagonal();
    for own in &frame.fruit {
        let (place, radius) = (own.place.map(f64::from), radius_of(frames, own.fruit));
        if bounds.holds(place, beside) {
            for k in 0..3 {
                for side in [-radius, radius] {
                    let mut point = place;
                    point[k] += side;
                    points.push(point);
                }
            }
        }
    }
    if points.is_empty() {
        points.extend([bounds.low, bounds.high]);
    }
    points
}

fn radius_of(frames: &SceneFrames, fruit: u32) -> f64 {
    let own = frames.radii.get((fruit as usize).wrapping_sub(1));
    own.copied().map_or(0.0, f64::from)
}

fn balls_of(
    frames: &SceneFrames,
    frame: &Frame,
    camera: &Camera,
    (most, sheet): (f64, &Sheet),
) -> Vec<Ball> {
    let (right, bottom) = sheet.ends();
    let ball = |own: &crate::run::frame_format::FruitFrame| {
        let (place, radius) = (own.place.map(f64::from), radius_of(frames, own.fruit));
        let seen = camera.see(place);
        Ball {
            place,
            radius,
            at: seen.at,
            size: camera.radius(radius, seen.depth),
            away: length(subtract(place, camera.eye)),
            value: f64::from(own.peak_force) / most,
        }
    };
    let near = |own: &Ball| {
        let depth = dot(subtract(own.place, camera.eye), camera.forward);
        let inside = own.at.0 > LEFT - own.size
            && own.at.0 < right + own.size
            && own.at.1 > TOP - own.size
            && own.at.1 < bottom + own.size;
        depth > 2.0 * own.radius && inside
    };
    frame.fruit.iter().map(ball).filter(near).collect()
}

/// The colour of a value from 0 to 1, in steps: fruit of one step share a shading.
fn step_colour(value: f64) -> [u8; 3] {
    let step = (value.clamp(0.0, 1.0) * (STEPS - 1) as f64).round();
    colour_of(step / (STEPS - 1) as f64)
}

/// Faces of a wall as they are seen; none of those behind the camera.
fn faces_of(wall: &WallGeometry, points: &[Vector], camera: &Camera) -> Vec<Pane3> {
    let corners = wall.about.corners;
    let normals: Vec<Vector> = wall
        .faces
        .chunks_exact(corners)
        .map(|own| normal_of(points, own))
        .collect();
    let meets = meeting_faces(wall, &normals);
    let mut faces = Vec::new();
    for (number, own) in wall.faces.chunks_exact(corners).enumerate() {
        let corners: Vec<Vector> = own.iter().map(|vertex| points[*vertex as usize]).collect();
        let seen: Vec<_> = corners.iter().map(|point| camera.see(*point)).collect();
        let nearest = seen
            .iter()
            .map(|own| own.depth)
            .fold(f64::INFINITY, f64::min);
        if nearest <= 1e-6 {
            continue;
        }
        faces.push(Pane3 {
            away: length(subtract(middle_of(&corners), camera.eye)),
            at: seen.iter().map(|own| own.at).collect(),
            edges: meets[number * corners.len()..][..corners.len()].to_vec(),
            endless: wall.about.endless,
            hides: false,
            corners,
        });
    }
    faces
}

fn normal_of(points: &[Vector], face: &[u32]) -> Vector {
    let at = |k: usize| points[face[k] as usize];
    let sides = (subtract(at(1), at(0)), subtract(at(face.len() - 1), at(0)));
    unit(cross(sides.0, sides.1)).unwrap_or([0.0; 3])
}

/// Of each edge of each face: whether the surface ends or bends there.
fn meeting_faces(wall: &WallGeometry, normals: &[Vector]) -> Vec<bool> {
    let corners = wall.about.corners;
    // Vertices at one place are one, also where faces have their own.
    let key = |vertex: u32| wall.vertices[vertex as usize].map(f32::to_bits);
    let mut faces: BTreeMap<[[u32; 3]; 2], Vec<usize>> = BTreeMap::new();
    let edge = |face: &[u32], k: usize| {
        let mut ends = [key(face[k]), key(face[(k + 1) % corners])];
        ends.sort_unstable();
        ends
    };
    for (number, face) in wall.faces.chunks_exact(corners).enumerate() {
        for k in 0..corners {
            faces.entry(edge(face, k)).or_default().push(number);
        }
    }
    let each = wall.faces.chunks_exact(corners).flat_map(|face| {
        (0..corners).map(|k| match faces.get(&edge(face, k)).map(Vec::as_slice) {
            Some(&[a, b]) => dot(normals[a], normals[b]).abs() < SMOOTH,
            _ => true,
        })
    });
    each.collect()
}

fn draw_face(drawing: &mut Drawing, face: &Pane3) {
    let opacity = match (face.hides, face.endless) {
        (true, _) => FRONT,
        (false, true) => PLANE,
        (false, false) => FACE,
    };
    drawing.veil(&face.at, Ink::Text, opacity);
    for (k, drawn) in face.edges.iter().enumerate() {
        if *drawn {
            let ends = [face.at[k], face.at[(k + 1) % face.at.len()]];
            drawing.faint_line(ends, Ink::Frame, EDGE);
        }
    }
}

fn draw_bar(drawing: &mut Drawing, most: f64, sheet: &Sheet) {
    let [apart, width, highest] = BAR;
    let (right, bottom) = sheet.ends();
    let (left, height) = (right + apart, highest.min(0.8 * (bottom - TOP)));
    let top = 0.5 * (TOP + bottom - height);
    let colours = (0..STEPS).map(|k| colour_of(k as f64 / (STEPS - 1) as f64));
    let colours: Vec<_> = colours.collect();
    drawing.colour_bar((left, top), (width, height), &colours);
    let scale = axis(0.0, most, 6);
    for (tick, label) in scale.ticks.iter().zip(&scale.labels) {
        let y = top + height * (1.0 - tick / most);
        drawing.rule((left + width, y), (left + width + 4.0, y), Ink::Frame);
        drawing.text((left + width + 7.0, y + 3.5), Anchor::Start, 10.5, label);
    }
    let title = format!("Largest peak force so far{}", unit_label("N", scale.power));
    drawing.turned_text((left + width + 46.0, top + 0.5 * height), 11.5, &title);
}

/// Directions of x, y and z.
fn draw_axes(drawing: &mut Drawing, camera: &Camera, sheet: &Sheet) {
    let origin = (LEFT + 22.0, sheet.height - 34.0);
    let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for (axis, name) in axes.into_iter().zip(["x", "y", "z"]) {
        let (x, y) = camera.direction(axis);
        if x.hypot(y) < 0.2 {
            continue;
        }
        let end = (origin.0 + 22.0 * x, origin.1 + 22.0 * y);
        drawing.polyline(&[origin, end], Ink::Text, 1.1);
        let (x, y) = (origin.0 + 30.0 * x, origin.1 + 30.0 * y + 3.5);
        drawing.text((x, y), Anchor::Middle, 10.5, name);
    }
}

fn csv_of(frames: &SceneFrames, frame: &Frame) -> Result<String, Error> {
    let header = ["fruit", "x_m", "y_m", "z_m", "radius_m", "peak_force_N"];
    let rows = frame.fruit.iter().map(|own| {
        let [x, y, z] = own.place;
        vec![
            own.fruit.to_string(),
            x.to_string(),
            y.to_string(),
            z.to_string(),
            radius_of(frames, own.fruit).to_string(),
            own.peak_force.to_string(),
        ]
    });
    let rows: Vec<Vec<String>> = rows.collect();
    csv_text(&header.map(str::to_owned), rows)
}
