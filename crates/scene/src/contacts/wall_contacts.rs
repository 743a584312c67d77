//! Contacts of a fruit with walls.

use crate::contacts::contact::{Moment, Outcome, Over, Parcel, encounter, parted, spot, too_deep};
use crate::contacts::mesh_contacts::thin;
use crate::contacts::react::{Clock, Touch, surface_motion};
use crate::contacts::store::NONE;
use crate::contacts::wall_forces::{WallContacts, WallMeeting};
use crate::error::Error;
use crate::event::{Encounter, Partner};
use crate::interaction::Interaction;
use crate::scene::Scene;
use crate::shape::facet_tree::FacetTree;
use crate::shape::placed::Placed;
use crate::shape::surface::{Closest, Facet, Shape};
use crate::shape::wall::Wall;
use crate::vector::{Rotation, Vector, dot, length, plus_scaled, scaled, subtract};
use std::ops::Range;
use windfall_contact::laws::kind::Law;

/// A part of a wall that a body may touch.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NearPart {
    pub facet: u32,
    /// Number of the contact in its store, or [`NONE`].
    pub slot: u32,
}

/// A contact with a wall while the neighbour list is rebuilt.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lifted {
    pub facet: u32,
    pub law: Law,
    pub parcel: Parcel,
    /// How they met last.
    pub meeting: WallMeeting,
    /// Force on the fruit a step ago; N.
    pub force: Vector,
}

/// The walls of a scene in parts, where they are now.
#[derive(Clone, Debug)]
pub(crate) struct WallState {
    /// Names of the walls.
    names: Vec<String>,
    /// Every part of every wall, with the wall's number.
    pub facets: Vec<(u32, Facet)>,
    /// Where moving walls are, and where they were half a step ago.
    pub placed: Vec<Option<(Placed, Placed)>>,
    /// Velocities of the surfaces of walls that stay: belts.
    pub belts: Vec<Option<Placed>>,
    /// How far points of each wall are from its axis; 0 of endless planes, which are always
    /// looked at; m.
    reaches: Vec<f64>,
    /// Parts that are of no mesh.
    single: Vec<u32>,
    /// Of each mesh its wall, its first part, and all of them at rest.
    trees: Vec<(u32, u32, FacetTree)>,
}

impl WallState {
    /// The walls of a scene that was checked, with what continues them beyond its ends.
    pub fn new(scene: &Scene) -> Self {
        let walls = &scene.walls;
        let mut facets = Vec::new();
        let (mut single, mut trees) = (Vec::new(), Vec::new());
        for (number, wall) in walls.iter().enumerate() {
            let (number, first) = (number as u32, facets.len() as u32);
            let own = scene.parts_of(wall).unwrap_or_else(|_| wall.shape.facets());
            match &wall.shape {
                Shape::Mesh { .. } => {
                    let triangle = |facet: &Facet| match facet {
                        Facet::Triangle(corners) => Some(*corners),
                        _ => None,
                    };
                    let triangles: Vec<[Vector; 3]> = own.iter().filter_map(triangle).collect();
                    trees.push((number, first, FacetTree::new(&triangles)));
                }
                _ => single.extend(first..first + own.len() as u32),
            }
            facets.extend(own.into_iter().map(|facet| (number, facet)));
        }
        let belt =
            |wall: &Wall| (wall.motion.runs() && wall.motion.stays()).then(|| wall.motion.at(0.0));
        Self {
            names: walls.iter().map(|wall| wall.name.clone()).collect(),
            facets,
            placed: vec![None; walls.len()],
            belts: walls.iter().map(belt).collect(),
            reaches: walls.iter().map(Wall::reach).collect(),
            single,
            trees,
        }
    }

    pub(crate) fn move_to(&mut self, walls: &[Wall], time: f64, step: f64) {
        let places = self.placed.iter_mut().zip(&mut self.belts);
        for ((placed, belt), wall) in places.zip(walls) {
            let before = time - 0.5 * step;
            match wall.motion.stays() {
                true if wall.motion.is_steady() => {}
                true => *belt = Some(wall.motion.at(before)),
                false => *placed = Some((wall.motion.at(time), wall.motion.at(before))),
            }
        }
    }

