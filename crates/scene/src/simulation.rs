//! A scene from step to step.

use crate::contact::{Moment, Outcome, event, event_of_pair};
use crate::energy::{Account, Energy};
use crate::error::Error;
use crate::event::{Event, Partner};
use crate::gather::{Gather, Sums};
use crate::interaction::Interaction;
use crate::neighbours::{Bodies, PairTable};
use crate::pair_contacts::{PairContacts, Part};
use crate::pair_forces::PairForce;
use crate::react::Clock;
use crate::scene::Scene;
use crate::vector::{Rotation, Vector};
use crate::wall_contacts::WallState;
use rayon::prelude::*;

/// A scene that runs.
///
/// Forces, places and events do not depend on the number of threads, to the last bit.
pub struct Simulation {
    pub(crate) scene: Scene,
    /// Interactions by number, and the number of each pair of materials.
    pub(crate) surfaces: Vec<Interaction>,
    pub(crate) numbers: Vec<usize>,
    pub(crate) bodies: Bodies,
    pub(crate) table: PairTable,
    /// Contacts of each block, in the order of its parts.
    pub(crate) contacts: Vec<Vec<Box<dyn PairContacts>>>,
    pub(crate) forces: Vec<PairForce>,
    /// Force and moment of the pairs of its block on each body.
    pub(crate) loads: Vec<[f64; 8]>,
    pub(crate) rolling: Vec<Vector>,
    pub(crate) walls: WallState,
    /// Parts of walls near each body, and where those of each begin.
    pub(crate) near: Vec<u32>,
    pub(crate) near_start: Vec<u32>,
    /// Places when the list was made; m.
    pub(crate) listed: Vec<Vector>,
    /// Largest way since then, of bodies and of walls; m.
    pub(crate) moved: f64,
    pub(crate) wall_way: f64,
    pub(crate) wall_speed: f64,
    pub(crate) skin: f64,
    pub(crate) steps: u64,
    /// Fruit that has come, by number.
    pub(crate) released: usize,
    pub(crate) events: Vec<Event>,
    pub(crate) taken: Vec<Leaving>,
    pub(crate) account: Account,
    pub(crate) rebuilds: u64,
}

/// A fruit that left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leaving {
    /// Its number.
    pub fruit: u32,
    /// When; s.
    pub time: f64,
    /// The sink, by its number.
    pub sink: usize,
}

/// A fruit now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FruitState {
    /// Its number.
    pub fruit: u32,
    /// Where; m.
    pub place: Vector,
    /// Velocity, half a step before the place; m/s.
    pub velocity: Vector,
    /// Angular velocity; rad/s.
    pub spin: Vector,
    /// Orientation, as a quaternion.
    pub turn: Rotation,
}

/// Skin of the list of neighbours over the mean radius; 1.
const SKIN: f64 = 0.16;

/// So few blocks are done sooner by one thread than given to several.
const FEW_BLOCKS: usize = 2;

/// Steps between looks at sinks.
const SINK_STEPS: u64 = 32;

