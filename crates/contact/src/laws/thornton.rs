//! Thornton: elastic spheres with a limiting contact pressure.

use crate::granular_law::{GranularLaw, MEMORY};
use crate::impact_law::{Given, ImpactLaw, ImpactScales};
use crate::law::{ContactForce, ContactLaw, from_values};
use crate::parameter::{Elastic, LawDescription, parameter};
use std::f64::consts::PI;
use windfall_numerics::real::Real;

/// F = (4/3) E* sqrt(R*) d^1.5 up to yield, then F_y + pi p_y R* (d - d_y); unloading (4/3) E* sqrt(R_p) (d - d_p)^1.5.
///
/// # Source
/// Thornton (1997), J. Appl. Mech. 64, 383.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thornton {
    /// Effective modulus, E*; Pa.
    pub modulus: f64,
    /// Effective radius, R*; m.
    pub radius: f64,
    /// Limiting contact pressure, p_y; Pa.
    pub yield_pressure: f64,
}

/// Description of the law.
pub const DESCRIPTION: LawDescription = LawDescription {
    name: "thornton",
    formula: "F = (4/3) E* sqrt(R*) d^1.5 up to yield, then F_y + pi p_y R* (d - d_y); unloading (4/3) E* sqrt(R_p) (d - d_p)^1.5",
    first_touch: "force and slope are zero",
    source: "Thornton (1997), J. Appl. Mech. 64, 383",
    elastic: Elastic::Other,
    damping: None,
    linear: &[],
    from_compression: false,
    parameters: &[
        parameter("E_star", "Pa", "effective modulus, E*", [1.0, 1e15], 5e6),
        parameter("R_star", "m", "effective radius, R*", [1e-6, 1e4], 0.04),
        parameter(
            "yield_pressure",
            "Pa",
            "limiting contact pressure, p_y",
            [1.0, 1e15],
            3e5,
        ),
    ],
};

from_values!(Thornton [modulus, radius, yield_pressure]);

/// A force with its derivatives by displacement and by E*, R*, p_y.
#[derive(Clone, Copy)]
struct Branch<R> {
    force: R,
    by_displacement: R,
    by_parameter: [R; 3],
}

impl Thornton {
    /// Displacement at yield, d_y = R* (π p_y/(2 E*))²; m.
    pub fn yield_displacement(&self) -> f64 {
        let ratio = PI * self.yield_pressure / (2.0 * self.modulus);
        self.radius * ratio * ratio
    }

    /// Force at yield, F_y = (2/3) π p_y R* d_y; N.
    pub fn yield_force(&self) -> f64 {
        2.0 / 3.0 * PI * self.yield_pressure * self.radius * self.yield_displacement()
    }

    /// Hertz, before yield.
    #[inline(always)]
    fn elastic<R: Real>(&self, d: R) -> Branch<R> {
        let stiffness = 4.0 / 3.0 * self.modulus * self.radius.sqrt();
        let root = d.sqrt();
        let force = d * root * stiffness;
        Branch {
            force,
            by_displacement: root * (1.5 * stiffness),
            by_parameter: [
                force * (1.0 / self.modulus),
                force * (0.5 / self.radius),
                d.constant(0.0),
            ],
        }
    }

    /// Loading at the limiting pressure, after yield.
    #[inline(always)]
    fn plastic<R: Real>(&self, d: R) -> Branch<R> {
        let (radius, pressure) = (self.radius, self.yield_pressure);
        let at_yield = self.yield_displacement();
        let force = self.yield_force();
        let slope = PI * pressure * radius;
        Branch {
            force: (d + -at_yield) * slope + force,
            by_displacement: d.constant(slope),
            by_parameter: [
                d.constant(2.0 / self.modulus * (slope * at_yield - force)),
                (d + -2.0 * at_yield) * (PI * pressure) + 2.0 * force / radius,
                (d + -3.0 * at_yield) * (PI * radius) + 3.0 * force / pressure,
            ],
        }
    }

