//! Walls from STL files, and what is looked at before a scene runs.

use super::windfall;
use std::path::Path;

type Triangles = Vec<[[f64; 3]; 3]>;

/// A flat piece in `parts` × `parts` parts.
fn piece(corner: [f64; 3], a: [f64; 3], b: [f64; 3], parts: usize) -> Triangles {
    let at = |i: usize, j: usize| {
        let (s, t) = (i as f64 / parts as f64, j as f64 / parts as f64);
        [0, 1, 2].map(|axis| corner[axis] + s * a[axis] + t * b[axis])
    };
    let mut all = Vec::new();
    for i in 0..parts {
        for j in 0..parts {
            let (p, q) = (at(i, j), at(i + 1, j));
            let (r, s) = (at(i + 1, j + 1), at(i, j + 1));
            all.extend([[p, q, r], [p, r, s]]);
        }
    }
    all
}

fn binary(triangles: &[[[f64; 3]; 3]]) -> Vec<u8> {
    let mut bytes = b"solid in its name only".to_vec();
    bytes.resize(80, 0);
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for own in triangles {
        bytes.extend([0; 12]);
        for value in own.as_flattened() {
            bytes.extend((*value as f32).to_le_bytes());
        }
        bytes.extend([0; 2]);
    }
    bytes
}

fn text(triangles: &[[[f64; 3]; 3]]) -> String {
    let mut out = "solid piece\r\n".to_owned();
    for own in triangles {
        out += "facet normal 0 0 0\r\nouter loop\r\n";
        for [x, y, z] in own {
            out += &format!("vertex {x} {y} {z}\r\n");
        }
        out += "endloop\r\nendfacet\r\n";
    }
    out + "endsolid piece\r\n"
}

/// The template with a single fruit that drops on the conveyor, with changes.
fn single(directory: &Path, changes: &[(&str, &str)]) -> String {
    if !directory.join("s").exists() {
        assert!(windfall(&["new", "scene", "s"], directory).0);
    } else {
        std::fs::remove_dir_all(directory.join("s")).unwrap();
        assert!(windfall(&["new", "scene", "s"], directory).0);
    }
    let path = directory.join("s/scene.toml");
    let mut text = std::fs::read_to_string(&path).unwrap();
    let own = [
        (
            "pour = { low = [-0.58, 0.02, 0.42], high = [-0.38, 0.48, 0.52], rate = \"50 Hz\" }",
            "drop = { place = [-0.3, 0.25, 0.5] }",
        ),
        ("count = 100", "count = 1"),
        ("end = \"4 s\"", "end = \"0.6 s\""),
    ];
    for (old, new) in own.iter().chain(changes) {
        assert!(text.contains(old), "{old}");
        text = text.replace(old, new);
    }
    std::fs::write(path, &text).unwrap();
    text
}

const CONVEYOR: &str = "plate = { corner = [-0.6, 0, 0.3], edges = [[0.6, 0, 0], [0, 0.5, 0]] }";

/// The line of a text that a place in it is on, as messages name it.
fn line(text: &str, of: &str) -> String {
    let at = text.find(of).unwrap();
    format!("line {}", 1 + text[..at].matches('\n').count())
}

fn run(directory: &Path) -> serde_json::Value {
    let arguments = [
        "scene",
        "run",
        "s/scene.toml",
        "--format",
        "json",
        "--also-read",
        ".",
    ];
    let (done, json, problem) = windfall(&arguments, directory);
    assert!(done, "{problem}");
    serde_json::from_str(&json).unwrap()
}

fn refused(directory: &Path) -> String {
    let (done, _, problem) = windfall(&["scene", "run", "s/scene.toml"], directory);
    assert!(!done && !problem.contains("panicked"), "{problem}");
    assert!(!directory.join("s/scene.run/events.csv").exists());
    problem
}

