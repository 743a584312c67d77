//! The part of a scene that one rank of another engine moves.
//!
//! A rank sees its own fruit and those of other ranks near its border. A contact belongs to the
//! rank of its fruit, and one of two fruit to that of the lower number: so each is followed
//! once. Where a fruit goes over to another rank, all that its contacts remember goes along
//! ([`Offer`]); so pulses do not depend on the number of ranks but for the engine's rounding.

use crate::binary;
use crate::contacts::store::NONE;
use crate::energy::Energy;
use crate::error::Error;
use crate::event::{Event, Partner};
use crate::follow::brought;
use crate::line::HalfLine;
use crate::motion::simulation::{FruitState, Leaving, Simulation};
use crate::scene::{Fruit, Scene};
use crate::state::{PairState, Saved, WallContactState, wall_state};
use crate::vector::{UNTURNED, Vector, add, dot, plus_scaled, scaled, subtract, turned_on};

/// Fruit that a rank sees at a step: its own, and behind them those of others.
#[derive(Clone, Copy, Debug)]
pub struct Seen<'a> {
    /// How many are its own.
    pub local: usize,
    /// Numbers, from 1.
    pub numbers: &'a [i32],
    /// Where; m.
    pub place: &'a [Vector],
    /// Velocity, half a step of the engine before but at the beginning; m/s.
    pub velocity: &'a [Vector],
    /// The same of the angular velocity; rad/s.
    pub spin: &'a [Vector],
}

/// Fruit that a rank had and has no more, with what their contacts remember; and those that it
/// sees for the first time.
#[derive(Clone, Debug, Default)]
pub struct Offer {
    fruit: Vec<FruitState>,
    walls: Vec<(u32, WallContactState)>,
    pairs: Vec<PairState>,
    asked: Vec<u32>,
}

/// Fruit that a rank took over, and what it knows of those that others ask for.
#[derive(Clone, Debug, Default)]
pub struct Answer {
    taken: Vec<u32>,
    told: Vec<FruitState>,
}

binary!(Offer {
    fruit,
    walls,
    pairs,
    asked
});
binary!(Answer { taken, told });

/// The part of a scene that a rank follows.
pub struct Share {
    pub(crate) simulation: Simulation,
    /// Steps of the engine in one of the simulation.
    steps: u64,
    /// What was seen last: numbers, and how many were its own.
    pub(crate) numbers: Vec<i32>,
    pub(crate) local: usize,
    /// Numbers and own ones before these changed.
    pub(crate) before: (Vec<i32>, usize),
    /// The atom of each fruit, and of each body; [`NONE`] of those that are not seen.
    pub(crate) atom: Vec<u32>,
    at: Vec<u32>,
    /// Rebuilds of the list for which `at` holds; none where it does not.
    listed: Option<u64>,
    /// Each fruit in the frame before, and whether it was seen.
    pub(crate) last: Vec<FruitState>,
    pub(crate) known: Vec<bool>,
}

impl Share {
    /// Nothing seen yet of a scene.
    ///
    /// * `scene`: with the time between frames as its time step
    /// * `steps`: steps of the engine from frame to frame
    ///
    /// # Errors
    /// See [`Scene::check`].
    pub fn new(scene: Scene, steps: u64) -> Result<Self, Error> {
        let mut simulation = Simulation::before_release(scene)?;
        let count = simulation.scene.fruit.len();
        simulation.foreign = vec![true; count];
        let nowhere = FruitState {
            fruit: 0,
            place: [0.0; 3],
            velocity: [0.0; 3],
            spin: [0.0; 3],
            turn: UNTURNED,
        };
        Ok(Self {
            simulation,
            steps,
            numbers: Vec::new(),
            local: 0,
            before: (Vec::new(), 0),
            atom: vec![NONE; count],
            at: Vec::new(),
            listed: None,
            last: vec![nowhere; count],
            known: vec![false; count],
        })
    }

