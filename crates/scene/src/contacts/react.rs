//! The force of one contact: the normal law, friction with memory, rolling friction.
//! For one contact or for several side by side: numbers are any [`Real`].

use crate::annuli::{Shear, slide};
use crate::interaction::Interaction;
use crate::vector::{Of, add, cross, dot, into_plane, less, scaled, stretch_into_plane};
use windfall_contact::law::ContactLaw;
use windfall_numerics::real::{Lanes, Real};

/// Two bodies where they touch.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Touch<R> {
    /// From the first body to the second; length 1.
    pub normal: Of<R>,
    /// How far the undeformed surfaces overlap, d; m.
    pub displacement: R,
    /// Velocity of the first body's surface relative to the second's, half a step ago; m/s.
    pub velocity: Of<R>,
    /// Angular velocity of the first relative to the second, half a step ago; rad/s.
    pub spin: Of<R>,
    /// R*; m.
    pub radius: R,
}

impl<R: Copy> Touch<R> {
    /// The same number everywhere.
    #[inline(always)]
    pub(crate) fn all(number: R) -> Self {
        Self {
            normal: [number; 3],
            displacement: number,
            velocity: [number; 3],
            spin: [number; 3],
            radius: number,
        }
    }
}

/// What a contact remembers that changes in every step; of numbers or of several side by side.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Memory<R> {
    /// Tangential force on the first body; N.
    pub tangential: [R; 3],
    /// Tangential stiffness; N/m.
    pub stiffness: R,
    /// Normal force; N.
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
    /// Largest normal force; N.
    pub force: R,
    /// Last time with a force, while there is none; s.
    pub ended: R,
}

impl<R: Real> Peaks<R> {
    /// As numbers without a processor's instructions.
    #[inline(always)]
    pub(crate) fn plain(self) -> Peaks<R::Plain> {
        Peaks {
            displacement: self.displacement.plain(),
            force: self.force.plain(),
            ended: self.ended.plain(),
        }
    }

    /// Above zero where any of them is later or larger than it was.
    #[inline(always)]
    pub(crate) fn growth_from(&self, before: &Self) -> R {
        let grown = (self.displacement - before.displacement).max(self.force - before.force);
        grown.max(self.ended - before.ended)
    }
}

impl<const W: usize> Peaks<Lanes<W>> {
    /// Nothing remembered.
    pub(crate) const ZERO: Self = Self {
        displacement: Lanes::ZERO,
        force: Lanes::ZERO,
        ended: Lanes::ZERO,
    };

    /// As numbers like `like`.
    #[inline(always)]
    pub(crate) fn with_plain<R: Real<Plain = Lanes<W>>>(self, like: R) -> Peaks<R> {
        Peaks {
            displacement: like.with_plain(self.displacement),
            force: like.with_plain(self.force),
            ended: like.with_plain(self.ended),
        }
    }

    /// One of several side by side.
    pub(crate) fn lane(&self, lane: usize) -> Peaks<f64> {
        Peaks {
            displacement: self.displacement.0[lane],
            force: self.force.0[lane],
            ended: self.ended.0[lane],
        }
    }

    /// Puts one among several.
    pub(crate) fn put_lane(&mut self, lane: usize, own: &Peaks<f64>) {
        self.displacement.0[lane] = own.displacement;
        self.force.0[lane] = own.force;
        self.ended.0[lane] = own.ended;
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

/// All that a contact remembers from step to step.
pub(crate) struct Remembered<'a, R: Real> {
    pub memory: &'a mut Memory<R>,
    pub peaks: &'a mut Peaks<R>,
    /// Elastic forces on the first body, from the innermost; N.
    pub annuli: &'a mut [Of<R::Plain>],
    /// The moment against rolling on the first body a step ago, where there is one; N m.
    pub rolling: Option<&'a mut Of<R>>,
}

/// What a contact does to the first body; the second has the opposite.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reaction<R> {
    /// Force; N.
    pub force: Of<R>,
    /// Moment besides that of the force; N m.
    pub rolling: Of<R>,
}

/// The normal force of a contact, as friction needs it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Normal<R> {
    /// Before it is clamped to be repulsive; N.
    pub force: R,
    /// ∂F/∂v; N s/m.
    pub damping: R,
    /// ∂F/∂d of the contact at rest; N/m.
    pub stiffness: R,
}

impl<R: Copy> Normal<R> {
    /// The same number everywhere.
    #[inline(always)]
    pub(crate) fn all(number: R) -> Self {
        Self {
            force: number,
            damping: number,
            stiffness: number,
        }
    }
}

/// The normal force of one law.
#[inline(always)]
pub(crate) fn normal_of<R: Real, L: ContactLaw<N>, const N: usize>(
    law: &L,
    displacement: R,
    rate: R,
    peak: R,
) -> Normal<R> {
    let moving = law.evaluate(displacement, rate, peak);
    let at_rest = law.evaluate(displacement, displacement.constant(0.0), peak);
    Normal {
        force: moving.force,
        damping: moving.by_rate,
        stiffness: at_rest.by_displacement,
    }
}

