//! What a contact remembers from step to step, alone or several side by side.

use crate::binary;
use windfall_numerics::real::{Lanes, Real};

/// What a contact remembers that changes in every step; of numbers or of several side by side.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Memory<R> {
    /// Tangential force on the first body; N.
    pub tangential: [R; 3],
    /// Tangential stiffness; N/m.
    pub stiffness: R,
    /// Normal force; N. Before the first step of a contact what that step weighs, below zero: see
    /// [`first_weight`](crate::contacts::react::first_weight); 1.
    pub normal: R,
    /// Rate of the displacement half a step ago; m/s.
    pub rate: R,
    /// Work of the bodies on the normal contact; J.
    pub work: R,
    /// Work of the bodies on friction and rolling; J.
    pub friction_work: R,
}

/// What a contact remembers that seldom changes, and is written only then.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Peaks<R> {
    /// Largest displacement; m.
    pub displacement: R,
    /// Largest normal force since it is watched anew: of the present pulse; N.
    pub force: R,
    /// Last time with a force, while there is none; s.
    pub ended: R,
    /// Largest displacement since it is watched anew: of the present pulse; m.
    pub reach: R,
    /// The band of the force: see [`Turn::band`](crate::contacts::pulse::Turn); N.
    pub below: R,
    pub above: R,
}

impl<R: Real> Peaks<R> {
    /// As numbers without a processor's instructions.
    #[inline(always)]
    pub(crate) fn plain(self) -> Peaks<R::Plain> {
        Peaks {
            displacement: self.displacement.plain(),
            force: self.force.plain(),
            ended: self.ended.plain(),
            reach: self.reach.plain(),
            below: self.below.plain(),
            above: self.above.plain(),
        }
    }

    /// Above zero where any of them is later or larger than it was.
    #[inline(always)]
    pub(crate) fn growth_from(&self, before: &Self) -> R {
        let grown = (self.displacement - before.displacement).max(self.force - before.force);
        grown.max((self.ended - before.ended).max(self.reach - before.reach))
    }
}

impl<const W: usize> Peaks<Lanes<W>> {
    /// Nothing remembered, and no force that matters.
    pub(crate) const ZERO: Self = Self {
        displacement: Lanes::ZERO,
        force: Lanes::ZERO,
        ended: Lanes::ZERO,
        reach: Lanes::ZERO,
        below: Lanes([-1.0; W]),
        above: Lanes([f64::INFINITY; W]),
    };

    /// As numbers like `like`.
    #[inline(always)]
    pub(crate) fn with_plain<R: Real<Plain = Lanes<W>>>(self, like: R) -> Peaks<R> {
        Peaks {
            displacement: like.with_plain(self.displacement),
            force: like.with_plain(self.force),
            ended: like.with_plain(self.ended),
            reach: like.with_plain(self.reach),
            below: like.with_plain(self.below),
            above: like.with_plain(self.above),
        }
    }

    /// One of several side by side.
    pub(crate) fn lane(&self, lane: usize) -> Peaks<f64> {
        Peaks {
            displacement: self.displacement.0[lane],
            force: self.force.0[lane],
            ended: self.ended.0[lane],
            reach: self.reach.0[lane],
            below: self.below.0[lane],
            above: self.above.0[lane],
        }
    }

    /// Puts one among several.
    pub(crate) fn put_lane(&mut self, lane: usize, own: &Peaks<f64>) {
        self.displacement.0[lane] = own.displacement;
        self.force.0[lane] = own.force;
        self.ended.0[lane] = own.ended;
        self.reach.0[lane] = own.reach;
        self.below.0[lane] = own.below;
        self.above.0[lane] = own.above;
    }
}

/// A memory of which each field comes of the same field of another.
macro_rules! memory {
    ($own:expr, $vector:ident, $number:ident) => {
        Memory {
            tangential: $vector!($own.tangential),
            stiffness: $number!($own.stiffness),
            normal: $number!($own.normal),
            rate: $number!($own.rate),
            work: $number!($own.work),
            friction_work: $number!($own.friction_work),
        }
    };
}

impl<R: Real> Memory<R> {
    /// As numbers without a processor's instructions.
    #[inline(always)]
    pub(crate) fn plain(self) -> Memory<R::Plain> {
        macro_rules! vector {
            ($own:expr) => {
                [$own[0].plain(), $own[1].plain(), $own[2].plain()]
            };
        }
        macro_rules! number {
            ($own:expr) => {
                $own.plain()
            };
        }
        memory!(self, vector, number)
    }
}

impl<const W: usize> Memory<Lanes<W>> {
    /// Nothing remembered.
    pub(crate) const ZERO: Self = {
        macro_rules! vector {
            ($own:expr) => {
                [Lanes::ZERO; 3]
            };
        }
        macro_rules! number {
            ($own:expr) => {
                Lanes::ZERO
            };
        }
        memory!((), vector, number)
    };

    /// As numbers like `like`.
    #[inline(always)]
    pub(crate) fn with_plain<R: Real<Plain = Lanes<W>>>(self, like: R) -> Memory<R> {
        macro_rules! vector {
            ($own:expr) => {
                like.with_each_plain($own)
            };
        }
        macro_rules! number {
            ($own:expr) => {
                like.with_plain($own)
            };
        }
        memory!(self, vector, number)
    }

    /// One of several side by side.
    pub(crate) fn lane(&self, lane: usize) -> History {
        macro_rules! vector {
            ($own:expr) => {
                $own.map(|own| own.0[lane])
            };
        }
        macro_rules! number {
            ($own:expr) => {
                $own.0[lane]
            };
        }
        memory!(self, vector, number)
    }

    /// Puts one among several.
    pub(crate) fn put_lane(&mut self, lane: usize, history: &History) {
        let mut all = *self;
        macro_rules! put {
            ($($field:ident)*) => {
                $(all.$field.0[lane] = history.$field;)*
            };
        }
        put!(stiffness normal rate work friction_work);
        for axis in 0..3 {
            all.tangential[axis].0[lane] = history.tangential[axis];
        }
        *self = all;
    }
}

/// The memory of one contact.
pub type History = Memory<f64>;

impl History {
    /// The same contact seen from the second body.
    pub(crate) fn swapped(self) -> Self {
        Self {
            tangential: self.tangential.map(|own| -own),
            ..self
        }
    }
}

binary!(Memory<f64> {
    tangential, stiffness, normal, rate, work, friction_work
});
binary!(Peaks<f64> {
    displacement,
    force,
    ended,
    reach,
    below,
    above
});