fn codes(json: &serde_json::Value) -> Vec<String> {
    let findings = json["findings"].as_array().unwrap();
    findings
        .iter()
        .map(|own| own["code"].as_str().unwrap().to_owned())
        .collect()
}

#[test]
fn a_wall_of_an_stl_file_is_the_wall() {
    let folder = tempfile::tempdir().unwrap();
    let directory = folder.path();
    let rows = || {
        let table = std::fs::read_to_string(directory.join("s/scene.run/events.csv")).unwrap();
        let cells = |row: &str| -> Vec<String> { row.split(',').map(str::to_owned).collect() };
        table.lines().skip(1).map(cells).collect::<Vec<_>>()
    };
    single(directory, &[]);
    run(directory);
    let plate = rows();
    assert!(plate.len() > 2, "{plate:?}");
    // In millimetres, lying along y: turned about z and moved into its place.
    let parts = piece([0.0; 3], [0.0, 600.0, 0.0], [-500.0, 0.0, 0.0], 20);
    let mesh = "mesh = { file = \"conveyor.stl\", unit = \"mm\", closed = false, \
        turn = { axis = [0, 0, 1], angle = \"-90 deg\" }, move = [-0.6, 0, 0.3] }";
    for bytes in [binary(&parts), text(&parts).into_bytes()] {
        single(directory, &[(CONVEYOR, mesh)]);
        std::fs::write(directory.join("s/conveyor.stl"), bytes).unwrap();
        let json = run(directory);
        assert!(codes(&json).is_empty(), "{json}");
        let mesh = rows();
        assert_eq!(plate.len(), mesh.len());
        for (a, b) in plate.iter().flatten().zip(mesh.iter().flatten()) {
            match (a.parse::<f64>(), b.parse::<f64>()) {
                (Ok(a), Ok(b)) => assert!((a - b).abs() < 1e-6 * (1.0 + a.abs()), "{a} {b}"),
                _ => assert_eq!(a, b),
            }
        }
    }
}

/// What the program says of a scene whose conveyor is a mesh of these bytes.
fn of_mesh(bytes: &[u8], more: &str) -> Result<serde_json::Value, String> {
    let folder = tempfile::tempdir().unwrap();
    let directory = folder.path();
    let mesh = format!("mesh = {{ file = \"conveyor.stl\"{more} }}");
    let whole = single(
        directory,
        &[(CONVEYOR, &mesh), ("end = \"0.6 s\"", "end = \"0.01 s\"")],
    );
    std::fs::write(directory.join("s/conveyor.stl"), bytes).unwrap();
    let arguments = ["scene", "run", "s/scene.toml", "--format", "json"];
    let (done, json, problem) = windfall(&arguments, directory);
    if done {
        return Ok(serde_json::from_str(&json).unwrap());
    }
    assert!(!problem.contains("panicked"), "{problem}");
    assert!(problem.contains(&line(&whole, "conveyor.stl")), "{problem}");
    Err(problem)
}

fn conveyor() -> Triangles {
    piece(
        [-600.0, 0.0, 300.0],
        [600.0, 0.0, 0.0],
        [0.0, 500.0, 0.0],
        2,
    )
}

