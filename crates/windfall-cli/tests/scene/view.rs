//! Frames, pictures and VTK files of scenes as a user meets them. Files are read here by code
//! of their own, from what the guide says of them.

use super::{change, windfall};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The template in DIRECTORY/s, with some of its text replaced.
fn scene(directory: &Path, changes: &[(&str, &str)]) -> PathBuf {
    super::scene(directory, changes);
    directory.join("s/scene.toml")
}

/// Few fruit for a short time, every contact written, a bin that shakes.
const SHORT: [(&str, &str); 4] = [
    ("count = 100", "count = 20"),
    ("end = \"4 s\"", "end = \"0.9 s\""),
    ("least_peak_force = \"0.5 N\"", "least_peak_force = \"0 N\""),
    (
        "[[walls]]\nname = \"pad\"",
        "vibration = { amplitude = [0.004, 0, 0.002], frequency = \"7 Hz\" }\n\n[[walls]]\nname = \"pad\"",
    ),
];

struct Fruit {
    number: u32,
    /// Place, orientation, velocity, largest peak force.
    values: [f32; 11],
}

struct Frame {
    time: f64,
    /// Rotation and shift of each wall.
    walls: Vec<[f32; 7]>,
    fruit: Vec<Fruit>,
}

struct Frames {
    about: serde_json::Value,
    radii: Vec<f32>,
    frames: Vec<Frame>,
}

/// frames.bin, by the table in the guide.
fn frames(path: &Path) -> Frames {
    let bytes = std::fs::read(path).unwrap();
    let four = |at: usize| <[u8; 4]>::try_from(&bytes[at..at + 4]).unwrap();
    let whole = |at: usize| u32::from_le_bytes(four(at)) as usize;
    let float = |at: usize| f32::from_le_bytes(four(at));
    assert_eq!(&bytes[..8], b"wfframes");
    assert_eq!(whole(8), 1);
    let json = 16..16 + whole(12);
    let mut at = json.end;
    let about: serde_json::Value = serde_json::from_slice(&bytes[json]).unwrap();
    let count = about["fruit"].as_u64().unwrap() as usize;
    let radii = (0..count).map(|k| float(at + 4 * k)).collect();
    at += 4 * count;
    let walls = about["walls"].as_array().unwrap();
    for wall in walls {
        let own = |key: &str| wall[key].as_u64().unwrap() as usize;
        at += 12 * own("vertices") + 4 * own("corners") * own("faces");
    }
    let mut frames = Vec::new();
    while at < bytes.len() {
        assert_eq!(&bytes[at..at + 4], b"frme");
        let fruit = whole(at + 4);
        let time = f64::from_le_bytes(bytes[at + 8..at + 16].try_into().unwrap());
        at += 16;
        let walls = walls.iter().map(|_| {
            let own = std::array::from_fn(|k| float(at + 4 * k));
            at += 28;
            own
        });
        let walls = walls.collect();
        let fruit = (0..fruit).map(|_| {
            let own = Fruit {
                number: whole(at) as u32,
                values: std::array::from_fn(|k| float(at + 4 + 4 * k)),
            };
            at += 48;
            own
        });
        let fruit = fruit.collect();
        frames.push(Frame { time, walls, fruit });
    }
    Frames {
        about,
        radii,
        frames,
    }
}

/// A table by the names of its columns.
fn table(path: &Path) -> Vec<BTreeMap<String, String>> {
    let mut reader = csv::Reader::from_path(path).unwrap();
    reader.deserialize().map(Result::unwrap).collect()
}

fn number(row: &BTreeMap<String, String>, column: &str) -> Option<f64> {
    let cell = &row[column];
    (!cell.is_empty()).then(|| cell.parse().unwrap())
}

