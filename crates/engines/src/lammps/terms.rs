//! Contacts in the words of LAMMPS.

use crate::deck::Task;
use crate::law::PairNumbers;
use std::fmt::Write;
use windfall_contact::granular_law::Damping;
use windfall_scene::interaction::Interaction;

/// Coefficients of a contact as `pair_style granular` and `fix wall/gran` take them.
pub(crate) fn terms(
    task: &Task,
    interaction: &Interaction,
    radius: f64,
    mass: f64,
) -> Result<String, String> {
    let pair = PairNumbers::of(interaction, radius, mass)?;
    let form = if pair.law.hertzian { "hertz" } else { "hooke" };
    let (coefficient, damping) = match pair.law.damping {
        Damping::None => (0.0, "velocity"),
        Damping::Constant(c) => (c, "velocity"),
        Damping::Root(c) => (pair.viscoelastic(c), "viscoelastic"),
        Damping::Quarter(c) => (tsuji(c / (mass * pair.law.k).sqrt())?, "tsuji"),
    };
    let mut text = format!(
        "{form} {} {coefficient} damping {damping}",
        pair.stiffness()
    );
    if interaction.friction > 0.0 {
        let kind = match pair.law.hertzian {
            true => "mindlin_rescale/force",
            false => "linear_history",
        };
        let _ = write!(
            text,
            " tangential {kind} {} {} {}",
            pair.tangential(interaction.tangential_ratio),
            interaction.tangential_damping,
            interaction.friction
        );
        if interaction.rolling > 0.0 {
            let stiffness = interaction.tangential_ratio * pair.stiffness_at(task.load(mass));
            let _ = write!(text, " rolling sds {stiffness} 0.0 {}", interaction.rolling);
        }
    } else {
        text += " tangential linear_history 1.0 0.0 0.0";
    }
    Ok(text + " limit_damping")
}

/// The restitution that LAMMPS makes this damping ratio of.
///
/// # Source
/// The polynomial of `damping tsuji` in the manual of `pair_style granular`.
fn tsuji(ratio: f64) -> Result<f64, String> {
    const TERMS: [f64; 7] = [1.2728, -4.2783, 11.087, -22.348, 27.467, -18.022, 4.8218];
    let of = |e: f64| TERMS.iter().rev().fold(0.0, |sum, term| sum * e + term);
    let (mut low, mut high) = (0.0, 1.0);
    if ratio > of(low) {
        return Err(format!(
            "a damping ratio of {ratio:.3} in tsuji: it has up to {}",
            of(low)
        ));
    }
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        match of(middle) > ratio {
            true => low = middle,
            false => high = middle,
        }
    }
    Ok(0.5 * (low + high))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_restitution_of_a_damping_ratio() {
        for e in [0.2_f64, 0.5, 0.7, 0.9] {
            // The polynomial itself, term by term.
            let ratio = 1.2728 - 4.2783 * e + 11.087 * e * e - 22.348 * e.powi(3)
                + 27.467 * e.powi(4)
                - 18.022 * e.powi(5)
                + 4.8218 * e.powi(6);
            assert!((tsuji(ratio).unwrap() - e).abs() < 1e-9, "{e}");
        }
        assert!(tsuji(1.5).is_err());
    }
}