    /// The largest speed of walls but endless planes between two times; m/s.
    pub(crate) fn largest_speed(&self, walls: &[Wall], between: [f64; 2]) -> f64 {
        let own = self.reaches.iter().zip(walls);
        let limited = own.filter(|(_, wall)| !matches!(wall.shape, Shape::Plane { .. }));
        let speeds = limited.map(|(reach, wall)| wall.motion.largest_speed(*reach, between));
        speeds.fold(0.0, f64::max)
    }

    /// The name of a wall as messages have it.
    pub(crate) fn name_of(&self, wall: u32) -> String {
        format!("\"{}\"", self.names[wall as usize])
    }

    #[inline(always)]
    pub(crate) fn closest(&self, facet: u32, place: Vector) -> Closest {
        let (wall, facet) = &self.facets[facet as usize];
        let placed = self.placed[*wall as usize].as_ref();
        facet.closest(placed.map(|(now, _)| now), place)
    }

    /// Whether a wall that moves is now where a sphere is to be.
    pub(crate) fn moved_into(&self, place: Vector, radius: f64) -> bool {
        self.facets.iter().any(|(wall, facet)| {
            let placed = self.placed[*wall as usize].as_ref();
            placed.is_some_and(|(now, _)| facet.closest(Some(now), place).distance < radius)
        })
    }

    /// The closest point of a part half a step ago.
    pub(crate) fn closest_before(&self, facet: u32, place: Vector) -> Closest {
        let (wall, facet) = &self.facets[facet as usize];
        let placed = self.placed[*wall as usize].as_ref();
        facet.closest(placed.map(|(_, before)| before), place)
    }

    /// Adds the parts of walls that come closer to a place than `reach`, by number.
    pub(crate) fn find_near(&self, place: Vector, reach: f64, near: &mut Vec<u32>) {
        let first = near.len();
        near.extend(self.single.iter().copied().filter(|&facet| {
            let (wall, part) = &self.facets[facet as usize];
            // Points of a moving plane far away go any way in a step.
            let endless = matches!(part, Facet::Plane { .. });
            endless && self.placed[*wall as usize].is_some()
                || self.closest(facet, place).distance < reach
        }));
        for (wall, start, tree) in &self.trees {
            let placed = self.placed[*wall as usize].as_ref();
            let own = placed.map_or(place, |(now, _)| now.inward(place));
            tree.near(own, reach, |triangle| {
                let facet = start + triangle;
                if self.facets[facet as usize].1.closest_at_rest(own).distance < reach {
                    near.push(facet);
                }
            });
        }
        near[first..].sort_unstable();
    }

    /// A place of a wall at rest, and a direction there, where the wall is now.
    pub(crate) fn moved(&self, wall: usize, place: Vector, normal: Vector) -> (Vector, Vector) {
        match &self.placed[wall] {
            Some((now, _)) => (now.outward(place), now.turned(normal)),
            None => (place, normal),
        }
    }

    /// How a sphere and a part of a wall meet, and the velocity of the wall where they met half
    /// a step ago; m/s.
    ///
    /// * `closest`: point of the part now
    #[inline(always)]
    pub(crate) fn meet(
        &self,
        facet: u32,
        closest: &Closest,
        body: &Flying,
        step: f64,
    ) -> (Touch<f64>, Vector) {
        let (wall, part) = &self.facets[facet as usize];
        let centre = plus_scaled(body.centre, body.velocity, -0.5 * step);
        let other;
        let before = match (
            &self.placed[*wall as usize],
            closest.inside && part.is_flat(),
        ) {
            (None, true) => closest,
            // Of the same plane, even where the fruit has just come over its edge.
            (Some((now, before)), true) => {
                other = now.carried(closest, before, centre);
                &other
            }
            (placed, false) => {
                other = part.closest(placed.as_ref().map(|(_, before)| before), centre);
                &other
            }
        };
        let wall_velocity = self.velocity(*wall, before.point, before.normal);
        let relative = subtract(body.velocity, wall_velocity);
        let arms = scaled(body.spin, before.distance);
        let (rate, slip) = surface_motion(relative, arms, before.normal);
        let touch = Touch {
            normal: closest.normal,
            displacement: body.radius - closest.distance,
            rate,
            slip,
            spin: body.spin,
            radius: part.effective_radius(body.radius, body.centre),
        };
        (touch, wall_velocity)
    }

    fn velocity(&self, wall: u32, place: Vector, normal: Vector) -> Vector {
        match (&self.placed[wall as usize], &self.belts[wall as usize]) {
            (Some((_, before)), _) => before.velocity_at(place, normal),
            (None, Some(belt)) => belt.velocity_at(place, normal),
            (None, None) => [0.0; 3],
        }
    }
}

