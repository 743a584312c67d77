//! Fruit that come into a scene and leave it.

use crate::contacts::store::NONE;
use crate::error::{Error, fruit_name};
use crate::event::{Event, Partner};
use crate::line::{HalfLine, Line};
use crate::motion::clump_motion::ClumpState;
use crate::motion::gather::PART_OF_CLUMP;
use crate::motion::simulation::{FruitState, Leaving, Simulation};
use crate::scene::Fruit;
use crate::vector::{Vector, dot, length, plus_scaled, subtract};

/// Overlap over the radius that fruit may have at the beginning; 1.
const ROOM: f64 = 0.01;

/// Places that are tried for a fruit in a step.
const ATTEMPTS: u64 = 8;

/// Multiples of these, without their whole parts, are spread evenly over a cube: powers of
/// the inverse of the root of x⁴ = x + 1, by Roberts (2018), "The unreasonable effectiveness
/// of quasirandom sequences".
const SPREAD_OUT: [f64; 3] = [
    0.819_172_513_396_164_4,
    0.671_043_606_703_789_3,
    0.549_700_477_901_970_3,
];

/// Where a fruit comes in: a box, or a place.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Source([Vector; 2]);

impl Source {
    fn of(fruit: &Fruit) -> Self {
        Self(fruit.elsewhere.unwrap_or([fruit.place; 2]))
    }
}

impl Simulation {
    /// Whether fruit are to come in now, or wait for room.
    pub(crate) fn due(&self) -> bool {
        self.comes_next() || !self.held.is_empty()
    }

    fn comes_next(&self) -> bool {
        let next = self.scene.fruit.get(self.released);
        next.is_some_and(|fruit| fruit.time <= self.time())
    }

    /// Releases the fruit that are due. One that finds no room waits until there is some, and all
    /// that come in at the same place wait behind it.
    pub(crate) fn release(&mut self) -> Result<(), Error> {
        let (step, gravity) = (self.scene.time_step, self.scene.gravity);
        let mut due = std::mem::take(&mut self.held);
        while self.comes_next() {
            due.push(self.released as u32);
            self.released += 1;
        }
        let mut taken: Vec<Source> = Vec::new();
        let mut came = false;
        for number in due {
            let source = Source::of(&self.scene.fruit[number as usize]);
            if taken.contains(&source) {
                self.held.push(number);
                continue;
            }
            if self.in_the_way(&self.scene.fruit[number as usize]) {
                let Some(place) = self.another_place(&self.scene.fruit[number as usize]) else {
                    self.held.push(number);
                    taken.push(source);
                    continue;
                };
                self.scene.fruit[number as usize].place = place;
            }
            let fruit = &self.scene.fruit[number as usize];
            self.account.brought += 0.5 * fruit.mass * dot(fruit.velocity, fruit.velocity)
                - fruit.mass * dot(gravity, fruit.place);
            self.account.brought += match &fruit.clump {
                None => 0.5 * fruit.inertia() * dot(fruit.spin, fruit.spin),
                Some(own) => own.rotational(own.turn, fruit.spin),
            };
            let turn = fruit.clump.as_ref().map(|own| own.turn);
            self.enter(&FruitState {
                fruit: number,
                place: fruit.place,
                velocity: plus_scaled(fruit.velocity, gravity, -0.5 * step),
                spin: fruit.spin,
                turn: turn.unwrap_or(Fruit::ORIENTATION),
            });
            came = true;
        }
        if came {
            self.rebuild();
        }
        Ok(())
    }

    /// Fruit that should have come in by now, and found no room.
    pub fn waiting(&self) -> usize {
        let (time, still_to_come) = (self.time(), &self.scene.fruit[self.released..]);
        self.held.len() + still_to_come.iter().filter(|own| own.time < time).count()
    }

