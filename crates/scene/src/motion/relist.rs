//! Rebuilds the neighbour list, carrying contacts over.

use crate::contacts::cells::sort_into_cells;
use crate::contacts::contact::Parcel;
use crate::contacts::neighbours::PairTable;
use crate::contacts::pair_contacts::PairContacts;
use crate::contacts::pair_forces::Pair;
use crate::contacts::store::{Load, NONE};
use crate::contacts::wall_contacts::{Lifted, NearPart};
use crate::contacts::wall_forces::WallContacts;
use crate::line::HalfLine;
use crate::motion::simulation::Simulation;
use crate::vector::{Vector, add, dot};
use rayon::prelude::*;
use std::ops::Range;
use windfall_contact::laws::kind::Law;
use windfall_numerics::real::Lanes;

/// A contact that goes over into a new list.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Carried {
    /// Its entry in the new list.
    entry: u32,
    /// Whether its first body is the second now.
    swapped: bool,
    /// Block, part and contact of the old list.
    block: u32,
    part: u32,
    pub contact: u32,
}

/// Where contacts come from that go over into a new list.
pub(crate) trait Origin: Sync {
    /// Law and memory of one, as it was.
    fn at(&self, own: &Carried) -> (Law, Parcel);
    /// All that went to entries of the new list before this one are settled.
    fn settled(&mut self, _before: usize) {}
}

/// Contacts of a block of an old list, by parts, with the first entries of those.
pub(crate) struct OldBlock(Vec<(usize, PairContacts)>);

/// Blocks of an old list, which go as soon as nothing more comes from them: so few contacts are
/// there twice at a time, since bodies hardly change their order.
struct OldBlocks {
    blocks: Vec<OldBlock>,
    /// The last entry to which each block gives a contact, and the block; the last block to
    /// go comes first.
    last: Vec<(u32, usize)>,
}

impl OldBlocks {
    fn new(blocks: Vec<OldBlock>, carried: &[Carried]) -> Self {
        let mut last: Vec<(u32, usize)> = (0..blocks.len()).map(|block| (0, block)).collect();
        for own in carried {
            let (entry, _) = &mut last[own.block as usize];
            *entry = own.entry.max(*entry);
        }
        last.sort_unstable_by(|a, b| b.cmp(a));
        Self { blocks, last }
    }
}

impl Origin for OldBlocks {
    fn at(&self, own: &Carried) -> (Law, Parcel) {
        let OldBlock(parts) = &self.blocks[own.block as usize];
        parts[own.part as usize].1.at(own.contact as usize)
    }

    fn settled(&mut self, before: usize) {
        while let Some((_, block)) = self.last.pop_if(|own| (own.0 as usize) < before) {
            self.blocks[block].0 = Vec::new();
        }
    }
}

/// Blocks whose contacts are settled at a time.
const SETTLED: usize = 64;

impl Simulation {
    /// A new list of neighbours; contacts go over into it.
    pub(crate) fn rebuild(&mut self) {
        let (blocks, carried) = self.renew();
        let origin = OldBlocks::new(blocks, &carried);
        self.settle(carried, origin);
    }

    /// A new list of neighbours without contacts; those of the old list, and where they go.
    pub(crate) fn renew(&mut self) -> (Vec<OldBlock>, Vec<Carried>) {
        self.rebuilds += 1;
        self.wrap();
        self.lift();
        let (cells, order) = sort_into_cells(&mut self.bodies, self.skin);
        self.find_spheres();
        let mut place = vec![NONE; order.len()];
        for (new, &old) in order.iter().enumerate() {
            place[old as usize] = new as u32;
        }
        let materials = self.scene.materials.len();
        let numbers = &self.numbers;
        let table = PairTable::build(
            &self.bodies,
            &cells,
            self.skin,
            self.surfaces.len(),
            &self.foreign,
            |a, b| numbers[a as usize * materials + b as usize],
        );
        let old = std::mem::replace(&mut self.table, table);
        let parts = old
            .blocks
            .into_iter()
            .zip(std::mem::take(&mut self.contacts));
        let blocks: Vec<OldBlock> = parts
            .map(|(parts, contacts)| {
                let starts = parts.into_iter().map(|(_, range)| range.start);
                OldBlock(starts.zip(contacts).collect())
            })
            .collect();
        let of_block = |(number, block): (usize, &OldBlock)| {
            let mut carried = Vec::new();
            for (part, (start, contacts)) in block.0.iter().enumerate() {
                for (contact, &entry) in contacts.entries().iter().enumerate() {
                    let entry = start + entry as usize;
                    let new = |body: u32| place.get(body as usize).copied().unwrap_or(NONE);
                    let pair = (new(old.first[entry]), new(old.second[entry]));
                    carried.extend(self.carried(pair, [number, part, contact]));
                }
            }
            carried
        };
        let carried: Vec<Vec<Carried>> = blocks.par_iter().enumerate().map(of_block).collect();
        (blocks, carried.concat())
    }