#[test]
fn frames_say_what_the_tables_say_and_change_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let path = scene(folder.path(), &SHORT);
    let (done, text, problem) = windfall(&["scene", "run", "s/scene.toml"], folder.path());
    assert!(done, "{problem}");
    assert!(text.contains("s/scene.run/frames.bin"), "{text}");
    let run = folder.path().join("s/scene.run");
    let found = frames(&run.join("frames.bin"));
    let (events, fruit) = (
        table(&run.join("events.csv")),
        table(&run.join("fruit.csv")),
    );
    let json = std::fs::read_to_string(run.join("scene.json")).unwrap();
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    let step = json["step"]["time_step"].as_f64().unwrap();

    // Every 20 ms to a step, to the end.
    assert_eq!(found.frames.len(), 46);
    for (k, frame) in found.frames.iter().enumerate() {
        let late = frame.time - 0.02 * k as f64;
        assert!((-1e-9..=1.001 * step).contains(&late), "{late} at {k}");
    }
    for (own, row) in found.radii.iter().zip(&fruit) {
        let diameter = number(row, "diameter_m").unwrap();
        assert!((2.0 * f64::from(*own) - diameter).abs() < 1e-7);
    }
    for frame in &found.frames {
        // Those that have come, and no others.
        let come = fruit
            .iter()
            .filter(|row| number(row, "released_s").is_some_and(|own| own < frame.time - step));
        let off = frame.fruit.len() as i64 - come.count() as i64;
        assert!((0..=1).contains(&off), "{off} at {}", frame.time);
        for own in &frame.fruit {
            let turn: f32 = own.values[3..7].iter().map(|q| q * q).sum();
            assert!((turn - 1.0).abs() < 1e-5);
            // The largest peak force lies between that of contacts that are over, and that of
            // all that have begun.
            let (mut over, mut begun) = (0.0_f64, 0.0_f64);
            for row in &events {
                let number_of = own.number.to_string();
                if row["fruit"] != number_of && row["partner_fruit"] != number_of {
                    continue;
                }
                let begin = number(row, "time_s").unwrap();
                let end = begin + number(row, "duration_s").unwrap();
                let force = number(row, "peak_force_N").unwrap();
                if end < frame.time - 2.0 * step {
                    over = over.max(force);
                }
                if begin <= frame.time + step {
                    begun = begun.max(force);
                }
            }
            let peak = f64::from(own.values[10]);
            assert!(
                peak >= over * (1.0 - 1e-6) && peak <= begun * (1.0 + 1e-6),
                "fruit {} at {}: {over} {peak} {begun}",
                own.number,
                frame.time
            );
        }
        // The bin shakes; nothing else moves.
        for (wall, own) in frame
            .walls
            .iter()
            .zip(found.about["walls"].as_array().unwrap())
        {
            let sine = (std::f64::consts::TAU * 7.0 * frame.time).sin();
            let shift = match own["name"].as_str().unwrap() {
                "bin" => [0.004 * sine, 0.0, 0.002 * sine],
                _ => [0.0; 3],
            };
            for k in 0..3 {
                assert!((f64::from(wall[4 + k]) - shift[k]).abs() < 1e-9);
            }
            assert_eq!(wall[..4], [1.0, 0.0, 0.0, 0.0]);
        }
    }
    // In free fall before the first touch.
    let first = &found.frames[0].fruit[0];
    let touched = events.iter().filter(|row| row["fruit"] == "1");
    let touched = touched
        .filter_map(|row| number(row, "time_s"))
        .fold(9.0, f64::min);
    let mut falls = 0;
    for frame in found.frames.iter().filter(|own| own.time < touched) {
        let fallen = f64::from(first.values[2] - frame.fruit[0].values[2]);
        let expected = 0.5 * 9.80665 * frame.time * frame.time;
        assert!(
            (fallen - expected).abs() < 1e-6 + 5e-4 * expected,
            "{fallen} {expected}"
        );
        falls += 1;
    }
    assert!(falls > 3, "{falls}");
    // The end is that of fruit.csv.
    let last = found.frames.last().unwrap();
    for own in &last.fruit {
        let row = &fruit[own.number as usize - 1];
        for (value, column) in own.values.iter().zip(["x_m", "y_m", "z_m"]) {
            // A step later at most.
            assert!((f64::from(*value) - number(row, column).unwrap()).abs() < 5.0 * step);
        }
        let force = number(row, "largest_peak_force_N").unwrap_or(0.0);
        assert!((f64::from(own.values[10]) - force).abs() <= 1e-5 * force + 0.05);
    }

    // Without frames, or with others, the contacts have the same bits.
    let before = std::fs::read(run.join("events.csv")).unwrap();
    for own in ["", "frames = \"3.3 ms\""] {
        let text = std::fs::read_to_string(&path).unwrap();
        let line = text
            .lines()
            .find(|line| line.starts_with("frames = "))
            .unwrap();
        let changed = text.replace(line, own);
        std::fs::write(
            &path,
            if own.is_empty() {
                format!("{changed}\n#frames = \n")
            } else {
                changed
            },
        )
        .unwrap();
        let arguments = ["scene", "run", "s/scene.toml", "--out", "other"];
        assert!(windfall(&arguments, folder.path()).0);
        let other = folder.path().join("other");
        assert_eq!(std::fs::read(other.join("events.csv")).unwrap(), before);
        assert_eq!(other.join("frames.bin").exists(), !own.is_empty());
        std::fs::write(&path, text).unwrap();
        std::fs::remove_dir_all(other).unwrap();
    }
}

