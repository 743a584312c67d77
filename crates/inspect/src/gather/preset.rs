//! What exports of testing machines call their columns.

use crate::run::{InspectRequest, Inspection, inspect_recording};
use serde::{Deserialize, Serialize};
use std::path::Path;
use windfall_files::error::Error;
use windfall_files::option_value::unusable;
use windfall_files::table::write::csv_text;
use windfall_files::text::table::paragraph;
use windfall_files::text::toml_source::suggestion;

/// The table of presets.
const TABLE: &str = include_str!("presets.toml");

/// Columns of the exports of one program.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize, utoipa::ToSchema)]
#[serde(deny_unknown_fields)]
pub struct Preset {
    /// By what it is asked for.
    pub name: String,
    /// Whose exports they are.
    pub title: String,
    /// The export that was seen.
    pub source: String,
    /// Its licence.
    pub licence: String,
    /// What a user should know.
    pub remark: String,
    /// Names of the column of times, the best first.
    pub time: Vec<String>,
    /// Names of the column of forces.
    pub force: Vec<String>,
    /// Names of the column of positions.
    pub position: Vec<String>,
}

#[derive(Deserialize)]
struct Table {
    preset: Vec<Preset>,
}

/// All presets.
///
/// # Errors
/// None in practice: the table is part of the program, and a test reads it.
pub fn presets() -> Result<Vec<Preset>, Error> {
    let table: Result<Table, _> = toml::from_str(TABLE);
    let table = table.map_err(|error| Error::unwritable("the table of presets", error))?;
    Ok(table.preset)
}

/// The preset of a name.
///
/// # Errors
/// There is none; names the nearest.
pub fn preset_of(name: &str) -> Result<Preset, Error> {
    let all = presets()?;
    let found = all.iter().find(|own| own.name == name).cloned();
    found.ok_or_else(|| {
        let names: Vec<&str> = all.iter().map(|own| own.name.as_str()).collect();
        let hint = suggestion(name, names.iter().copied());
        let problem = format!(
            "there are {}{hint}; `windfall inspect --presets` says what they are",
            names.join(" and ")
        );
        unusable(format!("--preset {name}"), problem)
    })
}

/// Looks through a recording, and gives its columns the roles that a preset says, if there is one.
///
/// # Errors
/// Those of [`inspect_recording`] and [`apply_preset`].
pub fn inspect_by(
    path: &Path,
    request: &InspectRequest,
    preset: Option<&Preset>,
) -> Result<Inspection, Error> {
    let mut seen = inspect_recording(path, request)?;
    if let Some(preset) = preset {
        apply_preset(&mut seen, preset)?;
    }
    Ok(seen)
}

/// Gives the columns of a recording the roles that a preset says; no other column keeps one of
/// these.
///
/// A column counts by what stands behind the name of its sheet or run, `Values 1/Standard force`.
///
/// # Errors
/// The recording has no column of the preset for the force.
pub fn apply_preset(seen: &mut Inspection, preset: &Preset) -> Result<(), Error> {
    let bare = |column: &str| {
        let own = column.rsplit(['/', ':']).next().unwrap_or(column);
        let own = own.split(['(', '[']).next().unwrap_or(own);
        own.trim().to_lowercase()
    };
    let roles = [
        ("time", &preset.time),
        ("force", &preset.force),
        ("position", &preset.position),
    ];
    for (role, names) in roles {
        let mut columns = seen.columns.iter();
        let place = names.iter().find_map(|name| {
            let name = name.to_lowercase();
            columns
                .clone()
                .position(|column| bare(&column.column) == name)
        });
        if place.is_none() && role == "force" {
            let problem = format!(
                "{} has no column called {}; it has {}",
                seen.file,
                names.join(" or "),
                columns
                    .by_ref()
                    .map(|own| own.column.as_str())
                    .collect::<Vec<_>>()
                    .join(", ")
            );
            return Err(unusable(format!("--preset {}", preset.name), problem));
        }
        let Some(place) = place else { continue };
        let of_role = format!("{role} ");
        seen.assumed.retain(|line| !line.starts_with(&of_role));
        for (other, column) in seen.columns.iter_mut().enumerate() {
            if other == place {
                column.role = Some(role);
            } else if column.role == Some(role) {
                column.role = None;
            }
        }
    }
    Ok(())
}

