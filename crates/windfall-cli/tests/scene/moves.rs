//! Walls that start and stop, and follow tables.

use super::windfall;
use std::path::Path;

/// One apple that lies on a plate in free space, and what moves the plate.
const LYING: &str = r#"format = 1
materials = ["apple", "steel"]
[scene]
time_step = "20 us"
end = "0.8 s"
[[contacts]]
between = ["apple", "apple"]
law = "kuwabara-kono(k=1000000, c=2000)"
[[contacts]]
between = ["apple", "steel"]
law = "kuwabara-kono(k=1000000, c=2000)"
[[fruit]]
name = "apple"
material = "apple"
count = 1
diameter = "75 mm"
density = "840 kg/m^3"
drop = { place = [0, 0, 0.0375] }
[[walls]]
name = "gate"
material = "steel"
plate = { corner = [-0.2, -0.2, 0], edges = [[0.4, 0, 0], [0, 0.4, 0]] }
[[walls]]
name = "stop"
material = "steel"
plane = { point = [0, 0, -9], normal = [0, 0, 1] }
"#;

fn written(directory: &Path, moves: &str) -> String {
    let text = format!("{LYING}{moves}");
    std::fs::write(directory.join("s.toml"), &text).unwrap();
    text
}

/// The row of the fruit's table, and the rows of its contacts.
fn run(directory: &Path, moves: &str) -> (Vec<f64>, Vec<Vec<String>>) {
    written(directory, moves);
    let (done, _, problem) = windfall(&["scene", "run", "s.toml"], directory);
    assert!(done, "{problem}");
    let rows = |name: &str| -> Vec<Vec<String>> {
        let text = std::fs::read_to_string(directory.join("s.run").join(name)).unwrap();
        let rows = text.lines().filter(|own| !own.starts_with('#')).skip(1);
        rows.map(|own| own.split(',').map(str::to_owned).collect())
            .collect()
    };
    let text = std::fs::read_to_string(directory.join("s.run/fruit.csv")).unwrap();
    let header = text.lines().find(|own| own.starts_with("fruit,")).unwrap();
    let first = header.split(',').position(|own| own == "x_m").unwrap();
    let place = rows("fruit.csv")[0][first..first + 3]
        .iter()
        .map(|own| own.parse().unwrap())
        .collect();
    (place, rows("events.csv"))
}

#[test]
fn closed_form_a_fruit_falls_when_its_gate_opens() {
    let folder = tempfile::tempdir().unwrap();
    let opens =
        "[[moves]]\nwalls = [\"gate\"]\nvelocity = [0, 0, -20]\nfrom = \"0.3 s\"\nramp = \"0 s\"\n";
    let (place, contacts) = run(folder.path(), opens);
    let fallen = 0.5 * 9.80665 * 0.5_f64.powi(2);
    // It lies 0.0005 m deep in the gate.
    assert!((place[2] - (0.0375 - fallen)).abs() < 0.0008, "{place:?}");
    let last = contacts.last().unwrap();
    assert_eq!(last[1], "gate");
    // Lifted in 0.25 s by 0.1 m and down again, it is where it was.
    let lifted = "[[moves]]\nwalls = [\"gate\", \"stop\"]\nshift = [0, 0, 0.1]\nfrom = \"0.1 s\"\n\
                  until = \"0.35 s\"\n";
    let back = lifted
        .replace("[0, 0, 0.1]", "[0, 0, -0.1]")
        .replace("0.35", "0.65")
        .replace("\"0.1 s\"", "\"0.4 s\"");
    let (place, _) = run(folder.path(), lifted);
    assert!((place[2] - 0.1373).abs() < 3e-4, "{place:?}");
    let (place, _) = run(folder.path(), &format!("{lifted}{back}"));
    assert!((place[2] - 0.0373).abs() < 3e-4, "{place:?}");
    // Turned by 90° about an edge, the gate drops it.
    let tipped = "[[moves]]\nwalls = [\"gate\"]\nfrom = \"0.1 s\"\nuntil = \"0.3 s\"\n\
                  rotation = { point = [-0.2, 0, 0], axis = [0, 1, 0], angle = \"90 deg\" }\n";
    let (place, _) = run(folder.path(), tipped);
    assert!(place[2] < -0.5, "{place:?}");
}

#[test]
fn a_table_of_positions_is_the_move_that_it_was_made_of() {
    let folder = tempfile::tempdir().unwrap();
    let thrown = "[[moves]]\nwalls = [\"gate\"]\nshift = [0, 0, 0.12]\nfrom = \"0.2 s\"\n\
                  until = \"0.3 s\"\nramp = \"50 ms\"\n";
    let (place, wanted) = run(folder.path(), thrown);
    // In millimetres and milliseconds: up with 48 m/s², then down with it.
    let mut table = "time_ms,z_mm\n".to_owned();
    for step in 0..=100 {
        let time = f64::from(step) * 1e-3;
        let way = match time < 0.05 {
            true => 0.5 * 48.0 * time * time,
            false => 0.12 - 0.5 * 48.0 * (0.1 - time).powi(2),
        };
        table += &format!("{},{}\n", 200.0 + 1e3 * time, 1e3 * way);
    }
    std::fs::write(folder.path().join("throw.csv"), table).unwrap();
    let by_table = "[[moves]]\nwalls = [\"gate\"]\npath = { file = \"throw.csv\" }\n";
    let (other, found) = run(folder.path(), by_table);
    assert_eq!(found.len(), wanted.len());
    assert!((place[2] - other[2]).abs() < 1e-3, "{place:?} {other:?}");
    let peak = |rows: &[Vec<String>]| {
        let peaks = rows.iter().map(|own| own[17].parse::<f64>().unwrap());
        peaks.fold(0.0, f64::max)
    };
    let (found, wanted) = (peak(&found), peak(&wanted));
    // Thrown: the plate pushes with more than m (g + 48 m/s²).
    assert!(wanted > 0.185 * 57.8, "{wanted}");
    assert!((found - wanted).abs() < 0.01 * wanted, "{found} {wanted}");
}