/// A sphere and how it moves.
pub(crate) struct Flying {
    pub centre: Vector,
    pub radius: f64,
    /// Half a step ago; m/s.
    pub velocity: Vector,
    /// Half a step ago; rad/s.
    pub spin: Vector,
}

/// A fruit that may touch walls.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Body<'a> {
    pub fruit: &'a u32,
    pub centre: Vector,
    pub radius: f64,
    /// Half a step ago; m/s.
    pub velocity: Vector,
    /// Half a step ago; rad/s.
    pub spin: Vector,
    pub turn: &'a Rotation,
    /// The clump that it belongs to, or [`NONE`], and where in it; m.
    pub clump: (&'a u32, &'a Vector),
}

/// What a fruit's contacts with walls need of the rest of the scene.
pub(crate) struct Around<'a, S> {
    pub walls: &'a WallState,
    /// Which of the parts near bodies of the block are near this one.
    pub near: Range<usize>,
    /// Number of the interaction with a wall, and the interaction.
    pub surface: S,
    pub now: &'a Moment<'a>,
}

/// Finds where a fruit touches walls, begins and ends contacts, and puts into their stores
/// where each touches now.
///
/// * `near`: parts of walls near the bodies of the block
/// * `owner`: the fruit among these
/// * `hits`: room for what it touches
pub(crate) fn aim<'a>(
    near: &mut [NearPart],
    owner: u32,
    body: &Body,
    around: &Around<impl Fn(u32) -> (usize, &'a Interaction)>,
    stores: &mut [WallContacts],
    hits: &mut Vec<(u32, Closest)>,
    outcome: &mut Outcome,
) {
    let (walls, now) = (around.walls, around.now);
    let &Body { centre, radius, .. } = body;
    let at = Flying {
        centre,
        radius,
        velocity: body.velocity,
        spin: body.spin,
    };
    find_hits(walls, &near[around.near.clone()], centre, radius, hits);
    let own = around.near.clone();
    if hits.is_empty() && near[own].iter().all(|part| part.slot == NONE) {
        return;
    }
    follow(near, around, hits, body, stores, outcome);
    for (facet, closest) in hits.iter() {
        let facet = *facet;
        let wall = walls.facets[facet as usize].0;
        let (interaction, surface) = (around.surface)(wall);
        let (touch, wall_velocity) = walls.meet(facet, closest, &at, now.clock.step);
        let displacement = touch.displacement;
        let Some(place) = around
            .near
            .clone()
            .find(|place| near[*place].facet == facet)
        else {
            continue;
        };
        if near[place].slot == NONE {
            match begin(surface, &touch, now, body) {
                Ok((law, parcel)) => {
                    let holder = [owner, place as u32];
                    near[place].slot = stores[interaction].adopt(holder, &law, parcel, [0.0; 3]);
                }
                Err(problem) => {
                    outcome.problem.get_or_insert(problem);
                    continue;
                }
            }
        }
        let meeting = WallMeeting::new(&touch, closest.distance, wall_velocity);
        stores[interaction].aim(near[place].slot, meeting);
        // Also where the distance is no number.
        let shallow = displacement <= DEEPEST * radius;
        if !shallow {
            outcome.problem.get_or_insert_with(|| {
                too_deep(
                    now.clock.time,
                    *body.fruit,
                    walls.name_of(wall),
                    displacement,
                    radius,
                )
            });
        }
    }
}

/// Parts of walls that overlap a fruit. An edge counts only where no face beside it does.
pub(crate) fn find_hits(
    walls: &WallState,
    near: &[NearPart],
    centre: Vector,
    radius: f64,
    hits: &mut Vec<(u32, Closest)>,
) {
    hits.clear();
    for &NearPart { facet, .. } in near {
        let closest = walls.closest(facet, centre);
        let apart = closest.distance >= radius;
        if !apart {
            hits.push((facet, closest));
        }
    }
    thin(
        &walls.facets,
        |facet, place| walls.closest(facet, place),
        radius,
        hits,
    );
    if hits.len() < 2 {
        return;
    }
    // Faces first; an edge gives way to a face in whose plane it lies, and to the same
    // edge of another facet.
    hits.sort_by_key(|(facet, closest)| (!closest.inside, *facet));
    let mut kept = 0;
    for place in 0..hits.len() {
        let (facet, closest) = hits[place];
        let wall = walls.facets[facet as usize].0;
        let covered = hits[..kept].iter().any(|(other, before)| {
            let same_wall = walls.facets[*other as usize].0 == wall;
            let off = subtract(closest.point, before.point);
            let height = dot(off, before.normal).abs();
            let flat = before.inside && height < COINCIDENT * radius;
            same_wall && (flat || length(off) < COINCIDENT * radius)
        });
        let doubled = match closest.inside {
            true => hits[..kept]
                .iter()
                .any(|(_, before)| same_place(before, &closest, radius)),
            false => covered,
        };
        if !doubled {
            hits[kept] = (facet, closest);
            kept += 1;
        }
    }
    hits.truncate(kept);
}