/// The presets for people.
pub fn text_of_presets(presets: &[Preset]) -> String {
    let told = presets.iter().map(|own| {
        let lines = [
            own.title.clone(),
            format!("seen in {} ({})", own.source, own.licence),
            format!(
                "time: {}; force: {}; position: {}",
                own.time.join(" or "),
                own.force.join(" or "),
                own.position.join(" or ")
            ),
            own.remark.clone(),
        ];
        let lines = lines.map(|line| paragraph(&format!("  {line}"), 4) + "\n");
        format!("{}\n{}", own.name, lines.concat())
    });
    told.collect::<Vec<_>>().join("\n")
}

/// The presets as CSV.
///
/// # Errors
/// None in practice: every cell can be written.
pub fn csv_of_presets(presets: &[Preset]) -> Result<String, Error> {
    let rows = presets.iter().map(|own| {
        let columns = [&own.time, &own.force, &own.position].map(|names| names.join("; "));
        let cells = [&own.name, &own.title, &own.source, &own.licence].map(Clone::clone);
        cells.into_iter().chain(columns).collect()
    });
    let header = [
        "name", "title", "source", "licence", "time", "force", "position",
    ];
    csv_text(&header, rows.collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seen(text: &str) -> Inspection {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("export.csv");
        std::fs::write(&path, text).unwrap();
        inspect_recording(&path, &InspectRequest::default()).unwrap()
    }

    fn roles(seen: &Inspection) -> Vec<(&str, &'static str)> {
        let columns = seen.columns.iter();
        columns
            .filter_map(|own| Some((own.column.as_str(), own.role?)))
            .collect()
    }

    /// Columns and units as the export of testXpert has them, with its block of parameters; the
    /// numbers are our own.
    #[test]
    fn reference_columns_of_testxpert() {
        let text = "\"Section\",6,\"mm\"\n\"v1\",1,\"mm/min\"\n\
                    \"Temps\",\"Traverse absolue\",\"Force standard\",\"Course standard\"\n\
                    \"s\",\"mm\",\"N\",\"mm\"\n0,-70,1,0\n0.1,-69.9,2,0.1\n0.2,-69.8,3,0.2\n\
                    0.3,-69.7,4,0.3\n";
        let mut found = seen(text);
        // Without it the first position is the crosshead's.
        assert_eq!(roles(&found)[1], ("Traverse absolue", "position"));
        apply_preset(&mut found, &preset_of("zwick-roell").unwrap()).unwrap();
        let expected = [
            ("Temps", "time"),
            ("Force standard", "force"),
            ("Course standard", "position"),
        ];
        assert_eq!(roles(&found), expected);
    }

    /// The same of WaveMatrix.
    #[test]
    fn reference_columns_of_wavematrix() {
        let text = "\"Total Time (s)\",\"Cycle Elapsed Time (s)\",\"Position (mm)\",\"Force (kN)\",\
                    \"Digital Position (mm)\"\n8.1,0,1,-0.1,1\n8.2,0.1,1.1,-0.2,1.1\n\
                    8.3,0.2,1.2,-0.3,1.2\n";
        let mut found = seen(text);
        apply_preset(&mut found, &preset_of("instron-wavematrix").unwrap()).unwrap();
        let expected = [
            ("Total Time (s)", "time"),
            ("Position (mm)", "position"),
            ("Force (kN)", "force"),
        ];
        assert_eq!(roles(&found), expected);
    }

    #[test]
    fn rejects_other_names_and_other_exports() {
        let told = preset_of("zwick").unwrap_err().to_string();
        assert!(
            told.contains("zwick-roell") && told.contains("--presets"),
            "{told}"
        );
        let mut found = seen("Time (s),Load (N)\n0,1\n1,2\n2,3\n");
        let refused = apply_preset(&mut found, &preset_of("zwick-roell").unwrap());
        let told = refused.unwrap_err().to_string();
        assert!(told.contains("Standard force or Force standard"), "{told}");
        assert!(told.contains("Load (N)"), "{told}");
    }

    /// Every preset names an export, and no name stands for two things.
    #[test]
    fn reference_presets_have_a_source() {
        let all = presets().unwrap();
        assert!(!all.is_empty());
        for own in &all {
            assert!(own.source.contains("github.com/") && !own.licence.is_empty());
            let both = own.force.iter().find(|name| own.position.contains(name));
            assert_eq!(both, None, "{}", own.name);
        }
    }
}