    /// One fruit more; the list of neighbours does not know it yet.
    ///
    /// * `state`: velocity half a step ago
    pub(crate) fn enter(&mut self, state: &FruitState) {
        let fruit = &self.scene.fruit[state.fruit as usize];
        let sphere = ([0.0; 3], fruit.radius);
        let (spheres, inverse) = match &fruit.clump {
            None => (
                std::slice::from_ref(&sphere),
                [1.0 / fruit.mass, 1.0 / fruit.inertia()],
            ),
            Some(own) => (&own.spheres[..], [PART_OF_CLUMP; 2]),
        };
        let own = fruit.clump.as_ref().map(|own| {
            let motion = [state.place, state.velocity, state.spin];
            ClumpState::new(own, state.fruit, motion, state.turn)
        });
        let clump = own.as_ref().map_or(NONE, |_| self.clumps.len() as u32);
        for (number, &(offset, radius)) in spheres.iter().enumerate() {
            let (place, velocity) = match &own {
                None => (state.place, state.velocity),
                Some(own) => own.sphere(offset, self.scene.time_step),
            };
            let ([x, y, z], [u, v, w], [a, b, c]) = (place, velocity, state.spin);
            let bodies = &mut self.bodies;
            bodies.place.push(HalfLine([x, y, z, radius]));
            let motion = [u, v, w, inverse[0], a, b, c, inverse[1]];
            bodies.motion.push(Line(motion));
            bodies.turn.push(state.turn);
            bodies.fruit.push(state.fruit);
            bodies.material.push(fruit.material as u32);
            bodies.clump.push(clump);
            bodies.sphere.push(number as u32);
            bodies.offset.push(offset);
            bodies.lifted.push(Vec::new());
        }
        self.clumps.extend(own);
    }

    /// Whether the fruit of the beginning have room.
    pub(crate) fn check_room(&self) -> Result<(), Error> {
        let places = &self.bodies.place;
        for (&first, &second) in self.table.first.iter().zip(&self.table.second) {
            let (a, b) = (places[first as usize], places[second as usize]);
            let overlap = self.bodies.overlap([first, second]);
            if overlap > ROOM * a[3].min(b[3]) {
                return Err(Error::Occupied {
                    fruit: self.bodies.fruit[first as usize],
                    place: [a[0], a[1], a[2]],
                    partner: fruit_name(self.bodies.fruit[second as usize]),
                    overlap,
                });
            }
        }
        Ok(())
    }

    /// A place where nothing is, among some that are spread over where a fruit may come in;
    /// other ones in each step.
    fn another_place(&self, fruit: &Fruit) -> Option<Vector> {
        let [low, high] = fruit.elsewhere?;
        let mut own = fruit.clone();
        for attempt in 0..ATTEMPTS {
            let number = (self.steps % 65_536 * ATTEMPTS + attempt) as f64;
            for axis in 0..3 {
                let share = (number * SPREAD_OUT[axis]).fract();
                own.place[axis] = low[axis] + (high[axis] - low[axis]) * share;
            }
            own.place = self.bodies.periods.wrapped(own.place);
            if !self.in_the_way(&own) {
                return Some(own.place);
            }
        }
        None
    }

    /// Whether a fruit, or a wall that has moved there, occupies a release place. Those of the
    /// beginning are checked together.
    fn in_the_way(&self, fruit: &Fruit) -> bool {
        let overlaps = |&HalfLine([x, y, z, radius]): &HalfLine| {
            let between = subtract([x, y, z], fruit.place);
            length(self.bodies.periods.nearest(between)) < radius + fruit.radius
        };
        self.steps > 0
            && (self.bodies.place.iter().any(overlaps)
                || self.walls.moved_into(fruit.place, fruit.radius))
    }

