//! The list of neighbours made anew, and what goes over into it.

use crate::contact::Parcel;
use crate::neighbours::{NONE, PairTable, sort_into_cells};
use crate::pair_contacts::pair_contacts;
use crate::pair_forces::PairForce;
use crate::simulation::Simulation;
use crate::vector::scaled;
use crate::wall::Facet;
use rayon::prelude::*;
use windfall_contact::law_kind::Law;

impl Simulation {
    /// A new list of neighbours; contacts go over into it.
    pub(crate) fn rebuild(&mut self) {
        self.rebuilds += 1;
        let (cells, order) = sort_into_cells(&mut self.bodies, self.skin);
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
            |a, b| numbers[a as usize * materials + b as usize],
        );
        let old = std::mem::replace(&mut self.table, table);
        let contacts = std::mem::take(&mut self.contacts);
        self.contacts = self
            .table
            .blocks
            .iter()
            .map(|parts| {
                let parts = parts.iter();
                parts
                    .map(|(own, _)| pair_contacts(&self.surfaces[*own].law))
                    .collect()
            })
            .collect();
        let mut carried = Vec::new();
        for (parts, contacts) in old.blocks.iter().zip(&contacts) {
            for ((_, range), contacts) in parts.iter().zip(contacts) {
                for contact in 0..contacts.count() {
                    let (entry, law, parcel) = contacts.at(contact);
                    let entry = range.start + entry as usize;
                    let new = |body: u32| place.get(body as usize).copied().unwrap_or(NONE);
                    let pair = (new(old.first[entry]), new(old.second[entry]));
                    carried.extend(self.carried(pair, law, parcel));
                }
            }
        }
        // In the order of the list, in which they are worked through.
        carried.sort_unstable_by_key(|(entry, ..)| *entry);
        for (entry, law, parcel) in carried {
            let block = self.table.block_of(self.table.first[entry] as usize);
            let parts = &self.table.blocks[block];
            if let Some(part) = parts.iter().position(|(_, range)| range.contains(&entry)) {
                let own = (entry - parts[part].1.start) as u32;
                self.table.slot[entry] = self.contacts[block][part].adopt(own, &law, parcel);
            }
        }
        self.forces = vec![PairForce::default(); self.table.first.len()];
        self.loads = vec![[0.0; 8]; self.bodies.len()];
        let rolls = self.surfaces.iter().any(|own| own.rolling > 0.0);
        self.rolling = vec![[0.0; 3]; if rolls { self.table.first.len() } else { 0 }];
        self.listed = self
            .bodies
            .place
            .iter()
            .map(|own| [own[0], own[1], own[2]])
            .collect();
        (self.moved, self.wall_way) = (0.0, 0.0);
        self.find_near();
    }

    /// A contact of the old list as one of the new.
    fn carried(&self, pair: (u32, u32), law: Law, parcel: Parcel) -> Option<(usize, Law, Parcel)> {
        if pair.0 == NONE || pair.1 == NONE {
            return None;
        }
        let (first, second, parcel) = match pair.0 < pair.1 {
            true => (pair.0, pair.1, parcel),
            false => {
                let swapped = Parcel {
                    scale: parcel.scale,
                    history: parcel.history.swapped(),
                    rolling: scaled(parcel.rolling, -1.0),
                    encounter: parcel.encounter.swapped(),
                };
                (pair.1, pair.0, swapped)
            }
        };
        self.table
            .find(first, second)
            .map(|entry| (entry, law, parcel))
    }

    /// Parts of walls near each body.
    pub(crate) fn find_near(&mut self) {
        let step = self.scene.time_step;
        self.walls.move_to(&self.scene.walls, self.time(), step);
        let (walls, skin) = (&self.walls, self.skin);
        let near: Vec<Vec<u32>> = self
            .bodies
            .place
            .par_iter()
            .map(|&[x, y, z, radius]| {
                let facets = 0..walls.facets.len() as u32;
                let reach = radius + 0.5 * skin;
                facets
                    .filter(|&facet| {
                        let (wall, part) = &walls.facets[facet as usize];
                        // Points of a moving plane far away go any way in a step.
                        let endless = matches!(part, Facet::Plane { .. });
                        endless && walls.placed[*wall as usize].is_some()
                            || walls.closest(facet, [x, y, z]).distance < reach
                    })
                    .collect()
            })
            .collect();
        self.near_start = vec![0];
        self.near = Vec::new();
        for own in near {
            self.near.extend(own);
            self.near_start.push(self.near.len() as u32);
        }
    }
}
