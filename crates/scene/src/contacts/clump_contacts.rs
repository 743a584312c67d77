//! Contacts of clumps of spheres: one for each pair of fruit, one for each side of a wall.
//!
//! Spheres of a clump overlap, and several of them may reach into the same partner. As the
//! fruit that they stand for is convex, it touches once: the sphere that reaches deepest makes
//! the contact, and hands it on when another one does. In a spheroid that is any sphere that fits
//! into it, found along its axis from the deepest of those that are bodies.

use crate::contacts::ball::Ball;
use crate::contacts::bodies::Bodies;
use crate::contacts::contact::{
    LARGEST_OVERLAP, Moment, Outcome, Over, Parcel, encounter, parted, too_deep, turn,
};
use crate::contacts::react::{
    Clock, Remembered, Touch, direction_before, given, normal_of, react, surface_motion,
};
use crate::contacts::store::Load;
use crate::contacts::wall_contacts::{
    DEEPEST, Flying, NearPart, SAME_CONTACT, WallState, find_hits,
};
use crate::error::{Error, fruit_name};
use crate::event::{Encounter, Partner};
use crate::interaction::Interaction;
use crate::shape::surface::Closest;
use crate::vector::{Vector, add, cross, dot, length, plus_scaled, scaled, subtract};
use std::collections::BTreeMap;
use windfall_contact::effective::effective_radius;
use windfall_contact::laws::kind::Law;
use windfall_contact::with_law;

/// A contact that is there.
#[derive(Clone, Debug)]
pub(crate) struct Touching {
    pub law: Law,
    pub parcel: Parcel,
}

/// A contact of a clump with a wall.
#[derive(Clone, Debug)]
pub(crate) struct TouchingWall {
    pub wall: u32,
    /// From the clump to the wall.
    pub normal: Vector,
    /// On the fruit a step ago; N.
    pub force: Vector,
    pub own: Touching,
}

/// Two fruit of which one or both are clumps.
#[derive(Clone, Debug, Default)]
struct FruitPair {
    /// Bodies of the first (with the lower number) and of the second that may touch.
    spheres: Vec<[u32; 2]>,
    contact: Option<Touching>,
}

/// A clump and the walls near it.
#[derive(Clone, Debug, Default)]
struct NearWalls {
    /// Its bodies, each with the parts of walls near it.
    near: Vec<(u32, Vec<NearPart>)>,
    contacts: Vec<TouchingWall>,
}

/// All contacts of clumps, by the numbers of the fruit.
#[derive(Clone, Debug, Default)]
pub(crate) struct ClumpContacts {
    pairs: BTreeMap<[u32; 2], FruitPair>,
    walls: BTreeMap<u32, NearWalls>,
}

/// What a step needs to know.
pub(crate) struct Around<'a, S> {
    pub bodies: &'a Bodies,
    pub walls: &'a WallState,
    pub now: &'a Moment<'a>,
    /// The interaction of two materials; of a material and a wall.
    pub surface: S,
    pub wall_materials: &'a [u32],
    /// How far the surfaces of two fruit lie outside of their bodies at most, together; m.
    pub lacks: f64,
}

impl ClumpContacts {
    /// Contacts of two fruit now.
    pub(crate) fn pair_count(&self) -> usize {
        let pairs = self.pairs.values();
        pairs.filter(|own| own.contact.is_some()).count()
    }

    /// A new list of what may touch; contacts go over into it.
    ///
    /// * `pairs`: bodies of different fruit, of which one belongs to a clump
    /// * `near`: bodies of clumps with parts of walls near them
    pub(crate) fn relist(
        &mut self,
        bodies: &Bodies,
        pairs: &[[u32; 2]],
        near: Vec<(u32, Vec<NearPart>)>,
    ) {
        let mut old = std::mem::take(self);
        let number = |body: u32| bodies.fruit[body as usize];
        for &[i, j] in pairs {
            let spheres = if number(i) < number(j) {
                [i, j]
            } else {
                [j, i]
            };
            let own = self.pairs.entry(spheres.map(number)).or_default();
            own.spheres.push(spheres);
        }
        for (key, own) in &mut self.pairs {
            own.spheres.sort_unstable();
            own.contact = old.pairs.get_mut(key).and_then(|old| old.contact.take());
        }
        for (body, parts) in near {
            let own = self.walls.entry(number(body)).or_default();
            own.near.push((body, parts));
        }
        for (fruit, own) in &mut self.walls {
            own.near.sort_unstable_by_key(|(body, _)| *body);
            let old = old.walls.get_mut(fruit);
            own.contacts = old.map_or_else(Vec::new, |old| std::mem::take(&mut old.contacts));
        }
    }

