//! Every key of every kind of file: with a value that cannot be, the message names file, line
//! and key. The keys are those that the files themselves know, asked for by a key that they do
//! not know; the files are the templates.

use std::collections::BTreeSet;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use windfall_campaign::settings::template::{
    TEMPLATES, write_scene_template, write_study_template, write_template,
};
use windfall_cards::read_card::read_card;
use windfall_cards::user_laws::read::read_laws;
use windfall_files::error::Error;
use windfall_scene_run::file::read::read_scene;
use windfall_scene_run::study::run::{StudyRequest, run_study};
use windfall_workspace::campaign_files::check_campaign;

/// Values that no key takes: of another type, no number, beyond all that numbers can be.
const WRONG: [&str; 9] = [
    "true",
    "nan",
    "-inf",
    "1e999",
    "\"nan kg\"",
    "\"\\u0001\"",
    "[[[]]]",
    "{ nosuch = 1 }",
    "1979-05-27",
];

/// A value that only keys take that may have any sign.
const NEGATIVE: &str = "-9223372036854775808";

/// Keys that take any text, or true.
const FREE: [&str; 26] = [
    "title",
    "note",
    "simulated",
    "directory",
    "time",
    "column",
    "comment",
    "missing",
    "group",
    "name",
    "meaning",
    "reference_column",
    "reference_value",
    "closed",
    // Of a law card, for people.
    "campaign",
    "date",
    "method",
    "windfall",
    "impactor",
    "target",
    "bodies",
    "of_what",
    "unit of a card",
    "on",
    "cautions",
    "digests",
];

/// Keys of numbers that may have any sign and size.
const SIGNED: [&str; 11] = [
    "offset",
    "delay",
    "gain",
    "sensitivity",
    "centre_of_mass",
    "driving_acceleration",
    "static_level",
    "angle",
    "angular_velocity",
    "frequency",
    "lower",
];

/// What a table or key needs beside it: where a table begins so, or a key is called so, these
/// are set; nothing removes one.
type Beside = (
    &'static str,
    &'static str,
    &'static [(&'static str, &'static str, Option<&'static str>)],
);
const BESIDE: [Beside; 22] = [
    (
        "channels.force",
        "",
        &[
            ("channels.force", "column", Some("\"a\"")),
            ("channels.force", "unit", Some("\"N\"")),
        ],
    ),
    (
        "channels.position",
        "",
        &[
            ("channels.position", "column", Some("\"a\"")),
            ("channels.position", "unit", Some("\"m\"")),
        ],
    ),
    (
        "channels.velocity",
        "",
        &[
            ("channels.velocity", "column", Some("\"a\"")),
            ("channels.velocity", "unit", Some("\"m/s\"")),
        ],
    ),
    (
        "channels.acceleration",
        "",
        &[
            ("channels.acceleration", "column", Some("\"a\"")),
            ("channels.acceleration", "unit", Some("\"m/s^2\"")),
        ],
    ),
    (
        "channels.angle",
        "",
        &[
            ("channels.angle", "column", Some("\"a\"")),
            ("channels.angle", "unit", Some("\"deg\"")),
        ],
    ),
    (
        "channels.count",
        "",
        &[("channels.count", "column", Some("\"a\""))],
    ),
    (
        "channels.phase_a",
        "",
        &[("channels.phase_a", "column", Some("\"a\""))],
    ),
    (
        "channels.phase_b",
        "",
        &[("channels.phase_b", "column", Some("\"b\""))],
    ),
    ("files", "time", &[("files", "rate", None)]),
    (
        "encoder",
        "count_length",
        &[("encoder", "counts_per_revolution", None)],
    ),
    ("contacts", "card", &[("contacts", "law", None)]),
    (
        "contacts",
        "tangential_ratio",
        &[("contacts", "poisson", None)],
    ),
    (
        "bruise",
        "",
        &[
            ("bruise", "predictor", Some("\"absorbed energy\"")),
            ("bruise", "threshold", Some("\"5 mJ\"")),
            ("bruise", "susceptibility", Some("\"3000 mm^3/J\"")),
            ("bruise", "limits", Some("[\"100 mm^3\"]")),
        ],
    ),
    (
        "bruise",
        "regression",
        &[("bruise", "susceptibility", None)],
    ),
    (
        "fruit.drop",
        "",
        &[
            ("fruit", "pour", None),
            ("fruit.drop", "place", Some("[0, 0, 1]")),
        ],
    ),
    (
        "fruit.tree",
        "",
        &[
            ("fruit", "pour", None),
            ("fruit.tree", "low", Some("[0, 0, 1]")),
            ("fruit.tree", "high", Some("[1, 1, 2]")),
        ],
    ),
    (
        "walls.cylinder",
        "",
        &[
            ("walls", "plate", None),
            ("walls.cylinder", "start", Some("[0, 0, 0]")),
            ("walls.cylinder", "end", Some("[0, 0, 1]")),
        ],
    ),
    (
        "walls.mesh",
        "",
        &[
            ("walls", "plate", None),
            ("walls.mesh", "file", Some("\"box.stl\"")),
            ("walls.mesh", "unit", Some("\"m\"")),
        ],
    ),
    (
        "walls.mesh.turn",
        "",
        &[("walls.mesh.turn", "axis", Some("[0, 0, 1]"))],
    ),
    (
        "walls.vibration",
        "",
        &[("walls.vibration", "amplitude", Some("[0, 0, 0.001]"))],
    ),
    (
        "walls.rotation",
        "",
        &[
            ("walls.rotation", "point", Some("[0, 0, 0]")),
            ("walls.rotation", "axis", Some("[0, 0, 1]")),
        ],
    ),
    (
        "rig",
        "plate_damping_sd",
        &[("rig", "plate_damping", Some("\"0.05 N s/mm\""))],
    ),
];