impl Simulation {
    /// A scene at its beginning.
    ///
    /// # Errors
    /// The scene cannot be, see [`Scene::check`]; fruit of time zero overlap each other.
    pub fn new(mut scene: Scene) -> Result<Self, Error> {
        scene.check()?;
        scene.fruit.sort_by(|a, b| a.time.total_cmp(&b.time));
        let mean = scene.fruit.iter().map(|fruit| fruit.radius).sum::<f64>();
        let skin = SKIN * mean / scene.fruit.len().max(1) as f64;
        let keys: Vec<(usize, usize)> = scene.interactions.keys().copied().collect();
        let materials = scene.materials.len();
        let number = |place: usize| {
            let (a, b) = (place / materials, place % materials);
            let key = (a.min(b), a.max(b));
            keys.iter()
                .position(|own| *own == key)
                .unwrap_or(usize::MAX)
        };
        let wall_speed = scene.walls.iter().map(|wall| {
            let pivot = wall.motion.rotation.map_or([0.0; 3], |own| own.point);
            let reach = wall.shape.reach(pivot);
            // Planes are always looked at.
            if reach.is_finite() {
                wall.motion.largest_speed(reach)
            } else {
                0.0
            }
        });
        let wall_speed = wall_speed.fold(0.0, f64::max);
        let mut simulation = Self {
            surfaces: scene.interactions.values().cloned().collect(),
            numbers: (0..materials * materials).map(number).collect(),
            walls: WallState::new(&scene.walls),
            scene,
            bodies: Bodies::default(),
            table: PairTable::default(),
            contacts: Vec::new(),
            forces: Vec::new(),
            loads: Vec::new(),
            rolling: Vec::new(),
            near: Vec::new(),
            near_start: vec![0],
            listed: Vec::new(),
            moved: f64::INFINITY,
            wall_way: 0.0,
            wall_speed,
            skin,
            steps: 0,
            released: 0,
            events: Vec::new(),
            taken: Vec::new(),
            account: Account::default(),
            rebuilds: 0,
        };
        simulation.release()?;
        simulation.check_room()?;
        Ok(simulation)
    }

    /// Time of the places; s.
    #[must_use]
    pub fn time(&self) -> f64 {
        self.steps as f64 * self.scene.time_step
    }

    /// Steps so far.
    #[must_use]
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// The scene.
    #[must_use]
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// How often the list of neighbours was made.
    #[must_use]
    pub fn rebuilds(&self) -> u64 {
        self.rebuilds
    }

    /// Fruit in the scene now.
    #[must_use]
    pub fn count(&self) -> usize {
        self.bodies.len()
    }

    /// Fruit that are still to come.
    #[must_use]
    pub fn waiting(&self) -> usize {
        self.scene.fruit.len() - self.released
    }

    /// Contacts of two fruit now.
    #[must_use]
    pub fn pair_contacts(&self) -> usize {
        self.contacts.iter().flatten().map(|own| own.count()).sum()
    }

    /// Every fruit in the scene, by number.
    #[must_use]
    pub fn fruit(&self) -> Vec<FruitState> {
        let state = |body: usize| {
            let ([x, y, z, _], m) = (self.bodies.place[body], self.bodies.motion[body]);
            FruitState {
                fruit: self.bodies.fruit[body],
                place: [x, y, z],
                velocity: [m[0], m[1], m[2]],
                spin: [m[4], m[5], m[6]],
                turn: self.bodies.turn[body],
            }
        };
        let mut all: Vec<FruitState> = (0..self.bodies.len()).map(state).collect();
        all.sort_by_key(|own| own.fruit);
        all
    }

    /// Contacts that ended since this was last asked, in the order of steps.
    pub fn take_events(&mut self) -> Vec<Event> {
        std::mem::take(&mut self.events)
    }

    /// Fruit that left since this was last asked.
    pub fn take_leavings(&mut self) -> Vec<Leaving> {
        std::mem::take(&mut self.taken)
    }

    /// Contacts that are still there, as if they ended now.
    #[must_use]
    pub fn lasting(&self) -> Vec<Event> {
        let mut events = Vec::new();
        for (parts, contacts) in self.table.blocks.iter().zip(&self.contacts) {
            for ((_, range), contacts) in parts.iter().zip(contacts) {
                for contact in 0..contacts.count() {
                    let (entry, _, parcel) = contacts.at(contact);
                    let entry = range.start + entry as usize;
                    let fruit = |body: u32| self.bodies.fruit[body as usize];
                    let pair = (
                        fruit(self.table.first[entry]),
                        fruit(self.table.second[entry]),
                    );
                    events.push(event_of_pair(parcel, pair, true));
                }
            }
        }
        for (body, own) in self.bodies.walls.iter().enumerate() {
            for contact in own {
                let partner = Partner::Wall(contact.wall);
                let fruit = self.bodies.fruit[body];
                let (history, encounter) = (&contact.history, &contact.encounter);
                events.push(event(history, encounter, fruit, partner, true));
            }
        }
        events.sort_by_key(|event| (event.fruit, event.partner));
        events
    }

