//! A scene from step to step.

use crate::contacts::bodies::Bodies;
use crate::contacts::clump_contacts::{self, ClumpContacts};
use crate::contacts::contact::{Moment, Outcome, Over, lasting};
use crate::contacts::neighbours::PairTable;
use crate::contacts::pair_contacts::PairContacts;
use crate::contacts::react::{Clock, LOOK};
use crate::contacts::store::{Load, NONE};
use crate::contacts::wall_contacts::{NearPart, WallState};
use crate::contacts::wall_forces::WallContacts;
use crate::energy::{Account, Energy};
use crate::error::Error;
use crate::event::{Event, Partner};
use crate::interaction::Interaction;
use crate::line::HalfLine;
use crate::motion::clump_motion::{Around, ClumpState};
use crate::motion::gather::{Loads, Sums, Swept};
use crate::scene::Scene;
use crate::vector::{Rotation, Vector};
use windfall_numerics::real_vector::Row;

/// A scene that runs.
///
/// Forces, places and events do not depend on the number of threads, to the last bit.
pub struct Simulation {
    /// What moves.
    pub scene: Scene,
    /// Interactions by number, and the number of each pair of materials.
    pub(crate) surfaces: Vec<Interaction>,
    pub(crate) numbers: Vec<usize>,
    pub(crate) bodies: Bodies,
    /// Fruit that are several of the bodies.
    pub(crate) clumps: Vec<ClumpState>,
    pub(crate) clump_contacts: ClumpContacts,
    pub(crate) table: PairTable,
    /// Contacts of each block, in the order of its parts.
    pub(crate) contacts: Vec<Vec<PairContacts>>,
    /// Of pairs of two blocks on the second body.
    pub(crate) out: Vec<Load>,
    /// For the loads on the bodies of blocks, while these are worked through.
    pub(crate) loads: Loads,
    /// Of contacts of clumps on each body, where there are clumps.
    pub(crate) clump_loads: Vec<Load>,
    pub(crate) walls: WallState,
    /// Contacts of the bodies of each block with walls, by interaction.
    pub(crate) wall_contacts: Vec<Vec<WallContacts>>,
    /// Parts of walls near each body, and where those of each begin.
    pub(crate) near: Vec<NearPart>,
    pub(crate) near_start: Vec<u32>,
    /// Places when the list was made; m.
    pub(crate) listed: Vec<Row>,
    /// The two largest ways since then of the bodies of each block; m.
    pub(crate) ways: Vec<[f64; 2]>,
    /// Largest way of all, how far two may have come together, and largest way of walls; m.
    pub(crate) moved: f64,
    pub(crate) approach: f64,
    pub(crate) wall_way: f64,
    /// How far apart bodies are listed, and what of that is needed without any motion; m.
    pub(crate) skin: f64,
    pub(crate) lacks: f64,
    pub(crate) steps: u64,
    /// Fruit whose time has come, by number.
    pub(crate) released: usize,
    /// Those of them that wait for room, by number.
    pub(crate) held: Vec<u32>,
    pub(crate) events: Vec<Event>,
    pub(crate) taken: Vec<Leaving>,
    pub(crate) account: Account,
    pub(crate) rebuilds: u64,
    /// Fruit that another rank follows, by number; empty where there is one rank.
    pub(crate) foreign: Vec<bool>,
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

/// Steps between looks at sinks: fruit leave at the beginning of a step whose number is a multiple.
pub const SINK_STEPS: u64 = 32;

impl Simulation {
    /// A scene at its beginning.
    ///
    /// # Errors
    /// The scene cannot be, see [`Scene::check`]; fruit of time zero overlap each other.
    pub fn new(scene: Scene) -> Result<Self, Error> {
        let mut simulation = Self::before_release(scene)?;
        simulation.release()?;
        simulation.check_room()?;
        Ok(simulation)
    }

    /// A scene into which no fruit has come.
    pub(crate) fn before_release(mut scene: Scene) -> Result<Self, Error> {
        scene.check()?;
        scene.fruit.sort_by(|a, b| a.time.total_cmp(&b.time));
        let periods = scene.periods();
        for fruit in &mut scene.fruit {
            fruit.place = periods.wrapped(fruit.place);
        }
        let [skin, lacks] = scene.skin();
        let keys: Vec<(usize, usize)> = scene.interactions.keys().copied().collect();
        let materials = scene.materials.len();
        let number = |place: usize| {
            let (a, b) = (place / materials, place % materials);
            let key = (a.min(b), a.max(b));
            keys.iter()
                .position(|own| *own == key)
                .unwrap_or(usize::MAX)
        };
        Ok(Self {
            surfaces: scene.interactions.values().cloned().collect(),
            numbers: (0..materials * materials).map(number).collect(),
            walls: WallState::new(&scene),
            scene,
            bodies: Bodies {
                periods,
                ..Bodies::default()
            },
            clumps: Vec::new(),
            clump_contacts: ClumpContacts::default(),
            table: PairTable::default(),
            contacts: Vec::new(),
            out: Vec::new(),
            loads: Default::default(),
            clump_loads: Vec::new(),
            wall_contacts: Vec::new(),
            near: Vec::new(),
            near_start: vec![0],
            listed: Vec::new(),
            ways: Vec::new(),
            moved: f64::INFINITY,
            approach: f64::INFINITY,
            wall_way: 0.0,
            skin,
            lacks,
            steps: 0,
            released: 0,
            held: Vec::new(),
            events: Vec::new(),
            taken: Vec::new(),
            account: Account::default(),
            rebuilds: 0,
            foreign: Vec::new(),
        })
    }

