//! Friction of a contact area whose annuli stick or slip each for itself.
//!
//! Tractions are sums of Hertz's and Mindlin's over circles: the annulus between two of them
//! behaves like a spring of its own. Annuli are as wide as each other and grow and shrink
//! with the contact area; so what each bears of the stiffness and of the normal force stays
//! the same. While they grow the material under them moves inward, with its shear; what the
//! rim newly presses on is not sheared yet. While they shrink the rim lets go.
//!
//! # Source
//! Jäger (1993), Arch. Appl. Mech. 63, 463; Popov and Heß (2015), Method of Dimensionality
//! Reduction in Contact Mechanics and Friction, chapter 5.

use crate::binary::{Binary, no_value};
use crate::vector::{Of, Vector, add, dot, into_plane, less, scaled, stretch_into_plane};
use std::io::{Read, Result as IoResult, Write};
use windfall_numerics::real::Real;

/// As many annuli as a contact area may have.
pub const MOST_ANNULI: usize = 8;

/// Elastic forces of the annuli of a contact on the first body, from the innermost; zeros
/// behind them; N.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Annuli(pub [Vector; MOST_ANNULI]);

impl Annuli {
    /// Of the same contact seen from the second body.
    pub(crate) fn swapped(self) -> Self {
        Self(self.0.map(|own| own.map(|axis| -axis)))
    }
}

impl Binary for Annuli {
    fn write(&self, to: &mut dyn Write) -> IoResult<()> {
        // By bits: a negative zero is one that is kept.
        let there = |own: &Vector| own.iter().any(|axis| axis.to_bits() != 0);
        let count = self.0.iter().rposition(there).map_or(0, |last| last + 1);
        (count as u8).write(to)?;
        self.0[..count].iter().try_for_each(|own| own.write(to))
    }

    fn read(from: &mut dyn Read) -> IoResult<Self> {
        let mut all = Self::default();
        let count = usize::from(u8::read(from)?);
        let there = all.0.get_mut(..count);
        for own in there.ok_or_else(|| no_value("number of annuli"))? {
            *own = Vector::read(from)?;
        }
        Ok(all)
    }
}

/// Part of the normal force on each annulus, for each number of them.
const LOADS: [[f64; MOST_ANNULI]; MOST_ANNULI + 1] = {
    let mut all = [[0.0; MOST_ANNULI]; MOST_ANNULI + 1];
    let mut count = 1;
    while count <= MOST_ANNULI {
        let mut own = 0;
        while own < count {
            // ∫ 3/2 (1 − x²) dx over the annulus, x = radius over that of the area.
            let (inner, outer, whole) = (own as f64, (own + 1) as f64, count as f64);
            let cubes = outer * outer * outer - inner * inner * inner;
            all[count][own] = 1.5 / whole - 0.5 * cubes / (whole * whole * whole);
            own += 1;
        }
        count += 1;
    }
    all
};

/// What shears all annuli of a contact together.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shear<R> {
    /// Largest size of the tangential force; N.
    pub limit: R,
    /// N s/m.
    pub damping: R,
    /// N/m.
    pub stiffness: R,
}

/// The tangential force of all annuli one step on.
///
/// * `annuli`: elastic forces of the annuli, from the innermost; N
/// * `slip`: tangential velocity; m/s
/// * `growth`: of the stiffness over that a step ago; 1
#[inline(always)]
pub(crate) fn slide<R: Real>(
    annuli: &mut [Of<R::Plain>],
    normal: Of<R>,
    slip: Of<R>,
    shear: Shear<R>,
    growth: R,
    step: f64,
) -> Of<R> {
    // Compiled apart for the numbers that are usual.
    match annuli {
        [_] => slide_over(&mut annuli[..1], normal, slip, shear, growth, step),
        [_, _, _, _] => slide_over(&mut annuli[..4], normal, slip, shear, growth, step),
        any => slide_over(any, normal, slip, shear, growth, step),
    }
}