    /// Removes fruit that are in a sink.
    pub(crate) fn sink(&mut self) {
        let time = self.time();
        let gravity = self.scene.gravity;
        let sink_of = |place: Vector| {
            let periods = &self.bodies.periods;
            let mut sinks = self.scene.sinks.iter();
            sinks.position(|sink| sink.holds(place, periods))
        };
        let mut keep = Vec::with_capacity(self.bodies.len());
        let mut gone = Vec::new();
        for body in 0..self.bodies.len() {
            let clump = self.clumps.get(self.bodies.clump[body] as usize);
            let HalfLine([x, y, z, _]) = self.bodies.place[body];
            let place = clump.map_or([x, y, z], |own| own.place);
            let Some(sink) = sink_of(place) else {
                keep.push(body);
                continue;
            };
            // Each clump counts once, by its first sphere.
            if self.bodies.sphere[body] > 0 {
                continue;
            }
            let fruit = self.bodies.fruit[body];
            let own = &self.scene.fruit[fruit as usize];
            let m = &self.bodies.motion[body];
            let (velocity, rotational) = match clump {
                Some(clump) => (clump.velocity, clump.rotational()),
                None => {
                    let spin = [m[4], m[5], m[6]];
                    ([m[0], m[1], m[2]], 0.5 * own.inertia() * dot(spin, spin))
                }
            };
            let velocity = plus_scaled(velocity, gravity, 0.5 * self.scene.time_step);
            let moving = 0.5 * own.mass * dot(velocity, velocity) + rotational;
            gone.push((
                moving - own.mass * dot(gravity, place),
                Leaving { fruit, time, sink },
            ));
        }
        for (energy, leaving) in gone {
            self.account.brought -= energy;
            self.taken.push(leaving);
        }
        if keep.len() < self.bodies.len() {
            self.end_contacts_without(&keep);
            self.rebuild();
        }
    }

    /// Ends contacts of bodies that are not kept, and leaves only those that are.
    pub(crate) fn end_contacts_without(&mut self, keep: &[usize]) {
        let mut place = vec![NONE; self.bodies.len()];
        for (new, &old) in keep.iter().enumerate() {
            place[old] = new as u32;
        }
        let mut left = vec![true; self.released];
        for &body in keep {
            left[self.bodies.fruit[body] as usize] = false;
        }
        let mut ended = Vec::new();
        for event in self.lasting() {
            let gone = |fruit: u32| left[fruit as usize];
            let other = match event.partner {
                Partner::Fruit(other) => gone(other),
                Partner::Wall(_) => false,
            };
            if gone(event.fruit) || other {
                ended.push(Event {
                    lasting: false,
                    ..event
                });
            }
        }
        for event in ended {
            self.account.normal += event.absorbed_energy;
            self.account.friction += event.friction_energy;
            self.events.push(event);
        }
        self.lift();
        let mut table = std::mem::take(&mut self.table);
        let old: Vec<(u32, u32)> = table
            .first
            .iter()
            .copied()
            .zip(table.second.iter().copied())
            .collect();
        // Contacts of what is gone are dropped with their entries.
        table.first = old.iter().map(|pair| place[pair.0 as usize]).collect();
        table.second = old.iter().map(|pair| place[pair.1 as usize]).collect();
        self.table = table;
        let bodies = &mut self.bodies;
        let kept = |old: usize| place[old] != NONE;
        retain(&mut bodies.place, kept);
        retain(&mut bodies.motion, kept);
        retain(&mut bodies.turn, kept);
        retain(&mut bodies.fruit, kept);
        retain(&mut bodies.material, kept);
        retain(&mut bodies.lifted, kept);
        retain(&mut bodies.clump, kept);
        retain(&mut bodies.sphere, kept);
        retain(&mut bodies.offset, kept);
        self.drop_clumps();
    }
}

impl Simulation {
    /// Leaves only the clumps whose spheres are still there.
    fn drop_clumps(&mut self) {
        let mut number = vec![NONE; self.clumps.len()];
        for &clump in &self.bodies.clump {
            if clump != NONE {
                number[clump as usize] = 0;
            }
        }
        let left = number.iter_mut().filter(|own| **own != NONE);
        for (next, own) in left.enumerate() {
            *own = next as u32;
        }
        let kept = |clump: usize| number[clump] != NONE;
        retain(&mut self.clumps, kept);
        for clump in self.bodies.clump.iter_mut().filter(|own| **own != NONE) {
            *clump = number[*clump as usize];
        }
    }
}

fn retain<T>(from: &mut Vec<T>, keep: impl Fn(usize) -> bool) {
    let mut place = 0;
    from.retain(|_| {
        place += 1;
        keep(place - 1)
    });
}
