//! Forward: a fruit falls on the plate and bounces.

/// What one impact of a drop comes to; SI, times from the release.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DropImpact {
    /// First touch; s.
    pub onset_time: f64,
    /// Speed of approach of fruit and plate at first touch; m/s.
    pub impact_velocity: f64,
    /// Largest force between fruit and plate; N.
    pub peak_contact_force: f64,
    /// When it is reached; s.
    pub time_of_peak_contact_force: f64,
    /// Largest force on the plate's support from this onset to the next, about
    /// its static load; N.
    pub peak_support_force: f64,
    /// When it is reached; s.
    pub time_of_peak_support_force: f64,
    /// Largest indentation; m.
    pub max_displacement: f64,
    /// When it is reached; s.
    pub time_of_max_displacement: f64,
    /// When the force is back at zero; s.
    pub force_end_time: f64,
    /// When the gap between fruit and plate opens; s.
    pub separation_time: f64,
    /// Velocity of the fruit then, up positive; m/s.
    pub separation_velocity: f64,
    /// Speed of the fruit at separation over that at onset; 1.
    pub restitution: f64,
    /// Speed at which the point of contact leaves the plate over the speed of
    /// approach; 1.
    pub contact_restitution: f64,
    /// Integral of the contact force; N s.
    pub impulse: f64,
    /// Energy that the fruit's centre of mass loses: kinetic, and of height
    /// from onset to separation; J.
    pub absorbed_energy: f64,
}
