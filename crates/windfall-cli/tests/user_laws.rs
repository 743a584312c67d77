//! Laws of the user's own and law cards, from the command line.

#![allow(clippy::unwrap_used)]

use assert_cmd::Command;
use std::path::Path;

fn output(arguments: &[&str]) -> (bool, String, String) {
    let output = Command::cargo_bin("windfall")
        .unwrap()
        .args(arguments)
        .output()
        .unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (
        output.status.success(),
        text(&output.stdout),
        text(&output.stderr),
    )
}

fn windfall(arguments: &[&str]) -> String {
    let (success, shown, told) = output(arguments);
    assert!(success, "{arguments:?}: {told}");
    shown
}

fn refused(arguments: &[&str]) -> String {
    let (success, _, told) = output(arguments);
    assert!(!success, "{arguments:?} was accepted");
    told
}

fn json(arguments: &[&str]) -> serde_json::Value {
    let arguments = [arguments, &["--format", "json"]].concat();
    serde_json::from_str(&windfall(&arguments)).unwrap()
}

fn number(value: &serde_json::Value, place: &str) -> f64 {
    let found = value.pointer(place).and_then(serde_json::Value::as_f64);
    found.unwrap_or_else(|| panic!("no {place} in {value}"))
}

fn codes(value: &serde_json::Value) -> Vec<&str> {
    let findings = value["findings"].as_array().unwrap();
    findings
        .iter()
        .map(|f| f["code"].as_str().unwrap())
        .collect()
}

const LAWS: &str = r#"
[laws.my-law]
force = "k*x^n + c*x^p*v"
parameters.k = { unit = "N/m^n", start = 4e5, meaning = "stiffness" }
parameters.n = { unit = "1", default = 1.5, lower = 1, upper = 3 }
parameters.c = { unit = "N s/m^(p+1)", start = 600 }
parameters.p = { unit = "1", default = 0.5, lower = 0, upper = 3 }

[laws.stiffening]
force = """
k*x^1.5
  + k2*max(x - d, 0)^2
  + c*sqrt(x)*v"""
parameters.k = { unit = "N/m^1.5", start = "12 N/mm^1.5" }
parameters.k2 = { unit = "N/m^2", default = 1e7 }
parameters.d = { unit = "m", default = "0.5 mm" }
parameters.c = { unit = "N s/m^1.5", start = 500 }

[laws.curve]
table = "curve.csv"
"#;

const CURVE: &str =
    "displacement_m,force_N,damping_N_s_m\n0,0,0\n0.0005,3,10\n0.001,10,15\n0.002,40,20\n";

/// A file of laws in a folder.
fn laws(folder: &Path) -> String {
    std::fs::write(folder.join("curve.csv"), CURVE).unwrap();
    let path = folder.join("laws.toml");
    std::fs::write(&path, LAWS).unwrap();
    path.to_str().unwrap().to_owned()
}

const IMPACT: [&str; 6] = [
    "simulate",
    "impact",
    "--mass",
    "0.2 kg",
    "--velocity",
    "0.5 m/s",
];

#[test]
fn reference_simulations_are_those_of_the_built_in_law() {
    let folder = tempfile::tempdir().unwrap();
    let laws = laws(folder.path());
    let own = ["--laws", &laws, "--law", "my-law(k=753599, c=1524)"];
    let built_in = ["--law", "kuwabara-kono(k=753599, c=1524)"];
    let mass = ["--mass", "0.2 kg"];
    let cases: [(&str, Vec<&str>, &str); 4] = [
        (
            "impact",
            [&mass[..], &["--velocity", "0.5 m/s"]].concat(),
            "/peak_force",
        ),
        (
            "pendulum",
            vec!["--velocity", "0.4 m/s"],
            "/impact/contact_duration",
        ),
        (
            "carriage",
            [&mass[..], &["--velocity", "0.5 m/s"]].concat(),
            "/impact/restitution",
        ),
        (
            "drop",
            [&mass[..], &["--height", "50 mm", "--impacts", "2"]].concat(),
            "/impacts/1/onset_time",
        ),
    ];
    for (event, options, place) in cases {
        let with = |law: &[&str]| {
            number(
                &json(&[&["simulate", event], &options[..], law].concat()),
                place,
            )
        };
        let (one, two) = (with(&own), with(&built_in));
        assert!((one / two - 1.0).abs() < 1e-9, "{event}: {one} {two}");
    }
}

