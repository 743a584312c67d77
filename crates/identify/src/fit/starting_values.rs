//! Where a fit begins: the parameters of each law that fit the peaks, the
//! duration and the restitution of the impact in order of magnitude.

use std::f64::consts::PI;
use windfall_contact::law::ContactLaw;
use windfall_contact::laws::any_law::AnyLaw;
use windfall_contact::laws::kind::LawKind;
use windfall_contact::laws::user::UserKind;
use windfall_contact::restitution::{damping_for_restitution, kuwabara_kono_pade};
use windfall_signal::impact::Impact;

/// Restitution assumed when the signals do not tell.
const USUAL_RESTITUTION: f64 = 0.5;
/// Restitutions outside this range are not believed for a start.
const RESTITUTIONS: (f64, f64) = (0.05, 0.95);
/// Contact duration times velocity over largest displacement of an elastic
/// sphere (Hertz; DOMAIN: (4/5) √π Γ(2/5)/Γ(9/10)).
const HERTZ_DURATION: f64 = 2.943_275_184;
/// Largest group of the Kuwabara-Kono law that the start looks at.
const LARGEST_GROUP: f64 = 20.0;

/// Rough features of an impact, all of them known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Features {
    /// Effective mass; kg.
    pub mass: f64,
    /// Velocity at first touch; m/s.
    pub velocity: f64,
    /// Largest displacement; m.
    pub displacement: f64,
    /// Largest force; N.
    pub force: f64,
    /// Contact duration; s.
    pub duration: f64,
    /// Coefficient of restitution; 1.
    pub restitution: f64,
}

impl Features {
    /// Features of a measured impact, the missing ones by the mechanics of a
    /// half-sine impact.
    pub fn of(impact: &Impact, mass: f64) -> Self {
        let measured = &impact.measured;
        let positive = |value: Option<f64>| value.filter(|v| v.is_finite() && *v > 0.0);
        let duration = positive(measured.contact_duration).unwrap_or(impact.end - impact.onset);
        let (low, high) = RESTITUTIONS;
        let restitution = positive(measured.restitution)
            .unwrap_or(USUAL_RESTITUTION)
            .clamp(low, high);
        let impulse = positive(measured.impulse)
            .or(positive(measured.peak_force).map(|f| 2.0 / PI * f * duration));
        let velocity = positive(measured.impact_velocity)
            .or(impulse.map(|j| j / (mass * (1.0 + restitution))))
            .or(positive(measured.max_displacement).map(|d| HERTZ_DURATION * d / duration))
            .unwrap_or(1.0);
        Self {
            mass,
            velocity,
            displacement: positive(measured.max_displacement)
                .unwrap_or(velocity * duration / HERTZ_DURATION),
            force: positive(measured.peak_force)
                .unwrap_or(PI * mass * velocity * (1.0 + restitution) / (2.0 * duration)),
            duration,
            restitution,
        }
    }

    /// Energy lost; J.
    fn loss(&self) -> f64 {
        0.5 * self.mass * self.velocity.powi(2) * (1.0 - self.restitution.powi(2))
    }
}

