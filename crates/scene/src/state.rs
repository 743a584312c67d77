//! The state of a running scene: saved, and resumed with the same bits.

use crate::binary;
use crate::binary::{Binary, no_value};
use crate::contacts::bodies::Bodies;
use crate::contacts::clump_contacts::{ClumpContacts, Touching, TouchingWall};
use crate::contacts::contact::Parcel;
use crate::contacts::wall_contacts::Lifted;
use crate::contacts::wall_forces::WallMeeting;
use crate::energy::Account;
use crate::error::Error;
use crate::motion::relist::{Carried, Origin};
use crate::motion::simulation::{FruitState, Leaving, Simulation};
use crate::scene::Scene;
use crate::vector::Vector;
use std::io::{Result as IoResult, Write};
use windfall_contact::laws::any_law::LARGEST_PARAMETERS;
use windfall_contact::laws::kind::{Law, LawKind};

/// Everything a scene carries from step to step, stored as [`Binary`].
#[derive(Clone, Debug)]
pub struct State {
    steps: u64,
    rebuilds: u64,
    account: Account,
    /// Where each fruit whose time has come came in; m.
    entered: Vec<Vector>,
    /// Those of them that wait for room, by number.
    held: Vec<u32>,
    /// Fruit in the scene, by number.
    fruit: Vec<FruitState>,
    /// Contacts with walls and the places of their fruit in `fruit`.
    walls: Vec<(u32, WallContactState)>,
    /// Contacts of two fruit, by their numbers.
    pairs: Vec<PairState>,
    /// Angular momenta of clumps half a step ago, with the numbers of the fruit; kg m²/s.
    momenta: Vec<(u32, Vector)>,
    /// Contacts of clumps with other fruit.
    clump_pairs: Vec<PairState>,
    /// Contacts of clumps with walls, with the numbers of the fruit.
    clump_walls: Vec<(u32, ClumpWallState)>,
}

/// Parameters of a law; zeros behind them.
type Parameters = [f64; LARGEST_PARAMETERS];

/// A contact of two fruit, as the one with the lower number sees it.
#[derive(Clone, Debug)]
pub(crate) struct PairState {
    pub fruit: [u32; 2],
    law: Parameters,
    parcel: Parcel,
}

/// A contact of a clump with a wall.
#[derive(Clone, Debug)]
struct ClumpWallState {
    wall: u32,
    normal: Vector,
    force: Vector,
    law: Parameters,
    parcel: Parcel,
}

/// A contact with a part of a wall.
#[derive(Clone, Debug)]
pub(crate) struct WallContactState {
    pub facet: u32,
    law: Parameters,
    parcel: Parcel,
    meeting: [[f64; 4]; 4],
    force: Vector,
}

binary!(State {
    steps,
    rebuilds,
    account,
    entered,
    held,
    fruit,
    walls,
    pairs,
    momenta,
    clump_pairs,
    clump_walls
});
binary!(ClumpWallState {
    wall,
    normal,
    force,
    law,
    parcel
});
binary!(PairState { fruit, law, parcel });
binary!(WallContactState {
    facet,
    law,
    parcel,
    meeting,
    force
});
binary!(FruitState {
    fruit,
    place,
    velocity,
    spin,
    turn
});
binary!(Account {
    normal,
    friction,
    drag,
    walls,
    brought
});
binary!(Leaving { fruit, time, sink });

impl State {
    /// Whether it is one of this scene.
    fn check(&self, scene: &Scene, facets: usize) -> IoResult<()> {
        let released = self.entered.len();
        let fruit = |number: u32| (number as usize) < released;
        let ordered = self.fruit.windows(2).all(|own| own[0].fruit < own[1].fruit);
        let there = |number: u32| {
            let place = self.fruit.binary_search_by_key(&number, |own| own.fruit);
            place.is_ok()
        };
        let known = released <= scene.fruit.len()
            && ordered
            && self.fruit.iter().all(|own| fruit(own.fruit))
            && self.held.iter().all(|own| fruit(*own) && !there(*own))
            && self
                .pairs
                .iter()
                .chain(&self.clump_pairs)
                .all(|own| own.fruit.into_iter().all(there))
            && self.momenta.iter().all(|(fruit, _)| there(*fruit))
            && self
                .clump_walls
                .iter()
                .all(|(fruit, own)| there(*fruit) && (own.wall as usize) < scene.walls.len())
            && self.walls.iter().all(|(body, own)| {
                (*body as usize) < self.fruit.len() && (own.facet as usize) < facets
            });
        if known {
            Ok(())
        } else {
            Err(no_value("state of this scene"))
        }
    }
}

