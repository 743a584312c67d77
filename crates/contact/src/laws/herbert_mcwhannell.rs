//! Herbert-McWhannell: Hunt-Crossley damping from an impact pair.

crate::laws::damped_power::damped_power_law! {
    HerbertMcWhannell, herbert_mcwhannell:
    "herbert-mcwhannell",
    "F = k d^n (1 + a v), a = 6 (1 - e)/(((2 e - 1)^2 + 3) v0)",
    "Herbert and McWhannell (1977), J. Eng. Ind. 99, 513"
}
