//! Lankarani-Nikravesh: Hunt-Crossley damping for restitution near one.

crate::laws::damped_power::damped_power_law! {
    LankaraniNikravesh, lankarani_nikravesh:
    "lankarani-nikravesh",
    "F = k d^n (1 + a v), a = 0.75 (1 - e^2)/v0",
    "Lankarani and Nikravesh (1990), J. Mech. Design 112, 369"
}
