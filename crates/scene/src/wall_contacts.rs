//! Contacts of a fruit with walls.

use crate::contact::{Moment, Outcome, Parcel, encounter, event, parted, too_deep};
use crate::error::Error;
use crate::event::{Encounter, Partner};
use crate::interaction::Interaction;
use crate::react::{History, Single, Touch, cross, dot, react, surface_velocity};
use crate::vector::{Rotation, Vector, add, length, plus_scaled, scaled, subtract, turned_back};
use crate::wall::{Closest, Facet, Placed, Wall};
use windfall_contact::law_kind::Law;
use windfall_contact::with_law;

/// A contact with a wall.
#[derive(Clone, Debug)]
pub(crate) struct WallContact {
    pub wall: u32,
    pub facet: u32,
    pub law: Law,
    pub normal: Vector,
    /// Force on the fruit a step ago; N.
    pub force: Vector,
    pub history: History,
    /// Moment against rolling on the fruit; N m.
    pub rolling: Vector,
    pub encounter: Encounter,
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
}

impl WallState {
    pub(crate) fn new(walls: &[Wall]) -> Self {
        let mut facets = Vec::new();
        for (number, wall) in walls.iter().enumerate() {
            facets.extend(
                wall.shape
                    .facets()
                    .into_iter()
                    .map(|facet| (number as u32, facet)),
            );
        }
        let belt = |wall: &Wall| {
            let runs = wall.motion.surface_velocity != [0.0; 3];
            (runs && wall.motion.stays()).then(|| wall.motion.at(0.0))
        };
        Self {
            names: walls.iter().map(|wall| wall.name.clone()).collect(),
            facets,
            placed: vec![None; walls.len()],
            belts: walls.iter().map(belt).collect(),
        }
    }

    pub(crate) fn move_to(&mut self, walls: &[Wall], time: f64, step: f64) {
        for (placed, wall) in self.placed.iter_mut().zip(walls) {
            if !wall.motion.stays() {
                *placed = Some((wall.motion.at(time), wall.motion.at(time - 0.5 * step)));
            }
        }
    }

    pub(crate) fn closest(&self, facet: u32, place: Vector) -> Closest {
        let (wall, facet) = &self.facets[facet as usize];
        let placed = self.placed[*wall as usize].as_ref();
        facet.closest(placed.map(|(now, _)| now), place)
    }

    fn velocity(&self, wall: u32, place: Vector, normal: Vector) -> Vector {
        match (&self.placed[wall as usize], &self.belts[wall as usize]) {
            (Some((_, before)), _) => before.velocity_at(place, normal),
            (None, Some(belt)) => belt.velocity_at(place, normal),
            (None, None) => [0.0; 3],
        }
    }
}

/// A fruit that may touch walls.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Body {
    pub fruit: u32,
    pub centre: Vector,
    pub radius: f64,
    /// Half a step ago; m/s.
    pub velocity: Vector,
    /// Half a step ago; rad/s.
    pub spin: Vector,
    pub turn: Rotation,
}

/// What walls do to a fruit in a step.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Pushed {
    /// N.
    pub force: Vector,
    /// N m.
    pub moment: Vector,
    /// Work that moving walls did; J.
    pub work: f64,
}

/// Forces of walls on a body, one step on.
///
/// * `near`: parts of walls that it may touch
/// * `hits`: room for those that it does
pub(crate) fn push<'a>(
    own: &mut Vec<WallContact>,
    body: &Body,
    (walls, near): (&WallState, &[u32]),
    surface: impl Fn(u32) -> &'a Interaction,
    now: &Moment,
    hits: &mut Vec<(u32, Closest)>,
    outcome: &mut Outcome,
) -> Pushed {
    let &Body { centre, radius, .. } = body;
    find_hits(walls, near, centre, radius, hits);
    let mut pushed = Pushed::default();
    if hits.is_empty() && own.is_empty() {
        return pushed;
    }
    follow(own, walls, hits, now, body, outcome);
    for &(facet, closest) in hits.iter() {
        let (wall, part) = &walls.facets[facet as usize];
        let surface = surface(*wall);
        let displacement = radius - closest.distance;
        let arm = closest.distance;
        let wall_velocity = walls.velocity(*wall, closest.point, closest.normal);
        let relative = subtract(body.velocity, wall_velocity);
        let touch = Touch {
            normal: closest.normal,
            displacement,
            velocity: surface_velocity(relative, scaled(body.spin, arm), closest.normal),
            spin: body.spin,
            radius: effective_radius(part, radius, centre),
        };
        let known = own.iter().position(|contact| contact.facet == facet);
        let place = match known {
            Some(place) => place,
            None => match begin((*wall, facet), surface, &touch, closest.point, now, body) {
                Ok(contact) => {
                    own.push(contact);
                    own.len() - 1
                }
                Err(problem) => {
                    outcome.problem.get_or_insert(problem);
                    continue;
                }
            },
        };
        let contact = &mut own[place];
        contact.normal = closest.normal;
        let rolling = (surface.rolling > 0.0).then_some(&mut contact.rolling);
        let reaction = with_law!(&contact.law, law => {
            react(&Single(law), surface, &touch, now.clock, &mut contact.history, rolling)
        });
        let mean = scaled(add(contact.force, reaction.force), 0.5);
        pushed.work += dot(mean, wall_velocity) * now.clock.step;
        contact.force = reaction.force;
        pushed.force = add(pushed.force, reaction.force);
        let moment = scaled(cross(closest.normal, reaction.force), arm);
        pushed.moment = add(add(pushed.moment, moment), reaction.rolling);
        // Also where the distance is no number.
        let shallow = displacement <= DEEPEST * radius;
        if !shallow {
            outcome.problem.get_or_insert_with(|| {
                too_deep(
                    now.clock.time,
                    body.fruit,
                    format!("\"{}\"", walls.names[*wall as usize]),
                    displacement,
                    radius,
                )
            });
        }
    }
    pushed
}