fn parameters(law: &Law) -> Parameters {
    let mut all = [0.0; LARGEST_PARAMETERS];
    for (own, value) in all.iter_mut().zip(law.parameters()) {
        *own = value;
    }
    all
}

/// The law of these parameters; laws of an interaction keep its kind.
fn law_of(kind: LawKind, own: &Parameters) -> IoResult<Law> {
    let count = kind.describe().parameters.len();
    let values = own.get(..count).unwrap_or(own);
    kind.from_values(values)
        .ok_or_else(|| no_value("law of this scene"))
}

/// The state of a scene, written from the scene itself: as [`State`] reads it.
pub struct Saved<'a>(pub(crate) &'a Simulation);

impl Saved<'_> {
    /// Writes it.
    pub fn write(&self, to: &mut dyn Write) -> IoResult<()> {
        let own = self.0;
        let fruit = own.fruit();
        (own.steps, own.rebuilds).write(to)?;
        own.account.write(to)?;
        let entered = own.scene.fruit[..own.released].iter();
        write_list(entered.map(|own| own.place), to)?;
        own.held.write(to)?;
        fruit.write(to)?;
        let mut walls = own.wall_contacts_of_bodies();
        walls.sort_by_key(|(body, _)| own.bodies.fruit[*body]);
        let place_of = |body: usize| {
            // Every body is among them.
            fruit.partition_point(|state| state.fruit < own.bodies.fruit[body]) as u32
        };
        let walls = walls
            .iter()
            .map(|(body, wall)| (place_of(*body), wall_state(wall)));
        write_list(walls, to)?;
        write_list(self.pairs(), to)?;
        let momenta = own.clumps.iter().map(|own| (own.fruit, own.momentum));
        write_list(momenta, to)?;
        let pairs: Vec<_> = own.clump_contacts.touching_pairs().collect();
        let pairs = pairs
            .iter()
            .map(|(fruit, own)| pair_state(*fruit, &own.law, own.parcel));
        write_list(pairs, to)?;
        let walls: Vec<_> = own.clump_contacts.touching_walls().collect();
        let walls = walls
            .iter()
            .map(|(fruit, own)| (*fruit, clump_wall_state(own)));
        write_list(walls, to)
    }

    /// Contacts of two fruit that are no clumps, by their numbers.
    pub(crate) fn pairs(&self) -> impl ExactSizeIterator<Item = PairState> + '_ {
        let own = self.0;
        let number = |body: u32| own.bodies.fruit[body as usize];
        let mut all = Vec::with_capacity(own.pair_contacts());
        for (block, parts) in own.table.blocks.iter().enumerate() {
            for (part, (_, range)) in parts.iter().enumerate() {
                let entries = own.contacts[block][part].entries();
                for (contact, &entry) in (0_u32..).zip(entries) {
                    let entry = range.start + entry as usize;
                    let fruit = [own.table.first[entry], own.table.second[entry]].map(number);
                    all.push((fruit, [block as u32, part as u32, contact]));
                }
            }
        }
        all.sort_unstable_by_key(|([a, b], _)| [*a.min(b), *a.max(b)]);
        all.into_iter().map(|(fruit, place)| {
            let [block, part, contact] = place.map(|own| own as usize);
            let (law, parcel) = own.contacts[block][part].at(contact);
            pair_state(fruit, &law, parcel)
        })
    }
}

/// Writes a list, one after the other, as it is read as a `Vec`.
fn write_list<T: Binary>(
    list: impl ExactSizeIterator<Item = T>,
    to: &mut dyn Write,
) -> IoResult<()> {
    list.len().write(to)?;
    list.into_iter().try_for_each(|own| own.write(to))
}

