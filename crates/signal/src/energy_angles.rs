//! Energies of a pendulum from the angles of release and rebound.

/// Potential energy above the lowest point, m g l (1 − cos θ); J.
///
/// * `mass`: of arm and impactor; kg
/// * `gravity`: m/s²
/// * `centre_of_mass`: distance from the pivot; m
/// * `angle`: from the vertical; rad
///
/// # Example
/// ```
/// let energy = windfall_signal::energy_angles::pendulum_energy(0.2, 9.81, 0.5, 0.0);
/// assert_eq!(energy, 0.0);
/// ```
pub fn pendulum_energy(mass: f64, gravity: f64, centre_of_mass: f64, angle: f64) -> f64 {
    // 1 − cos θ without cancellation at small angles.
    2.0 * mass * gravity * centre_of_mass * (0.5 * angle).sin().powi(2)
}

/// Speed of the point of contact at the lowest point, √(2E/m) with m = I/r²; m/s.
pub fn speed_of_energy(energy: f64, effective_mass: f64) -> f64 {
    (2.0 * energy / effective_mass).sqrt()
}