fn same_place(a: &Closest, b: &Closest, radius: f64) -> bool {
    length(subtract(a.point, b.point)) < COINCIDENT * radius && dot(a.normal, b.normal) > 0.999
}

/// Overlap over the radius above which a contact with a wall means nothing: a soft wall
/// may give way, but not beyond the centre of a fruit; 1.
pub(crate) const DEEPEST: f64 = 0.9;

/// Points closer than this part of the radius are one.
const COINCIDENT: f64 = 1e-6;

/// A fruit that rolls from one part of a wall on to the next keeps its contact: this is the
/// least cosine between the normals.
pub(crate) const SAME_CONTACT: f64 = 0.9;

/// Ends contacts that are over, and hands on those that go over to another part of a wall.
fn follow<'a>(
    near: &mut [NearPart],
    around: &Around<impl Fn(u32) -> (usize, &'a Interaction)>,
    hits: &[(u32, Closest)],
    body: &Body,
    stores: &mut [WallContacts],
    outcome: &mut Outcome,
) {
    let walls = around.walls;
    for place in around.near.clone() {
        let NearPart { facet, slot } = near[place];
        if slot == NONE || hits.iter().any(|(hit, _)| *hit == facet) {
            continue;
        }
        let wall = walls.facets[facet as usize].0;
        let interaction = (around.surface)(wall).0;
        let normal = stores[interaction].meeting(slot).normal();
        let next = hits.iter().find_map(|(hit, closest)| {
            let goes_on =
                walls.facets[*hit as usize].0 == wall && dot(closest.normal, normal) > SAME_CONTACT;
            let mut others = around.near.clone();
            let other = others.find(|other| near[*other].facet == *hit)?;
            (goes_on && near[other].slot == NONE).then_some(other)
        });
        near[place].slot = NONE;
        if let Some(next) = next {
            near[next].slot = slot;
            stores[interaction].hold(slot, next as u32);
            continue;
        }
        let (law, parcel, _) = stores[interaction].at(slot);
        if let Some(moved) = stores[interaction].remove(slot) {
            near[moved as usize].slot = slot;
        }
        let gap = walls.closest(facet, body.centre).distance - body.radius;
        let parcel = parted(parcel, gap.max(0.0), around.now.clock);
        let partner = Partner::Wall(wall);
        let over = Over::of(&parcel, &law, false);
        outcome.events.extend(over.with(*body.fruit, partner));
    }
}

fn begin(
    surface: &Interaction,
    touch: &Touch<f64>,
    now: &Moment,
    body: &Body,
) -> Result<(Law, Parcel), Error> {
    let draws = &now.fruit[*body.fruit as usize].draws;
    let (turn, clump) = (*body.turn, (*body.clump.0, *body.clump.1));
    let encounter = met_wall(touch, (body.centre, body.radius), (turn, clump), now.clock);
    let law = surface.law_of(touch.radius, draws, None)?;
    let parcel = Parcel::begin(
        surface.scale(touch.radius),
        &law,
        touch,
        now.clock,
        encounter,
    );
    Ok((law, parcel))
}

/// How a sphere touches a wall now, as a beginning.
///
/// * `turn`, `clump`: of the fruit; the clump that the sphere belongs to, or [`NONE`], and where
///   in it, m
pub(crate) fn met_wall(
    touch: &Touch<f64>,
    (centre, radius): (Vector, f64),
    (turn, (clump, offset)): (Rotation, (u32, Vector)),
    clock: Clock,
) -> Encounter {
    let offset = (clump != NONE).then_some(offset);
    Encounter {
        place: plus_scaled(centre, touch.normal, radius - touch.displacement),
        spot: spot(turn, offset, radius, touch.normal),
        ..encounter(touch, clock)
    }
}
