//! The force of one contact: the normal law, friction with memory, rolling friction.
//! For one contact or for several side by side: numbers are any [`Real`].

use crate::annuli::{Shear, slide};
use crate::contacts::memory::{Memory, Peaks};
use crate::interaction::Interaction;
use crate::vector::{Of, add, cross, dot, into_plane, less, scaled, stretch_into_plane};
use windfall_contact::law::ContactLaw;
use windfall_contact::laws::kind::Law;
use windfall_contact::with_law;
use windfall_numerics::real::Real;

/// Two bodies where they touch.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Touch<R> {
    /// From the first body to the second; length 1.
    pub normal: Of<R>,
    /// How far the undeformed surfaces overlap, d; m.
    pub displacement: R,
    /// Rate of the displacement half a step ago; m/s.
    pub rate: R,
    /// Velocity of the first body's surface along the second's, half a step ago; m/s.
    pub slip: Of<R>,
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
            rate: number,
            slip: [number; 3],
            spin: [number; 3],
            radius: number,
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
    /// Above zero where the normal force has left its band; N.
    pub turned: R,
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
    /// Whether loads that last are looked at in it.
    pub looks: bool,
}

/// Steps between looks at loads that last.
pub(crate) const LOOK: u64 = 64;

/// Displacement, its rate and the largest so far, for which the law is asked: the rate at the
/// end of the step is taken on from the last two half steps, so that damping has the
/// integrator's second order.
///
/// * `rate`, `peak`: as the contact remembers them
#[inline(always)]
pub(crate) fn given<R: Real>(touch: &Touch<R>, rate: R, peak: R) -> Of<R> {
    [touch.displacement, touch.rate * 1.5 - rate * 0.5, peak]
}

/// What the force at the end of the step of first touch weighs, so that the impulse of its damping
/// is that from first touch to the half step after it; 1. Damping that sets in at once, or as a
/// root, would otherwise act up to half a step too long or too short. The elastic part stays as
/// it is: weighed, it would not conserve energy over many contacts.
///
/// * `touch`: at the end of that step
pub(crate) fn first_weight(law: &Law, touch: &Touch<f64>, step: f64) -> f64 {
    let &Touch {
        displacement, rate, ..
    } = touch;
    let force = |displacement: f64, rate: f64| with_law!(law, law => normal_of(law, displacement, rate, displacement).force);
    let damping = |displacement: f64| force(displacement, rate) - force(displacement, 0.0);
    let now = force(displacement, rate);
    let end = displacement + 0.5 * rate * step;
    if now <= 0.0 || !begins(touch, step) {
        return 1.0;
    }
    // Of squares: forces begin with half powers of the displacement.
    let terms = NODES.map(|(node, weight)| 2.0 * weight * node * damping(end * node * node));
    let mean = terms.iter().sum::<f64>() * end / (rate * step);
    1.0 + (mean - damping(displacement)) / now
}

/// The force just after first touch, which is the largest where damping sets in at once and falls
/// faster than the elastic force grows; N.
///
/// * `touch`: at the end of that step
pub(crate) fn first_force(law: &Law, touch: &Touch<f64>, step: f64) -> f64 {
    // Laws have no force where there is no displacement.
    let displacement = JUST * touch.displacement;
    let force =
        || with_law!(law, law => normal_of(law, displacement, touch.rate, displacement).force);
    if begins(touch, step) {
        force().max(0.0)
    } else {
        0.0
    }
}

/// Steps after first touch in which a force is no peak; 1.
const BEGINNING: f64 = 2.05;

/// Displacement just after first touch, over that at the end of the step; 1.
const JUST: f64 = 1e-12;

/// Whether two bodies touched within the step before, as they came closer.
fn begins(touch: &Touch<f64>, step: f64) -> bool {
    // A little more where they touched just as the step began.
    touch.rate > 0.0 && touch.displacement <= 1.001 * touch.rate * step
}

/// Elastic energy of a contact: what it gives back on its way from a displacement, m; J.
///
/// * `deepest`: the largest displacement so far; m
pub(crate) fn stored_energy(law: &Law, displacement: f64, deepest: f64) -> f64 {
    let force = |displacement: f64| {
        with_law!(law, law => normal_of(law, displacement, 0.0, deepest).force).max(0.0)
    };
    let terms = NODES.map(|(node, weight)| 2.0 * weight * node * force(displacement * node * node));
    terms.iter().sum::<f64>() * displacement
}