#[test]
fn rejects_stl_files_that_cannot_be_used() {
    let whole = binary(&conveyor());
    let millimetres = ", unit = \"mm\"";
    let mut nan = conveyor();
    nan[3][1][2] = f64::NAN;
    let words = text(&conveyor());
    let cases: Vec<(Vec<u8>, &str, &[&str])> = vec![
        (
            whole[..300].to_vec(),
            millimetres,
            &["conveyor.stl", "8 triangles", "after triangle 4"],
        ),
        (
            whole[..40].to_vec(),
            millimetres,
            &["no STL file", "40 bytes"],
        ),
        (Vec::new(), millimetres, &["no STL file", "0 bytes"]),
        (binary(&[]), millimetres, &["no triangle"]),
        (
            binary(&nan),
            millimetres,
            &["triangle 4 (at byte 266)", "NaN"],
        ),
        (
            [whole.clone(), vec![0; 7]].concat(),
            millimetres,
            &["8 triangles", "write it anew"],
        ),
        (
            words
                .replace("vertex 0 0 300", "vertex 0 O 300")
                .into_bytes(),
            millimetres,
            &["line", "expected a number, found \"O\""],
        ),
        (
            words.as_bytes()[..words.len() - 40].to_vec(),
            millimetres,
            &["triangle 8", "expected"],
        ),
        (whole.clone(), "", &["unit", "unit = \"mm\""]),
        (whole.clone(), ", unit = \"kg\"", &["mesh unit", "kg"]),
        (
            whole.clone(),
            ", unit = \"m\"",
            &["781", "is `unit` right?"],
        ),
        (whole.clone(), ", unit = \"um\"", &["is `unit` right?"]),
        (
            whole.clone(),
            ", unit = \"mm\", closed = true",
            &[
                "must be closed",
                "8 edges",
                "1 rim",
                "2.2 m",
                "[-0.6, 0, 0.3]",
            ],
        ),
        (
            whole,
            ", unit = \"mm\", turn = { axis = [0, 0, 0], angle = \"1 rad\" }",
            &["turn axis"],
        ),
        (
            binary(&[[[0.0; 3], [300.0, 0.0, 0.0], [600.0, 0.0, 0.0]]]),
            millimetres,
            &["none of its triangles"],
        ),
    ];
    for (bytes, more, words) in cases {
        let problem = of_mesh(&bytes, more).unwrap_err();
        for word in words {
            assert!(problem.contains(word), "{more} without {word}: {problem}");
        }
    }
    let folder = tempfile::tempdir().unwrap();
    let both =
        format!("{CONVEYOR}\ncylinder = {{ start = [0, 0, 0], end = [0, 1, 0], diameter = 1 }}");
    single(folder.path(), &[(CONVEYOR, &both)]);
    let problem = refused(folder.path());
    assert!(problem.contains("it has plate already"), "{problem}");
    single(folder.path(), &[("name = \"pad\"", "name = \"bin\"")]);
    let problem = refused(folder.path());
    assert!(problem.contains("another wall has this name"), "{problem}");
    let mesh = "mesh = { file = \"none.stl\", unit = \"mm\" }";
    single(folder.path(), &[(CONVEYOR, mesh)]);
    assert!(refused(folder.path()).contains("none.stl"));
}

#[test]
fn flaws_of_a_mesh_are_told() {
    let found = |triangles: &Triangles| {
        let json = of_mesh(&binary(triangles), ", unit = \"mm\"").unwrap();
        let findings = json["findings"].as_array().unwrap().clone();
        let text = |own: &serde_json::Value| {
            format!(
                "{}: {}",
                own["code"].as_str().unwrap(),
                own["message"].as_str().unwrap()
            )
        };
        findings.iter().map(text).collect::<Vec<_>>().join("\n")
    };
    let open = found(&conveyor());
    for word in [
        "mesh-open",
        "\"conveyor\" (conveyor.stl)",
        "8 edges",
        "1 rim",
        "2.2 m",
    ] {
        assert!(open.contains(word), "{word}: {open}");
    }
    assert!(!open.contains("mesh-sliver"), "{open}");
    let mut own = conveyor();
    own.push([
        [0.0, 0.0, 300.0],
        [-300.0, 0.0, 300.0],
        [-150.0, 1e-5, 300.0],
    ]);
    let sliver = found(&own);
    assert!(
        sliver.contains("mesh-sliver") && sliver.contains("the first is number 9"),
        "{sliver}"
    );
    let mut own = conveyor();
    own.push(own[2]);
    let double = found(&own);
    assert!(
        double.contains("mesh-double") && double.contains("number 9"),
        "{double}"
    );
    let mut own = conveyor();
    own[1].swap(0, 1);
    let winding = found(&own);
    assert!(winding.contains("mesh-winding"), "{winding}");
    let mut own = conveyor();
    own.push([own[0][0], own[0][2], [-300.0, 100.0, 250.0]]);
    let branching = found(&own);
    assert!(branching.contains("mesh-branching: "), "{branching}");
    assert!(branching.contains("more than two triangles"), "{branching}");
}

