//! A scene whose fruit another engine moves.
//!
//! Its frames say where the fruit are; the contacts, with their forces, work and events, are
//! computed here, by the same code as in a scene of its own.

use crate::energy::Energy;
use crate::error::Error;
use crate::line::HalfLine;
use crate::motion::simulation::{FruitState, Leaving, Simulation};
use crate::scene::Fruit;
use crate::vector::{Vector, add, dot, length, plus_scaled, scaled, subtract, turned_on};

/// Where each fruit was in the frame before, by its number.
#[derive(Clone, Debug, Default)]
pub struct Followed {
    last: Vec<Option<FruitState>>,
}

impl Simulation {
    /// One frame on: a time step in which fruit go where they are said to be. Fruit that are
    /// new come in, those that are missing have left. The time step of the scene is the time
    /// between frames; contacts are as exact as many frames fall into one.
    ///
    /// The velocity that a contact is computed with is that between two frames, which is of
    /// second order in their distance.
    ///
    /// * `frame`: by number, with velocities at the time of the places
    ///
    /// # Errors
    /// See [`Simulation::step`]; a fruit has a number that the scene has not, or is missing
    /// and no sink is there.
    pub fn follow(
        &mut self,
        frame: &[FruitState],
        followed: &mut Followed,
    ) -> Result<Energy, Error> {
        followed.last.resize(self.scene.fruit.len(), None);
        let mut next: Vec<Option<FruitState>> = vec![None; self.scene.fruit.len()];
        for own in frame {
            let place = next.get_mut(own.fruit as usize);
            *place.ok_or(Error::Value {
                what: "the number of a fruit in a frame",
                value: f64::from(own.fruit) + 1.0,
                problem: "the scene has not so many",
            })? = Some(*own);
        }
        self.leave(&next, followed)?;
        self.come(&next, followed);
        self.go(&mut next, followed);
        followed.last = next;
        self.push(true)
    }

    /// Removes fruit that are missing in a frame.
    fn leave(&mut self, next: &[Option<FruitState>], followed: &Followed) -> Result<(), Error> {
        let (gravity, time) = (self.scene.gravity, self.time());
        let mut keep = Vec::with_capacity(self.bodies.len());
        for body in 0..self.bodies.len() {
            let fruit = self.bodies.fruit[body];
            let before = followed.last[fruit as usize];
            // One that came in with the scene and was not yet seen is waited for.
            let Some(state) = before.filter(|_| next[fruit as usize].is_none()) else {
                keep.push(body);
                continue;
            };
            let sink = self.sink_of(&state)?;
            self.account.brought -= brought(&self.scene.fruit[fruit as usize], &state, gravity);
            self.taken.push(Leaving { fruit, time, sink });
        }
        if keep.len() < self.bodies.len() {
            self.end_contacts_without(&keep);
            self.rebuild();
        }
        Ok(())
    }

    /// The sink through which a fruit has left that is gone.
    pub(crate) fn sink_of(&self, last: &FruitState) -> Result<usize, Error> {
        let far = |own: Vector, sink: usize| {
            let sink = &self.scene.sinks[sink];
            let off = [0, 1, 2].map(|axis| own[axis].clamp(sink.low[axis], sink.high[axis]));
            length(subtract(own, off))
        };
        let nearest = (0..self.scene.sinks.len())
            .min_by(|&a, &b| far(last.place, a).total_cmp(&far(last.place, b)));
        nearest.ok_or(Error::Value {
            what: "the number of a fruit that is gone",
            value: f64::from(last.fruit) + 1.0,
            problem: "the engine lost it: there is no sink through which it could leave",
        })
    }

    /// Adds fruit that are new in a frame.
    fn come(&mut self, next: &[Option<FruitState>], followed: &Followed) {
        let (gravity, step) = (self.scene.gravity, self.scene.time_step);
        let mut there = vec![false; next.len()];
        for &fruit in &self.bodies.fruit {
            there[fruit as usize] = true;
        }
        let mut came = false;
        for state in next.iter().flatten() {
            let fruit = &self.scene.fruit[state.fruit as usize];
            if there[state.fruit as usize] || followed.last[state.fruit as usize].is_some() {
                continue;
            }
            self.account.brought += brought(fruit, state, gravity);
            self.enter(&FruitState {
                velocity: plus_scaled(state.velocity, gravity, -0.5 * step),
                turn: Fruit::ORIENTATION,
                ..*state
            });
            self.released = self.released.max(state.fruit as usize + 1);
            came = true;
        }
        if came {
            self.rebuild();
        }
    }

    /// Moves all bodies to their places in the frame.
    fn go(&mut self, next: &mut [Option<FruitState>], followed: &Followed) {
        let step = self.scene.time_step;
        let mut moved = 0.0_f64;
        for body in 0..self.bodies.len() {
            let fruit = self.bodies.fruit[body] as usize;
            let Some(state) = &mut next[fruit] else {
                continue;
            };
            let [x, y, z] = state.place;
            let radius = self.bodies.place[body][3];
            self.bodies.place[body] = HalfLine([x, y, z, radius]);
            if let Some(before) = &followed.last[fruit] {
                let velocity = scaled(subtract(state.place, before.place), 1.0 / step);
                let spin = scaled(add(state.spin, before.spin), 0.5);
                self.bodies.motion[body][..3].copy_from_slice(&velocity);
                self.bodies.motion[body][4..7].copy_from_slice(&spin);
                self.bodies.turn[body] = turned_on(before.turn, spin, step);
            }
            state.turn = self.bodies.turn[body];
            let [x, y, z, _] = self.listed[body].0;
            let listed = [x, y, z];
            let way = subtract(state.place, listed);
            moved = moved.max(dot(way, way));
        }
        let moved = moved.sqrt();
        (self.moved, self.approach) = (moved, 2.0 * moved);
        self.ways.fill([moved; 2]);
    }
}

/// Energy that a fruit brings into a scene; J.
pub(crate) fn brought(fruit: &Fruit, state: &FruitState, gravity: Vector) -> f64 {
    0.5 * fruit.mass * dot(state.velocity, state.velocity)
        + 0.5 * fruit.inertia() * dot(state.spin, state.spin)
        - fruit.mass * dot(gravity, state.place)
}
