//! Laws of the user as `[laws.NAME]` of a campaign.toml.

use std::fmt::Write;
use windfall_contact::laws::kind::LawKind;
use windfall_contact::laws::user::UserForce;
use windfall_contact::parameter::NO_BOUND;
use windfall_files::text::quote::string_text;

/// The table of a user's law, as [`crate::user_laws::read`] reads it; nothing for a
/// built-in law.
pub fn law_table(kind: LawKind) -> String {
    let LawKind::User(user) = kind else {
        return String::new();
    };
    let definition = user.definition();
    let mut text = format!("[laws.{}]\n", kind.name());
    // Writing to a string cannot fail.
    match &definition.force {
        UserForce::Formula(formula) => {
            let _ = writeln!(text, "force = {}", string_text(formula));
        }
        UserForce::WithMemory { force, unloading } => {
            let _ = writeln!(text, "force = {}", string_text(force));
            let _ = writeln!(text, "unloading = {}", string_text(unloading));
        }
        UserForce::Table(table) => {
            let _ = writeln!(text, "displacement_m = {:?}", table.displacement);
            let _ = writeln!(text, "force_N = {:?}", table.force);
            if let Some(damping) = &table.damping {
                let _ = writeln!(text, "damping_N_s_m = {damping:?}");
            }
        }
    }
    for parameter in &definition.parameters {
        let mut keys = format!("unit = {}", string_text(&parameter.unit));
        let values = [
            ("start", parameter.start),
            ("default", parameter.default),
            ("lower", Some(parameter.lower).filter(|v| *v > -NO_BOUND)),
            ("upper", Some(parameter.upper).filter(|v| *v < NO_BOUND)),
        ];
        for (key, value) in values {
            if let Some(value) = value {
                let _ = write!(keys, ", {key} = {value:?}");
            }
        }
        if !parameter.meaning.is_empty() {
            let _ = write!(keys, ", meaning = {}", string_text(&parameter.meaning));
        }
        let _ = writeln!(text, "parameters.{} = {{ {keys} }}", parameter.name);
    }
    text
}