#[test]
fn rejects_walls_that_lie_on_each_other() {
    let folder = tempfile::tempdir().unwrap();
    let directory = folder.path();
    // The bin has a bottom where the pad is.
    let whole = single(
        directory,
        &[(
            "0.3], open = [\"top\", \"bottom\"]",
            "0.3], open = [\"top\"]",
        )],
    );
    let problem = refused(directory);
    for word in [
        "\"bin\" and \"pad\" lie on each other",
        &line(&whole, "[[walls]]\nname = \"pad\""),
    ] {
        assert!(problem.contains(word), "{word}: {problem}");
    }
    // A fifth of a millimetre apart is on each other, 4 mm is not.
    for (height, wrong) in [("-0.2998", true), ("-0.296", false)] {
        let pad = format!("corner = [0, 0, {height}]");
        single(
            directory,
            &[
                (
                    "0.3], open = [\"top\", \"bottom\"]",
                    "0.3], open = [\"top\"]",
                ),
                ("corner = [0, 0, -0.3]", &pad),
            ],
        );
        match wrong {
            true => assert!(refused(directory).contains("lie on each other")),
            false => drop(run(directory)),
        }
    }
    // A mesh on a plate; a plane on a plate.
    let mesh = format!(
        "{CONVEYOR}\n\n[[walls]]\nname = \"skin\"\nmaterial = \"foam\"\n\
         mesh = {{ file = \"conveyor.stl\", unit = \"mm\" }}"
    );
    let plane = format!(
        "{CONVEYOR}\n\n[[walls]]\nname = \"skin\"\nmaterial = \"foam\"\n\
         plane = {{ point = [0, 0, 0.3], normal = [0, 0, 1] }}"
    );
    for more in [mesh, plane] {
        single(directory, &[(CONVEYOR, &more), ("belt = [0.5, 0, 0]", "")]);
        std::fs::write(directory.join("s/conveyor.stl"), binary(&conveyor())).unwrap();
        let problem = refused(directory);
        assert!(problem.contains("\"conveyor\" and \"skin\""), "{problem}");
    }
}

#[test]
fn rejects_fruit_that_come_in_where_a_wall_is() {
    let folder = tempfile::tempdir().unwrap();
    let directory = folder.path();
    for (place, wall) in [
        ("[-0.3, 0.25, 0.32]", "\"conveyor\""),
        ("[-0.3, 0.01, 0.5]", "\"sides of the conveyor\""),
        ("[0.3, 0.25, -0.28]", "\"pad\""),
    ] {
        let drop = format!("place = {place}");
        let whole = single(directory, &[("place = [-0.3, 0.25, 0.5]", &drop)]);
        let problem = refused(directory);
        let fruit = line(&whole, "[[fruit]]");
        for word in ["\"apples\"", wall, "overlaps the wall", &fruit] {
            assert!(problem.contains(word), "{word}: {problem}");
        }
    }
}

/// A closed box of 0.6 m with a square hole in its bottom, in millimetres.
fn hopper(hole: f64) -> Triangles {
    let rest = 0.5 * (600.0 - hole);
    let (x, y, z) = ([600.0, 0.0, 0.0], [0.0, 600.0, 0.0], [0.0, 0.0, 600.0]);
    let mut all = Vec::new();
    all.extend(piece([0.0; 3], [rest, 0.0, 0.0], y, 1));
    all.extend(piece([600.0 - rest, 0.0, 0.0], [rest, 0.0, 0.0], y, 1));
    all.extend(piece(
        [rest, 0.0, 0.0],
        [hole, 0.0, 0.0],
        [0.0, rest, 0.0],
        1,
    ));
    let back = [rest, 600.0 - rest, 0.0];
    all.extend(piece(back, [hole, 0.0, 0.0], [0.0, rest, 0.0], 1));
    for (corner, a, b) in [
        ([0.0; 3], x, z),
        (y, x, z),
        ([0.0; 3], y, z),
        (x, y, z),
        (z, x, y),
    ] {
        all.extend(piece(corner, a, b, 1));
    }
    all
}

