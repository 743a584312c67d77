//! Drops from the command line.

#![allow(clippy::unwrap_used)]

use assert_cmd::Command;
use serde_json::Value;

fn windfall(arguments: &[&str]) -> (i32, String, String) {
    let output = Command::cargo_bin("windfall")
        .unwrap()
        .args(arguments)
        .output()
        .unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    let code = output.status.code().unwrap();
    (code, text(output.stdout), text(output.stderr))
}

fn succeeded(arguments: &[&str]) -> String {
    let (code, text, messages) = windfall(arguments);
    assert_eq!(code, 0, "{arguments:?}: {messages}");
    text
}

/// Rig of Kang et al. (2023), INMATEH 71:63: plate of 0.2 kg on 645.8 N/mm and
/// 0.05247 N s/mm, fruit of 4.8 g from 500 mm.
const FRUIT: [&str; 4] = ["--mass", "4.8 g", "--height", "500 mm"];
const PLATE: [&str; 6] = [
    "--plate-mass",
    "0.2 kg",
    "--plate-stiffness",
    "645.8 N/mm",
    "--plate-damping",
    "0.05247 N s/mm",
];

fn law(k: f64, e: f64, c: f64, d: f64) -> String {
    format!("adams-impact(k=\"{k} N/mm^{e}\", e={e}, c=\"{c} N s/mm\", d=\"{d} mm\")")
}

fn simulated(law: &str, more: &[&str]) -> Value {
    let begin = ["simulate", "drop", "--format", "json", "--law", law];
    let text = succeeded(&[&begin[..], &FRUIT, more].concat());
    serde_json::from_str(&text).unwrap()
}

fn number(value: &Value, path: &str) -> f64 {
    value.pointer(path).and_then(Value::as_f64).unwrap()
}

