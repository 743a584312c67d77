//! Force laws in the terms of engines for granular matter.

use windfall_contact::granular_law::{Damping, GranularLaw};
use windfall_scene::interaction::Interaction;

/// What engines need to know of the contact of two bodies; SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairNumbers {
    /// The law for this pair's R*.
    pub law: GranularLaw,
    /// R*; m.
    pub radius: f64,
    /// Effective mass; kg.
    pub mass: f64,
}

impl PairNumbers {
    /// Of bodies with this R* and this effective mass.
    ///
    /// # Errors
    /// See [`Law::granular`](windfall_contact::laws::kind::Law::granular).
    pub fn of(interaction: &Interaction, radius: f64, mass: f64) -> Result<Self, String> {
        let mut law = interaction.law.granular()?;
        let scale = interaction.scale(radius);
        law.k *= scale;
        if let Damping::Root(c) = &mut law.damping {
            *c *= scale;
        }
        Ok(Self { law, radius, mass })
    }

    /// Stiffness in the terms of LAMMPS and LIGGGHTS, where the force of Hertz's contact is
    /// K √(R* d) d; N/m² or N/m.
    pub fn stiffness(&self) -> f64 {
        match self.law.hertzian {
            true => self.law.k / self.radius.sqrt(),
            false => self.law.k,
        }
    }

    /// Tangential stiffness, to be multiplied by √(R* d) for Hertz's contact: `ratio` times
    /// ∂F/∂d; N/m² or N/m.
    pub fn tangential(&self, ratio: f64) -> f64 {
        match self.law.hertzian {
            true => 1.5 * ratio * self.stiffness(),
            false => ratio * self.stiffness(),
        }
    }

    /// γ of a damping γ m_eff √(R* d) v; 1/(m s).
    pub fn viscoelastic(&self, c: f64) -> f64 {
        c / (self.radius.sqrt() * self.mass)
    }

    /// ∂F/∂d where the elastic force has this size; N/m.
    pub fn stiffness_at(&self, force: f64) -> f64 {
        match self.law.hertzian {
            true => 1.5 * self.law.k.powf(2.0 / 3.0) * force.cbrt(),
            false => self.law.k,
        }
    }

    /// Whether a coefficient depends on the mass or the radius of who touches, so that
    /// fruit of different sizes need coefficients of their own.
    pub fn by_size(interaction: &Interaction) -> bool {
        interaction.law.granular().is_ok_and(|law| {
            let by_mass = matches!(law.damping, Damping::Root(_) | Damping::Quarter(_));
            by_mass || law.hertzian && !interaction.follows_radii()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use windfall_contact::expression::parse_law;
    use windfall_contact::laws::kind::Law;

    fn law(text: &str) -> Law {
        parse_law(text).unwrap().complete().unwrap()
    }

    #[test]
    fn closed_form_coefficients_of_a_pair() {
        let mut interaction = Interaction::frictionless(law("kuwabara-kono(k=800000, c=1500)"));
        interaction.effective_radius = Some(0.02);
        let pair = PairNumbers::of(&interaction, 0.08, 0.1).unwrap();
        // k and c double at four times the radius.
        assert!((pair.law.k - 1.6e6).abs() < 1e-6);
        assert!((pair.stiffness() - 1.6e6 / 0.08_f64.sqrt()).abs() < 1e-6);
        let Damping::Root(c) = pair.law.damping else {
            panic!("{pair:?}");
        };
        // F = γ m √(R d) v is c √d v again.
        let back = pair.viscoelastic(c) * 0.1 * 0.08_f64.sqrt();
        assert!((back - 3000.0).abs() < 1e-9);
        let at = |d: f64| 1.6e6 * d.powf(1.5);
        let slope = (at(1.001e-3) - at(0.999e-3)) / 2e-6;
        assert!((pair.stiffness_at(at(1e-3)) / slope - 1.0).abs() < 1e-5);
    }

    #[test]
    fn rejects_laws_that_engines_do_not_have() {
        for (text, word) in [
            ("power-law(k=1e6, n=1.9, c=3, p=0)", "n = 1.9"),
            ("power-law(k=1e6, n=1.5, c=3, p=1)", "p = 1"),
            ("adams-impact(k=1e6, e=1.5, c=10, d=0.0001)", "STEP"),
            ("hunt-crossley(k=1e6, n=1.5, lambda=1e5)", "damping"),
        ] {
            let problem = law(text).granular().unwrap_err();
            assert!(problem.contains(word), "{problem}");
        }
        let same = law("power-law(k=1e6, n=1.5, c=30, p=0)")
            .granular()
            .unwrap();
        assert_eq!(same.damping, Damping::Constant(30.0));
    }
}