/// Parts of walls that overlap a fruit. An edge counts only where no face beside it does.
fn find_hits(
    walls: &WallState,
    near: &[u32],
    centre: Vector,
    radius: f64,
    hits: &mut Vec<(u32, Closest)>,
) {
    hits.clear();
    for &facet in near {
        let closest = walls.closest(facet, centre);
        let apart = closest.distance >= radius;
        if !apart {
            hits.push((facet, closest));
        }
    }
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
const DEEPEST: f64 = 0.9;

/// Points closer than this part of the radius are one.
const COINCIDENT: f64 = 1e-6;

/// A fruit that rolls from one part of a wall on to the next keeps its contact: this is the
/// least cosine between the normals.
const SAME_CONTACT: f64 = 0.9;

/// Ends contacts that are over, and hands on those that go over to another part of a wall.
fn follow(
    own: &mut Vec<WallContact>,
    walls: &WallState,
    hits: &[(u32, Closest)],
    now: &Moment,
    body: &Body,
    outcome: &mut Outcome,
) {
    let mut place = 0;
    while place < own.len() {
        let contact = &own[place];
        if hits.iter().any(|(facet, _)| *facet == contact.facet) {
            place += 1;
            continue;
        }
        let next = hits.iter().find(|(facet, closest)| {
            walls.facets[*facet as usize].0 == contact.wall
                && dot(closest.normal, contact.normal) > SAME_CONTACT
                && own.iter().all(|other| other.facet != *facet)
        });
        if let Some((facet, _)) = next {
            own[place].facet = *facet;
            place += 1;
            continue;
        }
        let contact = own.remove(place);
        let gap = walls.closest(contact.facet, body.centre).distance - body.radius;
        let parcel = Parcel {
            scale: 1.0,
            history: contact.history,
            rolling: contact.rolling,
            encounter: contact.encounter,
        };
        let parcel = parted(parcel, gap.max(0.0), now.clock);
        let partner = Partner::Wall(contact.wall);
        outcome.events.push(event(
            &parcel.history,
            &parcel.encounter,
            body.fruit,
            partner,
            false,
        ));
    }
}

fn begin(
    (wall, facet): (u32, u32),
    surface: &Interaction,
    touch: &Touch<f64>,
    point: Vector,
    now: &Moment,
    body: &Body,
) -> Result<WallContact, Error> {
    let draws = &now.fruit[body.fruit as usize].draws;
    let mut encounter = encounter(touch.normal, touch.displacement, touch.velocity, now.clock);
    encounter.place = point;
    encounter.spot = turned_back(body.turn, touch.normal);
    Ok(WallContact {
        wall,
        facet,
        law: surface.law_of(touch.radius, draws, None)?,
        normal: touch.normal,
        force: [0.0; 3],
        history: History::at(now.clock.time, encounter.normal_speed),
        rolling: [0.0; 3],
        encounter,
    })
}

/// R* of a fruit on a part of a wall; m. Edges count as flat.
fn effective_radius(facet: &Facet, radius: f64, centre: Vector) -> f64 {
    let Facet::Cylinder {
        start,
        along,
        radius: tube,
    } = facet
    else {
        return radius;
    };
    let from = subtract(centre, *start);
    let out = plus_scaled(from, *along, -dot(from, *along) / dot(*along, *along));
    // Of a sphere against a cylinder, by the mean of the two curvatures.
    let sign = if length(out) < *tube { -1.0 } else { 1.0 };
    1.0 / (1.0 / radius + sign * 0.5 / tube)
}