    /// Contacts of two fruit, with their numbers.
    pub(crate) fn touching_pairs(&self) -> impl Iterator<Item = ([u32; 2], &Touching)> {
        let pairs = self.pairs.iter();
        pairs.filter_map(|(key, own)| Some((*key, own.contact.as_ref()?)))
    }

    /// Contacts with walls, with the numbers of the fruit.
    pub(crate) fn touching_walls(&self) -> impl Iterator<Item = (u32, &TouchingWall)> {
        let walls = self.walls.iter();
        walls.flat_map(|(fruit, own)| own.contacts.iter().map(|own| (*fruit, own)))
    }

    /// A contact of two fruit that is there before a list is made.
    pub(crate) fn put_pair(&mut self, fruit: [u32; 2], own: Touching) {
        self.pairs.entry(fruit).or_default().contact = Some(own);
    }

    /// A contact with a wall that is there before a list is made.
    pub(crate) fn put_wall(&mut self, fruit: u32, own: TouchingWall) {
        self.walls.entry(fruit).or_default().contacts.push(own);
    }

    /// Contacts that are still there, with the fruit and what they touch.
    pub(crate) fn all(&self) -> impl Iterator<Item = (u32, Partner, &Touching)> {
        let pairs = self.touching_pairs();
        let pairs = pairs.map(|([a, b], own)| (a, Partner::Fruit(b), own));
        let walls = self.touching_walls();
        pairs.chain(walls.map(|(fruit, own)| (fruit, Partner::Wall(own.wall), &own.own)))
    }

    /// Adds the forces of all to the loads of bodies, one step on; the work of walls, J.
    pub(crate) fn advance<'a>(
        &mut self,
        around: &Around<'a, impl Fn(u32, u32) -> &'a Interaction>,
        loads: &mut [Load],
        outcome: &mut Outcome,
    ) -> f64 {
        for own in self.pairs.values_mut() {
            if let Err(problem) = own.advance(around, loads, outcome) {
                outcome.problem.get_or_insert(problem);
            }
        }
        let mut work = 0.0;
        for (fruit, own) in &mut self.walls {
            match own.advance(*fruit, around, loads, outcome) {
                Ok(done) => work += done,
                Err(problem) => {
                    outcome.problem.get_or_insert(problem);
                }
            }
        }
        work
    }
}

impl Touching {
    /// Force and moment against rolling on the first body, one step on; with the loads that are
    /// over although the contact lasts.
    ///
    /// * `encounter`: how they touch now
    fn push(
        &mut self,
        surface: &Interaction,
        touch: &Touch<f64>,
        clock: Clock,
        encounter: impl FnOnce() -> Encounter,
    ) -> (Vector, Vector, Option<Over>) {
        let Parcel {
            history,
            peaks,
            annuli,
            rolling,
            pulse,
            encounter: began,
            ..
        } = &mut self.parcel;
        let [d, v, peak] = given(touch, history.rate, peaks.displacement);
        let found = with_law!(&self.law, law => normal_of(law, d, v, peak));
        let own = Remembered {
            memory: &mut *history,
            peaks: &mut *peaks,
            annuli: &mut annuli.0[..surface.annuli],
            rolling: surface.rolls().then_some(rolling),
        };
        let reaction = react(found, surface, touch, clock, own);
        let (now, law) = ((clock.time, touch.displacement), self.law);
        let over = match reaction.turned > 0.0 {
            true => turn(history, peaks, pulse, began, || law, now),
            false => None,
        };
        if over.is_some() {
            *began = encounter().from(pulse.rise.time);
        }
        (reaction.force, reaction.rolling, over)
    }
}