    /// Contacts into a list that holds none of them, and what goes with the list.
    pub(crate) fn settle(&mut self, mut carried: Vec<Carried>, mut origin: impl Origin) {
        // In the order of the list, in which they are worked through.
        carried.sort_unstable_by_key(|own| own.entry);
        let (table, bodies) = (&self.table, &self.bodies);
        let until = |end: usize| carried.partition_point(|own| (own.entry as usize) < end);
        // Room is made by one thread: several would each keep what is freed for themselves.
        let room = |(interaction, range): &(usize, Range<usize>)| {
            let contacts = until(range.end) - until(range.start);
            PairContacts::new(&self.surfaces[*interaction], contacts, range.len())
        };
        let fill = |origin: &_, base: usize, range: &Range<usize>, contacts: &mut PairContacts| {
            let bodies = bodies.from(base);
            let pair = |entry: usize| {
                [table.first[entry], table.second[entry]].map(|body| body - base as u32)
            };
            let carried = &carried[until(range.start)..until(range.end)];
            for own in carried {
                let entry = own.entry as usize;
                let (law, parcel) = Origin::at(origin, own);
                let parcel = if own.swapped {
                    parcel.swapped()
                } else {
                    parcel
                };
                let (bodies, out) = (pair(entry), table.out[entry]);
                let pair = Pair { bodies, out };
                contacts.adopt((entry - range.start) as u32, pair, &law, parcel);
            }
            contacts.wait(range.clone().map(pair), &bodies);
        };
        self.contacts = Vec::with_capacity(table.blocks.len());
        let bounds = table.bounds.chunks(SETTLED);
        for (blocks, bounds) in table.blocks.chunks(SETTLED).zip(bounds) {
            let made = blocks.iter().map(|parts| parts.iter().map(room));
            let mut settled: Vec<Vec<PairContacts>> = made.map(Iterator::collect).collect();
            let all = settled.par_iter_mut().zip(blocks).zip(bounds);
            all.for_each(|((settled, parts), bounds)| {
                for (contacts, (_, range)) in settled.iter_mut().zip(parts) {
                    fill(&origin, bounds.start, range, contacts);
                }
            });
            self.contacts.extend(settled);
            let last = blocks.iter().flatten().next_back();
            origin.settled(last.map_or(0, |(_, range)| range.end));
        }
        drop(origin);
        self.out = vec![Load::ZERO; self.table.outs_before(self.table.bounds.len())];
        self.listed = self.bodies.place.iter().map(|own| Lanes(own.0)).collect();
        (self.moved, self.approach, self.wall_way) = (0.0, 0.0, 0.0);
        self.ways = vec![[0.0; 2]; self.table.bounds.len()];
        self.find_near();
        self.settle_walls();
    }

    /// Takes fruit that have left through an end of a periodic axis to the other end. What gravity
    /// does on the way is brought in.
    pub(crate) fn wrap(&mut self) {
        let periods = self.bodies.periods;
        if !periods.repeat() {
            return;
        }
        let gravity = self.scene.gravity;
        let mut brought = 0.0;
        let shifts: Vec<Vector> = self
            .clumps
            .iter_mut()
            .map(|own| {
                let shift = periods.shift(own.place);
                own.place = add(own.place, shift);
                brought -= self.scene.fruit[own.fruit as usize].mass * dot(gravity, shift);
                shift
            })
            .collect();
        for body in 0..self.bodies.len() {
            let HalfLine([x, y, z, radius]) = self.bodies.place[body];
            let shift = match shifts.get(self.bodies.clump[body] as usize) {
                Some(shift) => *shift,
                None => {
                    let shift = periods.shift([x, y, z]);
                    let mass = self.scene.fruit[self.bodies.fruit[body] as usize].mass;
                    brought -= mass * dot(gravity, shift);
                    shift
                }
            };
            let [x, y, z] = add([x, y, z], shift);
            self.bodies.place[body] = HalfLine([x, y, z, radius]);
        }
        self.account.brought += brought;
    }

    /// Which bodies the spheres of each clump are now, in the order of its shape.
    fn find_spheres(&mut self) {
        if self.clumps.is_empty() {
            return;
        }
        for body in 0..self.bodies.len() {
            if let Some(own) = self.clumps.get_mut(self.bodies.clump[body] as usize) {
                own.bodies[self.bodies.sphere[body] as usize] = body as u32;
            }
        }
    }

    /// Where a contact of the old list goes.
    ///
    /// * `from`: block, part and contact of the old list
    pub(crate) fn carried(
        &self,
        pair: (u32, u32),
        [block, part, contact]: [usize; 3],
    ) -> Option<Carried> {
        if pair.0 == NONE || pair.1 == NONE {
            return None;
        }
        let entry = self.table.find(pair.0.min(pair.1), pair.0.max(pair.1))?;
        Some(Carried {
            entry: entry as u32,
            swapped: pair.1 < pair.0,
            block: block as u32,
            part: part as u32,
            contact: contact as u32,
        })
    }