#[inline(always)]
fn slide_over<R: Real>(
    annuli: &mut [Of<R::Plain>],
    normal: Of<R>,
    slip: Of<R>,
    shear: Shear<R>,
    growth: R,
    step: f64,
) -> Of<R> {
    let zero = growth.constant(0.0);
    let one = growth.constant(1.0);
    let share = 1.0 / annuli.len() as f64;
    let loads = &LOADS[annuli.len()];
    let stretch = shear.stiffness * (share * step);
    let damping = shear.damping * share;
    let grown = growth - one;
    let mut whole = [zero; 3];
    let mut flown = [zero; 3];
    // Annuli that point elsewhere than the innermost are a little too long or too short.
    let innermost = zero.with_each_plain(annuli[0]);
    let longer = stretch_into_plane(innermost, normal);
    let mut here = into_plane(innermost, normal, longer);
    for own in 0..annuli.len() {
        // Through the border of this annulus with the next, or with the outside; inward.
        let moved = (grown * (own + 1) as f64).max(-one);
        let (next, inward) = match annuli.get(own + 1) {
            Some(next) => {
                let next = into_plane(zero.with_each_plain(*next), normal, longer);
                let moved = moved.min(one) * 0.5;
                let sum = scaled(add(next, here), moved);
                let change = less(next, here, one);
                (next, add(sum, scaled(change, moved * moved * 2.0)))
            }
            None => ([zero; 3], scaled(here, moved.min(zero))),
        };
        let carried = less(add(here, inward), flown, one);
        let elastic = less(carried, slip, stretch);
        let sticking = less(elastic, slip, damping);
        let limit = shear.limit * loads[own];
        let square = dot(sticking, sticking);
        let beyond = square - limit * limit;
        let (mut borne, mut kept) = (sticking, elastic);
        if beyond.any_above_zero() {
            borne = scaled(sticking, beyond.select(limit / square.sqrt(), one));
            for axis in 0..3 {
                kept[axis] = beyond.select(borne[axis] + slip[axis] * damping, elastic[axis]);
            }
        }
        whole = add(whole, borne);
        annuli[own] = zero.each_plain(kept);
        (here, flown) = (next, inward);
    }
    whole
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A contact of Hertz's stiffness that is sheared along x; its work so far.
    struct Sheared {
        annuli: Vec<Of<f64>>,
        stiffness: f64,
        force: f64,
        work: f64,
    }

    impl Sheared {
        fn new(annuli: usize) -> Self {
            Self {
                annuli: vec![[0.0; 3]; annuli],
                stiffness: 0.0,
                force: 0.0,
                work: 0.0,
            }
        }

        /// Pressed to a depth and sheared by a way; F = 4/3 d^1.5, k_t = 0.8 F', μ = 0.3.
        fn step(&mut self, depth: f64, way: f64) -> f64 {
            let shear = Shear {
                limit: 0.3 * 4.0 / 3.0 * depth.powf(1.5),
                damping: 0.0,
                stiffness: 0.8 * 2.0 * depth.sqrt(),
            };
            let growth = match self.stiffness > 0.0 {
                true => shear.stiffness / self.stiffness,
                false => 1.0,
            };
            self.stiffness = shear.stiffness;
            let normal = [0.0, 0.0, 1.0];
            let force = slide(
                &mut self.annuli,
                normal,
                [way, 0.0, 0.0],
                shear,
                growth,
                1.0,
            )[0];
            self.work -= 0.5 * (self.force + force) * way;
            self.force = force;
            force
        }
    }

    #[test]
    fn closed_form_shear_at_rest_is_that_of_cattaneo_and_mindlin() {
        // T = μ F (1 − (1 − G* s/(μ E* d))^1.5), Mindlin and Deresiewicz (1953), J. Appl.
        // Mech. 20, 327; all annuli bear μ F where all slide.
        for (annuli, most) in [(1, 0.2), (2, 0.08), (4, 0.03), (8, 0.012)] {
            let (mut own, depth, steps) = (Sheared::new(annuli), 1.0_f64, 2000);
            let whole = 0.3 * depth / 0.8;
            let mut worst: f64 = 0.0;
            for step in 1..=steps {
                let force = -own.step(depth, 1.2 * whole / f64::from(steps)) / 0.4;
                let slid = 1.2 * f64::from(step) / f64::from(steps);
                let wanted = 1.0 - (1.0 - slid).max(0.0).powf(1.5);
                worst = worst.max((force - wanted).abs());
            }
            assert!(worst < most, "{annuli}: {worst}");
            assert!((own.force / -0.4 - 1.0).abs() < 1e-12, "{annuli}");
        }
    }

    #[test]
    fn no_cycle_of_load_and_shear_gives_energy() {
        // The depth goes up and down as the shear goes there and back, in any phase.
        let turn = 2.0 * std::f64::consts::PI;
        for annuli in 1..=MOST_ANNULI {
            for (swing, way) in [(0.3, 0.02), (0.9, 0.02), (0.9, 0.3), (0.6, 0.1)] {
                for phase in 0..12 {
                    let mut own = Sheared::new(annuli);
                    let (steps, mut before) = (400, 0.0);
                    for cycle in 0..6 {
                        for step in 0..steps {
                            let at = turn * f64::from(step) / f64::from(steps);
                            let depth = 1.0 + swing * at.cos();
                            let along = way * turn / f64::from(steps);
                            own.step(depth, along * (at + turn * f64::from(phase) / 12.0).cos());
                        }
                        let took = own.work - before;
                        before = own.work;
                        let all = 0.4 * way;
                        assert!(
                            cycle < 2 || took > -1e-3 * all,
                            "{annuli} annuli, {swing} {way}, phase {phase}: {took} of {all}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn annuli_are_kept_to_the_bit() {
        let mut own = Annuli::default();
        own.0[0] = [1.0, -0.0, 3.5];
        own.0[2] = [0.0, -0.0, 0.0];
        let mut bytes = Vec::new();
        own.write(&mut bytes).unwrap();
        assert_eq!(bytes.len(), 1 + 3 * 24);
        let back = Annuli::read(&mut &bytes[..]).unwrap();
        let bits = |all: Annuli| all.0.map(|own| own.map(f64::to_bits));
        assert_eq!(bits(own), bits(back));
        bytes[0] = 9;
        assert!(Annuli::read(&mut &bytes[..]).is_err());
    }
}