impl FruitPair {
    fn advance<'a>(
        &mut self,
        around: &Around<'a, impl Fn(u32, u32) -> &'a Interaction>,
        loads: &mut [Load],
        outcome: &mut Outcome,
    ) -> Result<(), Error> {
        let (bodies, now) = (around.bodies, around.now);
        let deepest = self.spheres.iter().map(|own| (bodies.overlap(*own), *own));
        let deepest = deepest.reduce(|a, b| if b.0 > a.0 { b } else { a });
        let Some((depth, [i, j])) = deepest else {
            return Ok(());
        };
        let fruit = [i, j].map(|body| bodies.fruit[body as usize]);
        if depth <= -around.lacks && self.contact.is_none() {
            return Ok(());
        }
        let [[a, b], [c, d]] = Ball::closest([i as usize, j as usize], bodies, now);
        let between = subtract(b.centre, a.centre);
        let distance = length(between);
        let depth = a.radius + b.radius - distance;
        let fruit = (fruit[0], fruit[1]);
        if depth <= 0.0 {
            if let Some(own) = self.contact.take() {
                let parted = parted(own.parcel, -depth, now.clock);
                let over = Over::of(&parted, &own.law, false);
                outcome.events.extend(over.of_pair(fruit));
            }
            return Ok(());
        }
        let smaller = a.radius.min(b.radius);
        let shallow = depth <= LARGEST_OVERLAP * smaller;
        if !shallow {
            let partner = fruit_name(fruit.1);
            return Err(too_deep(now.clock.time, fruit.0, partner, depth, smaller));
        }
        let normal = scaled(between, 1.0 / distance);
        let (near, far) = (a.radius - 0.5 * depth, b.radius - 0.5 * depth);
        // Of the spheres that touched half a step ago.
        let (close, away) = (c.radius - 0.5 * depth, d.radius - 0.5 * depth);
        let arms = add(scaled(c.spin, close), scaled(d.spin, away));
        let relative = subtract(c.velocity, d.velocity);
        let earlier = subtract(d.centre, c.centre);
        let before = direction_before((earlier, length(earlier)), relative, now.clock.step);
        let (rate, slip) = surface_motion(relative, arms, before);
        let touch = Touch {
            normal,
            displacement: depth,
            rate,
            slip,
            spin: subtract(a.spin, b.spin),
            radius: effective_radius(a.curvature_radius, b.curvature_radius),
        };
        let [i, j] = [a.body, b.body];
        let surface = (around.surface)(bodies.material[i], bodies.material[j]);
        let met = || Encounter {
            place: plus_scaled(a.centre, normal, near),
            spot: a.spot(bodies, normal),
            other_spot: b.spot(bodies, scaled(normal, -1.0)),
            ..encounter(&touch, now.clock)
        };
        let own = match &mut self.contact {
            Some(own) => own,
            none => {
                let draws = |body: usize| &now.fruit[bodies.fruit[body] as usize].draws;
                let law = surface.law_of(touch.radius, draws(i), Some(draws(j)))?;
                let scale = surface.scale(touch.radius);
                let parcel = Parcel::begin(scale, &law, &touch, now.clock, met());
                none.insert(Touching { law, parcel })
            }
        };
        let (force, rolling, over) = own.push(surface, &touch, now.clock, met);
        let over = over.into_iter().flat_map(|own| own.of_pair(fruit));
        outcome.events.extend(over);
        let twist = cross(normal, force);
        a.load(loads, force, add(scaled(twist, near), rolling));
        let (force, rolling) = (scaled(force, -1.0), scaled(rolling, -1.0));
        b.load(loads, force, add(scaled(twist, far), rolling));
        Ok(())
    }
}

/// A sphere of a clump that reaches into a wall.
struct Hit {
    ball: Ball,
    /// The sphere that touched half a step ago.
    before: Ball,
    facet: u32,
    wall: u32,
    depth: f64,
    closest: Closest,
}

impl NearWalls {
    /// Where the clump touches: the deepest of hits on one side of a wall.
    ///
    /// * `lacks`: how far its surface lies outside of its bodies at most; m
    fn hits(&self, bodies: &Bodies, walls: &WallState, now: &Moment, lacks: f64) -> Vec<Hit> {
        let (mut all, mut found) = (Vec::new(), Vec::new());
        for (place, (body, parts)) in self.near.iter().enumerate() {
            let ball = Ball::of(*body as usize, bodies);
            let reach = ball.radius + lacks;
            find_hits(walls, parts, ball.centre, reach, &mut found);
            let hits = found.iter().map(|&(facet, closest)| {
                let wall = walls.facets[facet as usize].0;
                let hit = Hit {
                    depth: ball.radius - closest.distance,
                    ball,
                    before: ball,
                    facet,
                    wall,
                    closest,
                };
                (place, hit)
            });
            all.extend(hits);
        }
        // The deepest first; of the same depth in the order of bodies.
        all.sort_by(|a, b| b.1.depth.total_cmp(&a.1.depth));
        let mut kept: Vec<Hit> = Vec::new();
        for (place, hit) in all {
            let same = |own: &Hit| hit.is_beside(own.wall, own.closest.normal);
            if !kept.iter().any(same) {
                kept.push(hit.deepest(&self.near[place].1, bodies, walls, now));
            }
        }
        kept.retain(|own| own.depth > 0.0);
        kept
    }