    /// Takes contacts with walls out of their stores.
    pub(crate) fn lift(&mut self) {
        let lifted = self.wall_contacts_of_bodies();
        self.near.clear();
        self.near_start = vec![0; self.bodies.len() + 1];
        for (body, own) in lifted {
            self.bodies.lifted[body].push(own);
        }
    }

    /// Contacts with walls, with the bodies that have them.
    pub(crate) fn wall_contacts_of_bodies(&self) -> Vec<(usize, Lifted)> {
        let lifted = |(body, part, stores): (usize, NearPart, &[WallContacts])| {
            let store = &stores[self.interaction_with(body, part.facet)];
            let (law, parcel, force) = store.at(part.slot);
            let own = Lifted {
                facet: part.facet,
                law,
                parcel,
                meeting: store.meeting(part.slot),
                force,
            };
            (body, own)
        };
        self.touched_parts().map(lifted).collect()
    }

    /// Number of the interaction of a body and a part of a wall.
    pub(crate) fn interaction_with(&self, body: usize, facet: u32) -> usize {
        let wall = self.walls.facets[facet as usize].0 as usize;
        let material = self.bodies.material[body] as usize;
        self.numbers[material * self.scene.materials.len() + self.scene.walls[wall].material]
    }

    /// Parts of walls that bodies touch, with the stores of the contacts.
    fn touched_parts(&self) -> impl Iterator<Item = (usize, NearPart, &[WallContacts])> + '_ {
        let bodies = self.near_start.windows(2).enumerate();
        bodies.flat_map(move |(body, range)| {
            let own = &self.near[range[0] as usize..range[1] as usize];
            let touched = own.iter().filter(|part| part.slot != NONE);
            touched.map(move |part| {
                let block = self.table.block_of(body);
                (body, *part, &self.wall_contacts[block][..])
            })
        })
    }

    /// Bodies that touch walls, which, and what the contacts remember.
    pub(crate) fn touched_walls(&self) -> impl Iterator<Item = (usize, u32, Law, Parcel)> + '_ {
        self.touched_parts().map(|(body, part, stores)| {
            let store = &stores[self.interaction_with(body, part.facet)];
            let wall = self.walls.facets[part.facet as usize].0;
            let (law, parcel, _) = store.at(part.slot);
            (body, wall, law, parcel)
        })
    }

    /// Puts contacts with walls into stores of the new blocks.
    fn settle_walls(&mut self) {
        let surfaces = &self.surfaces;
        let stores = || surfaces.iter().map(WallContacts::new).collect();
        self.wall_contacts = self.table.bounds.iter().map(|_| stores()).collect();
        for (block, bounds) in self.table.bounds.iter().enumerate() {
            let first = self.near_start[bounds.start];
            for body in bounds.clone() {
                for own in std::mem::take(&mut self.bodies.lifted[body]) {
                    let range = self.near_start[body] as usize..self.near_start[body + 1] as usize;
                    let known = self.near[range.clone()]
                        .iter()
                        .position(|part| part.facet == own.facet);
                    if let Some(place) = known {
                        let place = range.start + place;
                        let interaction = self.interaction_with(body, own.facet);
                        let store = &mut self.wall_contacts[block][interaction];
                        let holder = [(body - bounds.start) as u32, place as u32 - first];
                        let slot = store.adopt(holder, &own.law, own.parcel, own.force);
                        store.aim(slot, own.meeting);
                        self.near[place].slot = slot;
                    }
                }
            }
        }
    }

    /// Parts of walls near each body.
    pub(crate) fn find_near(&mut self) {
        let step = self.scene.time_step;
        self.walls.move_to(&self.scene.walls, self.time(), step);
        let (walls, skin) = (&self.walls, self.skin);
        let places = self.bodies.place.par_iter().zip(&self.bodies.lifted);
        let near: Vec<Vec<u32>> = places
            .zip(&self.bodies.fruit)
            .map(|((&HalfLine([x, y, z, radius]), lifted), fruit)| {
                // Another rank follows its contacts.
                if self.foreign.get(*fruit as usize).is_some_and(|own| *own) {
                    return Vec::new();
                }
                let mut own: Vec<u32> = lifted.iter().map(|own| own.facet).collect();
                walls.find_near([x, y, z], radius + skin, &mut own);
                own.sort_unstable();
                own.dedup();
                own
            })
            .collect();
        self.near_start = vec![0];
        self.near = Vec::new();
        let mut of_clumps = Vec::new();
        for (body, own) in near.into_iter().enumerate() {
            let slot = NONE;
            let parts = own.into_iter().map(|facet| NearPart { facet, slot });
            match self.bodies.clump[body] {
                NONE => self.near.extend(parts),
                _ => of_clumps.push((body as u32, parts.collect())),
            }
            self.near_start.push(self.near.len() as u32);
        }
        let pairs = &self.table.of_clumps;
        self.clump_contacts.relist(&self.bodies, pairs, of_clumps);
    }
}
