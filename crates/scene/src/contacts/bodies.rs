//! What moves in a scene, body by body.

use crate::contacts::store::NONE;
use crate::contacts::wall_contacts::Lifted;
use crate::line::{HalfLine, Line};
use crate::periods::Periods;
use crate::vector::{Rotation, Vector, length};

/// Fruit that are in the scene, in an order in which neighbours stand close together.
#[derive(Clone, Debug, Default)]
pub(crate) struct Bodies {
    /// Place, m, and radius, m.
    pub place: Vec<HalfLine>,
    /// Velocity half a step ago, m/s; 1/mass; angular velocity, rad/s; 1/moment of inertia.
    pub motion: Vec<Line>,
    /// Orientation.
    pub turn: Vec<Rotation>,
    /// Number of the fruit in the scene.
    pub fruit: Vec<u32>,
    pub material: Vec<u32>,
    /// The clump that a sphere belongs to, by its number among the clumps, or [`NONE`].
    pub clump: Vec<u32>,
    /// Its number in its clump.
    pub sphere: Vec<u32>,
    /// Where in its clump: from the centre, in the clump's own axes; m.
    pub offset: Vec<Vector>,
    /// Contacts with walls, while the list is rebuilt.
    pub lifted: Vec<Vec<Lifted>>,
    /// Along which axes bodies have images.
    pub periods: Periods,
}

impl Bodies {
    pub(crate) fn len(&self) -> usize {
        self.place.len()
    }

    /// Where in its clump a body is, if it belongs to one; m.
    pub(crate) fn offset_of(&self, body: usize) -> Option<Vector> {
        self.from(0).offset_of(body)
    }

    /// How far two bodies overlap; m.
    pub(crate) fn overlap(&self, pair: [u32; 2]) -> f64 {
        self.from(0).overlap(pair)
    }

    /// From a body on.
    pub(crate) fn from(&self, first: usize) -> BodiesFrom<'_> {
        let all = BodiesFrom {
            place: &self.place,
            motion: &self.motion,
            turn: &self.turn,
            fruit: &self.fruit,
            clump: &self.clump,
            offset: &self.offset,
            periods: &self.periods,
        };
        all.from(first)
    }

    /// In another order: body `order[n]` becomes body n.
    pub(crate) fn reordered(&mut self, order: &[u32]) {
        fn picked<T: Copy>(from: &[T], order: &[u32]) -> Vec<T> {
            order.iter().map(|&old| from[old as usize]).collect()
        }
        self.place = picked(&self.place, order);
        self.motion = picked(&self.motion, order);
        self.turn = picked(&self.turn, order);
        self.fruit = picked(&self.fruit, order);
        self.material = picked(&self.material, order);
        self.clump = picked(&self.clump, order);
        self.sphere = picked(&self.sphere, order);
        self.offset = picked(&self.offset, order);
        let mut old = std::mem::take(&mut self.lifted);
        self.lifted = order
            .iter()
            .map(|&place| std::mem::take(&mut old[place as usize]))
            .collect();
    }
}

/// Bodies from the first of a block on, by their numbers in it: see [`Bodies`].
#[derive(Clone, Copy)]
pub(crate) struct BodiesFrom<'a> {
    pub place: &'a [HalfLine],
    pub motion: &'a [Line],
    pub turn: &'a [Rotation],
    pub fruit: &'a [u32],
    pub clump: &'a [u32],
    pub offset: &'a [Vector],
    pub periods: &'a Periods,
}

impl<'a> BodiesFrom<'a> {
    /// From a later body on.
    pub(crate) fn from(&self, first: usize) -> BodiesFrom<'a> {
        BodiesFrom {
            place: &self.place[first..],
            motion: &self.motion[first..],
            turn: &self.turn[first..],
            fruit: &self.fruit[first..],
            clump: &self.clump[first..],
            offset: &self.offset[first..],
            periods: self.periods,
        }
    }

    /// Where in its clump a body is, if it belongs to one; m.
    pub(crate) fn offset_of(&self, body: usize) -> Option<Vector> {
        (self.clump[body] != NONE).then(|| self.offset[body])
    }

    /// How far two bodies overlap; m.
    pub(crate) fn overlap(&self, pair: [u32; 2]) -> f64 {
        let [a, b] = pair.map(|body| self.place[body as usize][3]);
        a + b - length(self.between(pair))
    }

    /// From one body to another, or to the nearest of its images; m.
    #[inline(always)]
    pub(crate) fn between(&self, pair: [u32; 2]) -> Vector {
        let [a, b] = pair.map(|body| &self.place[body as usize]);
        self.periods
            .nearest([b[0] - a[0], b[1] - a[1], b[2] - a[2]])
    }
}