#[test]
fn rejects_fruit_larger_than_the_outlet() {
    let folder = tempfile::tempdir().unwrap();
    let directory = folder.path();
    let path = directory.join("s/scene.toml");
    std::fs::create_dir(directory.join("s")).unwrap();
    let write = |hole: f64, sink: &str, more: &str| {
        let text = format!(
            "format = 1\nmaterials = [\"apple\", \"steel\"]\n[scene]\nend = \"1.5 s\"\n\
             [[contacts]]\nbetween = [\"apple\", \"apple\"]\nlaw = \"kuwabara-kono(k=753599, c=1524)\"\n\
             [[contacts]]\nbetween = [\"apple\", \"steel\"]\nlaw = \"kuwabara-kono(k=753599, c=1524)\"\n\
             [[fruit]]\nname = \"plum\"\nmaterial = \"apple\"\ncount = 1\ndiameter = \"30 mm\"\n\
             density = \"840 kg/m^3\"\ndrop = {{ place = [0.3, 0.3, 0.3] }}\n\
             [[fruit]]\nname = \"apples\"\nmaterial = \"apple\"\ncount = 1\ndiameter = \"75 mm\"\n\
             density = \"840 kg/m^3\"\ndrop = {{ place = [0.3, 0.3, 0.4] }}\n\
             [[walls]]\nname = \"hopper\"\nmaterial = \"steel\"\n\
             mesh = {{ file = \"hopper.stl\", unit = \"mm\", closed = false }}\n{more}\n\
             [[sinks]]\nname = \"out\"\n{sink}\n"
        );
        std::fs::write(&path, &text).unwrap();
        std::fs::write(directory.join("s/hopper.stl"), text_of(hole)).unwrap();
        text
    };
    let below = "low = [-1, -1, -0.6]\nhigh = [2, 2, -0.5]";
    let whole = write(45.0, below, "");
    let problem = refused(directory);
    for word in [
        "\"apples\"",
        "0.075",
        "no sink",
        "outlet",
        &line(&whole, "[[sinks]]"),
    ] {
        assert!(problem.contains(word), "{word}: {problem}");
    }
    // Through a hole that is wide enough both leave.
    write(90.0, below, "");
    assert_eq!(run(directory)["left"], 2);
    std::fs::remove_dir_all(directory.join("s/scene.run")).unwrap();
    // A hopper that moves may let them out elsewhere: nothing is said.
    write(
        50.0,
        below,
        "vibration = { amplitude = [0, 0, 0.001], frequency = \"10 Hz\" }",
    );
    run(directory);
    std::fs::remove_dir_all(directory.join("s/scene.run")).unwrap();
    // A sink turned inside out.
    let whole = write(90.0, "low = [-1, -1, -0.5]\nhigh = [2, 2, -0.6]", "");
    let problem = refused(directory);
    for word in ["\"out\" holds no place", &line(&whole, "[[sinks]]")] {
        assert!(problem.contains(word), "{word}: {problem}");
    }
}

fn text_of(hole: f64) -> String {
    text(&hopper(hole))
}

