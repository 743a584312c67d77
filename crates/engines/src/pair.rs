//! A pair of materials whose contact is put into another engine's terms.

use crate::delivered::{Ends, Force, Impact};
use windfall_contact::law::ContactLaw;
use windfall_contact::laws::kind::Law;
use windfall_contact::with_law;
use windfall_scene::interaction::Interaction;

pub(crate) type Words = (String, String, String);

/// A contact as one engine has it.
pub(crate) struct Given<'a> {
    /// What the engine is given, what is exact, what is approximate.
    pub words: Words,
    /// The force that it makes of it, where there is one, and when that ends.
    pub felt: Option<(Force<'a>, Ends)>,
}

/// A pair of materials with bodies of mean size.
pub(crate) struct Pair<'a> {
    pub names: [&'a str; 2],
    pub interaction: &'a Interaction,
    /// The law at the R* of mean fruit.
    pub law: Law,
    /// R*; m.
    pub radius: f64,
    /// Effective mass; kg.
    pub mass: f64,
    /// Impact speed at which approximate damping is right; m/s.
    pub speed: f64,
    /// Whether one of the two is a wall.
    pub wall: bool,
}

impl Pair<'_> {
    /// An impact at a speed; m/s.
    pub(crate) fn impact(&self, speed: f64) -> Impact {
        let depth = elastic(&self.law).map_or(1e-3, |(k, n)| {
            ((n + 1.0) * self.mass * speed * speed / (2.0 * k)).powf(1.0 / (n + 1.0))
        });
        Impact {
            mass: self.mass,
            speed,
            depth,
        }
    }

    /// Restitution of the law at a speed; 1.
    pub(crate) fn restitution(&self, speed: f64) -> f64 {
        let own = |d: f64, v: f64| force(&self.law, d, v);
        self.impact(speed).restitution(&own, Ends::Force)
    }

    /// The coefficient with which a force has the restitution of the law.
    pub(crate) fn matched<F: Fn(f64, f64) -> f64>(
        &self,
        like: impl Fn(f64) -> F,
        ends: Ends,
    ) -> f64 {
        let wanted = self.restitution(self.speed);
        self.impact(self.speed).matched(wanted, like, ends)
    }

    /// What is said where damping is not the law's.
    pub(crate) fn same_restitution(&self) -> String {
        format!(
            "damping: the restitution {:.4} is the law's at {:.3} m/s and {:.4} kg, at other speeds it \
             is not",
            self.restitution(self.speed),
            self.speed,
            self.mass
        )
    }
}

/// What cannot be put at all.
pub(crate) fn nothing<'a>(pair: &Pair) -> Given<'a> {
    let words = (
        String::new(),
        "nothing".to_owned(),
        format!(
            "{} has no counterpart there: fit a law that has to the same recordings",
            pair.law.kind().name()
        ),
    );
    Given { words, felt: None }
}

/// k and n of the elastic part of a law k d^n.
pub(crate) fn elastic(law: &Law) -> Option<(f64, f64)> {
    if let Ok(found) = law.granular() {
        return Some((found.k, if found.hertzian { 1.5 } else { 1.0 }));
    }
    let description = law.kind().describe();
    let values = law.parameters();
    let known: Vec<_> = values.iter().copied().map(Some).collect();
    let exponent = description.elastic_exponent(&known)?;
    Some((values[description.index_of("k")?], exponent))
}

/// A spring and a dashpot.
pub(crate) fn linear<'a>(k: f64, c: f64) -> Force<'a> {
    Box::new(move |d: f64, v: f64| k * d + c * v)
}

pub(crate) fn poisson(pair: &Pair) -> f64 {
    // From k_t/k_n = 2 (1 − ν)/(2 − ν).
    let ratio = pair.interaction.tangential_ratio;
    ((2.0 - 2.0 * ratio) / (2.0 - ratio)).clamp(0.0, 0.5)
}

pub(crate) fn sizes(pair: &Pair) -> &'static str {
    match pair.interaction.follows_radii() {
        true => "",
        false => " of bodies of the mean size",
    }
}

pub(crate) fn joined(parts: &[&str]) -> String {
    let parts: Vec<&str> = parts
        .iter()
        .copied()
        .filter(|own| !own.is_empty())
        .collect();
    match parts.is_empty() {
        true => "nothing".to_owned(),
        false => parts.join("; "),
    }
}

pub(crate) fn force(law: &Law, d: f64, v: f64) -> f64 {
    with_law!(law, own => own.evaluate(d, v, d).force)
}
