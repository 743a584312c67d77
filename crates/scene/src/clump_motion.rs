//! How clumps of spheres move.

use crate::clump::Clump;
use crate::gather::Sums;
use crate::law_column::Four;
use crate::neighbours::Bodies;
use crate::scene::{Air, Fruit};
use crate::store::Load;
use crate::vector::{
    Rotation, Vector, add, cross, dot, length, plus_scaled, scaled, subtract, turned, turned_back,
    turned_on,
};
use std::f64::consts::PI;
use windfall_numerics::real::Lanes;

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
    pub listed: &'a [Four],
    pub loads: &'a [Load],
}

impl ClumpState {
    /// A clump that comes in, and where its spheres are.
    pub(crate) fn new(number: u32, fruit: &Fruit, own: &Clump, velocity: Vector) -> Self {
        let inward = turned_back(own.turn, fruit.spin);
        let momentum = [0, 1, 2].map(|axis| own.moments[axis] * inward[axis]);
        Self {
            fruit: number,
            place: fruit.place,
            velocity,
            turn: own.turn,
            momentum: turned(own.turn, momentum),
            spin: fruit.spin,
            bodies: Vec::new(),
        }
    }

    /// From the centre to a point of the body, as it is turned now; m.
    pub(crate) fn arm(&self, offset: Vector) -> Vector {
        turned(self.turn, offset)
    }

    /// Velocity of a point; m/s.
    pub(crate) fn velocity_at(&self, arm: Vector) -> Vector {
        add(self.velocity, cross(self.spin, arm))
    }

    /// Energy of rotation; J.
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
            let arm = self.arm(bodies.offset[body as usize]);
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
        let spin_of = |momentum: Vector, turn: Rotation| {
            let inward = turned_back(turn, momentum);
            turned(
                turn,
                [0, 1, 2].map(|axis| inward[axis] / shape.moments[axis]),
            )
        };
        let now = plus_scaled(self.momentum, moment, 0.5 * step);
        let spin = spin_of(now, self.turn);
        let velocity = plus_scaled(self.velocity, acceleration, 0.5 * step);
        sums.kinetic += 0.5 * fruit.mass * dot(velocity, velocity);
        sums.rotational += 0.5 * dot(now, spin);
        sums.potential -= fruit.mass * dot(around.gravity, self.place);
        let between = turned_on(self.turn, spin, 0.5 * step);
        self.momentum = plus_scaled(self.momentum, moment, step);
        self.spin = spin_of(self.momentum, between);
        self.turn = turned_on(self.turn, self.spin, step);
        self.velocity = plus_scaled(self.velocity, acceleration, step);
        self.place = plus_scaled(self.place, self.velocity, step);
        for &body in &self.bodies {
            let body = body as usize;
            let [x, y, z, radius] = bodies.place[body];
            let next = add(self.place, self.arm(bodies.offset[body]));
            // The step before was taken without knowing of the clump: its velocity is not.
            let before = subtract([x, y, z], scaled(motion_of(bodies, body), step));
            let [u, v, w] = scaled(subtract(next, before), 1.0 / step);
            let [p, q, r] = self.spin;
            let ([a, b, c], m) = (next, &mut bodies.motion[body]);
            bodies.place[body] = [a, b, c, radius];
            *m = [u, v, w, m[3], p, q, r, m[7]];
            bodies.turn[body] = self.turn;
            let Lanes([a, b, c, _]) = around.listed[body];
            let way = subtract(next, [a, b, c]);
            sums.moved = sums.moved.max(dot(way, way));
        }
    }
}

fn motion_of(bodies: &Bodies, body: usize) -> Vector {
    let m = &bodies.motion[body];
    [m[0], m[1], m[2]]
}