#[test]
fn closed_form_laws_are_shown_with_their_findings() {
    let folder = tempfile::tempdir().unwrap();
    let laws = laws(folder.path());
    let shown = windfall(&["card", "show", "--laws", &laws]);
    assert!(shown.contains("my-law(k, n=1.5, c, p=0.5)"), "{shown}");
    assert!(shown.contains("curve(scale, damping_scale)"), "{shown}");
    let one = json(&["card", "show", "--laws", &laws, "--law", "stiffening"]);
    assert_eq!(one["laws"].as_array().unwrap().len(), 1);
    // 12 N/mm^1.5 in SI.
    let k = number(&one, "/laws/0/parameters/0/typical");
    assert!((k - 12.0 * 1000_f64.powf(1.5)).abs() < 1e-6, "{k}");
    // Without a file the flag lists the built-in laws, as ever.
    assert!(windfall(&["card", "show", "--laws"]).contains("kuwabara-kono(k, c)"));
    let beyond = [
        &IMPACT[..],
        &[
            "--laws",
            &laws,
            "--law",
            "curve(scale=0.2, damping_scale=0.2)",
        ],
    ]
    .concat();
    assert_eq!(codes(&json(&beyond)), ["beyond-table"]);
    let shown = windfall(&beyond);
    assert!(
        shown.contains("beyond-table: the displacement reaches"),
        "{shown}"
    );
}

#[test]
fn recovers_a_user_s_law_from_its_own_campaign_and_refits_a_changed_one() {
    let folder = tempfile::tempdir().unwrap();
    let laws = laws(folder.path());
    let campaign = folder.path().join("campaign");
    let directory = campaign.to_str().unwrap();
    let law = "stiffening(k=600000, k2=3e7, d=0.0003, c=1500)";
    windfall(&[
        "simulate",
        "pendulum",
        "--laws",
        &laws,
        "--law",
        law,
        "--recordings",
        directory,
        "--specimens",
        "3",
        "--repeats",
        "2",
        "--spread",
        "k=60000",
        "--velocity",
        "0.5 m/s",
    ]);
    // campaign.toml carries the law; pieces are held where they have a default.
    let file = campaign.join("campaign.toml");
    let text = std::fs::read_to_string(&file).unwrap();
    assert!(text.contains("[laws.stiffening]"), "{text}");
    let text = text
        .replace("default = 10000000.0", "default = 3e7")
        .replace("default = 0.0005", "default = 0.0003");
    std::fs::write(&file, &text).unwrap();
    let card = folder.path().join("law.toml");
    let card = card.to_str().unwrap();
    let fitted = json(&["fit", directory, "--card", card]);
    let impacts = fitted["impacts"].as_array().unwrap();
    assert_eq!(impacts.len(), 6);
    let c: Vec<f64> = impacts
        .iter()
        .map(|impact| number(impact, "/parameters/c/value"))
        .collect();
    let mean = c.iter().sum::<f64>() / 6.0;
    assert!((mean / 1500.0 - 1.0).abs() < 0.05, "{c:?}");

    // Nothing changed: from the store. Another formula: fitted again.
    let status = |fitted: &serde_json::Value| number(fitted, "/status/fitted");
    assert_eq!(status(&json(&["fit", directory])), 0.0);
    std::fs::write(&file, text.replace("c*sqrt(x)*v", "2*c*sqrt(x)*v")).unwrap();
    let again = json(&["fit", directory]);
    assert_eq!(status(&again), 6.0);
    let half = number(&again, "/impacts/0/parameters/c/value");
    assert!((2.0 * half / c[0] - 1.0).abs() < 1e-6, "{half} {}", c[0]);

    // The card carries the definition and how fruit differ: it works alone.
    let shown = json(&["card", "show", "--file", card]);
    assert_eq!(shown["format"], 2);
    assert_eq!(shown["population"]["of"][0], "ln k");
    assert_eq!(number(&shown, "/population/fruit"), 3.0);
    let inside = [&IMPACT[..4], &["--velocity", "0.5 m/s", "--law", card]].concat();
    let mass_only = json(&inside);
    assert!(
        codes(&mass_only)
            .iter()
            .all(|code| *code == "outside-card-range")
    );
    let text = windfall(&["card", "show", "--file", card]);
    assert!(text.contains("formula: k*x^1.5"), "{text}");
    assert!(text.contains("between fruit: sd of ln k"), "{text}");

    // A list of another length is named by its own line.
    let path = folder.path().join("short.toml");
    let whole = std::fs::read_to_string(card).unwrap();
    let is_median = |line: &&str| line.starts_with("median = ");
    let median = whole.lines().find(is_median).unwrap();
    std::fs::write(&path, whole.replace(median, "median = [5.0]")).unwrap();
    let line = whole.lines().position(|line| line == median).unwrap() + 1;
    let told = refused(&["card", "show", "--file", path.to_str().unwrap()]);
    let place = format!("short.toml, line {line}: [population] median");
    assert!(told.contains(&place), "{told}");

    // The same as JSON.
    let other = folder.path().join("law.json");
    let other = other.to_str().unwrap();
    windfall(&["fit", directory, "--card", other]);
    assert_eq!(
        json(&["card", "show", "--file", other])["law"],
        "stiffening"
    );
    let refused = refused(&[
        "card",
        "transfer",
        "--file",
        card,
        "--from",
        "38 mm, 25 mm",
        "--to",
        "38 mm, plane",
    ]);
    assert!(
        refused.contains("do not follow from radii and moduli"),
        "{refused}"
    );
    assert!(refused.contains("hertz, kuwabara-kono"), "{refused}");
}

