//! The loop of force over displacement.

use crate::kinematics::Walk;

/// Work along a loop of force over displacement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceLoop {
    /// Work done on the fruit up to the largest displacement; J.
    pub loading: f64,
    /// Work that it gave back; J.
    pub unloading: f64,
    /// Their difference, the area of the loop: what was absorbed; J.
    pub area: f64,
}

/// Work along the contact from `onset` to `end`, split at the largest
/// displacement: ∫ F dx, exact for what is linear between samples.
///
/// * `force`, `displacement`: times and samples; s, N, m. Times need not agree:
///   both are taken at the times of both.
///
/// `None` with fewer than three samples in contact.
pub fn force_loop(
    force: (&[f64], &[f64]),
    displacement: (&[f64], &[f64]),
    onset: f64,
    end: f64,
) -> Option<ForceLoop> {
    let inside = |times: &[f64]| {
        let first = times.partition_point(|&t| t < onset);
        first..times.partition_point(|&t| t <= end).max(first)
    };
    let own = &force.0[inside(force.0)];
    let other = &displacement.0[inside(displacement.0)];
    let mut times = vec![onset];
    times.extend(own);
    if own != other {
        times.extend(other);
        times.sort_by(f64::total_cmp);
    }
    times.push(end);
    times.dedup();
    if times.len() < 4 {
        return None;
    }
    let mut places = Walk::along(displacement.0, displacement.1);
    let mut forces = Walk::along(force.0, force.1);
    let at = |time: &f64| (places.at(*time), forces.at(*time));
    let points: Vec<(f64, f64)> = times.iter().map(at).collect();
    let top = (0..points.len()).max_by(|&a, &b| points[a].0.total_cmp(&points[b].0))?;
    let work = |points: &[(f64, f64)]| -> f64 {
        // Force and displacement are linear in time between points, so that the
        // work is that of the mean force.
        points
            .windows(2)
            .map(|p| 0.5 * (p[0].1 + p[1].1) * (p[1].0 - p[0].0))
            .sum()
    };
    let (loading, unloading) = (work(&points[..=top]), -work(&points[top..]));
    Some(ForceLoop {
        loading,
        unloading,
        area: loading - unloading,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_triangle() {
        // Up along F = 2 x to x = 1, down along F = 4 (x − 0.5).
        let times = [0.0, 1.0, 2.0, 3.0];
        let x = [0.0, 1.0, 0.5, 0.5];
        let f = [0.0, 2.0, 0.0, 0.0];
        let found = force_loop((&times, &f), (&times, &x), 0.0, 2.5).unwrap();
        assert!((found.loading - 1.0).abs() < 1e-15);
        assert!((found.unloading - 0.5).abs() < 1e-15);
        assert!((found.area - 0.5).abs() < 1e-15);
    }

    /// Kelvin-Voigt over one cycle of x = X sin ωt: the damper takes π c ω X².
    #[test]
    fn closed_form_damper() {
        let (k, c, omega, largest) = (1e3, 5.0, 200.0, 2e-3);
        let n = 20_001;
        let period = std::f64::consts::TAU / omega;
        let times: Vec<f64> = (0..n)
            .map(|i| period * f64::from(i) / f64::from(n - 1))
            .collect();
        let x: Vec<f64> = times.iter().map(|t| largest * (omega * t).sin()).collect();
        let rate = times.iter().map(|t| largest * omega * (omega * t).cos());
        let f: Vec<f64> = x.iter().zip(rate).map(|(x, v)| k * x + c * v).collect();
        let found = force_loop((&times, &f), (&times, &x), 0.0, period).unwrap();
        let expected = std::f64::consts::PI * c * omega * largest * largest;
        assert!((found.area / expected - 1.0).abs() < 1e-6, "{found:?}");
    }
}