/// Starting parameters of a law, in the order of its description; SI.
///
/// * `given`: values that are known already, such as exponents
///
/// # Source
/// Peaks and durations of Hertz impacts (Johnson 1985, sec. 11.4); the damping
/// from the energy lost over one loading and unloading.
pub(crate) fn starting_values(kind: LawKind, f: &Features, given: &[Option<f64>]) -> Vec<f64> {
    let parameters = kind.describe().parameters;
    let value_of = |name: &str| {
        let position = parameters.iter().position(|p| p.name == name);
        position.and_then(|i| given[i].or(parameters[i].default))
    };
    // A damped force peaks before the displacement does.
    let stiffness = |n: f64| 0.9 * f.force / f.displacement.powf(n);
    // ∮ c d^p v dd over loading and unloading, with v falling to zero halfway.
    let damping = |p: f64| f.loss() * (p + 1.5) / (1.3 * f.velocity * f.displacement.powf(p + 1.0));
    let guess: Vec<(&str, f64)> = match kind {
        LawKind::Hertz => vec![("k", stiffness(1.5))],
        LawKind::KelvinVoigt => {
            let logarithm = -f.restitution.ln();
            let ratio = logarithm / (PI * PI + logarithm * logarithm).sqrt();
            let frequency = PI / f.duration;
            vec![
                ("k", f.mass * frequency * frequency),
                ("c", 2.0 * ratio * f.mass * frequency),
            ]
        }
        LawKind::KuwabaraKono => {
            let k = stiffness(1.5);
            let c = kuwabara_kono_group_for(f.restitution) * f.mass * (k / f.mass).powf(0.6)
                / f.velocity.powf(0.2);
            vec![("k", k), ("c", c)]
        }
        LawKind::PowerLaw => {
            let n = value_of("n").unwrap_or(1.5);
            let p = value_of("p").unwrap_or(0.5);
            vec![("k", stiffness(n)), ("n", n), ("c", damping(p)), ("p", p)]
        }
        LawKind::HuntCrossley => {
            let n = value_of("n").unwrap_or(1.5);
            let factor = damping_for_restitution(f.restitution, f.velocity);
            let factor = factor.unwrap_or(1.5 * (1.0 - f.restitution) / f.velocity);
            vec![
                ("k", stiffness(n)),
                ("lambda", factor * stiffness(n)),
                ("n", n),
            ]
        }
        LawKind::LankaraniNikravesh | LawKind::Flores | LawKind::HerbertMcWhannell => {
            let n = value_of("n").unwrap_or(1.5);
            vec![
                ("k", stiffness(n)),
                ("n", n),
                ("restitution", f.restitution),
            ]
        }
        LawKind::Tsuji => vec![("k", stiffness(1.5)), ("restitution", f.restitution)],
        LawKind::AdamsImpact => {
            let e = value_of("e").unwrap_or(1.5);
            vec![
                ("k", stiffness(e)),
                ("e", e),
                ("c", damping(0.0)),
                ("d", 0.1 * f.displacement),
            ]
        }
        LawKind::WaltonBraun => {
            let k1 = f.force / f.displacement;
            vec![("k1", k1), ("k2", k1 / f.restitution.powi(2))]
        }
        LawKind::Thornton => {
            let radius = value_of("R_star").unwrap_or(0.02);
            let modulus = 1.5 * stiffness(1.5) / radius.sqrt();
            // The peak force is reached on the plastic slope π p_y R.
            let pressure = f.force / (PI * radius * f.displacement);
            vec![
                ("E_star", modulus),
                ("R_star", radius),
                ("yield_pressure", pressure),
            ]
        }
        LawKind::User(user) => user_guess(user, f, given),
    };
    parameters
        .iter()
        .enumerate()
        .map(|(i, parameter)| {
            let named = guess.iter().find(|(name, _)| *name == parameter.name);
            let event = match parameter.name {
                crate::fit::problem::IMPACT_VELOCITY => Some(f.velocity),
                crate::fit::problem::MASS => Some(f.mass),
                _ => None,
            };
            given[i]
                .or(event)
                .or(named.map(|(_, value)| *value))
                .or(parameter.default)
                .unwrap_or(parameter.typical)
                .clamp(parameter.lower, parameter.upper)
        })
        .collect()
}

/// Instants at which the work of a user's damping is added up.
const INSTANTS: usize = 64;

/// Starts of a user's law: its own, and otherwise scales of the force that give
/// the impact's peak, and scales of the damping that lose its energy.
fn user_guess(user: UserKind, f: &Features, given: &[Option<f64>]) -> Vec<(&'static str, f64)> {
    let kind = LawKind::User(user);
    let parameters = kind.describe().parameters;
    let starts = user.starts();
    let mut values: Vec<f64> = (0..parameters.len())
        .map(|i| given[i].or(starts[i]).unwrap_or(parameters[i].typical))
        .collect();
    // A default is kept: it is held, or where the user wants to begin.
    let open = |i: &&usize| {
        let unknown = given[**i].is_none() && parameters[**i].default.is_none();
        unknown && starts[**i].is_none_or(|start| start == 0.0)
    };
    let slope = |values: &[f64], i: usize, d: f64, v: f64| {
        let law = kind.from_values(values);
        law.map_or(0.0, |law| AnyLaw(law).evaluate(d, v, 0.0).by_parameter[i])
    };
    let scaled = |i: usize, value: f64| match value.is_finite() && value > 0.0 {
        true => value.clamp(parameters[i].lower, parameters[i].upper),
        false => parameters[i].typical,
    };
    let rest: Vec<usize> = user.linear_at_rest().iter().filter(open).copied().collect();
    for &i in &rest {
        let share = 0.9 * f.force / rest.len() as f64;
        values[i] = scaled(i, share / slope(&values, i, f.displacement, 0.0));
    }
    let rate: Vec<usize> = user.linear_in_rate().iter().filter(open).copied().collect();
    for &i in &rate {
        // ∮ ∂F/∂p dx over a half-sine of the displacement.
        let step = f.duration / INSTANTS as f64;
        let work: f64 = (0..INSTANTS)
            .map(|n| {
                let phase = PI * (n as f64 + 0.5) / INSTANTS as f64;
                let d = f.displacement * phase.sin();
                let v = f.displacement * PI / f.duration * phase.cos();
                slope(&values, i, d, v) * v * step
            })
            .sum();
        values[i] = scaled(i, f.loss() / (rate.len() as f64 * work));
    }
    let names = parameters.iter().map(|parameter| parameter.name);
    names.zip(values).collect()
}

/// The group B = (c/m)(m/k)^(3/5) v^(1/5) of a Kuwabara-Kono impact of this
/// restitution, by the Padé approximant.
fn kuwabara_kono_group_for(restitution: f64) -> f64 {
    windfall_numerics::root::bracketed_root(0.0, LARGEST_GROUP, 1e-6, |group| {
        kuwabara_kono_pade(group) - restitution
    })
}