    /// Time of the places; s.
    pub fn time(&self) -> f64 {
        self.steps as f64 * self.scene.time_step
    }

    /// Steps so far.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// How often the list of neighbours was made.
    pub fn rebuilds(&self) -> u64 {
        self.rebuilds
    }

    /// Fruit in the scene now.
    pub fn count(&self) -> usize {
        self.clumps.len() + self.bodies.clump.iter().filter(|own| **own == NONE).count()
    }

    /// Contacts of two fruit now.
    pub fn pair_contacts(&self) -> usize {
        let spheres: usize = self.contacts.iter().flatten().map(|own| own.count()).sum();
        spheres + self.clump_contacts.pair_count()
    }

    /// Every fruit in the scene, by number.
    pub fn fruit(&self) -> Vec<FruitState> {
        let mut all = Vec::with_capacity(self.count());
        self.visit_fruit(|_| true, |own| all.push(own));
        all.sort_by_key(|own| own.fruit);
        all
    }

    /// Hands out fruit that are in the scene, in any order; along periodic axes those images that
    /// are between the ends.
    ///
    /// * `wanted`: whether a fruit is, by its number
    pub fn visit_fruit(&self, wanted: impl Fn(u32) -> bool, mut tell: impl FnMut(FruitState)) {
        let periods = &self.bodies.periods;
        for body in 0..self.bodies.len() {
            let fruit = self.bodies.fruit[body];
            if self.bodies.clump[body] != NONE || !wanted(fruit) {
                continue;
            }
            let (HalfLine([x, y, z, _]), m) = (self.bodies.place[body], self.bodies.motion[body]);
            tell(FruitState {
                fruit,
                place: periods.wrapped([x, y, z]),
                velocity: [m[0], m[1], m[2]],
                spin: [m[4], m[5], m[6]],
                turn: self.bodies.turn[body],
            });
        }
        for own in self.clumps.iter().filter(|own| wanted(own.fruit)) {
            tell(FruitState {
                fruit: own.fruit,
                place: periods.wrapped(own.place),
                velocity: own.velocity,
                spin: own.spin,
                turn: own.turn,
            });
        }
    }

    /// Contacts that ended since the last call, in the order of steps.
    pub fn take_events(&mut self) -> Vec<Event> {
        std::mem::take(&mut self.events)
    }

    /// Fruit that left since the last call.
    pub fn take_leavings(&mut self) -> Vec<Leaving> {
        std::mem::take(&mut self.taken)
    }

    /// Contacts that are still there, as if they ended now.
    pub fn lasting(&self) -> Vec<Event> {
        let mut events = Vec::new();
        let last = self.steps.saturating_sub(1) as f64 * self.scene.time_step;
        for (parts, contacts) in self.table.blocks.iter().zip(&self.contacts) {
            for ((_, range), contacts) in parts.iter().zip(contacts) {
                for (contact, &entry) in contacts.entries().iter().enumerate() {
                    let (law, parcel) = contacts.at(contact);
                    let entry = range.start + entry as usize;
                    let fruit = |body: u32| self.bodies.fruit[body as usize];
                    let pair = (
                        fruit(self.table.first[entry]),
                        fruit(self.table.second[entry]),
                    );
                    events.extend(Over::of(&lasting(parcel, last), &law, true).of_pair(pair));
                }
            }
        }
        for (body, wall, law, parcel) in self.touched_walls() {
            let fruit = self.bodies.fruit[body];
            let partner = Partner::Wall(wall);
            events.extend(Over::of(&lasting(parcel, last), &law, true).with(fruit, partner));
        }
        for (fruit, partner, own) in self.clump_contacts.all() {
            let over = Over::of(&lasting(own.parcel, last), &own.law, true);
            events.extend(over.with(fruit, partner));
        }
        events.sort_by_key(|event| (event.fruit, event.partner, event.number));
        let wrapped = |event| self.wrapped(event);
        events.into_iter().map(wrapped).collect()
    }

    /// Advances by one time step.
    ///
    /// # Errors
    /// The result would mean nothing: bodies overlap or move too much.
    pub fn step(&mut self) -> Result<(), Error> {
        self.advance(false).map(|_| ())
    }

    /// Advances by several time steps.
    pub fn run(&mut self, steps: u64) -> Result<(), Error> {
        (0..steps).try_for_each(|_| self.step())
    }

    /// Advances by one time step; returns the energies at its beginning.
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