impl Simulation {
    /// The state now, to be written. A simulation that takes it up with
    /// [`Simulation::resume`] gives the same bits as this one from here on, on any number of
    /// threads.
    ///
    /// Sums depend on the order of the list of neighbours, which has a history; so this one
    /// forgets it: where checkpoints are made belongs to what a run is.
    /// Events and leavings that were not taken yet stay here, and are not part of the state.
    pub fn checkpoint(&mut self) -> Saved<'_> {
        self.wrap();
        self.lift();
        let fruit = self.fruit();
        let old = std::mem::take(&mut self.bodies);
        let momenta: Vec<Vector> = self.clumps.iter().map(|own| own.momentum).collect();
        self.enter_all(&fruit);
        // Clumps stand in the order of their fruit, before and after.
        for (own, momentum) in self.clumps.iter_mut().zip(momenta) {
            own.momentum = momentum;
        }
        let body_of = self.bodies_by_fruit();
        let new = |body: u32| body_of[old.fruit[body as usize] as usize];
        let table = &mut self.table;
        for body in table.first.iter_mut().chain(&mut table.second) {
            *body = new(*body);
        }
        for (body, lifted) in (0..).zip(old.lifted) {
            self.bodies.lifted[new(body) as usize].extend(lifted);
        }
        self.rebuild();
        Saved(self)
    }

    /// Resumes a scene from a state.
    ///
    /// # Errors
    /// The scene cannot be, see [`Scene::check`]; the state is of another scene.
    pub fn resume(scene: Scene, state: &State) -> Result<Self, Error> {
        let mut simulation = Self::before_release(scene)?;
        simulation.take_up(state)?;
        Ok(simulation)
    }

    /// Begins a scene at the end of another one, with its time and an energy account of its own. The
    /// other one may have had another time step: velocities are of half a step before its end.
    ///
    /// # Errors
    /// The scene cannot be, see [`Scene::check`]; the state is of a scene with other fruit or walls.
    pub fn start(scene: Scene, state: &State, time: f64) -> Result<Self, Error> {
        let mut simulation = Self::resume(scene, state)?;
        simulation.steps = (time / simulation.scene.time_step).round() as u64;
        simulation.account = Account::default();
        Ok(simulation)
    }

    /// Fruit of a state, by number, in place of those that are there.
    pub(crate) fn enter_all(&mut self, fruit: &[FruitState]) {
        self.bodies = Bodies {
            periods: self.scene.periods(),
            ..Bodies::default()
        };
        self.clumps = Vec::new();
        fruit.iter().for_each(|own| self.enter(own));
    }

    /// The body of each fruit that is one; of a clump any of its bodies.
    pub(crate) fn bodies_by_fruit(&self) -> Vec<u32> {
        let mut body_of = vec![0; self.released];
        for (body, &fruit) in self.bodies.fruit.iter().enumerate() {
            body_of[fruit as usize] = body as u32;
        }
        body_of
    }

    /// Takes up a state, with a neighbour list built from it alone.
    fn take_up(&mut self, state: &State) -> Result<(), Error> {
        let unfit = |problem: std::io::Error| Error::StateUnfit {
            problem: problem.to_string(),
        };
        state
            .check(&self.scene, self.walls.facets.len())
            .map_err(unfit)?;
        (self.steps, self.rebuilds) = (state.steps, state.rebuilds);
        (self.account, self.released) = (state.account, state.entered.len());
        self.held.clone_from(&state.held);
        for (fruit, place) in self.scene.fruit.iter_mut().zip(&state.entered) {
            fruit.place = *place;
        }
        self.enter_all(&state.fruit);
        for (fruit, momentum) in &state.momenta {
            let own = self.clumps.iter_mut().find(|own| own.fruit == *fruit);
            if let Some(own) = own {
                own.momentum = *momentum;
            }
        }
        self.clump_contacts = self.contacts_of_clumps(state).map_err(unfit)?;
        let body_of = self.bodies_by_fruit();
        for (fruit, own) in &state.walls {
            let body = body_of[state.fruit[*fruit as usize].fruit as usize] as usize;
            self.lay_at(body, own).map_err(unfit)?;
        }
        // Nothing is in a list: there is none.
        self.renew();
        self.rebuilds = state.rebuilds;
        self.settle_pairs(&state.pairs).map_err(unfit)
    }

    /// Contacts of fruit that are in the scene, into a list without contacts.
    pub(crate) fn settle_pairs(&mut self, pairs: &[PairState]) -> IoResult<()> {
        let body_of = self.bodies_by_fruit();
        let mut carried = Vec::with_capacity(pairs.len());
        let mut laws = Vec::with_capacity(pairs.len());
        for (number, own) in pairs.iter().enumerate() {
            let [first, second] = own.fruit.map(|fruit| body_of[fruit as usize]);
            let material = |body: u32| self.bodies.material[body as usize] as usize;
            let kind = self.kind_between(material(first), material(second));
            laws.push(law_of(kind, &own.law)?);
            carried.extend(self.carried((first, second), [0, 0, number]));
        }
        self.settle(carried, ReadPairs { laws, pairs });
        Ok(())
    }

    /// Contacts of clumps; where they may touch is not listed yet.
    fn contacts_of_clumps(&self, state: &State) -> IoResult<ClumpContacts> {
        let mut contacts = ClumpContacts::default();
        let material = |fruit: u32| self.scene.fruit[fruit as usize].material;
        for own in &state.clump_pairs {
            let [first, second] = own.fruit.map(material);
            let law = law_of(self.kind_between(first, second), &own.law)?;
            let parcel = own.parcel;
            contacts.put_pair(own.fruit, Touching { law, parcel });
        }
        for (fruit, own) in &state.clump_walls {
            let wall = self.scene.walls[own.wall as usize].material;
            let law = law_of(self.kind_between(material(*fruit), wall), &own.law)?;
            let parcel = own.parcel;
            contacts.put_wall(
                *fruit,
                TouchingWall {
                    wall: own.wall,
                    normal: own.normal,
                    force: own.force,
                    own: Touching { law, parcel },
                },
            );
        }
        Ok(contacts)
    }

    /// A contact with a wall to a body that has no list yet.
    pub(crate) fn lay_at(&mut self, body: usize, own: &WallContactState) -> IoResult<()> {
        let kind = self.surfaces[self.interaction_with(body, own.facet)]
            .law
            .kind();
        let law = law_of(kind, &own.law)?;
        self.bodies.lifted[body].push(lifted(own, law));
        Ok(())
    }

    fn kind_between(&self, material: usize, other: usize) -> LawKind {
        let number = self.numbers[material * self.scene.materials.len() + other];
        self.surfaces[number].law.kind()
    }
}

