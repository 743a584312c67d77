//! Mass of a carriage from the impulse of the contact and its change of velocity.

use crate::error::Error;
use crate::impact::Measured;

use crate::uncertain::{Uncertain, weighted_mean};

/// Mass of a carriage under a constant driving acceleration:
///
/// ```text
/// m x″ = m a − F   ⟹   −m (v₁ + v₂) = m a T − J   ⟹   m = J / (v₁ + v₂ + a T)
/// ```
///
/// * `measured`: impact velocity v₁, speed of rebound v₂ (away from the fruit),
///   duration T and impulse J = ∫F dt of the contact
/// * `driving`: a, positive into the fruit; m/s². Zero on a level track.
///
/// Returns m and its standard uncertainty; kg:
///
/// ```text
/// D = v₁ + v₂ + a T,   u²(m) = (u(J)/D)² + (m/D)² (u²(v₁) + u²(v₂) + T² u²(a))
/// ```
///
/// The uncertainty covers noise and offset of the force and the scatter of the
/// velocities. It does not cover calibration (an error of the force's
/// sensitivity goes into the mass in full), friction, or inertia ahead of the
/// force sensor.
///
/// # Errors
/// [`Error::NoMass`] if a quantity was not measured, [`Error::MassNotPositive`]
/// if impulse or change of velocity is not positive.
pub fn mass_from_impulse(measured: &Measured, driving: Uncertain) -> Result<Uncertain, Error> {
    let known = |value: Option<f64>, missing| value.ok_or(Error::NoMass { missing });
    let impulse = known(
        measured.impulse,
        "the impulse (a force channel over the whole contact)",
    )?;
    let before = known(measured.impact_velocity, "the impact velocity")?;
    let after = known(measured.rebound_velocity, "the speed of rebound")?;
    let duration = known(measured.contact_duration, "the contact duration")?;

    let change = before + after + driving.value * duration;
    if impulse <= 0.0 || change <= 0.0 {
        return Err(Error::MassNotPositive { impulse, change });
    }
    let mass = impulse / change;
    let square = |sd: Option<f64>| sd.unwrap_or(0.0).powi(2);
    let change_variance = square(measured.impact_velocity_sd)
        + square(measured.rebound_velocity_sd)
        + (duration * driving.sd).powi(2);
    let variance =
        square(measured.impulse_sd) / (change * change) + (mass / change).powi(2) * change_variance;
    Ok(Uncertain::new(mass, variance.sqrt()))
}

/// One mass from several impacts: [`weighted_mean`] with the scatter of each impact, plus
/// the shared uncertainty of the driving acceleration. `None` if no impact shows a mass.
pub fn mass_from_impulses(impacts: &[Measured], driving: Uncertain) -> Option<Uncertain> {
    let mean = |acceleration: f64| {
        let exact = Uncertain::new(acceleration, 0.0);
        let masses: Vec<Uncertain> = impacts
            .iter()
            .filter_map(|measured| mass_from_impulse(measured, exact).ok())
            .collect();
        weighted_mean(&masses)
    };
    let mass = mean(driving.value)?;
    let shifted = mean(driving.value + driving.sd)?;
    Some(Uncertain::new(
        mass.value,
        mass.sd.hypot(shifted.value - mass.value),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn measured() -> Measured {
        Measured {
            impulse: Some(0.9),
            impact_velocity: Some(1.0),
            rebound_velocity: Some(0.7),
            contact_duration: Some(0.25),
            impulse_sd: Some(0.009),
            ..Measured::default()
        }
    }

    #[test]
    fn closed_form_mass_under_a_driving_acceleration() {
        // 0.9 N s over 1.0 + 0.7 + 0.4 · 0.25 = 1.8 m/s.
        let driving = Uncertain::new(0.4, 0.0);
        let mass = mass_from_impulse(&measured(), driving).unwrap();
        assert!((mass.value - 0.5).abs() < 1e-15 && (mass.sd - 0.005).abs() < 1e-15);
    }

    #[test]
    fn closed_form_uncertainties_add_in_squares() {
        // 1 % of J, 3 % of D by a velocity, 4 % of D by the driving acceleration.
        let driving = Uncertain::new(0.4, 0.04 * 1.8 / 0.25);
        let mut measured = measured();
        measured.rebound_velocity_sd = Some(0.03 * 1.8);
        let mass = mass_from_impulse(&measured, driving).unwrap();
        assert!((mass.sd / mass.value - 26f64.sqrt() / 100.0).abs() < 1e-15);
    }

    #[test]
    fn closed_form_mean_of_two_that_disagree() {
        // 0.4 and 0.6 with u = 0.01: mean 0.5, standard error 0.1, not 0.007.
        let one = |value| Uncertain::new(value, 0.01);
        let mean = weighted_mean(&[one(0.4), one(0.6)]).unwrap();
        assert!((mean.value - 0.5).abs() < 1e-12 && (mean.sd - 0.1).abs() < 1e-12);
    }

    #[test]
    fn closed_form_what_impacts_share_does_not_average_out() {
        // 100 equal impacts: the 1 % of J becomes 0.1 %, the driving
        // acceleration stays: 0.9/(1.7 + 0.25 · 0.44) − 0.9/(1.7 + 0.25 · 0.4).
        let driving = Uncertain::new(0.4, 0.04);
        let mass = mass_from_impulses(&[measured(); 100], driving).unwrap();
        let shared: f64 = 0.9 / 1.81 - 0.5;
        assert!((mass.value - 0.5).abs() < 1e-12);
        assert!((mass.sd - shared.hypot(0.0005)).abs() < 1e-12, "{mass:?}");
        assert_eq!(mass_from_impulses(&[], driving), None);
    }

    #[test]
    fn rejects_a_mass_without_rebound() {
        let measured = Measured {
            rebound_velocity: None,
            ..measured()
        };
        assert_eq!(
            mass_from_impulse(&measured, Uncertain::default())
                .unwrap_err()
                .to_string(),
            "the mass cannot be found from impulse and change of velocity: the speed of rebound is not known; give the mass instead"
        );
    }
}
