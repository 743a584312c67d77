//! Which column of a recording is which channel: the one rule of `inspect`, of campaigns that
//! are made of recordings, and of the page's import.

use crate::text::column_role::{role_of, role_of_unit};

/// Times, and the channels that a campaign may have, in the order in which they are told.
pub const ROLES: [&str; 9] = [
    "time",
    "force",
    "position",
    "velocity",
    "acceleration",
    "angle",
    "count",
    "phase_a",
    "phase_b",
];

/// Units of mass in which forces are given, and the forces that are meant.
const WEIGHTS: [(&str, &str); 5] = [
    ("g", "gf"),
    ("kg", "kgf"),
    ("lb", "lbf"),
    ("lbs", "lbf"),
    ("oz", "ozf"),
];

/// A column, as far as its header goes.
#[derive(Clone, Copy, Debug)]
pub struct ColumnHead<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its unit, from the file or from its name.
    pub unit: Option<&'a str>,
    /// Whether the file itself says that it holds times.
    pub is_time: bool,
}

/// What the columns of a recording seem to be.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ColumnGuess {
    /// What each column could be.
    pub roles: Vec<Option<&'static str>>,
    /// What each column is taken for; at most one column has a channel.
    pub channels: Vec<Option<&'static str>>,
    /// Channels that several columns could be, none of them rather than another: positions.
    pub open: Vec<(&'static str, Vec<usize>)>,
    /// What was assumed, and what is left over; a sentence each.
    pub assumed: Vec<String>,
}

/// Tells columns by their names, and where those say nothing by their units.
///
/// Of several columns that are called alike the first is taken, and that is said. A unit alone
/// is enough where one column has it; where several have it, none is taken.
pub fn guess_columns(columns: &[ColumnHead]) -> ColumnGuess {
    let told: Vec<(Option<&'static str>, bool)> = columns.iter().map(role_of_head).collect();
    let mut guess = ColumnGuess {
        roles: told.iter().map(|(role, _)| *role).collect(),
        channels: vec![None; columns.len()],
        ..ColumnGuess::default()
    };
    let mut spoken_of = vec![false; columns.len()];
    for role in ROLES {
        let of_role = |named: bool| {
            let all = (0..columns.len()).filter(|&i| told[i] == (Some(role), named));
            all.collect::<Vec<usize>>()
        };
        let (named, united) = (of_role(true), of_role(false));
        let quoted = |indices: &[usize]| {
            let names = indices.iter().map(|&i| format!("\"{}\"", columns[i].name));
            names.collect::<Vec<_>>()
        };
        match (&named[..], &united[..]) {
            ([], []) => {}
            ([first, further @ ..], _) => {
                guess.channels[*first] = Some(role);
                if !further.is_empty() {
                    guess.assumed.push(format!(
                        "{role} is \"{}\", the first of {} columns that could be: not {}",
                        columns[*first].name,
                        named.len(),
                        some_of(&quoted(further), " or ")
                    ));
                }
                further.iter().for_each(|&i| spoken_of[i] = true);
            }
            ([], [only]) => {
                guess.channels[*only] = Some(role);
                guess.assumed.push(format!(
                    "{role} is \"{}\", by its unit alone: no other column is in {}",
                    columns[*only].name,
                    columns[*only].unit.unwrap_or_default()
                ));
            }
            ([], several) => {
                guess.assumed.push(format!(
                    "{role} could be {}, by their units: none of them is taken",
                    some_of(&quoted(several), " or ")
                ));
                several.iter().for_each(|&i| spoken_of[i] = true);
                guess.open.push((role, several.to_vec()));
            }
        }
    }
    guess.assumed.extend(contradictions(columns, &guess));
    let left = (0..columns.len()).filter(|&i| guess.channels[i].is_none() && !spoken_of[i]);
    let left: Vec<String> = left.map(|i| format!("\"{}\"", columns[i].name)).collect();
    if !left.is_empty() {
        let what = format!("nothing is taken from {}", some_of(&left, " and "));
        guess.assumed.push(what);
    }
    guess
}

/// The unit that is meant where a channel's unit is that of another quantity: grams of a force
/// are gram-force, and g of an acceleration is that of free fall.
pub fn unit_meant(role: &str, unit: &str) -> Option<&'static str> {
    match role {
        "force" => {
            let mut weights = WEIGHTS.iter();
            let found = weights.find(|(own, _)| *own == unit);
            found.map(|(_, force)| *force)
        }
        "acceleration" if ["g", "G"].contains(&unit) => Some("g0"),
        _ => None,
    }
}

/// What a column could be, and whether its name says so.
fn role_of_head(column: &ColumnHead) -> (Option<&'static str>, bool) {
    if column.is_time {
        return (Some("time"), true);
    }
    let named = role_of(column.name);
    let united = column.unit.and_then(role_of_unit);
    match (named, united) {
        // "Position (deg)": the unit knows better.
        (Some(name), Some(unit)) if name != unit => (Some(unit), false),
        (Some(name), _) => (Some(name), true),
        (None, unit) => (unit, false),
    }
}

