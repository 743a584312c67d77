//! The sphere of a fruit that makes a contact: a body, or one that fits into its spheroid.

use crate::contacts::bodies::Bodies;
use crate::contacts::contact::{Moment, spot};
use crate::contacts::store::Load;
use crate::line::HalfLine;
use crate::shape::spheroid::{Spine, closest_spheres};
use crate::vector::{Vector, add, cross, plus_scaled, scaled, turned, turned_on};

/// A sphere that moves with a body.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ball {
    /// The body.
    pub body: usize,
    /// m.
    pub centre: Vector,
    /// m.
    pub radius: f64,
    /// Radius for the law: of a spheroid the mean of both curvatures; m.
    pub curvature_radius: f64,
    /// Half a step ago; m/s.
    pub velocity: Vector,
    /// Half a step ago; rad/s.
    pub spin: Vector,
    /// From the centre of the body to that of the sphere; m.
    arm: Vector,
    /// The same in the fruit's own axes, along the first; m.
    along: f64,
}

impl Ball {
    /// The sphere of a body.
    pub(crate) fn of(body: usize, bodies: &Bodies) -> Self {
        let HalfLine([x, y, z, radius]) = bodies.place[body];
        let m = &bodies.motion[body];
        Self {
            body,
            centre: [x, y, z],
            radius,
            curvature_radius: radius,
            velocity: [m[0], m[1], m[2]],
            spin: [m[4], m[5], m[6]],
            arm: [0.0; 3],
            along: 0.0,
        }
    }

    /// The axis of its spheroid, where it belongs to one.
    pub(crate) fn spine(&self, bodies: &Bodies, now: &Moment) -> Option<Spine> {
        let fruit = &now.fruit[bodies.fruit[self.body] as usize];
        let shape = fruit.clump.as_ref()?.spheroid?;
        let axis = turned(bodies.turn[self.body], [1.0, 0.0, 0.0]);
        let centre = plus_scaled(self.centre, axis, -bodies.offset[self.body][0]);
        Some(Spine {
            shape,
            centre,
            axis,
        })
    }

    /// The axis of its spheroid half a step ago.
    fn spine_before(&self, spine: &Spine, bodies: &Bodies, now: &Moment) -> Spine {
        let (turn, step) = (bodies.turn[self.body], now.clock.step);
        let axis = turned(turned_on(turn, self.spin, -0.5 * step), [1.0, 0.0, 0.0]);
        let offset = scaled(axis, -bodies.offset[self.body][0]);
        let velocity = add(self.velocity, cross(self.spin, offset));
        Spine {
            centre: plus_scaled(spine.centre, velocity, -0.5 * step),
            axis,
            ..*spine
        }
    }

    /// The sphere that made the contact half a step ago, as it is now: another one of a spheroid
    /// that turns.
    ///
    /// * `from`: where on the axis the contact is now; m
    /// * `normal`: towards the closest point of the partner half a step ago from a place; length 1
    pub(crate) fn before(
        &self,
        (from, spine): (f64, &Spine),
        bodies: &Bodies,
        now: &Moment,
        normal: impl Fn(Vector) -> Vector,
    ) -> Self {
        let before = self.spine_before(spine, bodies, now);
        self.at(before.deepest(from, normal), spine, bodies, now)
    }

    /// The sphere at a place of the axis of its spheroid.
    ///
    /// * `along`: from the spheroid's centre; m
    pub(crate) fn at(&self, along: f64, spine: &Spine, bodies: &Bodies, now: &Moment) -> Self {
        let way = along - bodies.offset[self.body][0];
        let arm = scaled(spine.axis, way);
        // As it was half a step ago.
        let turn = turned_on(bodies.turn[self.body], self.spin, -0.5 * now.clock.step);
        let before = turned(turn, [way, 0.0, 0.0]);
        Self {
            centre: spine.at(along),
            radius: spine.shape.radius(along),
            curvature_radius: spine.shape.curvature_radius(along),
            velocity: add(self.velocity, cross(self.spin, before)),
            arm,
            along: way,
            ..*self
        }
    }

    /// The spheres of two fruit that overlap most, and those that did half a step ago, as they are
    /// now.
    ///
    /// * `pair`: bodies of them to begin with
    pub(crate) fn closest(pair: [usize; 2], bodies: &Bodies, now: &Moment) -> [[Self; 2]; 2] {
        let mut own = pair.map(|body| Self::of(body, bodies));
        // The second is the nearest of its images.
        own[1].centre = bodies.periods.image(own[1].centre, own[0].centre);
        let spines = own.each_ref().map(|own| own.spine(bodies, now));
        let centres = own.each_ref().map(|own| own.centre);
        let from = [0, 1].map(|side| spines[side].map_or(0.0, |_| bodies.offset[pair[side]][0]));
        let places = closest_spheres(spines.each_ref().map(Option::as_ref), centres, from);
        let at = |places: [f64; 2]| {
            [0, 1].map(|side| match &spines[side] {
                Some(spine) => own[side].at(places[side], spine, bodies, now),
                None => own[side],
            })
        };
        let half = 0.5 * now.clock.step;
        let before = [0, 1].map(|side| {
            let spine = spines[side].as_ref();
            spine.map(|spine| own[side].spine_before(spine, bodies, now))
        });
        let centres = own
            .each_ref()
            .map(|own| plus_scaled(own.centre, own.velocity, -half));
        let earlier = closest_spheres(before.each_ref().map(Option::as_ref), centres, places);
        [at(places), at(earlier)]
    }

    /// Where on its fruit it is touched.
    pub(crate) fn spot(&self, bodies: &Bodies, normal: Vector) -> Vector {
        let offset = bodies.offset_of(self.body);
        let offset = offset.map(|own| add(own, [self.along, 0.0, 0.0]));
        spot(bodies.turn[self.body], offset, self.radius, normal)
    }

    /// Adds a force on it, and a moment about its centre, to the loads of its body.
    pub(crate) fn load(&self, loads: &mut [Load], force: Vector, moment: Vector) {
        let moment = add(moment, cross(self.arm, force));
        let load = &mut loads[self.body];
        for axis in 0..3 {
            load[axis] += force[axis];
            load[4 + axis] += moment[axis];
        }
    }
}
