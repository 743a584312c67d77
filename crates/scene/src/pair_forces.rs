//! Forces of pairs that touch, four at a time.

use crate::interaction::Interaction;
use crate::neighbours::Bodies;
use crate::react::{
    Clock, History, Memory, Normal, NormalLaw, Of, Touch, cross, dot, normal_of, react,
    surface_velocity,
};
use crate::vector::{Vector, add, scaled};
use windfall_contact::law::ContactLaw;
use windfall_numerics::real::{Lanes, Real};
use windfall_numerics::real_vector::{FourLanes, LANES};

/// Force of a pair on its first body; the second has the opposite.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(64))]
pub(crate) struct PairForce {
    /// N.
    pub force: Vector,
    /// Normal × force: the moment is this times the distance to the contact; N.
    pub twist: Vector,
    /// Half the overlap: what the distance to the contact lacks of the radius; m.
    pub short: f64,
}

/// What every step needs of a contact.
#[derive(Clone, Copy)]
pub(crate) struct Hot<L> {
    /// The law of this pair.
    pub law: L,
    /// What radii multiply the median's force by; 1.
    pub scale: f64,
    pub history: History,
}

/// Pairs of one block and one interaction, of which some touch.
pub(crate) struct Batch<'a, L, const N: usize> {
    /// The median's law, where the pairs have multiples of it.
    pub median: Option<L>,
    pub bodies: &'a Bodies,
    pub first: &'a [u32],
    pub second: &'a [u32],
    /// The contact of each entry.
    pub slot: &'a [u32],
    /// Force (N) and moment (N m) of pairs on the bodies of the block, 0 to 2 and 4 to 6.
    pub loads: &'a mut [[f64; 8]],
    /// The first body of the block.
    pub base: usize,
    /// What second bodies of other blocks are to get.
    pub out: &'a mut [PairForce],
    pub rolling_out: &'a mut [Vector],
    /// Entries that touch.
    pub touching: &'a [u32],
    pub hot: &'a mut [Hot<L>],
    pub rolling: &'a mut [Vector],
    pub surface: &'a Interaction,
    pub clock: Clock,
}

impl<L: ContactLaw<N>, const N: usize> FourLanes for Batch<'_, L, N> {
    /// The largest overlap over the smaller radius; 1.
    type Output = f64;

    #[inline(always)]
    fn run<R: Real<Plain = Lanes<LANES>>>(self, zero: R) -> f64 {
        let mut batch = self;
        let median = batch.median;
        let mut deepest = zero;
        let rolls = !batch.rolling_out.is_empty();
        let touching = batch.touching;
        let mut start = 0;
        while start < touching.len() {
            // The last few are filled up with the last of them.
            let count = LANES.min(touching.len() - start);
            let mut entries = [touching[start + count - 1] as usize; LANES];
            for lane in 0..count {
                entries[lane] = touching[start + lane] as usize;
            }
            let mut own = [0; LANES];
            for lane in 0..LANES {
                own[lane] = batch.slot[entries[lane]] as usize;
            }
            let (touch, smaller) = touch(&batch, entries, zero);
            deepest = deepest.max(touch.displacement / smaller);
            let mut memory = load(batch.hot, own, zero);
            let mut moment = match rolls {
                true => load_vectors(batch.rolling, own, zero),
                false => [zero; 3],
            };
            let rolling = if rolls { Some(&mut moment) } else { None };
            let (surface, clock) = (batch.surface, batch.clock);
            let reaction = match &median {
                Some(law) => {
                    let scale = |lane: usize| batch.hot[own[lane]].scale;
                    let scale = zero.with_plain(Lanes([scale(0), scale(1), scale(2), scale(3)]));
                    let law = Scaled::<L, R, N> { law, scale };
                    react(&law, surface, &touch, clock, &mut memory, rolling)
                }
                None => {
                    let law = |lane: usize| batch.hot[own[lane]].law;
                    let law = Each::<L, N>([law(0), law(1), law(2), law(3)]);
                    react(&law, surface, &touch, clock, &mut memory, rolling)
                }
            };
            store(batch.hot, own, count, &memory);
            let (kept, given) = (plain(moment), plain(reaction.rolling));
            if rolls {
                for lane in 0..count {
                    for axis in 0..3 {
                        batch.rolling[own[lane]][axis] = kept[axis][lane];
                        batch.rolling_out[entries[lane]][axis] = given[axis][lane];
                    }
                }
            }
            let twist = cross(touch.normal, reaction.force);
            let load = (reaction.force, twist, touch.displacement);
            give(&mut batch, entries, count, load, given);
            start += count;
        }
        let Lanes(deepest) = deepest.plain();
        deepest.into_iter().fold(0.0, f64::max)
    }
}