/// Columns whose name and unit say different things.
fn contradictions(columns: &[ColumnHead], guess: &ColumnGuess) -> Vec<String> {
    let told = columns
        .iter()
        .zip(&guess.channels)
        .filter_map(|(column, taken)| {
            let named = role_of(column.name)?;
            let taken = taken.filter(|taken| *taken != named && !column.is_time)?;
            Some(format!(
                "\"{}\" is called a {named} and is in {}: it is taken for {taken}",
                column.name,
                column.unit.unwrap_or_default()
            ))
        });
    told.collect()
}

/// The first names of a list, and how many there are besides.
fn some_of(names: &[String], between: &str) -> String {
    const NAMED: usize = 3;
    let shown = names.iter().take(NAMED).cloned().collect::<Vec<_>>();
    match names.len() {
        0..=NAMED => shown.join(between),
        all => format!("{} and {} more", shown.join(", "), all - NAMED),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::text::column_role::unit_of;

    fn guess(names: &[&str]) -> ColumnGuess {
        let units: Vec<Option<String>> = names.iter().map(|name| unit_of(name)).collect();
        let heads = names.iter().zip(&units).map(|(name, unit)| ColumnHead {
            name,
            unit: unit.as_deref(),
            is_time: false,
        });
        guess_columns(&heads.collect::<Vec<_>>())
    }

    #[test]
    fn closed_form_columns_in_four_languages() {
        for (names, channels) in [
            (
                &["Zeit [s]", "Kraft [N]", "Weg in mm"][..],
                &["time", "force", "position"][..],
            ),
            (
                &["Temps (s)", "Force (N)", "Déplacement (mm)"],
                &["time", "force", "position"],
            ),
            (
                &["Tiempo (s)", "Fuerza (N)", "Velocidad (m/s)"],
                &["time", "force", "velocity"],
            ),
            (
                &["Tempo [ms]", "Forza [kgf]", "Spostamento [mm]"],
                &["time", "force", "position"],
            ),
            (
                &["t [s]", "Winkel °", "Last [gf]"],
                &["time", "angle", "force"],
            ),
            (
                &["Temps (s)", "Accélération (m/s²)", "Course (mm)"],
                &["time", "acceleration", "position"],
            ),
            (
                &["Tiempo (s)", "Aceleración (m/s²)", "Carga (lbf)"],
                &["time", "acceleration", "force"],
            ),
            (
                &["Zeit (s)", "Beschleunigung (g)", "Ángulo (deg)"],
                &["time", "acceleration", "angle"],
            ),
        ] {
            let found = guess(names);
            let expected: Vec<_> = channels.iter().map(|own| Some(*own)).collect();
            assert_eq!(found.channels, expected, "{names:?}: {found:?}");
        }
    }

    #[test]
    fn closed_form_units_alone_are_enough_where_one_column_has_them() {
        let found = guess(&["T [ms]", "Kanal 1 [N]", "Kanal 2 [mm]", "Kanal 3 [V]"]);
        assert_eq!(
            found.channels,
            [Some("time"), Some("force"), Some("position"), None]
        );
        let said = found.assumed.join("\n");
        assert!(
            said.contains("force is \"Kanal 1 [N]\", by its unit alone"),
            "{said}"
        );
        assert!(
            said.contains("nothing is taken from \"Kanal 3 [V]\""),
            "{said}"
        );
    }

    #[test]
    fn rejects_to_choose_between_columns_that_only_their_unit_tells() {
        let found = guess(&["Zeit (s)", "Kraft (N)", "Taster A (mm)", "Taster B (mm)"]);
        assert_eq!(found.channels, [Some("time"), Some("force"), None, None]);
        assert_eq!(found.open, [("position", vec![2, 3])]);
        let said = found.assumed.join("\n");
        assert!(
            said.contains("position could be \"Taster A (mm)\" or \"Taster B (mm)\""),
            "{said}"
        );
    }

    #[test]
    fn closed_form_of_two_accelerations_the_first_is_taken_and_said() {
        let found = guess(&[
            "time_s",
            "acceleration_1 (m/s²)",
            "acceleration_2 (m/s²)",
            "note",
        ]);
        assert_eq!(found.channels[1..3], [Some("acceleration"), None]);
        let said = found.assumed.join("\n");
        assert!(
            said.contains("the first of 2 columns that could be: not \"acceleration_2"),
            "{said}"
        );
        assert!(said.contains("nothing is taken from \"note\""), "{said}");
    }

    #[test]
    fn closed_form_units_correct_names() {
        let found = guess(&["time_s", "position (deg)", "force (g)"]);
        assert_eq!(found.channels, [Some("time"), Some("angle"), Some("force")]);
        assert!(
            found
                .assumed
                .iter()
                .any(|own| own.contains("called a position and is in deg"))
        );
        assert_eq!(unit_meant("force", "g"), Some("gf"));
        assert_eq!(unit_meant("acceleration", "g"), Some("g0"));
        assert_eq!(unit_meant("position", "g"), None);
    }
}
