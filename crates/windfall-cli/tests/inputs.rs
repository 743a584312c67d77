//! What a person pipes in is read to its end; what a file names lies beside it.

use assert_cmd::Command;
use std::path::Path;

/// Status, standard output and messages of a command line; `{}` in it is the first input.
fn typed(line: &str, piped: &[u8], folder: &Path) -> (Option<i32>, String, String) {
    let mut command = Command::cargo_bin("windfall").unwrap();
    let command = command.args(line.split(' ')).current_dir(folder);
    let output = command.write_stdin(piped).output().unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (
        output.status.code(),
        text(&output.stdout),
        text(&output.stderr),
    )
}

/// A table, and a recording of an impact with its times.
fn laboratory() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let table = "A,B,y,g\n0,0,1,a\n1,0,2,b\n0,1,3,a\n1,1,5,b\n0,0.5,2,a\n1,0.5,4,b\n";
    std::fs::write(folder.path().join("table.csv"), table).unwrap();
    std::fs::write(
        folder.path().join("bruises.csv"),
        "bruise_width_mm,bruise_depth_mm\n10,4\n",
    )
    .unwrap();
    let law = "kuwabara-kono(k=753599,c=1524)";
    let line =
        format!("simulate carriage --law {law} --mass 0.2kg --velocity 0.5m/s --specimens 1");
    let line = format!("{line} --recordings campaign");
    let (status, _, told) = typed(&line, b"", folder.path());
    assert_eq!(status, Some(0), "{told}");
    let recording = folder.path().join("campaign/raw/specimen-01.csv");
    let recording = std::fs::read_to_string(recording).unwrap();
    let timed = recording.lines().enumerate().map(|(row, line)| match row {
        0 => format!("time_s,{line}\n"),
        _ => format!("{},{line}\n", (row - 1) as f64 * 1e-4),
    });
    let timed: String = timed.collect();
    std::fs::write(folder.path().join("impact.csv"), timed).unwrap();
    folder
}

/// Every command that takes a table, and `inspect` and `fit FILE`.
const PIPED: &[(&str, &str)] = &[
    ("regress {} --response y --terms A+B+g", "table.csv"),
    (
        "regress table.csv --response y --terms A+B --predict {}",
        "table.csv",
    ),
    ("regress {} --response y --terms A --random g", "table.csv"),
    (
        "surface {} --factor A --factor B --response y --model A+B",
        "table.csv",
    ),
    ("summary {} --by g", "table.csv"),
    ("compare {} --value y --by g", "table.csv"),
    ("compare {} --measured y --predicted A", "table.csv"),
    (
        "design d-optimal --factor A=0..1 --factor B=0..1 --runs 4 --model A+B --candidates {}",
        "table.csv",
    ),
    ("bruise --table {}", "bruises.csv"),
    ("inspect {}", "impact.csv"),
    (
        "fit {} --rig carriage --mass 0.2kg --time time_s --channel force=force_V:N \
         --channel position=position_V:mm --law hertz",
        "impact.csv",
    ),
];

#[cfg(unix)]
#[test]
fn repeats_a_file_that_is_piped_in() {
    let laboratory = laboratory();
    let folder = laboratory.path();
    for (line, file) in PIPED {
        let line = line.replace("         ", "");
        let content = std::fs::read(folder.join(file)).unwrap();
        let (status, wanted, told) = typed(&line.replace("{}", file), b"", folder);
        assert_eq!(status, Some(0), "{line}: {told}");
        for name in ["-", "/dev/stdin"] {
            let piped = typed(&line.replace("{}", name), &content, folder);
            assert_eq!(piped.0, Some(0), "{line}, {name}: {}", piped.2);
            assert_eq!(numbers(&piped.1), numbers(&wanted), "{line}, {name}");
        }
        // No end, and nothing at all.
        let (status, _, told) = typed(&line.replace("{}", "/dev/zero"), b"", folder);
        assert_eq!(status, Some(2), "{line}: {told}");
        assert!(
            told.contains("/dev/zero: this is not a regular file"),
            "{told}"
        );
        let (status, _, told) = typed(&line.replace("{}", "-"), b"", folder);
        assert!(matches!(status, Some(1 | 2)), "{line}: {told}");
    }
}

/// Numbers with digits behind the point: names of files and numbers of lines left out.
fn numbers(text: &str) -> Vec<String> {
    let parts = text.split(|c: char| !(c.is_ascii_alphanumeric() || ".-−".contains(c)));
    let number =
        |part: &&str| part.contains('.') && part.trim_end_matches('.').parse::<f64>().is_ok();
    parts.filter(number).map(str::to_owned).collect()
}