    /// One time step on.
    ///
    /// # Errors
    /// The result would mean nothing: bodies overlap or move too much.
    pub fn step(&mut self) -> Result<(), Error> {
        self.advance(false).map(|_| ())
    }

    /// One time step on; answers the energies at its beginning.
    ///
    /// # Errors
    /// See [`Simulation::step`].
    pub fn step_with_energy(&mut self) -> Result<Energy, Error> {
        self.advance(true)
    }

    fn advance(&mut self, with_energy: bool) -> Result<Energy, Error> {
        if !self.scene.sinks.is_empty() && self.steps.is_multiple_of(SINK_STEPS) {
            self.sink();
        }
        if self.due() {
            self.release()?;
        }
        self.push(with_energy)
    }

    /// Forces on all bodies where they are now, and where they take them.
    pub(crate) fn push(&mut self, with_energy: bool) -> Result<Energy, Error> {
        let (step, time) = (self.scene.time_step, self.time());
        if 2.0 * self.moved > self.skin || self.moved + self.wall_way > 0.5 * self.skin {
            self.rebuild();
        }
        self.walls.move_to(&self.scene.walls, time, step);
        self.push_pairs(time)?;
        let energy = self.push_bodies(time, with_energy)?;
        self.wall_way += self.wall_speed * step;
        self.steps += 1;
        Ok(energy)
    }

    /// Forces of all pairs.
    fn push_pairs(&mut self, time: f64) -> Result<(), Error> {
        let bodies = &self.bodies;
        let now = Moment {
            fruit: &self.scene.fruit,
            clock: Clock {
                time,
                step: self.scene.time_step,
            },
        };
        let table = &mut self.table;
        let (mut first, mut second) = (&table.first[..], &table.second[..]);
        let (mut slot, mut out) = (&mut table.slot[..], &mut self.forces[..]);
        let mut rolling = &mut self.rolling[..];
        let rolls = !rolling.is_empty();
        let mut loads = &mut self.loads[..];
        let mut tasks = Vec::with_capacity(table.blocks.len());
        let blocks = table.blocks.iter().zip(&table.bounds);
        for ((parts, bounds), contacts) in blocks.zip(&mut self.contacts) {
            let mut own = Vec::with_capacity(parts.len());
            for (interaction, range) in parts {
                let length = range.len();
                let entries = (
                    take(&mut first, length),
                    take(&mut second, length),
                    take_mut(&mut slot, length),
                    take_mut(&mut out, length),
                    take_mut(&mut rolling, if rolls { length } else { 0 }),
                );
                own.push((*interaction, entries));
            }
            let loads = take_mut(&mut loads, bounds.len());
            tasks.push((own, bounds.start, loads, contacts));
        }
        let surfaces = &self.surfaces;
        let work = |(parts, base, loads, contacts): BlockTask| {
            let mut outcome = Outcome::default();
            loads.fill([0.0; 8]);
            for ((interaction, entries), contacts) in parts.into_iter().zip(contacts) {
                let (first, second, slot, out, rolling) = entries;
                let part = Part {
                    bodies,
                    first,
                    second,
                    slot,
                    loads: &mut *loads,
                    base,
                    out,
                    rolling,
                };
                contacts.advance(part, &surfaces[interaction], &now, &mut outcome);
            }
            outcome
        };
        let outcomes: Vec<Outcome> = match tasks.len() < FEW_BLOCKS {
            true => tasks.into_iter().map(work).collect(),
            false => tasks.into_par_iter().map(work).collect(),
        };
        for outcome in outcomes {
            if let Some(problem) = outcome.problem {
                return Err(problem);
            }
            for event in outcome.events {
                self.account.normal += event.absorbed_energy;
                self.account.friction += event.friction_energy;
                self.events.push(event);
            }
        }
        Ok(())
    }