#[test]
fn a_picture_shows_every_fruit_in_its_colour() {
    let folder = tempfile::tempdir().unwrap();
    scene(folder.path(), &SHORT);
    assert!(windfall(&["scene", "run", "s/scene.toml"], folder.path()).0);
    let (done, text, problem) = windfall(&["scene", "picture", "s/scene.run"], folder.path());
    assert!(done, "{problem}");
    assert!(
        text.contains("at 0.9 s") && text.contains("picture.png"),
        "{text}"
    );
    let run = folder.path().join("s/scene.run");
    let png = std::fs::read(run.join("picture.png")).unwrap();
    assert_eq!(&png[1..4], b"PNG");
    assert!(png.len() > 20_000);
    let svg = std::fs::read_to_string(run.join("picture.svg")).unwrap();
    let balls: Vec<&str> = svg
        .lines()
        .filter(|line| line.contains("url(#ball-"))
        .collect();
    let found = frames(&run.join("frames.bin"));
    let last = found.frames.last().unwrap();
    assert_eq!(balls.len(), last.fruit.len());
    // The hardest hit has the last colour, and it alone.
    assert_eq!(
        balls
            .iter()
            .filter(|line| line.contains("ball-fde725"))
            .count(),
        1
    );
    assert!(svg.contains("Largest peak force so far (N)") && svg.contains("20 fruit at 0.9 s"));

    // From above, places keep their proportions but for the perspective: x to the right.
    let arguments = [
        "scene",
        "picture",
        "s/scene.toml",
        "--time",
        "100 ms",
        "--from",
        "-90 deg,90 deg",
        "--out",
        "top.svg",
    ];
    let (done, _, problem) = windfall(&arguments, folder.path());
    assert!(done, "{problem}");
    let svg = std::fs::read_to_string(folder.path().join("top.svg")).unwrap();
    let frame = &found.frames[5];
    let mut seen: Vec<(f64, f64)> = svg
        .lines()
        .filter(|line| line.contains("url(#ball-"))
        .map(|line| {
            let value = |name: &str| -> f64 {
                let rest = line.split(&format!(" {name}=\"")).nth(1).unwrap();
                rest.split('"').next().unwrap().parse().unwrap()
            };
            (value("cx"), value("cy"))
        })
        .collect();
    assert_eq!(seen.len(), frame.fruit.len());
    let mut places: Vec<(f32, f32)> = frame
        .fruit
        .iter()
        .map(|own| (own.values[0], own.values[1]))
        .collect();
    seen.sort_by(|a, b| a.0.total_cmp(&b.0));
    places.sort_by(|a, b| a.0.total_cmp(&b.0));
    let across = (seen[1].0 - seen[0].0) / f64::from(places[1].0 - places[0].0);
    for (at, place) in seen.iter().zip(&places) {
        let off = at.0 - seen[0].0 - across * f64::from(place.0 - places[0].0);
        assert!(
            off.abs() < 0.06 * across.abs() && across > 0.0,
            "{off} {across}"
        );
    }
}