/// A file that a campaign, a scene, a study or a law names, where it lies, and the command
/// that would read it.
#[cfg(unix)]
#[test]
fn rejects_files_that_lie_elsewhere() {
    let laboratory = laboratory();
    let folder = laboratory.path();
    let mine = folder.join("theirs");
    std::fs::create_dir(folder.join("mine")).unwrap();
    std::fs::create_dir(&mine).unwrap();
    let put = |place: &str, text: &str| std::fs::write(folder.join(place), text).unwrap();
    let made = |line: &str| {
        let (status, _, told) = typed(line, b"", folder);
        assert_eq!(status, Some(0), "{line}: {told}");
    };
    made("new scene-study theirs/study");
    made("new scene theirs/scene");
    put(
        "mine/points.csv",
        "displacement_m,force_N\n0,0\n1e-3,10\n2e-3,30\n",
    );
    put(
        "mine/study.toml",
        &std::fs::read_to_string(mine.join("study/study.toml")).unwrap(),
    );
    for name in ["apple-apple.toml", "bruise.toml"] {
        std::fs::rename(
            mine.join("study").join(name),
            folder.join("mine").join(name),
        )
        .unwrap();
    }
    put("mine/chute.stl", "solid x\nendsolid x\n");
    std::fs::copy(folder.join("impact.csv"), folder.join("mine/impact.csv")).unwrap();
    let scene = std::fs::read_to_string(mine.join("scene/scene.toml")).unwrap();
    let study = std::fs::read_to_string(mine.join("study/scene.toml")).unwrap();
    let campaign = std::fs::read_to_string(folder.join("campaign/campaign.toml")).unwrap();
    let impacts = std::fs::read_to_string(folder.join("campaign/impacts.csv")).unwrap();
    let law = |name: &str| format!("format = 1\n[laws.own]\ntable = \"{name}\"\n");
    let card = "card = \"apple-apple.toml\"";
    let regression = "regression = \"bruise.toml\"";
    let wall = format!("{scene}\n[[walls]]\nname = \"chute\"\nmaterial = \"steel\"\n");
    let whole = folder.join("mine").display().to_string();
    // In which file the name stands, its text, what is named, the command, and the key.
    let cases = |prefix: &str| {
        let named = |file: &str| format!("{prefix}/{file}");
        vec![
            (
                "theirs/laws.toml",
                law(&named("points.csv")),
                "fit campaign --laws theirs/laws.toml --law own",
                "table",
            ),
            (
                "campaign/campaign.toml",
                campaign.replace("\"raw\"", &format!("\"{prefix}\"")),
                "fit campaign",
                "[files] directory",
            ),
            (
                "campaign/impacts.csv",
                impacts.replace("specimen-01.csv", &named("impact.csv")),
                "fit campaign",
                "\"file\"",
            ),
            (
                "theirs/study/scene.toml",
                study.replace(card, &format!("card = \"{}\"", named("apple-apple.toml"))),
                "scene export theirs/study/scene.toml --engine chrono --out deck --force",
                "card",
            ),
            (
                "theirs/study/study.toml",
                format!("format = 1\nscene = \"{}\"\n", named("study.toml")),
                "scene study theirs/study/study.toml",
                "scene",
            ),
            (
                "theirs/scene/scene.toml",
                format!(
                    "{wall}mesh = {{ file = \"{}\", unit = \"mm\" }}\n",
                    named("chute.stl")
                ),
                "scene export theirs/scene/scene.toml --engine chrono --out deck --force",
                "mesh file",
            ),
            (
                "theirs/study/scene.toml",
                study.replace(
                    regression,
                    &format!("regression = \"{}\"", named("bruise.toml")),
                ),
                "scene export theirs/study/scene.toml --engine chrono --out deck --force",
                "regression",
            ),
        ]
    };
    std::os::unix::fs::symlink(&whole, mine.join("link")).unwrap();
    let absolute = cases(&whole);
    for (file, text, line, key) in absolute {
        let before = std::fs::read(folder.join(file)).ok();
        // What the case itself is not about lies where it should.
        let beside = ["apple-apple.toml", "bruise.toml"];
        for name in beside
            .iter()
            .filter(|name| !text.contains(&format!("{whole}/{name}")))
        {
            std::fs::copy(
                folder.join("mine").join(name),
                mine.join("study").join(name),
            )
            .unwrap();
        }
        put(file, &text);
        let (status, out, told) = typed(line, b"", folder);
        // What becomes of each impact stands beside the results.
        let told = out + &told;
        assert!(matches!(status, Some(1 | 2)), "{line}: {told}");
        let name = file.rsplit('/').next().unwrap();
        assert!(told.contains(&format!("{name}, line ")), "{line}: {told}");
        assert!(
            told.contains(key) && told.contains("lies elsewhere"),
            "{line}: {told}"
        );
        // Allowed, the file is read: what is wrong now is the file's own fault, or nothing.
        let (_, out, told) = typed(&format!("{line} --also-read mine"), b"", folder);
        let told = out + &told;
        assert!(!told.contains("lies elsewhere"), "{line}: {told}");
        if let Some(before) = before {
            std::fs::write(folder.join(file), before).unwrap();
        }
    }
    // By way of a link.
    put("theirs/laws.toml", &law("link/points.csv"));
    let (status, _, told) = typed(
        "fit campaign --laws theirs/laws.toml --law own",
        b"",
        folder,
    );
    assert_eq!(status, Some(2), "{told}");
    assert!(told.contains("lies elsewhere"), "{told}");
}