#[test]
fn rejects_sources_without_room_with_their_line() {
    let folder = tempfile::tempdir().unwrap();
    let directory = folder.path();
    let drop = "drop = { place = [-0.3, 0.25, 0.5] }";
    for (source, words) in [
        (
            "pour = { low = [-0.5, 0.2, 0.4], high = [-0.45, 0.3, 0.5], rate = \"5 Hz\" }",
            "must fit into it",
        ),
        (
            "lattice = { low = [-0.5, 0.2, 0.4], high = [-0.4, 0.3, 0.5] }",
            "do not fit",
        ),
        (
            "tree = { low = [-0.5, 0.2, 0.45], high = [-0.4, 0.3, 0.5] }",
            "must fit into it",
        ),
    ] {
        let count = "count = 1\n";
        let whole = single(directory, &[(drop, source), (count, "count = 2\n")]);
        let problem = refused(directory);
        let fruit = line(&whole, "[[fruit]]");
        for word in [words, "may measure 0.0825 m", &fruit] {
            assert!(problem.contains(word), "{word}: {problem}");
        }
    }
}

#[test]
fn rejects_a_time_step_that_is_too_long_with_its_line() {
    let folder = tempfile::tempdir().unwrap();
    let directory = folder.path();
    for step in ["20 ms", "2 ms"] {
        let given = format!("time_step = \"{step}\"");
        let whole = single(directory, &[("time_step = \"auto\"", &given)]);
        let problem = refused(directory);
        let at = line(&whole, &given);
        for word in [
            "time_step",
            step,
            "shorter time step",
            "lasts",
            "\"auto\" would take",
            &at,
        ] {
            assert!(problem.contains(word), "{word}: {problem}");
        }
    }
    // One that errs by less runs, and says by how much.
    single(
        directory,
        &[("time_step = \"auto\"", "time_step = \"200 us\"")],
    );
    let error = run(directory)["step"]["peak_force_error"].as_f64().unwrap();
    assert!(error > 1e-5 && error < 0.1, "{error}");
}

#[test]
fn the_share_of_contacts_beyond_the_range_of_a_card() {
    let folder = tempfile::tempdir().unwrap();
    let directory = folder.path();
    let made = [
        "simulate",
        "pendulum",
        "--law",
        "kuwabara-kono(k=1065750, c=2155)",
        "--recordings",
        "apples",
        "--specimens",
        "2",
    ];
    assert!(windfall(&made, directory).0);
    let (done, _, problem) = windfall(&["fit", "apples", "--card", "apple.toml"], directory);
    assert!(done, "{problem}");
    assert!(windfall(&["new", "scene", "s"], directory).0);
    let path = directory.join("s/scene.toml");
    let mut whole = std::fs::read_to_string(&path).unwrap();
    for (old, new) in [
        (
            "law = \"kuwabara-kono(k=1065750, c=2155)\"",
            "card = \"../apple.toml\"",
        ),
        ("end = \"4 s\"", "end = \"0.8 s\""),
        ("least_peak_force = \"0.5 N\"", "least_peak_force = \"0 N\""),
    ] {
        assert!(whole.contains(old), "{old}");
        whole = whole.replace(old, new);
    }
    std::fs::write(&path, whole).unwrap();
    let json = run(directory);
    let findings = json["findings"].as_array().unwrap();
    let range = findings
        .iter()
        .find(|own| own["code"] == "law-range")
        .unwrap();
    let message = range["message"].as_str().unwrap();
    let fastest = message.split("faster than ").nth(1).unwrap();
    let fastest: f64 = fastest.split(' ').next().unwrap().parse().unwrap();
    let table = std::fs::read_to_string(directory.join("s/scene.run/events.csv")).unwrap();
    let speeds: Vec<f64> = table
        .lines()
        .skip(1)
        .map(|row| row.split(',').collect::<Vec<_>>())
        .filter(|row| row[1] != "fruit" && row[1] != "pad")
        .map(|row| row[15].parse().unwrap())
        .collect();
    let beyond = speeds.iter().filter(|own| **own > fastest).count();
    let share = 100.0 * beyond as f64 / speeds.len() as f64;
    let wanted = format!("{beyond} contacts of apple and steel ({share:.1} %)");
    assert!(
        beyond > 20 && message.contains(&wanted),
        "{wanted}: {message}"
    );
}
