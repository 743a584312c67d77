//! A perspective camera that sees the whole scene.

use windfall_scene::vector::{Vector, add, cross, dot, plus_scaled, scaled, subtract, unit};

/// Half of the field of view across the longer side; rad. That of a moderate telephoto lens:
/// what is near is larger, but not by much.
const HALF_FIELD: f64 = 0.23;

/// Rounds of bringing what is seen into the middle.
const ROUNDS: usize = 12;

/// A part of a drawing; px.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pane {
    pub middle: (f64, f64),
    /// Half of its width and height.
    pub half: (f64, f64),
}

/// A camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Where it is; m.
    pub eye: Vector,
    /// To the right, up, and into the picture; length 1.
    pub right: Vector,
    /// Up in the picture.
    pub up: Vector,
    /// Into the picture.
    pub forward: Vector,
    /// px of what is as wide as it is away.
    focal: f64,
    middle: (f64, f64),
}

/// A point as it is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// Where in the drawing; px.
    pub at: (f64, f64),
    /// How far into the picture; m. Behind the camera below zero.
    pub depth: f64,
}

impl Camera {
    /// A camera that has all points in its pane.
    ///
    /// * `from`: where it stands as seen from the scene: azimuth from x towards y, elevation
    ///   above the ground; rad
    pub fn around(points: &[Vector], from: [f64; 2], pane: Pane) -> Self {
        let [(sa, ca), (se, ce)] = from.map(f64::sin_cos);
        let forward = scaled([ca * ce, sa * ce, se], -1.0);
        // Right stays level, also for a view from straight above.
        let right = unit([-sa, ca, 0.0]).unwrap_or([1.0, 0.0, 0.0]);
        let up = cross(right, forward);
        let longer = pane.half.0.max(pane.half.1);
        let focal = longer / HALF_FIELD.tan();
        let bounds = crate::geometry::Bounds::around(points.iter().copied());
        let mut target = bounds.middle();
        let size = bounds.diagonal().max(1e-3);
        let (across, high) = (pane.half.0 / focal, pane.half.1 / focal);
        let mut away = size;
        for _ in 0..ROUNDS {
            away = points
                .iter()
                .map(|point| {
                    let from = subtract(*point, target);
                    let (x, y, z) = (dot(from, right), dot(from, up), dot(from, forward));
                    (x.abs() / across).max(y.abs() / high) - z
                })
                .fold(0.05 * size, f64::max);
            let (mut low, mut top) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
            for point in points {
                let from = subtract(*point, target);
                let depth = (away + dot(from, forward)).max(f64::MIN_POSITIVE);
                for (k, axis) in [right, up].into_iter().enumerate() {
                    let own = dot(from, axis) / depth;
                    low[k] = low[k].min(own);
                    top[k] = top[k].max(own);
                }
            }
            for (k, axis) in [right, up].into_iter().enumerate() {
                let off = 0.5 * (low[k] + top[k]) * away;
                if off.is_finite() {
                    target = plus_scaled(target, axis, off);
                }
            }
        }
        Self {
            eye: plus_scaled(target, forward, -away),
            right,
            up,
            forward,
            focal,
            middle: pane.middle,
        }
    }

    /// A point as it is seen.
    pub fn see(&self, point: Vector) -> Seen {
        let from = subtract(point, self.eye);
        let depth = dot(from, self.forward);
        let scale = self.focal / depth;
        Seen {
            at: (
                self.middle.0 + scale * dot(from, self.right),
                self.middle.1 - scale * dot(from, self.up),
            ),
            depth,
        }
    }

    /// Radius of a ball in the drawing; px.
    pub fn radius(&self, radius: f64, depth: f64) -> f64 {
        let beyond = (depth * depth - radius * radius).max(f64::MIN_POSITIVE);
        self.focal * radius / beyond.sqrt()
    }

    /// A direction of space in the drawing, as if seen from far away; px of a length of 1.
    pub fn direction(&self, along: Vector) -> (f64, f64) {
        (dot(along, self.right), -dot(along, self.up))
    }
}

/// A point that a wall's pose turns and shifts.
pub fn posed(point: [f32; 3], pose: &crate::run::frame_format::WallFrame) -> Vector {
    let turn = pose.turn.map(f64::from);
    let shift = pose.shift.map(f64::from);
    add(
        windfall_scene::vector::turned(turn, point.map(f64::from)),
        shift,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All points are in the pane, the outermost at its border, and what is nearer is larger.
    #[test]
    fn closed_form_the_camera_sees_all_and_fills_the_pane() {
        let pane = Pane {
            middle: (300.0, 200.0),
            half: (280.0, 180.0),
        };
        let mut points = Vec::new();
        for x in [-0.6, 0.6] {
            for y in [0.0, 0.5] {
                for z in [-0.3, 0.6] {
                    points.push([x, y, z]);
                }
            }
        }
        for from in [
            [-1.0, 0.4],
            [0.0, 0.0],
            [2.0, 1.5],
            [0.3, std::f64::consts::FRAC_PI_2],
        ] {
            let camera = Camera::around(&points, from, pane);
            let mut most: f64 = 0.0;
            for point in &points {
                let seen = camera.see(*point);
                let off = [
                    (seen.at.0 - 300.0).abs() / 280.0,
                    (seen.at.1 - 200.0).abs() / 180.0,
                ];
                assert!(
                    seen.depth > 0.0 && off[0] < 1.001 && off[1] < 1.001,
                    "{seen:?}"
                );
                most = most.max(off[0]).max(off[1]);
            }
            assert!(most > 0.97, "{from:?}: {most}");
            assert!(camera.radius(0.1, 2.0) > camera.radius(0.1, 3.0));
        }
        // From the front: x to the right, z up.
        let camera = Camera::around(&points, [-std::f64::consts::FRAC_PI_2, 0.0], pane);
        let (a, b) = (camera.see([0.1, 0.2, 0.3]), camera.see([0.3, 0.2, 0.5]));
        assert!(b.at.0 > a.at.0 && b.at.1 < a.at.1);
    }
}