/// The median's law times a factor of each pair.
struct Scaled<'a, L, R, const N: usize> {
    law: &'a L,
    scale: R,
}

impl<R: Real, L: ContactLaw<N>, const N: usize> NormalLaw<R> for Scaled<'_, L, R, N> {
    #[inline(always)]
    fn normal(&self, displacement: R, rate: R, peak: R) -> Normal<R> {
        let own = normal_of(self.law, displacement, rate, peak);
        Normal {
            force: own.force * self.scale,
            damping: own.damping * self.scale,
            stiffness: own.stiffness * self.scale,
        }
    }
}

/// A law of its own for each of four pairs.
struct Each<L, const N: usize>([L; LANES]);

impl<R: Real<Plain = Lanes<LANES>>, L: ContactLaw<N>, const N: usize> NormalLaw<R> for Each<L, N> {
    #[inline(always)]
    fn normal(&self, displacement: R, rate: R, peak: R) -> Normal<R> {
        let (Lanes(d), Lanes(v), Lanes(p)) = (displacement.plain(), rate.plain(), peak.plain());
        let (mut force, mut damping, mut stiffness) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        for lane in 0..LANES {
            let own = normal_of(&self.0[lane], d[lane], v[lane], p[lane]);
            (force[lane], damping[lane], stiffness[lane]) = (own.force, own.damping, own.stiffness);
        }
        Normal {
            force: rate.with_plain(Lanes(force)),
            damping: rate.with_plain(Lanes(damping)),
            stiffness: rate.with_plain(Lanes(stiffness)),
        }
    }
}

/// Column `at` of four rows.
#[inline(always)]
fn column<R: Real<Plain = Lanes<LANES>>, const W: usize>(
    rows: [&[f64; W]; LANES],
    at: usize,
    zero: R,
) -> R {
    zero.with_plain(Lanes([rows[0][at], rows[1][at], rows[2][at], rows[3][at]]))
}

/// Where four pairs touch, and the smaller radius of each.
#[inline(always)]
fn touch<R: Real<Plain = Lanes<LANES>>, L, const N: usize>(
    batch: &Batch<L, N>,
    entries: [usize; LANES],
    zero: R,
) -> (Touch<R>, R) {
    let (places, motions) = (&batch.bodies.place[..], &batch.bodies.motion[..]);
    let mut i = [0; LANES];
    let mut j = [0; LANES];
    for lane in 0..LANES {
        i[lane] = batch.first[entries[lane]] as usize;
        j[lane] = batch.second[entries[lane]] as usize;
    }
    let a = [&places[i[0]], &places[i[1]], &places[i[2]], &places[i[3]]];
    let b = [&places[j[0]], &places[j[1]], &places[j[2]], &places[j[3]]];
    let u = [
        &motions[i[0]],
        &motions[i[1]],
        &motions[i[2]],
        &motions[i[3]],
    ];
    let w = [
        &motions[j[0]],
        &motions[j[1]],
        &motions[j[2]],
        &motions[j[3]],
    ];
    let between = [
        column(b, 0, zero) - column(a, 0, zero),
        column(b, 1, zero) - column(a, 1, zero),
        column(b, 2, zero) - column(a, 2, zero),
    ];
    let (left, right) = (column(a, 3, zero), column(b, 3, zero));
    let reach = left + right;
    let distance = dot(between, between).sqrt();
    let displacement = reach - distance;
    let one = zero.constant(1.0);
    let inverse = one / distance;
    let normal = [
        between[0] * inverse,
        between[1] * inverse,
        between[2] * inverse,
    ];
    let half = displacement * 0.5;
    let (near, far) = (left - half, right - half);
    let (p, q) = (
        [column(u, 4, zero), column(u, 5, zero), column(u, 6, zero)],
        [column(w, 4, zero), column(w, 5, zero), column(w, 6, zero)],
    );
    let relative = [
        column(u, 0, zero) - column(w, 0, zero),
        column(u, 1, zero) - column(w, 1, zero),
        column(u, 2, zero) - column(w, 2, zero),
    ];
    let arms = [
        near * p[0] + far * q[0],
        near * p[1] + far * q[1],
        near * p[2] + far * q[2],
    ];
    let touch = Touch {
        normal,
        displacement,
        velocity: surface_velocity(relative, arms, normal),
        spin: [p[0] - q[0], p[1] - q[1], p[2] - q[2]],
        radius: left * right / reach,
    };
    (touch, left.min(right))
}

