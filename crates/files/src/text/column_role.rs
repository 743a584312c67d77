//! What the name of a channel says: its unit, and what it seems to be.

use windfall_formats::contents::ChannelContents;
use windfall_formats::text::is_time_name;
use windfall_numerics::unit::quantity::parse_unit;

/// The unit in "Force (N)", "force_N", `Force [N]` or "Force in N", and in
/// "Force (N) (segment 2)".
pub fn unit_of(name: &str) -> Option<String> {
    let is_unit =
        |unit: &str| unit.starts_with(|c: char| !c.is_ascii_digit()) && parse_unit(unit).is_ok();
    let brackets = name.rmatch_indices(['(', '[']);
    let mut bracketed = brackets.filter_map(|(open, bracket)| {
        let close = if bracket == "(" { ')' } else { ']' };
        let (unit, _) = name[open + 1..].split_once(close)?;
        Some(unit.trim())
    });
    let last = || name.rsplit_once(['_', ' ']).map(|(_, last)| last.trim());
    let found = bracketed.find(|unit| is_unit(unit));
    found
        .or_else(|| last().filter(|unit| is_unit(unit)))
        .map(str::to_owned)
}

/// Parts of names and what they usually stand for.
const ROLES: [(&str, &str); 16] = [
    ("time", "time"),
    ("phase_a", "phase_a"),
    ("phase a", "phase_a"),
    ("phase_b", "phase_b"),
    ("phase b", "phase_b"),
    ("force", "force"),
    ("load", "force"),
    ("velocity", "velocity"),
    ("speed", "velocity"),
    ("accel", "acceleration"),
    ("angle", "angle"),
    ("count", "count"),
    ("encoder", "count"),
    ("position", "position"),
    ("pos", "position"),
    ("displacement", "position"),
];

/// Ends of words in German, French, Spanish and Italian, and what they stand for: what
/// testing machines write there ("Standardkraft", "Prüfzeit").
const FOREIGN: [(&str, &str); 28] = [
    ("zeit", "time"),
    ("kraft", "force"),
    ("fuerza", "force"),
    ("forza", "force"),
    ("weg", "position"),
    ("verschiebung", "position"),
    ("verformung", "position"),
    ("auslenkung", "position"),
    ("déplacement", "position"),
    ("deplacement", "position"),
    ("desplazamiento", "position"),
    ("posición", "position"),
    ("spostamento", "position"),
    ("posizione", "position"),
    ("geschwindigkeit", "velocity"),
    ("vitesse", "velocity"),
    ("velocidad", "velocity"),
    ("velocità", "velocity"),
    ("beschleunigung", "acceleration"),
    ("accélération", "acceleration"),
    ("aceleración", "acceleration"),
    ("aceleracion", "acceleration"),
    ("accelerazione", "acceleration"),
    ("winkel", "angle"),
    ("ángulo", "angle"),
    ("angulo", "angle"),
    ("angolo", "angle"),
    ("zähler", "count"),
];

/// What a channel seems to be: "time", or the campaign channel that it could feed.
pub fn role_of(name: &str) -> Option<&'static str> {
    let lower = name.to_lowercase();
    // "Run 1: Time (s)", "Time series/Load (kN)": the name itself, before names above it.
    let bare = lower.split(['(', '[']).next().unwrap_or(&lower);
    let own = bare.rsplit([':', '/']).next().unwrap_or(bare);
    let below = bare.contains('/').then(|| role_in(own)).flatten();
    if below.is_none() && is_time_name(name) {
        return Some("time");
    }
    role_in(own).or_else(|| role_in(&lower))
}

fn role_in(text: &str) -> Option<&'static str> {
    let known = ROLES.iter().find(|(part, _)| text.contains(part));
    let mut words = text.split(|c: char| !c.is_alphanumeric());
    let foreign = || words.find_map(|word| FOREIGN.iter().find(|(end, _)| word.ends_with(end)));
    known.or_else(foreign).map(|(_, role)| *role)
}

/// What a unit alone says of a channel.
pub fn role_of_unit(unit: &str) -> Option<&'static str> {
    let same = |known: &str| match (parse_unit(unit), parse_unit(known)) {
        (Ok(unit), Ok(known)) => unit.dimension.matches(&known.dimension),
        _ => false,
    };
    [
        ("s", "time"),
        ("N", "force"),
        ("m/s^2", "acceleration"),
        ("m/s", "velocity"),
        ("m", "position"),
        ("rad", "angle"),
    ]
    .into_iter()
    .find_map(|(known, role)| same(known).then_some(role))
}

/// The unit of a channel: from the file, else from its name.
pub fn unit_in(channel: &ChannelContents) -> Option<String> {
    channel.unit.clone().or_else(|| unit_of(&channel.name))
}

/// Seconds per unit of a channel of times; 1 where its unit is not known.
pub fn seconds_per_unit(channel: &ChannelContents) -> f64 {
    let unit = unit_in(channel).and_then(|unit| parse_unit(&unit).ok());
    let second = parse_unit("s").ok();
    match (unit, second) {
        (Some(unit), Some(second)) if unit.dimension.matches(&second.dimension) => {
            unit.si_from(1.0)
        }
        _ => 1.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_units_and_roles_from_names() {
        for (name, unit, role) in [
            ("Run 1: Force (N)", Some("N"), Some("force")),
            ("Run 1: Time (s)", Some("s"), Some("time")),
            ("Acceleration (m/s²)", Some("m/s²"), Some("acceleration")),
            ("phase_a_V", Some("V"), Some("phase_a")),
            ("position_mm", Some("mm"), Some("position")),
            ("Load (lbf)", Some("lbf"), Some("force")),
            ("Extension [in]", Some("in"), None),
            ("Kraft [N]", Some("N"), Some("force")),
            ("Standardkraft in kgf", Some("kgf"), Some("force")),
            ("Weg [mm]", Some("mm"), Some("position")),
            ("Prüfzeit [s]", Some("s"), Some("time")),
            ("Déplacement (mm)", Some("mm"), Some("position")),
            ("Temps (s)", Some("s"), Some("time")),
            ("Fuerza (N)", Some("N"), Some("force")),
            ("Desplazamiento (mm)", Some("mm"), Some("position")),
            ("Tiempo (s)", Some("s"), Some("time")),
            (
                "Time series/Load (kN) (segment 2)",
                Some("kN"),
                Some("force"),
            ),
            ("Force/Untitled", None, Some("force")),
            ("Temperatur (°)", Some("°"), None),
            ("remarks", None, None),
            ("column_1", None, None),
        ] {
            assert_eq!(unit_of(name).as_deref(), unit, "{name}");
            assert_eq!(role_of(name), role, "{name}");
        }
    }

    #[test]
    fn closed_form_roles_from_units() {
        assert_eq!(role_of_unit("kN"), Some("force"));
        assert_eq!(role_of_unit("mm"), Some("position"));
        assert_eq!(role_of_unit("V"), None);
        assert_eq!(role_of_unit("Volts of old"), None);
    }
}