/// What a scene with these moves is refused for.
fn refused(directory: &Path, moves: &str) -> String {
    written(directory, moves);
    let (done, _, problem) = windfall(&["scene", "run", "s.toml"], directory);
    assert!(!done && !problem.contains("panicked"), "{moves}: {problem}");
    assert!(!directory.join("s.run/events.csv").exists());
    problem
}

#[test]
fn rejects_moves_that_cannot_be_with_their_line() {
    let folder = tempfile::tempdir().unwrap();
    let first = LYING.lines().count() + 1;
    let gate = "[[moves]]\nwalls = [\"gate\"]\n";
    let lift = format!("{gate}shift = [0, 0, 0.1]\nfrom = \"0.1 s\"\nuntil = \"0.3 s\"\n");
    let overlaps = format!("{lift}{}", lift.replace("0.1 s", "0.2 s"));
    let turn = |point: &str| {
        format!(
            "{gate}rotation = {{ point = {point}, axis = [0, 1, 0], angular_velocity = \"1 rad/s\" }}\n"
        )
    };
    let cases: Vec<(String, usize, &str)> = vec![
        (lift.replace("gate", "gte"), 1, "did you mean \"gate\""),
        (
            lift.replace("\"gate\"", "\"gate\", \"gate\""),
            1,
            "named twice",
        ),
        (
            "[[moves]]\nshift = [0, 0, 1]\n".to_owned(),
            0,
            "which walls move",
        ),
        (gate.to_owned(), 0, "one of shift, velocity"),
        (
            format!("{lift}belt = [1, 0, 0]\n"),
            5,
            "it has shift already",
        ),
        (
            lift.replace("until = \"0.3 s\"\n", ""),
            2,
            "give `until` as well",
        ),
        (lift.replace("0.3 s", "0.1 s"), 4, "must be after 0.1 s"),
        (lift.replace("0.3 s", "0.1000001 s"), 2, "give it more time"),
        (
            lift.replace("0.1 s", "0.9 s").replace("0.3 s", "2 s"),
            3,
            "would never begin",
        ),
        (format!("{lift}ramp = \"0.11 s\"\n"), 5, "at most half"),
        (
            format!("{lift}ramp = \"-1 s\"\n"),
            5,
            "must not be below zero",
        ),
        (
            overlaps,
            5,
            "overlaps another move of the same kind, which begins at 0.1 s",
        ),
        (
            format!("{}{}", turn("[0, 0, 0]"), turn("[1, 0, 0]")),
            3,
            "about one axis",
        ),
        (
            turn("[0, 0, 0]").replace("1 rad/s", "1 m"),
            2,
            "angular_velocity",
        ),
        (
            turn("[0, 0, 0]").replace(", angular_velocity = \"1 rad/s\"", ""),
            2,
            "give either angle",
        ),
        (
            format!("{gate}path = {{ file = \"none.csv\" }}\n"),
            2,
            "there is no file",
        ),
        (
            format!("{gate}path = {{ file = \"/etc/hosts\" }}\n"),
            2,
            "path file",
        ),
    ];
    for (moves, line, words) in cases {
        let problem = refused(folder.path(), &moves);
        assert!(problem.contains(words), "{moves}{problem}");
        let place = format!("line {}", first + line);
        assert!(problem.contains(&place), "{place}: {moves}{problem}");
    }
}

#[test]
fn rejects_tables_of_positions_that_jump_or_cannot_be_read() {
    let folder = tempfile::tempdir().unwrap();
    let moves = "[[moves]]\nwalls = [\"gate\"]\npath = { file = \"p.csv\" }\n";
    let axis = moves.replace("\" }", "\", point = [0, 0, 0], axis = [0, 1, 0] }");
    for (table, moves, words) in [
        (
            "time_s,z_m\n0,0\n0.1,0.1\n0.101,0.5\n",
            moves,
            "line 4: the wall would get here",
        ),
        (
            "time_s,z_m\n0,0\n0.2,0.1\n0.1,0.2\n",
            moves,
            "line 4: its time is not after",
        ),
        ("time_s,z_m\n0,0\n0.2,\n", moves, "line 3: a cell is blank"),
        ("time_s,z_m\n5,0\n6,1\n", moves, "it would never begin"),
        ("time_s,z_m\n0,0\n", moves, "at least two rows"),
        ("t,z_m\n0,0\n1,1\n", moves, "needs the column time_s"),
        ("time_s,w_m\n0,0\n1,1\n", moves, "x_m, y_m, z_m"),
        (
            "time_s,angle_deg\n0,0\n1,1\n",
            moves,
            "give the `point` and the `axis`",
        ),
        ("time_s,z_m\n0,0\n1,1\n", &axis, "no column of angles"),
        ("time_s,angle_rad\n0,0\n0.001,1\n", &axis, "at 1000 rad/s"),
        ("time_s,z_m\n0,zero\n1,1\n", moves, "p.csv"),
        ("", moves, "p.csv"),
    ] {
        std::fs::write(folder.path().join("p.csv"), table).unwrap();
        let problem = refused(folder.path(), moves);
        assert!(problem.contains(words), "{table}{problem}");
    }
}