#[test]
fn rejects_what_cannot_be_drawn_or_recorded() {
    let folder = tempfile::tempdir().unwrap();
    let path = scene(folder.path(), &SHORT);
    let refused = |arguments: &[&str], words: &[&str]| {
        let (done, _, problem) = windfall(arguments, folder.path());
        assert!(!done, "{arguments:?}");
        for word in words {
            assert!(
                problem.contains(word),
                "{arguments:?} without {word}: {problem}"
            );
        }
        assert!(!problem.contains("panicked"), "{problem}");
    };
    for (value, words) in [
        ("\"0 s\"", &["[record] frames", "above zero", "line"][..]),
        ("\"-20 ms\"", &["above zero"]),
        ("\"20 kg\"", &["20 kg", "s"]),
    ] {
        let text = std::fs::read_to_string(&path).unwrap();
        change(
            &path,
            &[("frames = \"20 ms\"", &format!("frames = {value}"))],
        );
        refused(&["scene", "run", "s/scene.toml"], words);
        std::fs::write(&path, text).unwrap();
    }
    refused(
        &["scene", "picture", "s/scene.run"],
        &["scene.run", "windfall scene run"],
    );
    change(&path, &[("frames = \"20 ms\"", "#frames")]);
    assert!(windfall(&["scene", "run", "s/scene.toml"], folder.path()).0);
    refused(
        &["scene", "picture", "s/scene.run"],
        &["[record] frames", "no frames were recorded"],
    );
    refused(
        &["scene", "vtk", "s/scene.run"],
        &["no frames were recorded"],
    );
    std::fs::remove_file(folder.path().join("s/scene.run/scene.json")).unwrap();
    refused(
        &["scene", "picture", "s/scene.run"],
        &["no run of this scene came to its end"],
    );
    change(&path, &[("#frames", "frames = \"20 ms\"")]);
    assert!(windfall(&["scene", "run", "s/scene.toml"], folder.path()).0);
    for (option, value, words) in [
        ("--time", "7 s", &["--time", "not within"][..]),
        ("--time", "1 kg", &["--time"]),
        ("--from", "30 deg", &["--from", "elevation"]),
        ("--from", "a,b", &["--from"]),
        ("--largest-force", "0 N", &["--largest-force", "above zero"]),
        ("--out", "a.gif", &[".svg, .png or .pdf"]),
        ("--out", "none/a.svg", &["none/a.svg", "write"]),
    ] {
        refused(&["scene", "picture", "s/scene.run", option, value], words);
    }

    // A file that is cut short within a frame is read up to there; others are refused.
    let file = folder.path().join("s/scene.run/frames.bin");
    let whole = std::fs::read(&file).unwrap();
    std::fs::write(&file, &whole[..whole.len() - 10]).unwrap();
    let (done, text, problem) = windfall(&["scene", "picture", "s/scene.run"], folder.path());
    assert!(done && text.contains("at 0.88 s"), "{text}{problem}");
    let mut newer = whole.clone();
    newer[8] = 2;
    let mut broken = whole.clone();
    let at = whole.windows(4).rposition(|own| own == b"frme").unwrap();
    broken[at] = b'x';
    let mut huge = whole.clone();
    huge[12..16].copy_from_slice(&u32::MAX.to_le_bytes());
    let mut many = whole.clone();
    many[at + 4..at + 8].copy_from_slice(&u32::MAX.to_le_bytes());
    for (bytes, words) in [
        (&b""[..], &["frames.bin", "ends before"][..]),
        (b"fruit,partner,time", &["no file of frames"]),
        (&whole[..200], &["ends before its first frame"]),
        (&newer, &["version 2", "newer windfall"]),
        (&broken, &["here should begin a frame", &at.to_string()]),
        (&huge, &["cannot be so long"]),
        (&many, &["here should begin a frame"]),
    ] {
        std::fs::write(&file, bytes).unwrap();
        refused(&["scene", "picture", "s/scene.run"], words);
    }
    // What cannot be written is told, and what was there stays.
    std::fs::remove_file(&file).unwrap();
    std::fs::create_dir(&file).unwrap();
    std::fs::write(file.join("kept"), "kept").unwrap();
    refused(
        &["scene", "run", "s/scene.toml"],
        &["frames.bin", "cannot write"],
    );
    assert!(file.join("kept").exists());
    // With room for it the run goes on where it was.
    std::fs::remove_dir_all(&file).unwrap();
    let arguments = ["scene", "run", "s/scene.toml", "--resume"];
    let (done, _, problem) = windfall(&arguments, folder.path());
    assert!(done, "{problem}");
    let left = std::fs::read_dir(folder.path().join("s/scene.run")).unwrap();
    let left = left.filter(|own| {
        own.as_ref()
            .unwrap()
            .file_name()
            .to_string_lossy()
            .contains("partial")
    });
    assert_eq!(left.count(), 0);
}