/// Nodes and weights of Gauss and Legendre's quadrature from 0 to 1.
///
/// # Source
/// Abramowitz and Stegun (1964), table 25.4, n = 4.
const NODES: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_9),
    (0.330_009_478_207_571_9, 0.326_072_577_431_273_1),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_1),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_9),
];

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
        rate,
        slip,
        ..
    } = touch;
    let zero = displacement.constant(0.0);
    let now = displacement.constant(clock.time);
    let force = found.force.max(zero);
    // How much of a step the force acts before now: half, except at first touch.
    let late = (-memory.normal).select(-memory.normal + -0.5, zero + 0.5);
    let before = memory.normal.max(zero);
    if force.select(zero, before).any_above_zero() {
        // Where the force ended within the step.
        let since = found.force / (found.force - before);
        let ended = before.select(now - since * clock.step, peaks.ended);
        peaks.ended = force.select(peaks.ended, ended);
    }
    memory.work = memory.work + (before * 0.5 + force * late) * rate * clock.step;
    memory.rate = rate;
    memory.normal = force;
    peaks.displacement = peaks.displacement.max(displacement);
    // The rate that follows first touch is taken on from one before it: too high for a peak there,
    // which is known (see [`first_force`]).
    let begun = displacement - rate * (BEGINNING * clock.step);
    peaks.force = peaks.force.max(begun.select(force, zero));
    peaks.reach = peaks.reach.max(displacement);
    let seldom = if clock.looks {
        -peaks.below
    } else {
        zero + -1.0
    };
    let half = (-peaks.below).select(seldom, peaks.force * 0.5);
    let below = peaks.below.select(peaks.below, half);
    let mut reaction = Reaction {
        force: scaled(normal, -force),
        rolling: [zero; 3],
        turned: (below - force).max(force - peaks.above),
    };
    if surface.friction > 0.0 {
        let slip = less(slip, normal, dot(slip, normal));
        let shear = Shear {
            limit: force * surface.friction,
            damping: found.damping.max(zero) * surface.tangential_damping,
            stiffness: found.stiffness.max(zero) * surface.tangential_ratio,
        };
        let before = memory.stiffness;
        let growth = before.select(shear.stiffness / before, zero + 1.0);
        memory.stiffness = shear.stiffness;
        let whole = slide(annuli, normal, slip, shear, growth, clock.step);
        let both = less(scaled(memory.tangential, zero + 0.5), whole, -late);
        memory.friction_work = memory.friction_work - dot(both, slip) * clock.step;
        memory.tangential = whole;
        reaction.force = add(reaction.force, whole);
        if let Some(moment) = rolling {
            let limit = touch.radius * force * surface.rolling;
            reaction.rolling = roll(touch, limit, clock, memory, moment);
        }
    }
    reaction.force = scaled(reaction.force, late + 0.5);
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

/// Direction from one centre to another half a step ago; length 1 but for a square of the step.
/// The rate of the distance along it is that of the whole step.
///
/// * `between`: from the first to the second now, with its length; m
/// * `relative`: velocity of the first relative to the second, half a step ago; m/s
#[inline(always)]
pub(crate) fn direction_before<R: Real>(
    (between, distance): (Of<R>, R),
    relative: Of<R>,
    step: f64,
) -> Of<R> {
    let one = distance.constant(1.0);
    let before = less(between, relative, -one * step);
    let middle = less(between, relative, -one * (0.5 * step));
    scaled(middle, one * 2.0 / (distance + dot(before, before).sqrt()))
}

/// How two surfaces move where they touch: rate of the displacement, and velocity of the first
/// along the second; m/s.
///
/// * `relative`: velocity of the first body relative to the second; m/s
/// * `arms`: spins times their distances to the contact, added: l₁ω₁ + l₂ω₂; m/s
/// * `normal`: from the first to the second; length 1
#[inline(always)]
pub(crate) fn surface_motion<R: Real>(relative: Of<R>, arms: Of<R>, normal: Of<R>) -> (R, Of<R>) {
    let rate = dot(relative, normal);
    (rate, add(less(relative, normal, rate), cross(arms, normal)))
}