/// A file that is read, and how.
struct Kind {
    name: String,
    file: PathBuf,
    read: fn(&Path) -> Result<(), Error>,
    /// Tables from which the keys are asked for.
    roots: &'static [&'static str],
    /// Keys that are not told, because others may stand there too.
    more: &'static [(&'static str, &'static str)],
}

impl Kind {
    /// What reading it says, with a text in the place of its own.
    fn told(&self, text: &str) -> Result<(), String> {
        std::fs::write(&self.file, text).unwrap();
        (self.read)(&self.file).map_err(|error| error.to_string())
    }

    /// The keys that the file knows in a table; none where it is none.
    fn known(&self, text: &str, table: &str) -> BTreeSet<String> {
        let told = self.told(&with_key(text, table, "nosuchkey", Some("1")));
        let told = told.err().unwrap_or_default();
        match told.split_once("known keys: ") {
            Some((begin, keys)) if begin.contains("\"nosuchkey\"") => {
                keys.split(", ").map(str::to_owned).collect()
            }
            _ => BTreeSet::new(),
        }
    }
}

/// The table that a line begins.
fn header(line: &str) -> Option<&str> {
    let name = line.strip_prefix('[')?.trim_start_matches('[').split(']');
    name.take(1).next()
}

/// Lines of the first table of that name, behind its header.
fn lines_of(lines: &[String], table: &str) -> Option<std::ops::Range<usize>> {
    let begin = match table {
        "" => 0,
        _ => 1 + lines.iter().position(|line| header(line) == Some(table))?,
    };
    let next = lines[begin..].iter().position(|line| line.starts_with('['));
    Some(begin..next.map_or(lines.len(), |next| begin + next))
}