    /// Whether a rank sees other fruit than in the frame before, or has others.
    ///
    /// # Errors
    /// A fruit has a number that the scene has not, or one that another one has.
    pub fn differs(&mut self, seen: &Seen) -> Result<bool, Error> {
        if self.local == seen.local && self.numbers == seen.numbers {
            return Ok(false);
        }
        for number in &self.numbers {
            self.atom[*number as usize - 1] = NONE;
        }
        for (atom, &number) in (0..).zip(seen.numbers) {
            let place = self.atom.get_mut((number as usize).wrapping_sub(1));
            let place = place.filter(|own| **own == NONE);
            *place.ok_or(Error::Value {
                what: "the number of a fruit on a rank",
                value: f64::from(number),
                problem: "the scene has not so many, or it is there twice",
            })? = atom;
        }
        let before = std::mem::replace(&mut self.numbers, seen.numbers.to_vec());
        self.before = (before, std::mem::replace(&mut self.local, seen.local));
        self.listed = None;
        let (numbers, local) = (&self.before.0, self.before.1);
        let others = numbers.len() != seen.numbers.len()
            || local != seen.local
            || seen.numbers[..local].iter().any(|own| self.foreign(*own))
            || seen
                .numbers
                .iter()
                .any(|own| !self.known[*own as usize - 1]);
        Ok(others)
    }

    fn foreign(&self, number: i32) -> bool {
        self.simulation.foreign[number as usize - 1]
    }

    /// Whether the rank has a fruit now.
    pub(crate) fn has(&self, fruit: u32) -> bool {
        self.atom[fruit as usize] < self.local as u32
    }

    /// What the rank had and has no more.
    pub fn offer(&self) -> Offer {
        let (numbers, local) = (&self.before.0, self.before.1);
        let own = numbers[..local].iter().map(|number| *number as u32 - 1);
        let fruit: Vec<FruitState> = own
            .filter(|own| !self.has(*own))
            .map(|own| self.last[own as usize])
            .collect();
        let asked = self.numbers.iter().map(|number| *number as u32 - 1);
        let asked = asked.filter(|own| !self.has(*own) && !self.known[*own as usize]);
        let mut offer = Offer {
            asked: asked.collect(),
            ..Offer::default()
        };
        if fruit.is_empty() {
            return offer;
        }
        let lost = |fruit: u32| !self.simulation.foreign[fruit as usize] && !self.has(fruit);
        let saved = Saved(&self.simulation);
        let pairs = saved.pairs();
        offer.pairs = pairs.filter(|own| lost(own.fruit[0])).collect();
        offer.walls = self.walls(lost);
        offer.fruit = fruit;
        offer
    }

    /// Contacts with walls of some fruit.
    pub(crate) fn walls(&self, wanted: impl Fn(u32) -> bool) -> Vec<(u32, WallContactState)> {
        let all = self.simulation.wall_contacts_of_bodies();
        let all = all.iter().map(|(body, own)| {
            let fruit = self.simulation.bodies.fruit[*body];
            (fruit, wall_state(own))
        });
        all.filter(|(fruit, _)| wanted(*fruit)).collect()
    }

    /// What the rank takes over of all offers, and knows of what others ask for.
    pub fn answer(&self, offers: &[Offer]) -> Answer {
        let offered = || offers.iter().flat_map(|own| &own.fruit);
        let taken = offered().filter(|own| self.has(own.fruit));
        let mut answer = Answer {
            taken: taken.clone().map(|own| own.fruit).collect(),
            told: Vec::new(),
        };
        let mut taken: Vec<&FruitState> = taken.collect();
        taken.sort_unstable_by_key(|own| own.fruit);
        let mut asked: Vec<u32> = offers.iter().flat_map(|own| own.asked.clone()).collect();
        asked.sort_unstable();
        asked.dedup();
        for fruit in asked.into_iter().filter(|own| self.has(*own)) {
            let new = taken.binary_search_by_key(&fruit, |own| own.fruit);
            let state = match new {
                Ok(place) => *taken[place],
                Err(_) if self.known[fruit as usize] => self.last[fruit as usize],
                // It came in with this frame.
                Err(_) => continue,
            };
            answer.told.push(state);
        }
        answer
    }