/// The bytes of a data array (RFC 4648, with VTK's count of bytes before them).
fn decoded(text: &str) -> Vec<u8> {
    let value = |c: u8| -> u32 {
        match c {
            b'A'..=b'Z' => u32::from(c - b'A'),
            b'a'..=b'z' => u32::from(c - b'a') + 26,
            b'0'..=b'9' => u32::from(c - b'0') + 52,
            b'+' => 62,
            b'/' => 63,
            _ => 0,
        }
    };
    let mut bytes = Vec::new();
    for group in text.as_bytes().chunks(4) {
        let word = group.iter().fold(0, |word, c| word << 6 | value(*c));
        let padding = group.iter().filter(|c| **c == b'=').count();
        bytes.extend(&word.to_be_bytes()[1..4 - padding]);
    }
    let (count, rest) = bytes.split_at(8);
    assert_eq!(
        u64::from_le_bytes(count.try_into().unwrap()) as usize,
        rest.len()
    );
    rest.to_vec()
}

#[test]
fn vtk_files_hold_the_frames() {
    let folder = tempfile::tempdir().unwrap();
    scene(folder.path(), &SHORT);
    assert!(windfall(&["scene", "run", "s/scene.toml"], folder.path()).0);
    let (done, text, problem) = windfall(&["scene", "vtk", "s/scene.run"], folder.path());
    assert!(done, "{problem}");
    assert!(
        text.contains("46 frames") && text.contains("scene.pvd"),
        "{text}"
    );
    let run = folder.path().join("s/scene.run");
    let found = frames(&run.join("frames.bin"));
    let read = |name: &str| std::fs::read_to_string(run.join("vtk").join(name)).unwrap();
    let list = read("scene.pvd");
    let sets: Vec<&str> = list
        .lines()
        .filter(|line| line.contains("<DataSet"))
        .collect();
    assert_eq!(sets.len(), 2 * 46);
    let cell = |line: &str, name: &str| {
        let rest = line
            .split(&format!(" {name}=\""))
            .nth(1)
            .unwrap()
            .to_owned();
        rest.split('"').next().unwrap().to_owned()
    };
    // The bin moves, so that walls have a file at each time.
    let at = sets
        .iter()
        .filter(|line| cell(line, "name") == "fruit")
        .nth(30)
        .unwrap();
    let frame = &found.frames[30];
    assert_eq!(cell(at, "timestep").parse::<f64>().unwrap(), frame.time);
    let text = read(&cell(at, "file"));
    let tree = roxmltree::Document::parse(&text).unwrap();
    let array = |name: &str| -> Vec<f32> {
        let own = tree
            .descendants()
            .find(|own| own.attribute("Name") == Some(name))
            .unwrap();
        let bytes = decoded(own.text().unwrap());
        let words = bytes.chunks(4).map(|own| <[u8; 4]>::try_from(own).unwrap());
        match own.attribute("type").unwrap() {
            "Float32" => words.map(f32::from_le_bytes).collect(),
            "Int32" => words.map(|own| i32::from_le_bytes(own) as f32).collect(),
            other => panic!("{other}"),
        }
    };
    let all = |range: std::ops::Range<usize>| -> Vec<f32> {
        frame
            .fruit
            .iter()
            .flat_map(|own| own.values[range.clone()].to_vec())
            .collect()
    };
    assert_eq!(array("Points"), all(0..3));
    assert_eq!(array("orientation"), all(3..7));
    assert_eq!(array("velocity"), all(7..10));
    assert_eq!(array("largest_peak_force"), all(10..11));
    let numbers: Vec<f32> = frame.fruit.iter().map(|own| own.number as f32).collect();
    assert_eq!(array("fruit"), numbers);
    let radii: Vec<f32> = frame
        .fruit
        .iter()
        .map(|own| found.radii[own.number as usize - 1])
        .collect();
    assert_eq!(array("radius"), radii);
    let walls = read("walls_000030.vtp");
    let tree = roxmltree::Document::parse(&walls).unwrap();
    let piece = tree
        .descendants()
        .find(|own| own.has_tag_name("Piece"))
        .unwrap();
    // A plate, a box of three, one of four, a plate.
    assert_eq!(piece.attribute("NumberOfPolys"), Some("9"));
    assert_eq!(piece.attribute("NumberOfPoints"), Some("36"));

    // VTK's own reader, where VTK_PYTHON names a Python that has it (140 MB; not in CI).
    if let Some(python) = std::env::var_os("VTK_PYTHON") {
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scene/check_vtk.py");
        let done = std::process::Command::new(python)
            .arg(script)
            .arg(&run)
            .status();
        assert!(done.unwrap().success());
    }
}