#[test]
fn conserves_a_law_there_and_back_between_geometries() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let campaign = path("campaign");
    windfall(&[
        "simulate",
        "pendulum",
        "--law",
        "kuwabara-kono(k=753599, c=1524)",
        "--recordings",
        &campaign,
        "--specimens",
        "3",
        "--repeats",
        "2",
        "--spread",
        "k=60000",
    ]);
    let (here, wall, back) = (path("here.toml"), path("wall.json"), path("back.toml"));
    windfall(&["fit", &campaign, "--card", &here]);
    let steel = ["38 mm, 25 mm", "--from-other", "200 GPa, 0.3"];
    let transfer = ["card", "transfer", "--file", &here, "--from"];
    let to = [
        "--to",
        "38 mm, plane",
        "--to-other",
        "10 MPa, 0.45",
        "--card",
        &wall,
    ];
    let there = json(&[&transfer[..], &steel, &to].concat());
    // 1/E* = A_fruit + A_other; k = (4/3) E* √R*.
    let k = |card: &str| {
        number(
            &json(&["card", "show", "--file", card]),
            "/parameters/k/value",
        )
    };
    let radius = 1.0_f64 / (1.0 / 0.038 + 1.0 / 0.025);
    let here_modulus = 0.75 * k(&here) / radius.sqrt();
    assert!((number(&there, "/from/effective_modulus") / here_modulus - 1.0).abs() < 1e-9);
    let fruit = 1.0 / here_modulus - (1.0 - 0.09) / 200e9;
    let modulus = 1.0 / (fruit + (1.0 - 0.45 * 0.45) / 10e6);
    let expected = 4.0 / 3.0 * modulus * 0.038_f64.sqrt();
    assert!(
        (k(&wall) / expected - 1.0).abs() < 1e-9,
        "{} {expected}",
        k(&wall)
    );
    let returned = [
        "card",
        "transfer",
        "--file",
        &wall,
        "--from",
        "38 mm, plane",
        "--from-other",
        "10 MPa, 0.45",
        "--to",
        "38 mm, 25 mm",
        "--to-other",
        "200 GPa, 0.3",
        "--card",
        &back,
    ];
    windfall(&returned);
    assert!((k(&back) / k(&here) - 1.0).abs() < 1e-9);
    let text = windfall(&["card", "show", "--file", &wall]);
    for expected in ["assumed: Hertz's contact", "R* = 0.03800 m", "equal strain"] {
        assert!(text.contains(expected), "{expected}: {text}");
    }
    let soft = refused(&[
        "card",
        "transfer",
        "--file",
        &here,
        "--from",
        "38 mm, 25 mm",
        "--from-other",
        "1 kPa, 0.4",
        "--to",
        "38 mm, plane",
    ]);
    assert!(soft.contains("its modulus is too low"), "{soft}");

    // Outside what the card has seen: told with range and by how much.
    let fast = [
        "simulate",
        "impact",
        "--mass",
        "0.2 kg",
        "--velocity",
        "2 m/s",
        "--law",
        &here,
    ];
    let findings = json(&fast);
    assert!(codes(&findings).contains(&"outside-card-range"));
    let text = windfall(&fast);
    assert!(
        text.contains("an impact velocity of 2.000 m/s is higher than the law's card has seen"),
        "{text}"
    );
    assert!(text.contains("by a factor of 5"), "{text}");
    let mut drop = fast.to_vec();
    drop[1] = "drop";
    drop.splice(4..6, ["--height", "300 mm"]);
    assert!(codes(&json(&drop)).contains(&"outside-card-range"));
}