    /// Elastic recovery from a plastic `peak`, with the derivative by it.
    ///
    /// With K = (4/3) E* √R_p and the recovery s = (F_max/K)^(2/3) the force is
    /// K (d - d_peak + s)^1.5. Below the remaining indentation it goes on as an
    /// odd function, so that it changes sign where the contact ends.
    #[inline(always)]
    fn recovery<R: Real>(&self, d: R, peak: R) -> (Branch<R>, R) {
        let (modulus, pressure) = (self.modulus, self.yield_pressure);
        let yield_force = self.yield_force();
        let top = self.plastic(peak);
        let sum = top.force * 2.0 + yield_force;
        let area = sum * (1.0 / (2.0 * PI * pressure));
        let radius = area * area.sqrt() / top.force * (4.0 / 3.0 * modulus);
        let stiffness = radius.sqrt() * (4.0 / 3.0 * modulus);
        let recovered = (top.force / stiffness).powf(2.0 / 3.0);
        let depth = d - peak + recovered;
        let root = depth.max(-depth).sqrt();
        let force = stiffness * depth * root;
        let slope = stiffness * root * 1.5;

        // Relative changes of K and s from those of F_max, F_y, E* and p_y.
        let change = |top_change: R, yield_change: f64, ln_modulus: f64, ln_pressure: f64| {
            let ln_top = top_change / top.force;
            let ln_area = (top_change * 2.0 + yield_change) / sum + -ln_pressure;
            let ln_radius = ln_area * 1.5 - ln_top + ln_modulus;
            let ln_stiffness = ln_radius * 0.5 + ln_modulus;
            let ln_recovered = (ln_top - ln_stiffness) * (2.0 / 3.0);
            force * ln_stiffness + slope * recovered * ln_recovered
        };
        let [by_modulus, by_radius, by_pressure] = top.by_parameter;
        let branch = Branch {
            force,
            by_displacement: slope,
            by_parameter: [
                change(by_modulus, -2.0 * yield_force / modulus, 1.0 / modulus, 0.0),
                change(by_radius, 2.0 * yield_force / self.radius, 0.0, 0.0),
                change(
                    by_pressure,
                    3.0 * yield_force / pressure,
                    0.0,
                    1.0 / pressure,
                ),
            ],
        };
        let by_peak = change(top.by_displacement, 0.0, 0.0, 0.0) - slope;
        (branch, by_peak)
    }
}

/// `positive` where `condition > 0`, else `otherwise`.
#[inline(always)]
fn choose<R: Real>(condition: R, positive: Branch<R>, otherwise: Branch<R>) -> Branch<R> {
    let [p0, p1, p2] = positive.by_parameter;
    let [o0, o1, o2] = otherwise.by_parameter;
    Branch {
        force: condition.select(positive.force, otherwise.force),
        by_displacement: condition.select(positive.by_displacement, otherwise.by_displacement),
        by_parameter: [
            condition.select(p0, o0),
            condition.select(p1, o1),
            condition.select(p2, o2),
        ],
    }
}

impl ContactLaw<3> for Thornton {
    const HISTORY: bool = true;

    #[inline(always)]
    fn evaluate<R: Real>(&self, d: R, _v: R, peak: R) -> ContactForce<R, 3> {
        let zero = d.constant(0.0);
        let at_yield = self.yield_displacement();
        let loading = choose(d + -at_yield, self.plastic(d), self.elastic(d));

        // A peak before yield leaves nothing behind: unloading is Hertz again.
        let beyond_yield = peak + -at_yield;
        let (recovery, by_peak) = self.recovery(d, peak.max(d.constant(at_yield)));
        let unloading = choose(beyond_yield, recovery, self.elastic(d));

        let below = peak - d;
        let branch = choose(below, unloading, loading);
        ContactForce {
            force: branch.force,
            by_displacement: branch.by_displacement,
            by_rate: zero,
            by_parameter: branch.by_parameter,
            by_peak: below.select(beyond_yield.select(by_peak, zero), zero),
        }
    }

    fn kink(&self) -> f64 {
        self.yield_displacement()
    }
}

impl ImpactLaw for Thornton {
    fn start(scales: &ImpactScales, given: &Given) -> Vec<(&'static str, f64)> {
        let radius = given("R_star").unwrap_or(0.02);
        let modulus = 1.5 * scales.stiffness(1.5) / radius.sqrt();
        // The peak force is reached on the plastic slope π p_y R.
        let pressure = scales.force / (PI * radius * scales.displacement);
        vec![
            ("E_star", modulus),
            ("R_star", radius),
            ("yield_pressure", pressure),
        ]
    }

    fn granular(&self) -> Result<GranularLaw, String> {
        Err(MEMORY.to_owned())
    }
}
