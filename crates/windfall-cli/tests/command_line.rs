//! The command as a user meets it: results, messages, exit status.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use assert_cmd::Command;

fn windfall(arguments: &[&str]) -> std::process::Output {
    Command::cargo_bin("windfall")
        .unwrap()
        .args(arguments)
        .output()
        .unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

fn json(arguments: &[&str]) -> serde_json::Value {
    let output = windfall(arguments);
    assert!(output.status.success(), "{}", text(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

/// windfall reference tables, check_values.json (two independent integrators).
#[test]
fn reference_simulated_impacts() {
    let kuwabara = [
        ("peak_force", 32.86620939),
        ("max_displacement", 1.109922018e-3),
        ("contact_duration", 7.650136965e-3),
        ("final_displacement", 4.834733915e-4),
        ("separation_velocity", 0.2390715645),
        ("restitution", 0.4781431291),
        ("absorbed_energy", 0.0192844787),
    ];
    let hertz = [
        ("peak_force", 42.49953084),
        ("max_displacement", 1.470604469e-3),
        ("contact_duration", 8.656787282e-3),
        ("restitution", 1.0),
        ("impulse", 0.2),
    ];
    let walton = [
        ("restitution", 0.6),
        ("max_displacement", 1.118033989e-3),
        ("peak_force", 44.72135955),
        ("contact_duration", 5.619851785e-3),
        ("absorbed_energy", 0.016),
    ];
    check(
        "kuwabara-kono(k=753599, c=1524)",
        "200 g",
        "0.5 m/s",
        &kuwabara,
    );
    check(
        "hertz(k=\"753.599 kN/m^1.5\")",
        "0.2 kg",
        "500 mm/s",
        &hertz,
    );
    check(
        "walton-braun(k1=40000, k2=111111.1111)",
        "0.2",
        "0.5",
        &walton,
    );
    let adams = "adams-impact(k=\"0.868 N/mm^1.91\", e=1.91, c=\"5.56e-4 N s/mm\", d=\"0.001 mm\")";
    let kang = [
        ("peak_force", 12.82377044),
        ("contact_duration", 3.719021913e-3),
    ];
    check(adams, "4.8 g", "3.13 m/s", &kang);
}

fn check(law: &str, mass: &str, velocity: &str, expected: &[(&str, f64)]) {
    let found = json(&[
        "simulate",
        "impact",
        "--law",
        law,
        "--mass",
        mass,
        "--velocity",
        velocity,
        "--format",
        "json",
    ]);
    for (name, value) in expected {
        let number = found[name].as_f64().unwrap();
        assert!(
            (number / value - 1.0).abs() < 1e-8,
            "{law} {name}: {number}, expected {value}"
        );
    }
}

#[test]
fn rejects_wrong_requests_with_status_2_and_a_way_out() {
    let impact = [
        "simulate",
        "impact",
        "--mass",
        "0.2 kg",
        "--velocity",
        "0.5 m/s",
        "--law",
    ];
    let cases: [(&[&str], &str); 7] = [
        (&["hertzian(k=1)"], "hertz"),
        (&["hertz"], "k"),
        (&["hertz(k=\"1 N/m\")"], "N/m^1.5"),
        (&["hertz(k=1)", "--mass", "0.2 kgg"], "kg"),
        (
            &["hertz(k=1)", "--velocity", "0.5 kg"],
            "--velocity: \"0.5 kg\" is a mass (kg)",
        ),
        (
            &["hertz(k=1)", "--mass", "0 kg"],
            "--mass: \"0 kg\" must be above zero",
        ),
        (&["hertz(k=1)", "--end", "never"], "force-zero, gap-zero"),
    ];
    for (more, expected) in cases {
        // A later flag replaces an earlier one only if that one is not given.
        let mut arguments: Vec<&str> = impact.to_vec();
        if more.contains(&"--mass") {
            arguments = vec!["simulate", "impact", "--velocity", "0.5 m/s", "--law"];
        } else if more.contains(&"--velocity") {
            arguments = vec!["simulate", "impact", "--mass", "0.2 kg", "--law"];
        }
        arguments.extend(more);
        let output = windfall(&arguments);
        assert_eq!(output.status.code(), Some(2), "{more:?}");
        assert!(output.stdout.is_empty(), "{more:?}");
        assert!(
            text(&output.stderr).contains(expected),
            "{more:?}: {}",
            text(&output.stderr)
        );
    }
    for arguments in [
        &["fit", "no-such-directory"][..],
        &["inspect", "no-such-file.csv"],
        &["fits"],
    ] {
        assert_eq!(windfall(arguments).status.code(), Some(2), "{arguments:?}");
    }
}

#[test]
fn reference_twelve_laws_are_listed_with_formula_unit_and_source() {
    let laws = json(&["card", "show", "--laws", "--format", "json"]);
    let names: Vec<&str> = laws["laws"]
        .as_array()
        .unwrap()
        .iter()
        .map(|law| law["name"].as_str().unwrap())
        .collect();
    // DESIGN.md, section 5.
    let expected = [
        "hertz",
        "kelvin-voigt",
        "kuwabara-kono",
        "power-law",
        "hunt-crossley",
        "lankarani-nikravesh",
        "flores",
        "herbert-mcwhannell",
        "tsuji",
        "adams-impact",
        "walton-braun",
        "thornton",
    ];
    for name in expected {
        assert!(names.contains(&name), "{name}");
    }
    assert_eq!(names.len(), expected.len());
    for law in laws["laws"].as_array().unwrap() {
        for key in ["formula", "first_touch", "source"] {
            assert!(!law[key].as_str().unwrap().is_empty(), "{law}");
        }
        assert!(!law["parameters"].as_array().unwrap().is_empty(), "{law}");
    }
    let shown = text(&windfall(&["card", "show", "--law", "power-law"]).stdout);
    assert!(
        shown.starts_with("power-law(k, n=1.5, c, p=0.5)"),
        "{shown}"
    );
}

#[test]
fn closed_form_motion_has_its_columns_and_begins_free() {
    let output = windfall(&[
        "simulate",
        "pendulum",
        "--law",
        "kuwabara-kono(k=394931, c=681)",
        "--rate",
        "10 kHz",
        "--format",
        "csv",
    ]);
    let motion = text(&output.stdout);
    let mut lines = motion.lines();
    assert_eq!(
        lines.next(),
        Some("time_s,displacement_m,rate_m_s,force_N,acceleration_m_s2")
    );
    let first: Vec<f64> = lines
        .next()
        .unwrap()
        .split(',')
        .map(|cell| cell.parse().unwrap())
        .collect();
    // Before contact: x = v t to first order, no force.
    assert!(first[0] < 0.0 && first[3] == 0.0);
    assert!(
        (first[1] / (0.388 * first[0]) - 1.0).abs() < 1e-3,
        "{first:?}"
    );
}

#[test]
fn rejects_to_overwrite_a_directory() {
    let scratch = tempfile::tempdir().unwrap();
    let directory = scratch.path().join("campaign");
    let directory = directory.to_str().unwrap();
    assert!(windfall(&["new", "carriage", directory]).status.success());
    let again = windfall(&["new", "carriage", directory]);
    assert_eq!(again.status.code(), Some(2));
    assert!(text(&again.stderr).contains("exists already and is not overwritten"));
}

#[test]
fn closed_form_completions_name_the_commands() {
    let completions = text(&windfall(&["completions", "bash"]).stdout);
    for command in ["new", "inspect", "fit", "simulate", "card"] {
        assert!(completions.contains(command), "{command}");
    }
}

#[test]
fn rejects_unknown_commands_with_those_that_are_meant() {
    let cases: [(&[&str], &str); 4] = [
        (&["ft"], "similar subcommand exists: 'fit'"),
        (
            &["regres", "table.csv"],
            "similar subcommand exists: 'regress'",
        ),
        (
            &["scene", "rn", "scene.toml"],
            "similar subcommand exists: 'run'",
        ),
        (&["telescope"], "unrecognized subcommand 'telescope'"),
    ];
    for (words, told) in cases {
        let output = windfall(words);
        let found = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2));
        assert!(found.contains(told), "{found}");
    }
}

#[test]
fn a_campaign_is_fitted_from_within() {
    let folder = tempfile::tempdir().unwrap();
    let run = |words: &[&str], inside: &str| {
        let mut command = Command::cargo_bin("windfall").unwrap();
        let directory = folder.path().join(inside);
        command.args(words).current_dir(directory).output().unwrap()
    };
    let law = "hertz(k=4e5)";
    let made = run(
        &[
            "simulate",
            "pendulum",
            "--law",
            law,
            "--recordings",
            "study",
        ],
        "",
    );
    assert!(made.status.success(), "{}", text(&made.stderr));
    let within = run(&["fit", "--law", "hertz", "--format", "csv"], "study");
    assert!(within.status.success(), "{}", text(&within.stderr));
    let named = run(&["fit", "study", "--law", "hertz", "--format", "csv"], "");
    assert_eq!(within.stdout, named.stdout);
    let told = text(&run(&["fit"], "").stderr);
    assert!(told.contains("campaign.toml"), "{told}");
}