/// A central sphere on the sprung and on the rigid plate, by an independent
/// integration (table `central_sphere_reference` of the project's reference
/// values for the drop study): run 1, run 7 and depth 0.1 mm of its Table 2.
#[test]
fn reference_central_sphere() {
    struct Row {
        law: String,
        sprung: [(&'static str, f64); 8],
        rigid: [(&'static str, f64); 3],
    }
    let rows = [
        Row {
            law: law(1.0, 2.25, 3.5e-4, 0.001),
            sprung: [
                ("/impacts/0/onset_time", 0.319_329_956_781_058_8),
                ("/impacts/0/peak_contact_force", 18.080_344_768_036_845),
                ("/impacts/0/peak_support_force", 26.943_519_781_130_316),
                ("/impacts/0/force_end_time", 0.322_428_306_000_259_9),
                ("/impacts/0/separation_time", 0.322_795_020_996_358_15),
                ("/impacts/0/separation_velocity", 2.692_291_677_172_108),
                ("/impacts/1/peak_contact_force", 14.605_678_766_807_143),
                ("/intervals/0", 0.552_540_838_502_156_1),
            ],
            rigid: [
                ("/impacts/0/peak_contact_force", 18.275_875_136_432_433),
                ("/impacts/0/max_displacement", 3.635_943_543_124_291_5e-3),
                ("/intervals/0", 0.560_029_356_720_673_8),
            ],
        },
        Row {
            law: law(0.44, 1.8, 5e-4, 0.001),
            sprung: [
                ("/impacts/0/onset_time", 0.319_329_956_781_058_8),
                ("/impacts/0/peak_contact_force", 9.068_026_984_907_27),
                ("/impacts/0/peak_support_force", 12.027_982_648_150_589),
                ("/impacts/0/force_end_time", 0.324_351_838_882_985_6),
                ("/impacts/0/separation_time", 0.325_090_006_121_042_44),
                ("/impacts/0/separation_velocity", 2.317_217_180_081_801),
                ("/impacts/1/peak_contact_force", 6.085_210_852_275_072),
                ("/intervals/0", 0.478_342_863_363_870_9),
            ],
            rigid: [
                ("/impacts/0/peak_contact_force", 9.099_549_102_773_874),
                ("/impacts/0/max_displacement", 5.355_492_079_667_181e-3),
                ("/intervals/0", 0.477_930_593_207_376_13),
            ],
        },
        Row {
            law: law(5.4, 2.0, 4e-4, 0.1),
            sprung: [
                ("/impacts/0/onset_time", 0.319_329_956_781_058_8),
                ("/impacts/0/peak_contact_force", 27.732_297_550_385_738),
                ("/impacts/0/peak_support_force", 36.484_833_380_031_29),
                ("/impacts/0/force_end_time", 0.321_321_575_618_598_86),
                ("/impacts/0/separation_time", 0.321_486_784_858_439_6),
                ("/impacts/0/separation_velocity", 2.761_318_970_218_087),
                ("/impacts/1/peak_contact_force", 23.403_118_941_903_827),
                ("/intervals/0", 0.565_291_373_450_342_6),
            ],
            rigid: [
                ("/impacts/0/peak_contact_force", 28.106_443_448_946_298),
                ("/impacts/0/max_displacement", 2.280_653_574_994_343_3e-3),
                ("/intervals/0", 0.581_579_924_681_493),
            ],
        },
    ];
    for row in &rows {
        let sprung = simulated(&row.law, &PLATE);
        let rigid = simulated(&row.law, &[]);
        let sprung = row.sprung.iter().map(|expected| (&sprung, expected));
        let rigid = row.rigid.iter().map(|expected| (&rigid, expected));
        for (found, (path, expected)) in sprung.chain(rigid) {
            let found = number(found, path);
            let error = (found / expected - 1.0).abs();
            assert!(error < 1e-6, "{} {path}: {found}, not {expected}", row.law);
        }
    }
}

/// Without damping, on a rigid plate, the fruit comes back as fast as it came.
#[test]
fn conserves_energy_without_damping() {
    let drop = simulated("hertz(k=170000)", &["--impacts", "3"]);
    assert_eq!(drop["impacts"].as_array().unwrap().len(), 3);
    for impact in 0..3 {
        let e = number(&drop, &format!("/impacts/{impact}/restitution"));
        assert!((e - 1.0).abs() < 1e-10, "{e}");
    }
    assert_eq!(drop["plate"], Value::Null);
    assert_eq!(drop["at_rest"], Value::Bool(false));
}

/// The motion holds contact and support force in columns of their own, and its
/// largest values are those of the summary.
#[test]
fn closed_form_motion_in_columns() {
    let law = law(0.868, 1.91, 5.56e-4, 0.001);
    let motion = ["--sampling-rate", "200 kHz", "--impacts", "1"];
    let drop = simulated(&law, &[&PLATE[..], &motion].concat());
    let column = |name: &str| -> Vec<f64> {
        let values = drop["motion"][name].as_array().unwrap();
        values.iter().map(|v| v.as_f64().unwrap()).collect()
    };
    let largest = |values: &[f64]| values.iter().copied().fold(f64::MIN, f64::max);
    for (name, peak) in [
        ("contact_force", "/impacts/0/peak_contact_force"),
        ("support_force", "/impacts/0/peak_support_force"),
    ] {
        let (found, exact) = (largest(&column(name)), number(&drop, peak));
        assert!(
            (found / exact - 1.0).abs() < 1e-4,
            "{name}: {found}, {exact}"
        );
    }
    // Before first touch: free fall. Support force is −(k x + c v) of the plate.
    let (times, height) = (column("time"), column("height"));
    let half = times.len() / 2;
    let fallen = 0.5 - 0.5 * 9.80665 * times[half].powi(2);
    assert!((height[half] - fallen).abs() < 1e-12);
    let (x, v) = (column("plate_displacement"), column("plate_velocity"));
    for (i, force) in column("support_force").iter().enumerate() {
        let plate = -(645_800.0 * x[i] + 52.47 * v[i]);
        assert!((force - plate).abs() < 1e-9, "{force} {plate}");
    }
    let begin = ["simulate", "drop", "--format", "csv", "--law", &law];
    let csv = succeeded(&[&begin[..], &FRUIT, &PLATE, &motion].concat());
    assert!(
        csv.starts_with(
            "time_s,contact_force_N,support_force_N,height_m,velocity_m_s,plate_displacement_m,plate_velocity_m_s\n"
        ),
        "{csv:.200}"
    );
    assert_eq!(csv.lines().count(), 1 + times.len());
}

#[test]
fn closed_form_tables_for_people_and_programs() {
    let law = law(0.868, 1.91, 5.56e-4, 0.001);
    let begin = ["simulate", "drop", "--law", &law];
    let text = succeeded(&[&begin[..], &FRUIT, &PLATE].concat());
    // DOMAIN: contact force 12.81 N on the sprung plate, 19.0 N at the base.
    assert!(text.contains("12.81 ") && text.contains("19.0"), "{text}");
    assert!(
        text.contains("plate 0.2 kg on 645800 N/m and 52.47 N s/m"),
        "{text}"
    );
    let csv = succeeded(&[&begin[..], &FRUIT, &["--format", "csv"]].concat());
    assert_eq!(csv.lines().count(), 3);
    let sprung = [&begin[..], &FRUIT, &PLATE, &["--format", "csv"]].concat();
    assert!(succeeded(&sprung).contains("12.8149"));
    assert!(csv.starts_with("impact,onset_time_s,impact_velocity_m_s,peak_contact_force_N"));
    // A soft landing: the fruit stays on the plate, and the text says so.
    let soft = ["simulate", "drop", "--law", "kelvin-voigt(k=100, c=10)"];
    let text = succeeded(&[&soft[..], &FRUIT].concat());
    assert!(text.contains("stays on the plate"), "{text}");
    let json = simulated("kelvin-voigt(k=100, c=10)", &[]);
    assert_eq!(json["at_rest"], Value::Bool(true));
}

#[test]
fn rejects_half_a_plate_and_several_heights() {
    let refused = |more: &[&str], expected: &str| {
        let begin = ["simulate", "drop", "--law", "hertz(k=1e5)"];
        let (code, _, messages) = windfall(&[&begin[..], &FRUIT, more].concat());
        assert_eq!(code, 2, "{messages}");
        assert!(messages.contains(expected), "{messages}");
    };
    refused(&PLATE[..2], "expected all three");
    refused(&["--height", "1 m"], "expected one height");
    refused(&["--effective-mass-factor", "1.5"], "a central impact");
    refused(&["--impacts", "0"], "expected 1 or more");
    refused(&["--gravity", "0 m/s^2"], "--gravity");
}