/// The text with a key of a table set, or removed.
fn with_key(text: &str, table: &str, key: &str, value: Option<&str>) -> String {
    // Without the tables in it.
    let inner = match table {
        "" => key.to_owned(),
        _ => format!("{table}.{key}"),
    };
    let mut within = false;
    let mut lines: Vec<String> = Vec::new();
    for line in text.lines() {
        if let Some(name) = header(line) {
            within = name == inner || name.starts_with(&format!("{inner}."));
        }
        if !within {
            lines.push(line.to_owned());
        }
    }
    if lines_of(&lines, table).is_none() {
        // Where it belongs to one of several tables: within that one.
        let outer = table.rsplit_once('.').map_or("", |(outer, _)| outer);
        let at = lines_of(&lines, outer).map_or(lines.len(), |own| own.end);
        let at = if outer.is_empty() { lines.len() } else { at };
        lines.insert(at, format!("[{table}]"));
    }
    let own = lines_of(&lines, table).unwrap();
    let begins = format!("{key} = ");
    let there = own.clone().find(|at| lines[*at].starts_with(&begins));
    let line = value.map(|value| format!("{key} = {value}"));
    match there {
        Some(at) => {
            // With the lines of a list that goes on.
            let mut end = at + 1;
            while end < own.end
                && lines[at].trim_end().ends_with('[')
                && !lines[end - 1].starts_with(']')
            {
                end += 1;
            }
            lines.splice(at..end, line);
        }
        None => {
            lines.splice(own.start..own.start, line);
        }
    }
    lines.join("\n") + "\n"
}

/// The text with a key set and all that it needs, and the line of the key.
fn prepared(text: &str, table: &str, key: &str, value: &str) -> (String, usize) {
    let mut text = text.to_owned();
    for (own, of, beside) in BESIDE {
        let inside = table == own || table.starts_with(&format!("{own}."));
        if !inside || !of.is_empty() && of != key {
            continue;
        }
        for (table, key, value) in beside {
            let lines: Vec<String> = text.lines().map(str::to_owned).collect();
            let begins = format!("{key} = ");
            // A sensitivity stands in the place of a unit.
            let there = |line: &String| {
                line.starts_with(&begins) || *key == "unit" && line.starts_with("sensitivity = ")
            };
            let there = lines_of(&lines, table).is_some_and(|own| lines[own].iter().any(there));
            if !there || value.is_none() {
                text = with_key(&text, table, key, *value);
            }
        }
    }
    if key == "sensitivity" {
        text = with_key(&text, table, "unit", None);
    }
    let text = with_key(&text, table, key, Some(value));
    let lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let own = lines_of(&lines, table).unwrap();
    let begins = format!("{key} = ");
    let line = own.clone().find(|at| lines[*at].starts_with(&begins));
    (text.clone(), line.unwrap() + 1)
}

/// What is wrong with what is told of a wrong value.
fn fault(kind: &Kind, text: &str, (table, key): (&str, &str), value: &str) -> Option<String> {
    let (changed, line) = prepared(text, table, key, value);
    let place = format!("{}, line {line}:", kind.file.file_name().unwrap().display());
    let free = FREE.contains(&key) && (value.starts_with('"') || value == "true");
    let signed = SIGNED.contains(&key) && value == NEGATIVE;
    match kind.told(&changed) {
        Ok(()) if free || signed => None,
        Ok(()) => Some("is accepted".to_owned()),
        Err(told) => {
            // The fault may be a key of a table within the line.
            let named = told.contains(key) || value.contains("nosuch") && told.contains("nosuch");
            let plain = !told.contains("struct ");
            (!told.contains(&place) || !named || !plain).then(|| format!("{place} {told}"))
        }
    }
}

/// Asserts the rule for every key of a table and of those in it; how many values there were.
fn check(kind: &Kind, text: &str, table: &str, depth: usize, faults: &mut Vec<String>) -> usize {
    let mut count = 0;
    let more = kind.more.iter().filter(|(own, _)| *own == table);
    let mut keys = kind.known(text, table);
    keys.extend(more.map(|(_, key)| (*key).to_owned()));
    for key in keys {
        let inner = match table {
            "" => key.clone(),
            _ => format!("{table}.{key}"),
        };
        if depth < 3 && !kind.known(text, &inner).is_empty() {
            count += 1 + check(kind, text, &inner, depth + 1, faults);
            let found = fault(kind, text, (table, &key), "true");
            faults.extend(found.map(|own| format!("{}: {inner} = true: {own}", kind.name)));
            continue;
        }
        for value in WRONG.into_iter().chain([NEGATIVE]) {
            count += 1;
            let found = fault(kind, text, (table, &key), value);
            faults.extend(
                found.map(|own| format!("{}: [{table}] {key} = {value}: {own}", kind.name)),
            );
        }
    }
    count
}