    /// Takes over what is its own now, and ends contacts of fruit that left the scene.
    ///
    /// # Errors
    /// A fruit is gone, and there is no sink; an offer is of another scene.
    pub fn settle(
        &mut self,
        seen: &Seen,
        offers: &[Offer],
        answers: &[Answer],
    ) -> Result<(), Error> {
        let offered = offers.iter().flat_map(|own| &own.fruit);
        let mut gone: Vec<u32> = offered.clone().map(|own| own.fruit).collect();
        gone.sort_unstable();
        for taken in answers.iter().flat_map(|own| &own.taken) {
            if let Ok(place) = gone.binary_search(taken) {
                gone.remove(place);
            }
        }
        self.end(&gone)?;
        let mut pairs: Vec<PairState> = Saved(&self.simulation).pairs().collect();
        pairs.extend(offers.iter().flat_map(|own| own.pairs.iter().cloned()));
        pairs.retain(|own| {
            self.has(own.fruit[0]) && own.fruit.iter().all(|own| gone.binary_search(own).is_err())
        });
        // What was offered was among its own before.
        pairs.sort_by_key(|own| own.fruit);
        pairs.dedup_by_key(|own| own.fruit);
        let mut walls = self.walls(|own| self.has(own));
        let had = |fruit: u32| !self.simulation.foreign[fruit as usize];
        let new = offers.iter().flat_map(|own| &own.walls);
        walls.extend(new.filter(|own| self.has(own.0) && !had(own.0)).cloned());
        let told = answers.iter().flat_map(|own| &own.told);
        for own in offered.chain(told) {
            let fruit = own.fruit as usize;
            if self.atom[fruit] != NONE && !self.known[fruit] {
                (self.last[fruit], self.known[fruit]) = (*own, true);
            }
        }
        self.regroup(seen, &pairs, &walls)?;
        // It is handed over: a rank that sees no other fruit at the next exchange offers nothing.
        self.before = (Vec::new(), 0);
        Ok(())
    }

    /// Ends the contacts of fruit that left.
    ///
    /// * `gone`: their numbers, in their order
    fn end(&mut self, gone: &[u32]) -> Result<(), Error> {
        if gone.is_empty() {
            return Ok(());
        }
        let is_gone = |fruit: u32| gone.binary_search(&fruit).is_ok();
        for event in self.simulation.lasting() {
            let other = match event.partner {
                Partner::Fruit(other) => is_gone(other),
                Partner::Wall(_) => false,
            };
            if is_gone(event.fruit) || other {
                let account = &mut self.simulation.account;
                account.normal += event.absorbed_energy;
                account.friction += event.friction_energy;
                let lasting = false;
                self.simulation.events.push(Event { lasting, ..event });
            }
        }
        let (time, gravity) = (self.simulation.time(), self.simulation.scene.gravity);
        for &fruit in gone {
            if self.simulation.foreign[fruit as usize] {
                continue;
            }
            let last = self.last[fruit as usize];
            let sink = self.simulation.sink_of(&last)?;
            let own = &self.simulation.scene.fruit[fruit as usize];
            self.simulation.account.brought -= brought(own, &last, gravity);
            self.simulation.taken.push(Leaving { fruit, time, sink });
        }
        Ok(())
    }

    /// All bodies anew, with the contacts that are the rank's own.
    pub(crate) fn regroup(
        &mut self,
        seen: &Seen,
        pairs: &[PairState],
        walls: &[(u32, WallContactState)],
    ) -> Result<(), Error> {
        let unfit = |problem: std::io::Error| Error::StateUnfit {
            problem: problem.to_string(),
        };
        for number in &self.before.0 {
            let fruit = *number as usize - 1;
            self.simulation.foreign[fruit] = true;
            self.known[fruit] &= self.atom[fruit] != NONE;
        }
        let (step, gravity) = (
            self.simulation.scene.time_step,
            self.simulation.scene.gravity,
        );
        // Velocities are those of half a step of the engine before, but at the beginning.
        let behind = match self.simulation.steps {
            0 => 0.0,
            _ => 0.5 * step / self.steps as f64,
        };
        let mut states = Vec::with_capacity(seen.numbers.len());
        for (atom, number) in seen.numbers.iter().enumerate() {
            let fruit = *number as u32 - 1;
            self.simulation.foreign[fruit as usize] = atom >= seen.local;
            let mut state = FruitState {
                fruit,
                place: seen.place[atom],
                velocity: plus_scaled(seen.velocity[atom], gravity, behind),
                spin: seen.spin[atom],
                turn: Fruit::ORIENTATION,
            };
            if self.known[fruit as usize] {
                state.turn = self.last[fruit as usize].turn;
            } else if atom < seen.local {
                let own = &self.simulation.scene.fruit[fruit as usize];
                self.simulation.account.brought += brought(own, &state, gravity);
            }
            state.velocity = plus_scaled(state.velocity, gravity, -0.5 * step);
            states.push(state);
        }
        states.sort_unstable_by_key(|own| own.fruit);
        let last = states.last().map_or(0, |own| own.fruit as usize + 1);
        let own = &mut self.simulation;
        own.released = own.released.max(last);
        own.near.clear();
        own.table = Default::default();
        own.contacts = Vec::new();
        own.enter_all(&states);
        own.near_start = vec![0; own.bodies.len() + 1];
        let body_of = own.bodies_by_fruit();
        for (fruit, wall) in walls {
            own.lay_at(body_of[*fruit as usize] as usize, wall)
                .map_err(unfit)?;
        }
        own.renew();
        own.settle_pairs(pairs).map_err(unfit)
    }

