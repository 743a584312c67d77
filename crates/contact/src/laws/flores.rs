//! Flores: Hunt-Crossley damping for the whole range of restitution.

crate::laws::damped_power::damped_power_law! {
    Flores, flores:
    "flores",
    "F = k d^n (1 + a v), a = 8 (1 - e)/(5 e v0)",
    "Flores, Machado, Silva and Martins (2011), Multibody Syst. Dyn. 25, 357"
}
