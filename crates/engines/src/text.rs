//! A deck that was written, for a terminal.

use crate::contacts::ContactsOutcome;
use crate::delivered::text_of_delivered;
use crate::run::DeckOutcome;
use windfall_files::text::statistic::number;
use windfall_files::text::table::finding_lines;
use windfall_scene_run::file::engine_kind::Engine;
use windfall_scene_run::run::tables::text_of_files;

/// What was written, and what to do with it.
pub fn text_of_deck(outcome: &DeckOutcome) -> String {
    let mut text = format!(
        "A deck for {}: {} steps of {} µs, a frame every {}.\n",
        outcome.engine,
        outcome.steps,
        number(1e6 * outcome.time_step),
        match outcome.frame_steps {
            1 => "step".to_owned(),
            steps => format!("{steps} steps"),
        }
    );
    for line in finding_lines(&outcome.findings) {
        text += &format!("\n{line}\n");
    }
    let program = match outcome.engine == Engine::Liggghts.title() {
        true => "liggghts",
        false => "lmp",
    };
    let start = outcome.files.first().and_then(|file| file.file_name());
    let start = start.map_or(String::new(), |name| name.to_string_lossy().into_owned());
    text += &format!(
        "\nThere: {program} -in {start}, on one machine or on many. It writes frames.bin, of which\n\
         `windfall scene run FILE --engine {} --frames frames.bin` makes contacts, fruit and bruises.\n",
        outcome.engine.to_lowercase()
    );
    text + &text_of_files(&outcome.files)
}

/// Contacts in another engine's terms: what is exact, and what is not.
pub fn text_of_contacts(outcome: &ContactsOutcome) -> String {
    let mut text = format!("Contacts for {}.\n", outcome.engine);
    for own in &outcome.contacts {
        let [a, b] = &own.between;
        text += &format!(
            "\n{a} and {b}\n  exact: {}\n  approximate: {}\n",
            own.exact, own.approximate
        );
        if !own.delivered.is_empty() {
            let delivered = text_of_delivered(&own.delivered);
            text += &format!("  restitution delivered: {delivered}\n");
        }
    }
    text + &format!("\nWritten: {}\n", outcome.file.display())
}
