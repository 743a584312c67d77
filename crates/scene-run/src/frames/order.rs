//! Drawing order: near things hide those behind them.

use crate::frames::camera::Camera;
use windfall_scene::vector::{Vector, add, cross, dot, length, scaled, subtract};

/// A ball as it is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    /// Its centre; m.
    pub place: Vector,
    /// Its radius; m.
    pub radius: f64,
    /// Centre in the drawing; px.
    pub at: (f64, f64),
    /// Radius in the drawing; px.
    pub size: f64,
    /// Distance of the centre from the eye; m.
    pub away: f64,
    /// What it shows, from 0 to 1.
    pub value: f64,
}

/// A face of a wall as it is seen.
#[derive(Clone, Debug, PartialEq)]
pub struct Pane3 {
    /// Its corners; m.
    pub corners: Vec<Vector>,
    /// Its corners in the drawing; px.
    pub at: Vec<(f64, f64)>,
    /// Which of the edges from each corner to the next are edges of the wall.
    pub edges: Vec<bool>,
    /// Distance of its middle from the eye; m.
    pub away: f64,
    /// Whether it stands for an endless plane.
    pub endless: bool,
    /// Whether a ball is behind it; [`order`] finds it out.
    pub hides: bool,
}

/// What is drawn next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Next {
    /// The ball of this number.
    Ball(usize),
    /// The face of this number.
    Face(usize),
}

/// Faces smaller than so many radii of a ball are sorted by their distance alone.
const SMALL: f64 = 4.0;

/// The order in which balls and faces are drawn: far ones first. Of a large face its side
/// tells which balls are behind it.
pub fn order(balls: &[Ball], faces: &mut [Pane3], camera: &Camera) -> Vec<Next> {
    let mut sorted: Vec<usize> = (0..balls.len()).collect();
    sorted.sort_by(|a, b| balls[*b].away.total_cmp(&balls[*a].away));
    let mean = balls.iter().map(|own| own.radius).sum::<f64>() / balls.len().max(1) as f64;
    let mut cuts: Vec<(usize, usize)> = Vec::with_capacity(faces.len());
    for (number, face) in faces.iter_mut().enumerate() {
        let extent = face
            .corners
            .iter()
            .map(|own| length(subtract(*own, face.corners[0])));
        let small = extent.fold(0.0, f64::max) < SMALL * mean;
        let cut = match small {
            true => sorted.partition_point(|own| balls[*own].away > face.away),
            false => cut_of(face, balls, &sorted, camera),
        };
        face.hides = sorted[..cut].iter().any(|own| covers(face, &balls[*own]));
        cuts.push((cut, number));
    }
    cuts.sort_by(|a, b| {
        let nearer = faces[b.1].away.total_cmp(&faces[a.1].away);
        a.0.cmp(&b.0).then(nearer)
    });
    let mut all = Vec::with_capacity(balls.len() + faces.len());
    let mut faces = cuts.into_iter().peekable();
    for place in 0..=sorted.len() {
        while let Some((_, number)) = faces.next_if(|own| own.0 <= place) {
            all.push(Next::Face(number));
        }
        all.extend(sorted.get(place).map(|own| Next::Ball(*own)));
    }
    all
}

/// Where in the order of balls a face comes so that as few as can be are on the wrong side.
fn cut_of(face: &Pane3, balls: &[Ball], sorted: &[usize], camera: &Camera) -> usize {
    let corner = face.corners[0];
    let edges = [1, face.corners.len() - 1].map(|k| subtract(face.corners[k], corner));
    let normal = cross(edges[0], edges[1]);
    let side = |point: Vector| dot(subtract(point, corner), normal);
    let eye = side(camera.eye);
    // Balls before the face that are in front of it, and behind it that are behind it.
    let concerned = |own: &&usize| covers(face, &balls[**own]);
    let behind = |own: &usize| side(balls[*own].place) * eye < 0.0;
    let mut wrong = sorted
        .iter()
        .filter(concerned)
        .filter(|own| behind(own))
        .count();
    let (mut best, mut least) = (0, wrong);
    for (place, own) in sorted.iter().enumerate() {
        if covers(face, &balls[*own]) {
            match behind(own) {
                true => wrong -= 1,
                false => wrong += 1,
            }
        }
        if wrong < least || (wrong == least && behind(own)) {
            (best, least) = (place + 1, wrong);
        }
    }
    best
}

/// Whether a ball and a face lie over each other in the drawing.
fn covers(face: &Pane3, ball: &Ball) -> bool {
    let all = &face.at;
    let sides = (0..all.len()).map(|k| {
        let (a, b) = (all[k], all[(k + 1) % all.len()]);
        let (dx, dy) = (b.0 - a.0, b.1 - a.1);
        let off = dx * (ball.at.1 - a.1) - dy * (ball.at.0 - a.0);
        off / dx.hypot(dy).max(f64::MIN_POSITIVE)
    });
    let (low, high) = sides.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), own| {
        (low.min(own), high.max(own))
    });
    // Corners may run either way round.
    low > -ball.size || high < ball.size
}

/// The middle of points.
pub fn middle_of(points: &[Vector]) -> Vector {
    let sum = points.iter().fold([0.0; 3], |sum, own| add(sum, *own));
    scaled(sum, 1.0 / points.len().max(1) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::camera::Pane;

    /// A large face between balls comes between them, whatever their distances from the eye.
    #[test]
    fn closed_form_a_face_hides_what_is_behind_it() {
        let pane = Pane {
            middle: (0.0, 0.0),
            half: (100.0, 100.0),
        };
        let box_of = [[-1.0, -1.0, 0.0], [1.0, 1.0, 1.0]];
        // From the front, y into the picture.
        let camera = Camera::around(&box_of, [-std::f64::consts::FRAC_PI_2, 0.2], pane);
        let ball = |place: Vector| {
            let seen = camera.see(place);
            Ball {
                place,
                radius: 0.05,
                at: seen.at,
                size: camera.radius(0.05, seen.depth),
                away: length(subtract(place, camera.eye)),
                value: 0.0,
            }
        };
        // A wall aslant from near left to far right: a ball behind its near end is nearer to
        // the eye than one before its far end.
        let corners = vec![
            [-1.0, -0.9, 0.0],
            [1.0, 0.9, 0.0],
            [1.0, 0.9, 1.0],
            [-1.0, -0.9, 1.0],
        ];
        let face = Pane3 {
            at: corners.iter().map(|own| camera.see(*own).at).collect(),
            away: length(subtract(middle_of(&corners), camera.eye)),
            edges: vec![true; 4],
            endless: false,
            hides: false,
            corners,
        };
        let balls = [
            ball([-0.8, -0.4, 0.5]),
            ball([0.8, 0.3, 0.5]),
            ball([0.0, 5.0, 0.5]),
        ];
        assert!(balls[0].away < balls[1].away);
        let mut faces = [face];
        let found = order(&balls[..1], &mut faces, &camera);
        assert_eq!(found, [Next::Ball(0), Next::Face(0)]);
        assert!(faces[0].hides);
        let found = order(&balls[1..], &mut faces, &camera);
        assert_eq!(found, [Next::Ball(1), Next::Face(0), Next::Ball(0)]);
    }
}