    fn advance<'a>(
        &mut self,
        fruit: u32,
        around: &Around<'a, impl Fn(u32, u32) -> &'a Interaction>,
        loads: &mut [Load],
        outcome: &mut Outcome,
    ) -> Result<f64, Error> {
        let (bodies, now) = (around.bodies, around.now);
        let mut before = std::mem::take(&mut self.contacts);
        let mut work = 0.0;
        for hit in self.hits(bodies, around.walls, now, 0.5 * around.lacks) {
            let goes_on = |own: &TouchingWall| hit.is_beside(own.wall, own.normal);
            let ball = &hit.ball;
            let material = around.wall_materials[hit.wall as usize];
            let surface = (around.surface)(bodies.material[ball.body], material);
            let radius = ball.radius;
            let shallow = hit.depth <= DEEPEST * radius;
            if !shallow {
                let partner = around.walls.name_of(hit.wall);
                return Err(too_deep(now.clock.time, fruit, partner, hit.depth, radius));
            }
            let at = Flying {
                centre: hit.before.centre,
                radius,
                velocity: hit.before.velocity,
                spin: ball.spin,
            };
            let (walls, step) = (around.walls, now.clock.step);
            let (mut touch, wall_velocity) = walls.meet(hit.facet, &hit.closest, &at, step);
            touch.radius = walls.facets[hit.facet as usize]
                .1
                .effective_radius(ball.curvature_radius, ball.centre);
            let mut own = match before.iter().position(goes_on) {
                Some(place) => before.remove(place),
                None => hit.begin(surface, &touch, bodies, now)?,
            };
            let met = || hit.met(&touch, bodies, now.clock);
            let (force, rolling, over) = own.own.push(surface, &touch, now.clock, met);
            let partner = Partner::Wall(hit.wall);
            let over = over.into_iter().flat_map(|own| own.with(fruit, partner));
            outcome.events.extend(over);
            let mean = scaled(add(own.force, force), 0.5);
            work += dot(mean, wall_velocity) * now.clock.step;
            (own.force, own.normal) = (force, touch.normal);
            let moment = scaled(cross(touch.normal, force), hit.closest.distance);
            ball.load(loads, force, add(moment, rolling));
            self.contacts.push(own);
        }
        for own in before {
            // How far it is away is not looked for: the force was small already.
            let parcel = parted(own.own.parcel, 0.0, now.clock);
            let partner = Partner::Wall(own.wall);
            let over = Over::of(&parcel, &own.own.law, false);
            outcome.events.extend(over.with(fruit, partner));
        }
        Ok(work)
    }
}

impl Hit {
    /// Whether it is on the side of a wall that has this normal there.
    fn is_beside(&self, wall: u32, normal: Vector) -> bool {
        self.wall == wall && dot(self.closest.normal, normal) > SAME_CONTACT
    }

    /// The same side of the wall touched by the sphere of a spheroid that reaches deepest.
    ///
    /// * `near`: parts of walls near the body
    fn deepest(self, near: &[NearPart], bodies: &Bodies, walls: &WallState, now: &Moment) -> Self {
        let Some(spine) = self.ball.spine(bodies, now) else {
            return self;
        };
        let nearest = |place: Vector| {
            let parts = near.iter().map(|own| own.facet);
            let own = parts.filter(|facet| walls.facets[*facet as usize].0 == self.wall);
            let own = own.map(|facet| (facet, walls.closest(facet, place)));
            let beside = own.filter(|(_, own)| self.is_beside(self.wall, own.normal));
            let found = beside.reduce(|a, b| if b.1.distance < a.1.distance { b } else { a });
            found.unwrap_or((self.facet, self.closest))
        };
        let from = bodies.offset[self.ball.body][0];
        let along = spine.deepest(from, |place| nearest(place).1.normal);
        let ball = self.ball.at(along, &spine, bodies, now);
        let (facet, closest) = nearest(ball.centre);
        let earlier = |place: Vector| walls.closest_before(facet, place).normal;
        let before = self.ball.before((along, &spine), bodies, now, earlier);
        Self {
            depth: ball.radius - closest.distance,
            ball,
            before,
            facet,
            closest,
            ..self
        }
    }

    /// How they touch now, as a beginning.
    fn met(&self, touch: &Touch<f64>, bodies: &Bodies, clock: Clock) -> Encounter {
        Encounter {
            place: self.closest.point,
            spot: self.ball.spot(bodies, touch.normal),
            ..encounter(touch, clock)
        }
    }

    fn begin(
        &self,
        surface: &Interaction,
        touch: &Touch<f64>,
        bodies: &Bodies,
        now: &Moment,
    ) -> Result<TouchingWall, Error> {
        let draws = &now.fruit[bodies.fruit[self.ball.body] as usize].draws;
        let law = surface.law_of(touch.radius, draws, None)?;
        let scale = surface.scale(touch.radius);
        let parcel = Parcel::begin(
            scale,
            &law,
            touch,
            now.clock,
            self.met(touch, bodies, now.clock),
        );
        Ok(TouchingWall {
            wall: self.wall,
            normal: touch.normal,
            force: [0.0; 3],
            own: Touching { law, parcel },
        })
    }
}
