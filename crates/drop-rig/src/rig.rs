//! The drop rig: a fruit falls on a plate that rests on a spring and a damper.

use windfall_identify::error::{Error, check_not_negative, check_positive};

/// Plate of the rig: a mass on a spring and a damper, about its static
/// position, m_p x'' = −F − k x − c x'.
///
/// # Source
/// Kang et al. (2023), INMATEH 71:63, fig. 1 and eqs. (4) to (6).
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, utoipa::ToSchema)]
pub struct Plate {
    /// Mass, m_p; kg.
    pub mass: f64,
    /// Stiffness of its support, k; N/m.
    pub stiffness: f64,
    /// Damping of its support, c; N s/m.
    pub damping: f64,
}

/// A fruit that falls on a plate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DropRig {
    /// Mass of the fruit, m; kg.
    pub mass: f64,
    /// Part f of its mass that the contact feels: 1 for a central impact. The
    /// point of contact moves as a mass f m, the centre of mass as m; what is
    /// between goes into rotation, 1/(f m) = 1/m + r²/I. 1.
    pub effective_mass_factor: f64,
    /// Acceleration between impacts, towards the plate; m/s².
    pub gravity: f64,
    /// The plate; `None` for one that does not move.
    pub plate: Option<Plate>,
}

impl DropRig {
    /// Whether every quantity has a physical value.
    ///
    /// # Errors
    /// [`Error::BadInput`] names the first that has none.
    pub fn check(&self) -> Result<(), Error> {
        let mut positive = vec![
            ("mass", self.mass),
            ("effective mass factor", self.effective_mass_factor),
            ("gravity", self.gravity),
        ];
        if let Some(plate) = &self.plate {
            positive.push(("plate mass", plate.mass));
            positive.push(("plate stiffness", plate.stiffness));
            // Zero damping is a plate that rings for ever: allowed.
            check_not_negative("plate damping", plate.damping)?;
        }
        positive
            .into_iter()
            .try_for_each(|(name, value)| check_positive(name, value))
    }

    /// Speed of a fruit that has fallen from rest; m/s.
    ///
    /// * `height`: of its lowest point above the plate; m
    pub fn impact_velocity(&self, height: f64) -> f64 {
        (2.0 * self.gravity * height).sqrt()
    }
}
