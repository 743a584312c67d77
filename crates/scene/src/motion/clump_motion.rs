//! How clumps of spheres move.

use crate::contacts::bodies::Bodies;
use crate::contacts::store::Load;
use crate::line::{HalfLine, Line};
use crate::motion::gather::{PART_OF_CLUMP, Sums};
use crate::scene::{Air, Fruit};
use crate::shape::clump::Clump;
use crate::vector::{
    Rotation, Vector, add, cross, dot, length, plus_scaled, subtract, turned, turned_on,
};
use std::f64::consts::PI;
use windfall_numerics::real::Lanes;
use windfall_numerics::real_vector::Row;

/// A clump in a scene that runs.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ClumpState {
    /// Number of the fruit.
    pub fruit: u32,
    /// Its centre; m.
    pub place: Vector,
    /// Half a step ago; m/s.
    pub velocity: Vector,
    pub turn: Rotation,
    /// Angular momentum half a step ago; kg m²/s.
    pub momentum: Vector,
    /// Half a step ago; rad/s.
    pub spin: Vector,
    /// Its spheres among the bodies.
    pub bodies: Vec<u32>,
}

/// What every clump of a step needs to know.
pub(crate) struct Around<'a> {
    pub fruit: &'a [Fruit],
    pub gravity: Vector,
    pub air: Option<Air>,
    pub step: f64,
    pub listed: &'a [Row],
    pub loads: &'a [Load],
}

impl ClumpState {
    /// The clump of a fruit; its spheres are not among the bodies yet.
    ///
    /// * `place`, m; `velocity`, m/s, and `spin`, rad/s: half a step ago
    pub fn new(
        shape: &Clump,
        fruit: u32,
        [place, velocity, spin]: [Vector; 3],
        turn: Rotation,
    ) -> Self {
        Self {
            fruit,
            place,
            velocity,
            turn,
            momentum: shape.momentum(turn, spin),
            spin,
            bodies: vec![0; shape.spheres.len()],
        }
    }

    /// Where a sphere is, m, and its velocity half a step ago, m/s.
    pub(crate) fn sphere(&self, offset: Vector, step: f64) -> (Vector, Vector) {
        let before = turned_on(self.turn, self.spin, -0.5 * step);
        let place = add(self.place, turned(self.turn, offset));
        let velocity = add(self.velocity, cross(self.spin, turned(before, offset)));
        (place, velocity)
    }

    /// Energy of rotation half a step ago; J.
    pub(crate) fn rotational(&self) -> f64 {
        0.5 * dot(self.momentum, self.spin)
    }

    /// One step on: of second order in the step, by angular momenta at half steps.
    ///
    /// # Source
    /// Fincham (1992), Mol. Simul. 8, 165 (explicit leapfrog of quaternions).
    pub(crate) fn go(&mut self, around: &Around, bodies: &mut Bodies, sums: &mut Sums) {
        let fruit = &around.fruit[self.fruit as usize];
        let Some(shape) = &fruit.clump else {
            return;
        };
        let step = around.step;
        let (mut force, mut moment) = ([0.0; 3], [0.0; 3]);
        for &body in &self.bodies {
            let load = &around.loads[body as usize];
            let own = [load[0], load[1], load[2]];
            let arm = turned(self.turn, bodies.offset[body as usize]);
            force = add(force, own);
            moment = add(moment, add([load[4], load[5], load[6]], cross(arm, own)));
        }
        if let Some(air) = around.air {
            // As of a sphere of the same volume.
            let area = PI * (shape.volume(fruit.mass) * 0.75 / PI).powf(2.0 / 3.0);
            let speed = length(self.velocity);
            let drag = 0.5 * air.density * air.drag_coefficient * area * speed;
            force = plus_scaled(force, self.velocity, -drag);
            sums.drag += drag * speed * speed * step;
        }
        let acceleration = plus_scaled(around.gravity, force, 1.0 / fruit.mass);
        let now = plus_scaled(self.momentum, moment, 0.5 * step);
        let spin = shape.spin(self.turn, now);
        let velocity = plus_scaled(self.velocity, acceleration, 0.5 * step);
        sums.kinetic += 0.5 * fruit.mass * dot(velocity, velocity);
        sums.rotational += 0.5 * dot(now, spin);
        sums.potential -= fruit.mass * dot(around.gravity, self.place);
        let between = turned_on(self.turn, spin, 0.5 * step);
        self.momentum = plus_scaled(self.momentum, moment, step);
        self.spin = shape.spin(between, self.momentum);
        self.turn = turned_on(self.turn, self.spin, step);
        self.velocity = plus_scaled(self.velocity, acceleration, step);
        self.place = plus_scaled(self.place, self.velocity, step);
        for &body in &self.bodies {
            let body = body as usize;
            let (place, velocity) = self.sphere(bodies.offset[body], step);
            let ([x, y, z], [u, v, w], [p, q, r]) = (place, velocity, self.spin);
            let radius = bodies.place[body][3];
            bodies.place[body] = HalfLine([x, y, z, radius]);
            bodies.motion[body] = Line([u, v, w, PART_OF_CLUMP, p, q, r, PART_OF_CLUMP]);
            bodies.turn[body] = self.turn;
            let Lanes([a, b, c, _]) = around.listed[body];
            let way = subtract(place, [a, b, c]);
            sums.moved[0] = sums.moved[0].max(dot(way, way));
        }
    }
}
