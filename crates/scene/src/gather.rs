//! Forces on each body added up, and where they take it.

use crate::contact::{Moment, Outcome};
use crate::error::Error;
use crate::interaction::Interaction;
use crate::neighbours::{NONE, PairTable};
use crate::pair_forces::{PairForce, moment_on};
use crate::scene::Scene;
use crate::vector::{Rotation, Vector, add, dot, length, plus_scaled, scaled, subtract, turned_on};
use crate::wall_contacts::{Body, WallContact, WallState, push};

/// Way in one step over the radius above which contacts are missed; 1.
const LONGEST_WAY: f64 = 0.2;

/// Sums over a block.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Sums {
    /// Square of the largest way since the list was made; m².
    pub moved: f64,
    pub drag: f64,
    pub walls: f64,
    pub kinetic: f64,
    pub rotational: f64,
    pub potential: f64,
}

/// What is known when forces on bodies are added up.
pub(crate) struct Gather<'a> {
    pub table: &'a PairTable,
    pub loads: &'a [[f64; 8]],
    pub forces: &'a [PairForce],
    pub rolling: &'a [Vector],
    pub scene: &'a Scene,
    pub surfaces: &'a [Interaction],
    pub numbers: &'a [usize],
    pub walls: &'a WallState,
    pub near: (&'a [u32], &'a [u32]),
    /// Numbers and materials of the bodies.
    pub bodies: (&'a [u32], &'a [u32]),
    pub listed: &'a [Vector],
    pub with_energy: bool,
}

impl Gather<'_> {
    pub(crate) fn block(
        &self,
        start: usize,
        place: &mut [[f64; 4]],
        motion: &mut [[f64; 8]],
        turn: &mut [Rotation],
        walls: &mut [Vec<WallContact>],
        now: &Moment,
    ) -> (Outcome, Sums) {
        let mut outcome = Outcome::default();
        let mut sums = Sums::default();
        let mut hits = Vec::new();
        let materials = self.scene.materials.len();
        let step = now.clock.step;
        for own in 0..place.len() {
            let body = start + own;
            let [x, y, z, radius] = place[own];
            let m = &mut motion[own];
            let (mut force, mut moment) = self.of_pairs(body, radius);
            let material = self.bodies.1[body] as usize;
            let near = &self.near.0[self.near.1[body] as usize..self.near.1[body + 1] as usize];
            if !near.is_empty() || !walls[own].is_empty() {
                let surface = |wall: u32| {
                    let other = self.scene.walls[wall as usize].material;
                    &self.surfaces[self.numbers[material * materials + other]]
                };
                let body = Body {
                    fruit: self.bodies.0[body],
                    centre: [x, y, z],
                    radius,
                    velocity: [m[0], m[1], m[2]],
                    spin: [m[4], m[5], m[6]],
                    turn: turn[own],
                };
                let (contacts, near) = (&mut walls[own], (self.walls, near));
                let pushed = push(contacts, &body, near, surface, now, &mut hits, &mut outcome);
                force = add(force, pushed.force);
                moment = add(moment, pushed.moment);
                sums.walls += pushed.work;
            }
            if let Some(air) = self.scene.air {
                let velocity = [m[0], m[1], m[2]];
                let area = std::f64::consts::PI * radius * radius;
                let drag = 0.5 * air.density * air.drag_coefficient * area * length(velocity);
                force = plus_scaled(force, velocity, -drag);
                sums.drag += drag * dot(velocity, velocity) * step;
            }
            let acceleration = plus_scaled(self.scene.gravity, force, m[3]);
            let angular = scaled(moment, m[7]);
            if self.with_energy {
                let velocity = plus_scaled([m[0], m[1], m[2]], acceleration, 0.5 * step);
                let spin = plus_scaled([m[4], m[5], m[6]], angular, 0.5 * step);
                sums.kinetic += 0.5 * dot(velocity, velocity) / m[3];
                sums.rotational += 0.5 * dot(spin, spin) / m[7];
                sums.potential -= dot(self.scene.gravity, [x, y, z]) / m[3];
            }
            for axis in 0..3 {
                m[axis] += step * acceleration[axis];
                m[4 + axis] += step * angular[axis];
                place[own][axis] += step * m[axis];
            }
            turn[own] = turned_on(turn[own], [m[4], m[5], m[6]], step);
            let [x, y, z, _] = place[own];
            let way = subtract([x, y, z], self.listed[body]);
            let square = dot(way, way);
            sums.moved = sums.moved.max(square);
            let speed = dot([m[0], m[1], m[2]], [m[0], m[1], m[2]]);
            let limit = LONGEST_WAY * radius;
            let short = speed * step * step <= limit * limit;
            if !short {
                let fruit = self.bodies.0[body];
                let (time, speed) = (now.clock.time, speed.sqrt());
                let share = 100.0 * speed * step / radius;
                outcome.problem.get_or_insert(match speed.is_finite() {
                    true => Error::Speed {
                        time,
                        fruit,
                        speed,
                        share,
                    },
                    false => Error::NotFinite { time, fruit },
                });
            }
        }
        (outcome, sums)
    }

    /// Force and moment of all pairs on a body: those of its block, then those of others in
    /// the order of the list.
    #[inline(always)]
    fn of_pairs(&self, body: usize, radius: f64) -> (Vector, Vector) {
        let own = &self.loads[body];
        let (mut force, mut moment) = ([own[0], own[1], own[2]], [own[4], own[5], own[6]]);
        for &entry in self.table.incoming(body) {
            let entry = entry as usize;
            if self.table.slot[entry] == NONE {
                continue;
            }
            let out = &self.forces[entry];
            force = subtract(force, out.force);
            moment = moment_on(out, radius, moment);
            if let Some(rolling) = self.rolling.get(entry) {
                moment = subtract(moment, *rolling);
            }
        }
        (force, moment)
    }
}