/// Contacts of two fruit as they were read.
struct ReadPairs<'a> {
    laws: Vec<Law>,
    pairs: &'a [PairState],
}

impl Origin for ReadPairs<'_> {
    fn at(&self, own: &Carried) -> (Law, Parcel) {
        let number = own.contact as usize;
        (self.laws[number], self.pairs[number].parcel)
    }
}

fn pair_state(fruit: [u32; 2], law: &Law, parcel: Parcel) -> PairState {
    let swap = fruit[1] < fruit[0];
    let [a, b] = fruit;
    PairState {
        fruit: [a.min(b), a.max(b)],
        law: parameters(law),
        parcel: if swap { parcel.swapped() } else { parcel },
    }
}

pub(crate) fn wall_state(own: &Lifted) -> WallContactState {
    WallContactState {
        facet: own.facet,
        law: parameters(&own.law),
        parcel: own.parcel,
        meeting: own.meeting.rows(),
        force: own.force,
    }
}

fn clump_wall_state(own: &TouchingWall) -> ClumpWallState {
    ClumpWallState {
        wall: own.wall,
        normal: own.normal,
        force: own.force,
        law: parameters(&own.own.law),
        parcel: own.own.parcel,
    }
}

fn lifted(own: &WallContactState, law: Law) -> Lifted {
    Lifted {
        facet: own.facet,
        law,
        parcel: own.parcel,
        meeting: WallMeeting::of_rows(own.meeting),
        force: own.force,
    }
}