/// Time of a step, in all numbers side by side the same.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Clock {
    /// Now; s.
    pub time: f64,
    /// Time step; s.
    pub step: f64,
}

/// Displacement, its rate and the largest so far, for which the law is asked: the rate at the
/// end of the step is taken on from the last two half steps, so that damping has the
/// integrator's second order.
///
/// * `rate`, `peak`: as the contact remembers them
#[inline(always)]
pub(crate) fn given<R: Real>(touch: &Touch<R>, rate: R, peak: R) -> Of<R> {
    let now = dot(touch.velocity, touch.normal);
    [touch.displacement, now * 1.5 - rate * 0.5, peak]
}

/// Force of a contact, one step on.
///
/// The normal force is the law's; it never pulls.
/// The tangential force follows Mindlin's no-slip contact by increments, k_t = ratio ·
/// ∂F/∂d, in each annulus of the contact area for itself; while the contact unloads it shrinks
/// with the stiffness, so that no energy comes of it; Coulomb's limit caps it. Rolling is resisted by a spring that yields at
/// μ_r R* F, with the stiffness k_t R*².
///
/// * `found`: what the law says of [`given`]
///
/// # Source
/// Mindlin (1949), J. Appl. Mech. 16, 259; Thornton, Cummins and Cleary (2013), Powder
/// Technol. 233, 30 (unloading); Ai et al. (2011), Powder Technol. 206, 269 (rolling, model C).
#[inline(always)]
pub(crate) fn react<R: Real>(
    found: Normal<R>,
    surface: &Interaction,
    touch: &Touch<R>,
    clock: Clock,
    own: Remembered<R>,
) -> Reaction<R> {
    let Remembered {
        memory,
        peaks,
        annuli,
        rolling,
    } = own;
    let &Touch {
        normal,
        displacement,
        velocity,
        ..
    } = touch;
    let zero = displacement.constant(0.0);
    let now = displacement.constant(clock.time);
    let rate = dot(velocity, normal);
    let force = found.force.max(zero);
    // Where the force ended within the step.
    let since = found.force / (found.force - memory.normal);
    let ended = memory.normal.select(now - since * clock.step, peaks.ended);
    peaks.ended = force.select(peaks.ended, ended);
    memory.work = memory.work + (memory.normal + force) * rate * (0.5 * clock.step);
    memory.rate = rate;
    memory.normal = force;
    peaks.displacement = peaks.displacement.max(displacement);
    peaks.force = peaks.force.max(force);
    let mut reaction = Reaction {
        force: scaled(normal, -force),
        rolling: [zero; 3],
    };
    if surface.friction > 0.0 {
        let slip = less(velocity, normal, rate);
        let shear = Shear {
            limit: force * surface.friction,
            damping: found.damping.max(zero) * surface.tangential_damping,
            stiffness: found.stiffness.max(zero) * surface.tangential_ratio,
        };
        let before = memory.stiffness;
        let growth = before.select(shear.stiffness / before, zero + 1.0);
        memory.stiffness = shear.stiffness;
        let whole = slide(annuli, normal, slip, shear, growth, clock.step);
        let both = add(memory.tangential, whole);
        memory.friction_work = memory.friction_work - dot(both, slip) * (0.5 * clock.step);
        memory.tangential = whole;
        reaction.force = add(reaction.force, whole);
        if let Some(moment) = rolling {
            let limit = touch.radius * force * surface.rolling;
            reaction.rolling = roll(touch, limit, clock, memory, moment);
        }
    }
    reaction
}

/// The moment against rolling, one step on.
#[inline(always)]
fn roll<R: Real>(
    touch: &Touch<R>,
    limit: R,
    clock: Clock,
    memory: &mut Memory<R>,
    own: &mut Of<R>,
) -> Of<R> {
    let stiffness = memory.stiffness * touch.radius * touch.radius;
    let rolling = less(touch.spin, touch.normal, dot(touch.spin, touch.normal));
    let stretch = stretch_into_plane(*own, touch.normal);
    let before = into_plane(*own, touch.normal, stretch);
    let moment = less(before, rolling, stiffness * clock.step);
    let square = dot(moment, moment);
    let beyond = square - limit * limit;
    let capped = beyond.select(limit / square.sqrt(), limit.constant(1.0));
    let moment = scaled(moment, capped);
    let both = add(before, moment);
    memory.friction_work = memory.friction_work - dot(both, rolling) * (0.5 * clock.step);
    *own = moment;
    moment
}

/// Velocity of a body's surface where it touches, relative to another's.
///
/// * `arms`: spins times their distances to the contact, added: l₁ω₁ + l₂ω₂; m/s
#[inline(always)]
pub(crate) fn surface_velocity<R: Real>(relative: Of<R>, arms: Of<R>, normal: Of<R>) -> Of<R> {
    add(relative, cross(arms, normal))
}