#[inline(always)]
fn load<R: Real<Plain = Lanes<LANES>>, L>(
    hot: &[Hot<L>],
    own: [usize; LANES],
    zero: R,
) -> Memory<R> {
    let [a, b, c, d] = [
        &hot[own[0]].history,
        &hot[own[1]].history,
        &hot[own[2]].history,
        &hot[own[3]].history,
    ];
    macro_rules! side_by_side {
        ($($field:tt)+) => {
            zero.with_plain(Lanes([a.$($field)+, b.$($field)+, c.$($field)+, d.$($field)+]))
        };
    }
    Memory {
        elastic: [
            side_by_side!(elastic[0]),
            side_by_side!(elastic[1]),
            side_by_side!(elastic[2]),
        ],
        tangential: [
            side_by_side!(tangential[0]),
            side_by_side!(tangential[1]),
            side_by_side!(tangential[2]),
        ],
        stiffness: side_by_side!(stiffness),
        normal: side_by_side!(normal),
        rate: side_by_side!(rate),
        peak: side_by_side!(peak),
        peak_force: side_by_side!(peak_force),
        work: side_by_side!(work),
        friction_work: side_by_side!(friction_work),
        pushed: side_by_side!(pushed),
    }
}

#[inline(always)]
fn load_vectors<R: Real<Plain = Lanes<LANES>>>(
    from: &[Vector],
    own: [usize; LANES],
    zero: R,
) -> Of<R> {
    let rows = [&from[own[0]], &from[own[1]], &from[own[2]], &from[own[3]]];
    [
        column(rows, 0, zero),
        column(rows, 1, zero),
        column(rows, 2, zero),
    ]
}

#[inline(always)]
fn plain<R: Real<Plain = Lanes<LANES>>>(a: Of<R>) -> [[f64; LANES]; 3] {
    let (Lanes(x), Lanes(y), Lanes(z)) = (a[0].plain(), a[1].plain(), a[2].plain());
    [x, y, z]
}

#[inline(always)]
fn store<R: Real<Plain = Lanes<LANES>>, L>(
    hot: &mut [Hot<L>],
    own: [usize; LANES],
    count: usize,
    memory: &Memory<R>,
) {
    let (elastic, tangential) = (plain(memory.elastic), plain(memory.tangential));
    let (Lanes(stiffness), Lanes(normal)) = (memory.stiffness.plain(), memory.normal.plain());
    let (Lanes(rate), Lanes(peak)) = (memory.rate.plain(), memory.peak.plain());
    let (Lanes(peak_force), Lanes(work)) = (memory.peak_force.plain(), memory.work.plain());
    let Lanes(friction_work) = memory.friction_work.plain();
    let Lanes(pushed) = memory.pushed.plain();
    for lane in 0..count {
        hot[own[lane]].history = Memory {
            elastic: [elastic[0][lane], elastic[1][lane], elastic[2][lane]],
            tangential: [
                tangential[0][lane],
                tangential[1][lane],
                tangential[2][lane],
            ],
            stiffness: stiffness[lane],
            normal: normal[lane],
            rate: rate[lane],
            peak: peak[lane],
            peak_force: peak_force[lane],
            work: work[lane],
            friction_work: friction_work[lane],
            pushed: pushed[lane],
        };
    }
}

#[inline(always)]
fn give<R: Real<Plain = Lanes<LANES>>, L, const N: usize>(
    batch: &mut Batch<L, N>,
    entries: [usize; LANES],
    count: usize,
    (force, twist, displacement): (Of<R>, Of<R>, R),
    rolling: [[f64; LANES]; 3],
) {
    let (force, twist) = (plain(force), plain(twist));
    let Lanes(short) = (displacement * 0.5).plain();
    for lane in 0..count {
        let entry = entries[lane];
        let (i, j) = (batch.first[entry] as usize, batch.second[entry] as usize);
        let force = [force[0][lane], force[1][lane], force[2][lane]];
        let twist = [twist[0][lane], twist[1][lane], twist[2][lane]];
        let rolling = [rolling[0][lane], rolling[1][lane], rolling[2][lane]];
        let arm = batch.bodies.place[i][3] - short[lane];
        let load = &mut batch.loads[i - batch.base];
        for axis in 0..3 {
            load[axis] += force[axis];
            load[4 + axis] += twist[axis] * arm + rolling[axis];
        }
        // Second bodies stand behind.
        if let Some(load) = batch.loads.get_mut(j - batch.base) {
            let arm = batch.bodies.place[j][3] - short[lane];
            for axis in 0..3 {
                load[axis] -= force[axis];
                load[4 + axis] += twist[axis] * arm - rolling[axis];
            }
        } else {
            batch.out[entry] = PairForce {
                force,
                twist,
                short: short[lane],
            };
        }
    }
}

/// Moment of a pair's force on one of its bodies, without that against rolling; N m.
#[inline(always)]
pub(crate) fn moment_on(out: &PairForce, radius: f64, so_far: Vector) -> Vector {
    add(so_far, scaled(out.twist, radius - out.short))
}
