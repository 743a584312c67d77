//! One impact cut out of a recording: what identification fits.

/// Samples of one quantity around the contact.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Series {
    /// Sampling times on the clock of the recording, strictly increasing; s.
    pub times: Vec<f64>,
    /// Samples, positive into the fruit, forces positive in repulsion; SI.
    pub values: Vec<f64>,
    /// Standard deviation of the noise of one sample; SI.
    pub noise: f64,
    /// Standard uncertainty of the zero that was subtracted, shared by all samples; SI.
    pub zero_sd: f64,
    /// Correlation φ of the noise of successive samples before contact, if known; 1.
    pub persistence: Option<f64>,
    /// Step of the samples, where they are quantised; SI.
    pub quantum: Option<f64>,
    /// Whether it was computed from another series.
    pub derived: bool,
}

/// Measured without a law; `None` where the channels needed are missing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measured {
    /// Velocity just before contact; m/s.
    pub impact_velocity: Option<f64>,
    /// Speed of rebound just after contact, positive away from the fruit; m/s.
    pub rebound_velocity: Option<f64>,
    /// Rebound over impact speed; 1.
    pub restitution: Option<f64>,
    /// Time between the crossings of the force threshold; s.
    pub contact_duration: Option<f64>,
    /// Largest force, of the smoothed signal where its noise would raise it; N.
    pub peak_force: Option<f64>,
    /// Largest displacement after first contact; m.
    pub max_displacement: Option<f64>,
    /// Kinetic energy just before contact; J.
    pub impact_energy: Option<f64>,
    /// Kinetic energy just after contact; J.
    pub elastic_energy: Option<f64>,
    /// Their difference; J.
    pub absorbed_energy: Option<f64>,
    /// Integral of the force over the contact; N s.
    pub impulse: Option<f64>,
    /// Work of the force up to the largest displacement; J.
    pub loading_energy: Option<f64>,
    /// Area of the loop of force over displacement; J.
    pub hysteresis_energy: Option<f64>,
    /// Impulse of the force over that of mass times acceleration; 1.
    pub acceleration_impulse_ratio: Option<f64>,
    /// Largest force over the largest mass times acceleration; 1.
    pub acceleration_peak_ratio: Option<f64>,
    /// Largest departure of the twice integrated acceleration from the displacement; m.
    pub integrated_displacement_error: Option<f64>,
    /// Root mean square of that departure over the contact; m.
    pub integrated_displacement_rms: Option<f64>,
    /// That departure at the end of the contact; m.
    pub integrated_displacement_drift: Option<f64>,
    /// Standard uncertainty of the ratio of the impulses, from noise and zeros; 1.
    pub acceleration_impulse_ratio_sd: Option<f64>,
    /// Standard uncertainty of the ratio of the peaks, from noise and zeros; 1.
    pub acceleration_peak_ratio_sd: Option<f64>,
    /// Recorded force over mass times the acceleration of the displacement; 1.
    pub force_gain: Option<f64>,
    /// Time by which the force comes later than the displacement; s.
    pub force_delay: Option<f64>,
    /// Root mean square between the displacement and the twice integrated force; m.
    pub motion_misfit: Option<f64>,
    /// The part of that misfit that the noise of the displacement, or its steps, explains; m.
    pub motion_noise: Option<f64>,
    /// The longest of the times between samples, and between counts of the displacement at the
    /// impact velocity, as a part of the contact; 1.
    pub resolution: Option<f64>,
    /// Standard uncertainty of the gain, from scatter; 1.
    pub force_gain_sd: Option<f64>,
    /// Standard uncertainty of the delay, from scatter; s.
    pub force_delay_sd: Option<f64>,
    /// Standard uncertainty of the impact velocity, from the scatter about the line; m/s.
    pub impact_velocity_sd: Option<f64>,
    /// Standard uncertainty of the speed of rebound, likewise; m/s.
    pub rebound_velocity_sd: Option<f64>,
    /// Standard uncertainty of what changes the velocity between touch and the crossing of the
    /// threshold, which either velocity leaves out; m/s.
    pub touch_velocity_sd: Option<f64>,
    /// Standard uncertainty of the duration, from noise at the crossings of the threshold; s.
    pub contact_duration_sd: Option<f64>,
    /// Standard uncertainty of the largest force, from noise and offset; N.
    pub peak_force_sd: Option<f64>,
    /// Standard uncertainty of the largest displacement, from noise at its top and at its
    /// zero, and of the onset; m.
    pub max_displacement_sd: Option<f64>,
    /// Standard uncertainty of the impulse, from noise and offset of the force; N s.
    pub impulse_sd: Option<f64>,
}

/// One impact: each channel around the contact, and the contact window.
///
/// The displacement is zero at `onset`; the series reach a little before and
/// after the contact, so that onset and separation can be estimated.
#[derive(Clone, Debug, PartialEq)]
pub struct Impact {
    /// Displacement; m.
    pub displacement: Option<Series>,
    /// Displacement rate; m/s.
    pub rate: Option<Series>,
    /// Contact force; N.
    pub force: Option<Series>,
    /// Acceleration; m/s².
    pub acceleration: Option<Series>,
    /// First contact by the threshold; s on the recording's clock.
    pub onset: f64,
    /// End of contact by the threshold; s on the recording's clock.
    pub end: f64,
    /// What the signals say without a law.
    pub measured: Measured,
}