    /// Sums forces and integrates the motion of all bodies.
    pub(crate) fn push(&mut self, with_energy: bool) -> Result<Energy, Error> {
        let skin = self.skin - self.lacks;
        if self.approach > skin || self.moved + self.wall_way > skin {
            self.rebuild();
        }
        let (time, step) = (self.time(), self.scene.time_step);
        self.walls.move_to(&self.scene.walls, time, step);
        let looks = self.steps.is_multiple_of(LOOK);
        let clock = Clock { time, step, looks };
        let of_clumps = self.push_clump_contacts(clock);
        let swept = self.sweep(clock, with_energy);
        self.end(of_clumps)?;
        let energy = self.take_in(swept, with_energy)?;
        self.wall_way += self
            .walls
            .largest_speed(&self.scene.walls, [time, time + step])
            * step;
        self.steps += 1;
        Ok(energy)
    }

    /// Collects the results of a step.
    fn take_in(&mut self, swept: Swept, with_energy: bool) -> Result<Energy, Error> {
        swept.pairs.into_iter().try_for_each(|own| self.end(own))?;
        let mut energy = Energy::default();
        (self.moved, self.approach) = (0.0, 0.0);
        let ways = swept
            .bodies
            .iter()
            .map(|(_, sums)| sums.moved.map(f64::sqrt));
        self.ways = ways.collect();
        for (block, (outcome, sums)) in swept.bodies.into_iter().enumerate() {
            self.end(outcome)?;
            self.moved = self.moved.max(self.ways[block][0]);
            self.approach = self.approach.max(self.table.approach(block, &self.ways));
            self.account.drag += sums.drag;
            self.account.walls += sums.walls;
            energy.kinetic += sums.kinetic;
            energy.rotational += sums.rotational;
            energy.potential += sums.potential;
        }
        let sums = self.push_clumps();
        self.moved = self.moved.max(sums.moved[0].sqrt());
        if !self.clumps.is_empty() {
            self.approach = 2.0 * self.moved;
        }
        self.account.drag += sums.drag;
        if with_energy {
            energy.kinetic += sums.kinetic;
            energy.rotational += sums.rotational;
            energy.potential += sums.potential;
            self.complete(&mut energy);
        }
        Ok(energy)
    }

    /// Forces of all contacts of clumps, for themselves.
    fn push_clump_contacts(&mut self, clock: Clock) -> Outcome {
        let mut outcome = Outcome::default();
        self.clump_loads.clear();
        if self.clumps.is_empty() {
            return outcome;
        }
        self.clump_loads.resize(self.bodies.len(), Load::ZERO);
        let now = Moment {
            fruit: &self.scene.fruit,
            clock,
        };
        let (surfaces, numbers) = (&self.surfaces, &self.numbers);
        let materials = self.scene.materials.len();
        let wall_materials = self.scene.walls.iter().map(|wall| wall.material as u32);
        let wall_materials: Vec<u32> = wall_materials.collect();
        let around = clump_contacts::Around {
            bodies: &self.bodies,
            walls: &self.walls,
            now: &now,
            surface: |a: u32, b: u32| &surfaces[numbers[a as usize * materials + b as usize]],
            wall_materials: &wall_materials,
            lacks: self.lacks,
        };
        let contacts = &mut self.clump_contacts;
        let work = contacts.advance(&around, &mut self.clump_loads, &mut outcome);
        self.account.walls += work;
        outcome
    }

    /// Collects the results of contacts.
    fn end(&mut self, outcome: Outcome) -> Result<(), Error> {
        if let Some(problem) = outcome.problem {
            return Err(problem);
        }
        for event in outcome.events {
            self.account.normal += event.absorbed_energy;
            self.account.friction += event.friction_energy;
            self.events.push(self.wrapped(event));
        }
        Ok(())
    }

    /// A load that is told where it is between the ends of the scene.
    fn wrapped(&self, event: Event) -> Event {
        Event {
            place: self.bodies.periods.wrapped(event.place),
            ..event
        }
    }

    /// Clumps one step on, and their spheres with them.
    fn push_clumps(&mut self) -> Sums {
        let mut sums = Sums::default();
        let around = Around {
            fruit: &self.scene.fruit,
            gravity: self.scene.gravity,
            air: self.scene.air,
            step: self.scene.time_step,
            listed: &self.listed,
            loads: &self.clump_loads,
        };
        for clump in &mut self.clumps {
            clump.go(&around, &mut self.bodies, &mut sums);
        }
        sums
    }

    fn complete(&self, energy: &mut Energy) {
        for contacts in self.contacts.iter().flatten() {
            for contact in 0..contacts.count() {
                let (_, parcel) = contacts.at(contact);
                energy.in_contacts += parcel.history.work;
                energy.in_friction += parcel.history.friction_work;
            }
        }
        for (_, _, _, parcel) in self.touched_walls() {
            energy.in_contacts += parcel.history.work;
            energy.in_friction += parcel.history.friction_work;
        }
        for (_, _, own) in self.clump_contacts.all() {
            energy.in_contacts += own.parcel.history.work;
            energy.in_friction += own.parcel.history.friction_work;
        }
        energy.lost_in_contacts = self.account.normal;
        energy.lost_by_friction = self.account.friction;
        energy.lost_by_drag = self.account.drag;
        energy.done_by_walls = self.account.walls;
        energy.brought = self.account.brought;
    }
}