    /// One frame on.
    ///
    /// * `with_energy`: whether the energies at its time are wanted, which costs about as much as the
    ///   frame
    ///
    /// # Errors
    /// See [`Simulation::step`].
    pub fn follow(&mut self, seen: &Seen, with_energy: bool) -> Result<Energy, Error> {
        self.go(seen);
        self.simulation.push(with_energy)
    }

    /// Moves all bodies to where they are seen.
    fn go(&mut self, seen: &Seen) {
        let own = &mut self.simulation;
        if self.listed != Some(own.rebuilds) {
            let atoms = own
                .bodies
                .fruit
                .iter()
                .map(|fruit| self.atom[*fruit as usize]);
            self.at = atoms.collect();
            self.listed = Some(own.rebuilds);
        }
        let step = own.scene.time_step;
        // Spins are of half a step of the engine before: those of the middle between frames.
        let part = (self.steps as f64 - 1.0) / (2.0 * self.steps as f64);
        let mut moved = 0.0_f64;
        for body in 0..own.bodies.len() {
            let (fruit, atom) = (own.bodies.fruit[body] as usize, self.at[body] as usize);
            let (place, now) = (seen.place[atom], seen.spin[atom]);
            let radius = own.bodies.place[body][3];
            own.bodies.place[body] = HalfLine([place[0], place[1], place[2], radius]);
            let last = &mut self.last[fruit];
            if self.known[fruit] {
                let velocity = scaled(subtract(place, last.place), 1.0 / step);
                let spin = add(scaled(now, 1.0 - part), scaled(last.spin, part));
                own.bodies.motion[body][..3].copy_from_slice(&velocity);
                own.bodies.motion[body][4..7].copy_from_slice(&spin);
                own.bodies.turn[body] = turned_on(last.turn, spin, step);
            }
            *last = FruitState {
                fruit: fruit as u32,
                place,
                velocity: seen.velocity[atom],
                spin: now,
                turn: own.bodies.turn[body],
            };
            self.known[fruit] = true;
            let [x, y, z, _] = own.listed[body].0;
            let way = subtract(place, [x, y, z]);
            moved = moved.max(dot(way, way));
        }
        let moved = moved.sqrt();
        (own.moved, own.approach) = (moved, 2.0 * moved);
        own.ways.fill([moved; 2]);
    }

    /// Loads that ended since the last call, in the order of steps.
    pub fn take_events(&mut self) -> Vec<Event> {
        self.simulation.take_events()
    }

    /// Fruit that left since the last call.
    pub fn take_leavings(&mut self) -> Vec<Leaving> {
        self.simulation.take_leavings()
    }

    /// Contacts that are still there, as if they ended now.
    pub fn lasting(&self) -> Vec<Event> {
        self.simulation.lasting()
    }

    /// The rank's own fruit, by number.
    pub fn fruit(&self) -> Vec<FruitState> {
        let foreign = &self.simulation.foreign;
        let mut all = Vec::with_capacity(self.local);
        let wanted = |fruit: u32| !foreign[fruit as usize];
        self.simulation.visit_fruit(wanted, |own| all.push(own));
        all.sort_unstable_by_key(|own| own.fruit);
        all
    }

    /// Frames so far.
    pub fn frames(&self) -> u64 {
        self.simulation.steps
    }
}

impl Simulation {
    /// A step that others have made: loads that ended in it, and fruit that left.
    pub fn take_told(&mut self, events: Vec<Event>, leavings: Vec<Leaving>) {
        let left = leavings.iter().map(|own| own.fruit as usize + 1);
        self.released = left.fold(self.released, usize::max);
        self.events.extend(events);
        self.taken.extend(leavings);
        self.steps += 1;
    }

    /// Puts fruit that others have moved where they are at the end; by number.
    pub fn stand(&mut self, fruit: &[FruitState]) {
        self.enter_all(fruit);
        let last = fruit.last().map_or(0, |own| own.fruit as usize + 1);
        self.released = self.released.max(last);
    }
}