#[test]
fn rejects_what_is_no_law_or_card() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("laws.toml");
    let path = file.to_str().unwrap();
    let told = |text: &str| {
        std::fs::write(&file, text).unwrap();
        refused(&["card", "show", "--laws", path])
    };
    let cases = [
        (
            "[laws.a]\nforce = \"k*log(x/d)\"\nparameters.k = { unit = \"N\", start = 1 }\nparameters.d = { unit = \"m\", start = 1 }",
            "no finite value at first touch (x = 0): `log(x/d)`",
        ),
        (
            "\n[laws.a]\nforce = \"k*x^1.5 + q\"\nparameters.k = { unit = \"N/m^1.5\", start = 1 }",
            "laws.toml, line 3",
        ),
        (
            "[laws.a]\nforce = \"k*x\"\nparameters.k = { unit = \"N/m^1.5\", start = 1 }",
            "k would have to be in N/m, not N/m^1.5",
        ),
        (
            "[laws.a]\nforce = \"k*x\"\nparameters.k = { unit = \"N/m\", start = 1, upper = 0.5 }",
            "its start 1 is outside its bounds, 0 to 0.5",
        ),
        (
            "[laws.a]\nforce = \"k*x\"\nparameters.k = { unit = \"N/m\", start = \"1 N\" }",
            "parameters.k.start",
        ),
        (
            "[laws.a]\nforce = \"k*x\"\ntable = \"a.csv\"",
            "`force` is given too",
        ),
        (
            "[laws.a]\ntable = \"absent.csv\"",
            "absent.csv cannot be read",
        ),
        (
            "[laws.a]\ndisplacement_m = [0, 1, 2]\nforce_N = [0, 2, 1]",
            "row 3 of the table: the force falls",
        ),
        ("[fit]\nlaws = []", "it holds no law"),
    ];
    for (text, expected) in cases {
        let message = told(text);
        assert!(message.contains(expected), "{text}: {message}");
    }
    let card = folder.path().join("card.toml");
    std::fs::write(&card, "format = 3\nnew = 1\n").unwrap();
    let newer = refused(&["card", "show", "--file", card.to_str().unwrap()]);
    assert!(
        newer.contains("this windfall reads law cards of formats 1 to 2"),
        "{newer}"
    );
    let unknown = refused(&[&IMPACT[..], &["--law", "my-law(k=1)"]].concat());
    assert!(unknown.contains("unknown law \"my-law\""), "{unknown}");
}

/// A law with memory from recordings to a card; what is wrong with one names its line.
#[test]
fn recovers_a_law_with_memory() {
    let folder = tempfile::tempdir().unwrap();
    let law = "[laws.mine]\nforce = \"k1*x\"\nunloading = \"F_max + k2*(x - x_max)\"\n\
               parameters.k1 = { unit = \"N/m\", start = 20000 }\n\
               parameters.k2 = { unit = \"N/m\", start = 30000 }\n";
    std::fs::write(folder.path().join("laws.toml"), law).unwrap();
    let run = |line: &str| crate::counted::windfall(line, folder.path());
    let (status, _, told) = run(
        "simulate carriage --laws laws.toml --law mine(k1=15000,k2=40000) --mass 0.2kg \
         --velocity 0.5m/s --specimens 3 --recordings campaign",
    );
    assert_eq!(status, Some(0), "{told}");
    let found = crate::counted::fitted(folder.path());
    for impact in found["impacts"].as_array().unwrap() {
        for (name, truth) in [("k1", 15_000.0), ("k2", 40_000.0)] {
            let own = &impact["parameters"][name];
            let (value, sd) = (own["value"].as_f64().unwrap(), own["sd"].as_f64().unwrap());
            assert!(
                (value - truth).abs() < 5.0 * sd && sd < 0.02 * truth,
                "{impact}"
            );
        }
    }
    let (status, _, told) = run("fit campaign --card card.toml");
    assert_eq!(status, Some(0), "{told}");
    let card = std::fs::read_to_string(folder.path().join("card.toml")).unwrap();
    assert!(
        card.contains("unloading = \"F_max + k2*(x - x_max)\""),
        "{card}"
    );
    let (status, out, told) =
        run("simulate impact --law card.toml --mass 0.2kg --velocity 0.5m/s --format json");
    assert_eq!(status, Some(0), "{told}");
    // e = √(k1/k2) of Walton and Braun.
    let found: serde_json::Value = serde_json::from_str(&out).unwrap();
    let restitution = found["restitution"].as_f64().unwrap();
    assert!(
        (restitution - (15.0_f64 / 40.0).sqrt()).abs() < 0.005,
        "{restitution}"
    );

    let refused = |law: &str| {
        std::fs::write(folder.path().join("wrong.toml"), law).unwrap();
        let (status, _, told) = run("card show --laws wrong.toml");
        assert_eq!(status, Some(2), "{told}");
        told
    };
    let jump = refused(&law.replace("F_max +", "0.5*F_max +"));
    assert!(
        jump.contains("wrong.toml, line 3: [laws.mine] unloading") && jump.contains("jumps"),
        "{jump}"
    );
    let table =
        "[laws.mine]\ndisplacement_m = [0, 1e-3]\nforce_N = [0, 10]\nunloading = \"F_max\"\n";
    let told = refused(table);
    assert!(
        told.contains("line 4") && told.contains("a table has no memory"),
        "{told}"
    );
}