    /// Forces on all bodies, and where they take them.
    fn push_bodies(&mut self, time: f64, with_energy: bool) -> Result<Energy, Error> {
        let now = Moment {
            fruit: &self.scene.fruit,
            clock: Clock {
                time,
                step: self.scene.time_step,
            },
        };
        let gather = Gather {
            table: &self.table,
            loads: &self.loads,
            forces: &self.forces,
            rolling: &self.rolling,
            scene: &self.scene,
            surfaces: &self.surfaces,
            numbers: &self.numbers,
            walls: &self.walls,
            near: (&self.near, &self.near_start),
            bodies: (&self.bodies.fruit, &self.bodies.material),
            listed: &self.listed,
            with_energy,
        };
        let (mut places, mut motions) = (&mut self.bodies.place[..], &mut self.bodies.motion[..]);
        let (mut turns, mut contacts) = (&mut self.bodies.turn[..], &mut self.bodies.walls[..]);
        let bounds = self.table.bounds.iter();
        let blocks: Vec<_> = bounds
            .map(|own| {
                let length = own.len();
                let place = take_mut(&mut places, length);
                let motion = take_mut(&mut motions, length);
                let turn = take_mut(&mut turns, length);
                (
                    own.start,
                    place,
                    motion,
                    turn,
                    take_mut(&mut contacts, length),
                )
            })
            .collect();
        let work = |(start, place, motion, turn, walls)| {
            gather.block(start, place, motion, turn, walls, &now)
        };
        let found: Vec<(Outcome, Sums)> = match blocks.len() < FEW_BLOCKS {
            true => blocks.into_iter().map(work).collect(),
            false => blocks.into_par_iter().map(work).collect(),
        };
        let mut energy = Energy::default();
        self.moved = 0.0;
        for (outcome, sums) in found {
            if let Some(problem) = outcome.problem {
                return Err(problem);
            }
            for event in outcome.events {
                self.account.normal += event.absorbed_energy;
                self.account.friction += event.friction_energy;
                self.events.push(event);
            }
            self.moved = self.moved.max(sums.moved.sqrt());
            self.account.drag += sums.drag;
            self.account.walls += sums.walls;
            energy.kinetic += sums.kinetic;
            energy.rotational += sums.rotational;
            energy.potential += sums.potential;
        }
        if with_energy {
            self.complete(&mut energy);
        }
        Ok(energy)
    }

    fn complete(&self, energy: &mut Energy) {
        for contacts in self.contacts.iter().flatten() {
            for contact in 0..contacts.count() {
                let (_, _, parcel) = contacts.at(contact);
                energy.in_contacts += parcel.history.work;
                energy.in_friction += parcel.history.friction_work;
            }
        }
        for contact in self.bodies.walls.iter().flatten() {
            energy.in_contacts += contact.history.work;
            energy.in_friction += contact.history.friction_work;
        }
        energy.lost_in_contacts = self.account.normal;
        energy.lost_by_friction = self.account.friction;
        energy.lost_by_drag = self.account.drag;
        energy.done_by_walls = self.account.walls;
        energy.brought = self.account.brought;
    }
}

/// Entries of a block and interaction: first and second bodies, contacts, forces, moments
/// against rolling.
type Entries<'a> = (
    &'a [u32],
    &'a [u32],
    &'a mut [u32],
    &'a mut [PairForce],
    &'a mut [Vector],
);

/// What is to be done of a block: its entries by interaction, its first body, what its bodies
/// get, and its contacts.
type BlockTask<'a> = (
    Vec<(usize, Entries<'a>)>,
    usize,
    &'a mut [[f64; 8]],
    &'a mut Vec<Box<dyn PairContacts>>,
);

/// Takes the first elements off a slice.
fn take<'a, T>(from: &mut &'a [T], length: usize) -> &'a [T] {
    let (own, rest) = from.split_at(length);
    *from = rest;
    own
}

fn take_mut<'a, T>(from: &mut &'a mut [T], length: usize) -> &'a mut [T] {
    let (own, rest) = std::mem::take(from).split_at_mut(length);
    *from = rest;
    own
}