/// Reads a study as its run does, which ends then.
fn read_study(path: &Path) -> Result<(), Error> {
    let read = run_study(path, &StudyRequest::default(), &|_, _| {
        ControlFlow::Break(())
    });
    match read {
        Err(Error::Cancelled) => Ok(()),
        other => other.map(|_| ()),
    }
}

/// The templates of all kinds of files, in a folder.
fn kinds(folder: &Path) -> Vec<Kind> {
    let campaigns = TEMPLATES.into_iter().map(|(name, template)| {
        let directory = folder.join(name);
        write_template(template, &directory).unwrap();
        if name == "carriage" {
            let path = directory.join("campaign.toml");
            let text = std::fs::read_to_string(&path).unwrap();
            std::fs::write(path, text + "[encoder]\ncount_length = \"0.17 mm\"\n").unwrap();
        }
        Kind {
            name: name.to_owned(),
            file: directory.join("campaign.toml"),
            read: |path| check_campaign(path.parent().unwrap()),
            roots: &[""],
            more: &[],
        }
    });
    let mut kinds: Vec<Kind> = campaigns.collect();
    write_scene_template(&folder.join("scene")).unwrap();
    for name in ["study", "card", "regression"] {
        write_study_template(&folder.join(name)).unwrap();
    }
    let laws = "[laws.soft]\nforce = \"k * x^1.5\"\n[laws.soft.parameters.k]\nunit = \"N/m^1.5\"\nstart = 5e5\n";
    std::fs::write(folder.join("laws.toml"), laws).unwrap();
    let stl = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n";
    std::fs::write(folder.join("scene/box.stl"), stl).unwrap();
    let mut add = |name: &str, file: &str, read, roots, more| {
        kinds.push(Kind {
            name: name.to_owned(),
            file: folder.join(file),
            read,
            roots,
            more,
        });
    };
    add(
        "scene",
        "scene/scene.toml",
        |path| read_scene(path).map(|_| ()),
        &[""],
        &[],
    );
    add("study", "study/study.toml", read_study, &["", "vary"], &[]);
    add(
        "card",
        "card/apple-apple.toml",
        |path| read_card(path).map(|_| ()),
        &[""],
        &[],
    );
    add(
        "regression",
        "regression/bruise.toml",
        |path| read_scene(&path.with_file_name("scene.toml")).map(|_| ()),
        &[""],
        &[
            ("", "response"),
            ("", "sigma"),
            ("", "covariance"),
            ("", "volume_unit"),
            ("", "terms"),
            ("", "ranges"),
        ],
    );
    add(
        "laws",
        "laws.toml",
        |path| read_laws(path).map(|_| ()),
        &["laws.soft", "laws.soft.parameters.k"],
        &[],
    );
    kinds
}

#[test]
fn rejects_every_wrong_value_with_file_line_and_key() {
    let folder = tempfile::tempdir().unwrap();
    let kinds = kinds(folder.path());
    let of_kind = |kind: &Kind| {
        let text = std::fs::read_to_string(&kind.file).unwrap();
        kind.told(&text).unwrap();
        let mut faults = Vec::new();
        let roots = kind.roots.iter();
        let count: usize = roots
            .map(|root| check(kind, &text, root, 0, &mut faults))
            .sum();
        assert!(count >= 40, "{}: {count} values", kind.name);
        (count, faults)
    };
    let of_kind = &of_kind;
    let found: Vec<(usize, Vec<String>)> = std::thread::scope(|scope| {
        let all = kinds.iter().map(|kind| scope.spawn(move || of_kind(kind)));
        let all: Vec<_> = all.collect();
        all.into_iter().map(|own| own.join().unwrap()).collect()
    });
    let all: usize = found.iter().map(|(count, _)| count).sum();
    let faults: Vec<String> = found.into_iter().flat_map(|(_, faults)| faults).collect();
    assert!(
        faults.is_empty(),
        "{}\n{} faults of {all}",
        faults.join("\n"),
        faults.len()
    );
    assert!(all > 5000, "{all} values");
}
