//! `windfall serve` from outside: what the page asks, and what nobody should.

#![allow(clippy::unwrap_used)]

use crate::http;

use http::{Running, break_off, serve};
use serde_json::{Value, json};
use std::io::{Read, Write};
use std::path::Path;
use std::time::{Duration, Instant};

/// What of an impact's result only the view of that impact shows.
const ONE_IMPACT: [&str; 8] = [
    "correlations",
    "residuals",
    "regression",
    "derived_sd",
    "derived_from",
    "fitted",
    "directions",
    "common",
];
const LAW: &str = "kuwabara-kono(k=394931, c=681)";

fn windfall(arguments: &[&str]) -> assert_cmd::assert::Assert {
    let mut command = assert_cmd::Command::new(env!("CARGO_BIN_EXE_windfall"));
    command.args(arguments).assert()
}

fn fitted(directory: &Path, options: &[&str]) -> Value {
    let directory = directory.display().to_string();
    let mut arguments = vec!["fit", &directory, "--format", "json"];
    arguments.extend(options);
    let output = windfall(&arguments).success().get_output().stdout.clone();
    serde_json::from_slice(&output).unwrap()
}

/// A directory with a campaign "bench" of recordings.
fn bench(specimens: &str) -> (tempfile::TempDir, std::path::PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let campaign = folder.path().join("bench");
    let path = campaign.display().to_string();
    let arguments = [
        "simulate",
        "pendulum",
        "--law",
        LAW,
        "--recordings",
        &path,
        "--specimens",
        specimens,
        "--repeats",
        "2",
        "--spread",
        "k=60000",
    ];
    windfall(&arguments).success();
    (folder, campaign)
}

fn version(running: &Running) -> String {
    let view = running.get("/api/campaigns/bench");
    assert_eq!(view.status, 200, "{}", view.text());
    let version = view.json()["version"].as_str().unwrap().to_owned();
    assert_eq!(view.header("etag"), Some(format!("\"{version}\"").as_str()));
    version
}

fn ids(running: &Running) -> Vec<String> {
    let view = running.get("/api/campaigns/bench").json();
    let rows = view["impacts"]["rows"].as_array().unwrap().clone();
    rows.iter()
        .map(|row| row[0].as_str().unwrap().to_owned())
        .collect()
}

#[test]
fn serves_a_page_that_may_load_nothing_from_elsewhere_and_describes_itself() {
    let (folder, _) = bench("1");
    let running = serve(folder.path(), &[]);
    let page = running.get("/");
    assert_eq!(page.status, 200);
    let policy = page.header("content-security-policy").unwrap();
    assert!(
        policy.starts_with("default-src 'none'; script-src 'self'"),
        "{policy}"
    );
    assert!(
        page.text().contains("<script type=\"module\""),
        "{}",
        page.text()
    );
    assert_eq!(running.get("/nothing.js").status, 404);

    // Every address that is described is there, for every method that is described.
    let described = running.get("/api/openapi.json").json();
    let paths = described["paths"].as_object().unwrap();
    assert!(paths.len() >= 24, "{}", paths.len());
    for (path, methods) in paths {
        let real = path
            .replace("{id}", "bench")
            .replace("{job}", "1")
            .replace("{file}", "report.html");
        for method in methods.as_object().unwrap().keys() {
            if path == "/api/campaigns/{id}/events" {
                continue;
            }
            let answer = running.page(&method.to_uppercase(), &real, Some("x"), &json!({}));
            let text = answer.text();
            assert_ne!(answer.status, 405, "{method} {path}: {text}");
            assert!(
                !text.contains("there is nothing at this address"),
                "{method} {path}"
            );
            let known = methods[method]["responses"].as_object().unwrap();
            assert!(
                known.contains_key(&answer.status.to_string()),
                "{method} {path}: {text}"
            );
        }
    }
}

#[test]
fn rejects_strangers() {
    let (folder, _) = bench("1");
    let running = serve(folder.path(), &[]);
    let list = |head: &[(&str, &str)]| running.send("GET", "/api/campaigns", head, b"").status;
    assert_eq!(list(&[]), 200);
    assert_eq!(list(&[("Host", "evil.example")]), 403);
    assert_eq!(list(&[("Origin", "http://evil.example")]), 403);
    assert_eq!(list(&[("Sec-Fetch-Site", "cross-site")]), 403);
    let body = json!({"id": "x", "kind": "pendulum"}).to_string();
    let form = [("Content-Type", "text/plain")];
    let sent = running.send("POST", "/api/campaigns", &form, body.as_bytes());
    assert_eq!(sent.status, 403, "{}", sent.text());
    assert!(!folder.path().join("x").exists());
}

#[test]
fn answers_only_those_who_have_the_token() {
    let (folder, _) = bench("1");
    for options in [&[][..], &["--host", "0.0.0.0"]] {
        let running = serve(folder.path(), options);
        assert_eq!(running.token.len(), 32, "{}", running.token);
        let body = json!({"id": "x", "kind": "pendulum"}).to_string();
        let with = |method: &str, path: &str, head: &[(&str, &str)]| {
            let head = [&[("X-Windfall", "page")], head].concat();
            running.send(method, path, &head, body.as_bytes())
        };
        let none = ("Authorization", "none");
        for path in [
            "/",
            "/api/campaigns",
            "/nothing.js",
            "/?token=",
            "/?token=0123",
        ] {
            let answer = with("GET", path, &[none]);
            assert_eq!(answer.status, 401, "{path}");
            assert!(answer.text().contains("windfall serve"), "{path}");
        }
        let page = with("GET", "/", &[none, ("Accept", "text/html")]);
        assert_eq!(
            page.header("content-type"),
            Some("text/html; charset=utf-8")
        );
        let entry = format!("/api/campaigns?token={}", running.token);
        assert_eq!(with("POST", "/api/campaigns", &[none]).status, 401);
        assert_eq!(with("POST", &entry, &[none]).status, 401);
        assert!(!folder.path().join("x").exists());

        // The address becomes a cookie of this server alone.
        let entered = with("GET", &entry, &[none]);
        let location = entered.header("location");
        assert_eq!((entered.status, location), (303, Some("/api/campaigns")));
        let cookie = entered.header("set-cookie").unwrap();
        let name = format!("windfall-{}={}", running.address.port(), running.token);
        let known = format!("{name}; HttpOnly; SameSite=Strict; Path=/");
        assert_eq!(cookie, known);
        let pair = [none, ("Cookie", name.as_str())];
        assert_eq!(with("GET", "/api/campaigns", &pair).status, 200);
        assert_eq!(running.get("/api/campaigns").status, 200);
    }
    let open = serve(folder.path(), &["--no-token"]);
    assert_eq!(open.token, "");
    assert_eq!(open.get("/api/campaigns").status, 200);
    let directory = folder.path().display().to_string();
    let both = [
        "serve",
        "--no-token",
        "--host",
        "0.0.0.0",
        "--no-open",
        &directory,
    ];
    let refused = windfall(&both).failure().get_output().stderr.clone();
    let refused = String::from_utf8(refused).unwrap();
    assert!(
        refused.contains("--no-token with --host 0.0.0.0"),
        "{refused}"
    );
}

/// Connections that say nothing, and requests that never end, keep nobody out.
#[test]
fn answers_while_others_hold_connections() {
    let (folder, _) = bench("1");
    let running = serve(folder.path(), &[]);
    let begun = format!("GET / HTTP/1.1\r\nHost: {}\r\nX-", running.address);
    let held: Vec<_> = (0..300)
        .map(|number| {
            let mut stream = running.connect();
            if number % 2 == 0 {
                // One that was given up meanwhile takes nothing.
                let _ = stream.write_all(begun.as_bytes());
            }
            stream
        })
        .collect();
    let begin = Instant::now();
    assert_eq!(running.get("/api/campaigns").status, 200);
    assert!(
        begin.elapsed() < Duration::from_secs(5),
        "{:?}",
        begin.elapsed()
    );
    // The last one is let go when its time is over.
    let mut last = held.last().unwrap();
    let mut rest = Vec::new();
    let _ = last.read_to_end(&mut rest);
    let waited = begin.elapsed();
    assert!(waited < Duration::from_secs(20), "{waited:?}");
}

#[test]
fn compresses_what_gets_smaller() {
    let (folder, _) = bench("1");
    let running = serve(folder.path(), &[]);
    let get = |path: &str| running.send("GET", path, &[("Accept-Encoding", "gzip")], b"");
    let page = running.get("/").text();
    let script = page.split('"').find(|part| part.ends_with(".js")).unwrap();
    let script = format!("/{}", script.trim_start_matches(['.', '/']));
    for path in ["/api/openapi.json", &script] {
        let (small, large) = (get(path), running.get(path));
        assert_eq!(small.header("content-encoding"), Some("gzip"), "{path}");
        assert_eq!(large.header("content-encoding"), None, "{path}");
        assert!(2 * small.body.len() < large.body.len(), "{path}");
    }
    let job = running.work("bench", &json!({"work": "fit"}));
    let events = get(&format!(
        "/api/jobs/{}/events",
        job["job"].as_str().unwrap()
    ));
    assert_eq!(events.header("content-encoding"), None);
    assert!(events.text().contains("event: end"), "{}", events.text());
}

#[test]
fn rejects_every_way_out_of_the_directory() {
    let (folder, campaign) = bench("1");
    std::fs::write(
        folder.path().join("secret.csv"),
        "time_s,force_N\n0,7777\n1,8\n",
    )
    .unwrap();
    let outside = tempfile::tempdir().unwrap();
    std::fs::write(
        outside.path().join("secret.csv"),
        "time_s,force_N\n0,7777\n1,8\n",
    )
    .unwrap();
    #[cfg(unix)]
    {
        let link = |name: &str| std::os::unix::fs::symlink(outside.path(), campaign.join(name));
        link("raw/link").unwrap();
        link("tables").unwrap();
        link("report").unwrap();
        std::os::unix::fs::symlink(outside.path(), folder.path().join("linked")).unwrap();
    }
    let running = serve(folder.path(), &[]);
    let ways = [
        "../secret.csv",
        "../../secret.csv",
        "..%2Fsecret.csv",
        "%2e%2e/secret.csv",
        "..%5Csecret.csv",
        "link/secret.csv",
        "tables/secret.csv",
        "/etc/passwd",
        "%2Fetc%2Fpasswd",
        "raw/../../secret.csv",
        "....//secret.csv",
        "secret.csv%00.csv",
        "secret.csv",
        ".",
    ];
    for way in ways {
        for path in [
            format!("/api/campaigns/bench/recording?file={way}"),
            format!("/api/campaigns/bench/outline?channel=force_N&file={way}"),
            format!("/api/campaigns/bench/table?file={way}"),
            format!("/api/campaigns/bench/report/{way}"),
            format!("/api/campaigns/{way}"),
            format!("/{way}"),
        ] {
            let answer = running.get(&path);
            assert!(
                (400..500).contains(&answer.status),
                "{path}: {}",
                answer.text()
            );
            assert!(!answer.text().contains("7777"), "{path}");
            assert!(!answer.text().contains("root:"), "{path}");
        }
        for kind in ["raw", "table"] {
            let path = format!("/api/campaigns/bench/{kind}?file=../{way}");
            let answer = running.upload(&path, b"a,b\n1,2\n");
            assert!(
                (400..500).contains(&answer.status),
                "{path}: {}",
                answer.text()
            );
        }
        let version = version(&running);
        let row =
            json!({"impacts": [{"id": "n", "specimen": "s", "file": way.replace("%2F", "/")}]});
        if way != "secret.csv" && !way.contains('%') && way != "tables/secret.csv" {
            let path = "/api/campaigns/bench/impacts";
            let answer = running.page("POST", path, Some(&version), &row);
            assert!(
                (400..500).contains(&answer.status),
                "{way}: {}",
                answer.text()
            );
        }
    }
    let text = std::fs::read_to_string(campaign.join("campaign.toml")).unwrap();
    let moved = text.replace("directory = \"raw\"", "directory = \"/etc\"");
    assert_ne!(moved, text);
    let body = json!({ "text": moved });
    let answer = running.page(
        "PUT",
        "/api/campaigns/bench/text",
        Some(&version(&running)),
        &body,
    );
    assert_eq!(answer.status, 422, "{}", answer.text());
    assert_eq!(
        std::fs::read_to_string(campaign.join("campaign.toml")).unwrap(),
        text
    );
    assert_eq!(std::fs::read_dir(outside.path()).unwrap().count(), 1);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 3);
}

/// What the files of a campaign name is confined as well: who gets a directory from others
/// did not write them.
#[cfg(unix)]
#[test]
fn rejects_files_that_lead_out_of_the_campaign() {
    use std::os::unix::fs::symlink;
    let (folder, campaign) = bench("1");
    let outside = tempfile::tempdir().unwrap();
    let secret = outside.path().join("secret.csv");
    std::fs::write(&secret, "time_s,force_N\n0,7777\n1,8\n").unwrap();
    let running = serve(folder.path(), &[]);
    let text = std::fs::read_to_string(campaign.join("campaign.toml")).unwrap();
    let path = "/api/campaigns/bench/text";
    let tables = [
        "/dev/zero",
        "/dev/stdin",
        "../../secret.csv",
        &secret.display().to_string(),
    ];
    for table in tables {
        let text = format!("{text}\n[laws.own]\ntable = \"{table}\"\n");
        let answer = running.page("PUT", path, Some("*"), &json!({ "text": text }));
        assert!(
            [400, 422].contains(&answer.status),
            "{table}: {}",
            answer.text()
        );
        assert!(!answer.text().contains("7777"), "{}", answer.text());
    }
    // The column "file" is checked, whatever the other columns are called.
    let cells = json!({"file": secret.display().to_string()});
    let row = json!({"id": "n", "specimen": "s", "file": "a.csv", "cells": cells});
    let path = "/api/campaigns/bench/impacts";
    running.page("POST", path, Some("*"), &json!({"impacts": [row]}));
    let rows = std::fs::read_to_string(campaign.join("impacts.csv")).unwrap();
    assert!(!rows.contains("secret"), "{rows}");

    // Files that were put there otherwise: a recording elsewhere, an endless table, a store.
    let rows = rows.replace("specimen-01-01.csv", &secret.display().to_string());
    std::fs::write(campaign.join("impacts.csv"), rows).unwrap();
    let body = json!({"impact": ids(&running)[0], "series": true});
    let refit = running.page("POST", "/api/campaigns/bench/refit", None, &body);
    assert_eq!(refit.json()["code"], "unusable", "{}", refit.text());
    assert!(refit.text().contains("lies elsewhere"), "{}", refit.text());
    let job = running.work("bench", &json!({"work": "fit"}));
    assert_eq!(job["state"], "done", "{job}");
    let told = job["result"]["failed"][0]["message"].as_str().unwrap();
    assert!(told.contains("lies elsewhere"), "{job}");
    let refused = |name: &str, target: &Path| {
        let own = campaign.join(name);
        let kept = folder.path().join("kept");
        let was = std::fs::rename(&own, &kept).is_ok();
        symlink(target, &own).unwrap();
        let answer = running.get("/api/campaigns/bench");
        assert!(
            (400..500).contains(&answer.status),
            "{name}: {}",
            answer.text()
        );
        assert_eq!(running.get("/api/campaigns").status, 200);
        std::fs::remove_file(&own).unwrap();
        if was {
            std::fs::rename(&kept, &own).unwrap();
        }
    };
    refused("specimens.csv", Path::new("/dev/zero"));
    refused("campaign.toml", &secret);
    refused("results.sqlite", &outside.path().join("other.sqlite"));
    assert_eq!(running.get("/api/campaigns/bench").status, 200);
    symlink(outside.path(), campaign.join("report")).unwrap();
    let job = running.work("bench", &json!({"work": "report"}));
    assert_eq!(job["state"], "failed", "{job}");
    assert_eq!(std::fs::read_dir(outside.path()).unwrap().count(), 1);
}

#[test]
fn tells_no_path_of_the_machine() {
    let (folder, campaign) = bench("1");
    std::fs::remove_file(
        std::fs::read_dir(campaign.join("raw"))
            .unwrap()
            .next()
            .unwrap()
            .unwrap()
            .path(),
    )
    .unwrap();
    std::fs::create_dir(folder.path().join("broken")).unwrap();
    std::fs::write(folder.path().join("broken/campaign.toml"), "format = [\n").unwrap();
    let running = serve(folder.path(), &[]);
    let machine = folder.path().canonicalize().unwrap().display().to_string();
    let mut said = String::new();
    for path in [
        "/api/about",
        "/api/campaigns",
        "/api/campaigns/bench",
        "/api/campaigns/broken",
    ] {
        said += &running.get(path).text();
    }
    for impact in ids(&running) {
        let body = json!({"impact": impact, "laws": ["hertz"]});
        said += &running
            .page("POST", "/api/campaigns/bench/refit", None, &body)
            .text();
    }
    said += &running.work("bench", &json!({"work": "fit"})).to_string();
    said += &running
        .work("bench", &json!({"work": "report"}))
        .to_string();
    said += &running.get("/api/campaigns/bench/results").text();
    said += &running
        .get("/api/campaigns/bench/report/report.html")
        .text();
    assert!(
        said.contains("There is no such file") || said.contains("no such file"),
        "{said}"
    );
    assert!(
        !said.contains(&machine),
        "{}",
        &said[said.find(&machine).unwrap()..][..200]
    );
}

/// The numbers of a live fit are those that the command gives, to the last digit, for
/// fifty clients at once that each ask something else.
#[test]
fn repeats_fits_of_the_command_for_fifty_clients_at_once() {
    let (folder, campaign) = bench("4");
    let laws = ["kuwabara-kono", "hertz", "kelvin-voigt"];
    let mut options = Vec::new();
    laws.iter().for_each(|law| options.extend(["--law", law]));
    let expected = fitted(&campaign, &options);
    let running = serve(folder.path(), &[]);
    let ids = ids(&running);
    let one = |client: usize| {
        for turn in 0..6 {
            let impact = &ids[(client + turn) % ids.len()];
            let law = laws[(client / 3 + turn) % laws.len()];
            let body = json!({"impact": impact, "laws": [law], "series": turn == 0});
            let answer = running.page("POST", "/api/campaigns/bench/refit", None, &body);
            assert_eq!(answer.status, 200, "{}", answer.text());
            let view = answer.json();
            assert_eq!(view["impact"], *impact);
            let mut all = expected["impacts"].as_array().unwrap().iter();
            let known = all
                .find(|known| known["id"] == *impact && known["law"] == law)
                .unwrap();
            let found = &view["laws"][0]["outcome"];
            assert_eq!(found["parameters"], known["parameters"]);
            assert_eq!(found["derived"], known["derived"]);
        }
    };
    std::thread::scope(|scope| {
        let one = &one;
        let clients: Vec<_> = (0..50)
            .map(|client| scope.spawn(move || one(client)))
            .collect();
        clients
            .into_iter()
            .for_each(|client| client.join().unwrap());
    });
}

/// What is shorter is what only the view of one impact shows; all else is as in the whole results.
fn brief_results_are_the_whole_ones_abridged(running: &Running) {
    let whole = running.get("/api/campaigns/bench/results");
    let brief = running.get("/api/campaigns/bench/results?impacts=brief");
    assert!(brief.text().len() < whole.text().len() / 2);
    let (mut whole, mut brief) = (whole.json(), brief.json());
    for outcome in [&mut whole, &mut brief].map(|results| &mut results["outcome"]["impacts"]) {
        for impact in outcome.as_array_mut().unwrap() {
            let impact = impact.as_object_mut().unwrap();
            for name in ONE_IMPACT {
                impact.remove(name);
            }
            impact["nuisances"]
                .as_object_mut()
                .unwrap()
                .retain(|name, _| name == "onset");
            for name in ["drawn", "profiles"] {
                impact["intervals"].as_object_mut().unwrap().remove(name);
            }
        }
    }
    assert_eq!(whole, brief);
    let wrong = running.get("/api/campaigns/bench/results?impacts=banana");
    assert_eq!(wrong.status, 400);
    assert!(wrong.text().contains("banana"), "{}", wrong.text());
}

#[test]
fn work_in_the_page_is_in_the_files_that_the_command_reads() {
    let (folder, campaign) = bench("3");
    let running = serve(folder.path(), &[]);
    let before = running.get("/api/campaigns/bench/results").json();
    assert_eq!(
        (&before["outcome"], &before["pending"]),
        (&Value::Null, &json!(6))
    );

    let job = running.work("bench", &json!({"work": "fit"}));
    assert_eq!(job["state"], "done", "{job}");
    assert_eq!((&job["done"], &job["all"]), (&json!(6), &json!(6)));
    assert_eq!(job["command"], "windfall fit bench");
    let status = &fitted(&campaign, &[])["status"];
    assert_eq!(
        (&status["stored"], &status["up_to_date"]),
        (&json!(6), &json!(true))
    );
    let table = std::fs::read_to_string(campaign.join("tables/results.csv")).unwrap();
    assert_eq!(table.lines().count(), 7);
    brief_results_are_the_whole_ones_abridged(&running);

    // A window moved in the page: the command fits that impact anew, with the same result.
    let id = &ids(&running)[0];
    let whole = running
        .page(
            "POST",
            "/api/campaigns/bench/refit",
            None,
            &json!({"impact": id}),
        )
        .json();
    let to = whole["end"].as_f64().unwrap()
        - 0.3 * (whole["end"].as_f64().unwrap() - whole["onset"].as_f64().unwrap());
    let asked = json!({"impact": id, "to": to});
    let live = running
        .page("POST", "/api/campaigns/bench/refit", None, &asked)
        .json();
    let found = &live["laws"][0]["outcome"];
    assert!(found["samples"].as_u64() < whole["laws"][0]["outcome"]["samples"].as_u64());
    let window = json!({"impact": id, "from": null, "to": to});
    let saved = running.page(
        "PUT",
        "/api/campaigns/bench/window",
        Some(&version(&running)),
        &window,
    );
    assert_eq!(saved.status, 200, "{}", saved.text());
    let pending = running.get("/api/campaigns/bench/results").json();
    assert_eq!(pending["pending"], 1);
    let again = fitted(&campaign, &[]);
    assert_eq!(
        (&again["status"]["stored"], &again["status"]["fitted"]),
        (&json!(5), &json!(1))
    );
    assert_eq!(again["impacts"][0]["parameters"], found["parameters"]);

    // Options set in the page, and remarks kept.
    let options = json!({"laws": ["hunt-crossley"], "weights": "inverse-mean"});
    let set = running.page(
        "PUT",
        "/api/campaigns/bench/options",
        Some(&version(&running)),
        &options,
    );
    assert_eq!(
        set.json()["laws"],
        json!(["hunt-crossley"]),
        "{}",
        set.text()
    );
    assert_eq!(fitted(&campaign, &[])["impacts"][0]["law"], "hunt-crossley");

    let card = running.get("/api/campaigns/bench/card?law=hunt-crossley");
    assert!(
        card.text().contains("law = \"hunt-crossley\""),
        "{}",
        card.text()
    );
    let model = json!({"table": "tables/results.csv", "response": "k", "terms": "impact_velocity_m_per_s", "random": []});
    let model = running.page("POST", "/api/campaigns/bench/regress", None, &model);
    assert!(
        model.status == 200 || model.text().contains("impact_velocity"),
        "{}",
        model.text()
    );
}

#[test]
fn a_change_on_the_ground_of_an_older_version_changes_nothing() {
    let (folder, campaign) = bench("1");
    let running = serve(folder.path(), &[]);
    let version = version(&running);
    let put = |name: &str, version: &str, body: &Value| {
        let path = format!("/api/campaigns/bench/{name}");
        running.page("PUT", &path, Some(version), body)
    };
    let first = put("options", &version, &json!({"end": "gap-zero"}));
    assert_eq!(first.status, 200, "{}", first.text());
    let text = std::fs::read_to_string(campaign.join("campaign.toml")).unwrap();
    // A second tab, which has not seen the first change.
    let second = put("options", &version, &json!({"end": "force-zero"}));
    assert_eq!(
        (second.status, &second.json()["code"]),
        (412, &json!("changed-meanwhile"))
    );
    // A change by an editor.
    std::fs::write(campaign.join("campaign.toml"), format!("{text}# edited\n")).unwrap();
    let third = put(
        "options",
        first.json()["version"].as_str().unwrap(),
        &json!({"end": "force-zero"}),
    );
    assert_eq!(third.status, 412);
    assert!(
        std::fs::read_to_string(campaign.join("campaign.toml"))
            .unwrap()
            .ends_with("# edited\n")
    );
    // A campaign that could not be read is not written.
    let now = running.get("/api/campaigns/bench").json()["version"]
        .as_str()
        .unwrap()
        .to_owned();
    let wrong = put(
        "text",
        &now,
        &json!({"text": "format = 1\n[rig]\nkind = \"pendulum\"\nfoo = 1\n"}),
    );
    assert_eq!(wrong.status, 422, "{}", wrong.text());
    assert!(
        wrong.text().contains("campaign.toml, line 4"),
        "{}",
        wrong.text()
    );
    let wrong = put("options", &now, &json!({"laws": ["hertzz"]}));
    assert_eq!(wrong.status, 422);
    assert!(wrong.text().contains("hertz"), "{}", wrong.text());
    assert!(
        std::fs::read_to_string(campaign.join("campaign.toml"))
            .unwrap()
            .ends_with("# edited\n")
    );
    let missing = running.page(
        "PUT",
        "/api/campaigns/bench/text",
        None,
        &json!({"text": ""}),
    );
    assert_eq!(missing.status, 428);
}

#[test]
fn a_change_is_undone_while_its_files_are_as_it_left_them() {
    let (folder, campaign) = bench("1");
    let running = serve(folder.path(), &[]);
    let table = || std::fs::read_to_string(campaign.join("impacts.csv")).unwrap();
    let before = table();
    let send = |method: &str, name: &str, body: &Value| {
        let path = format!("/api/campaigns/bench/{name}");
        running.page(method, &path, Some("*"), body)
    };
    let id = running.get("/api/campaigns/bench").json()["impacts"]["rows"][0][0].clone();
    let noted = send("PUT", "note", &json!({"impact": id, "note": "fell twice"}));
    assert_eq!(noted.status, 200, "{}", noted.text());
    assert!(table().contains("fell twice"));
    let lines = json!({"impact": id, "note": "two\nlines"});
    assert_eq!(send("PUT", "note", &lines).status, 400);
    let on_all = send("PUT", "note", &json!({"note": "two\nlines"})).json();
    assert_eq!(on_all["note"], "two\nlines");
    assert_eq!(on_all["undo"]["words"], "changed the note on the campaign");
    assert_eq!(fitted(&campaign, &[])["note"], "two\nlines");

    let undo = json!({"way": "undo"});
    assert_eq!(send("POST", "undo", &undo).json()["note"], Value::Null);
    let edited = table() + "\n";
    std::fs::write(campaign.join("impacts.csv"), &edited).unwrap();
    let refused = send("POST", "undo", &undo);
    assert_eq!(
        (refused.status, &refused.json()["code"]),
        (409, &json!("changed-since")),
        "{}",
        refused.text()
    );
    assert_eq!(table(), edited);
    let beside = running.get("/api/campaigns/bench/undo?way=undo").json();
    assert_eq!(beside[0]["now"], edited.as_str());
    assert_eq!(beside[0]["before"], before.as_str());
    std::fs::write(
        campaign.join("impacts.csv"),
        edited.trim_end_matches('\n').to_owned() + "\n",
    )
    .unwrap();
    let undone = send("POST", "undo", &undo);
    assert_eq!(undone.status, 200, "{}", undone.text());
    assert_eq!(table(), before);
    assert_eq!(send("POST", "undo", &undo).status, 422);
    let redone = send("POST", "undo", &json!({"way": "redo"})).json();
    assert_eq!(redone["redo"]["words"], "changed the note on the campaign");
    assert!(table().contains("fell twice"));
}

#[test]
fn a_file_arrives_whole_or_not_at_all() {
    let (folder, campaign) = bench("1");
    let running = serve(folder.path(), &["--upload-limit", "1"]);
    let raw = campaign.join("raw");
    let names = || {
        let entries = std::fs::read_dir(&raw).unwrap();
        let mut names: Vec<_> = entries
            .map(|e| e.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    };
    let before = names();
    let put = |file: &str, bytes: &[u8]| {
        running.upload(&format!("/api/campaigns/bench/raw?file={file}"), bytes)
    };
    break_off(&running, "/api/campaigns/bench/raw?file=half.csv");
    assert_eq!(put("large.csv", &vec![b'1'; 1_500_000]).status, 413);
    assert_eq!(put("empty.csv", b"").status, 400);
    let strange = put("picture.csv", b"\x89PNG\r\n\x1a\n\x00\x00\x00\rIHDR");
    assert_eq!(strange.status, 422, "{}", strange.text());
    let good = b"time_s;force_N\n0,0;0,1\n0,1;2,5\n0,2;0,2\n";
    let arrived = put("new%20one.csv", good);
    assert_eq!(arrived.status, 201, "{}", arrived.text());
    let recording = &arrived.json()["recording"];
    assert_eq!(recording["columns"][1]["role"], "force");
    assert_eq!(recording["columns"][1]["largest"], 2.5);
    assert_eq!(put("new%20one.csv", b"other").status, 409);
    assert_eq!(std::fs::read(raw.join("new one.csv")).unwrap(), good);
    // The upload that broke off is noticed when its connection is.
    let begin = Instant::now();
    while names().len() > before.len() + 1 && begin.elapsed() < Duration::from_secs(20) {
        std::thread::sleep(Duration::from_millis(20));
    }
    let mut expected = before;
    expected.push("new one.csv".to_owned());
    expected.sort();
    assert_eq!(names(), expected);

    let outline = running
        .get("/api/campaigns/bench/outline?file=new%20one.csv&channel=force_N")
        .json();
    assert_eq!(outline["low"], json!([0.1, 2.5, 0.2]));
    assert_eq!(outline["time"], json!([0.0, 0.1, 0.2]));
}

#[test]
fn work_can_be_stopped_and_a_killed_server_leaves_the_results_of_before() {
    let (folder, campaign) = bench("20");
    let mut running = serve(folder.path(), &[]);
    let begun = running.page(
        "POST",
        "/api/campaigns/bench/jobs",
        None,
        &json!({"work": "fit", "intervals": "bootstrap"}),
    );
    assert_eq!(begun.status, 202, "{}", begun.text());
    let job = begun.json()["job"].as_str().unwrap().to_owned();
    let again = running.page(
        "POST",
        "/api/campaigns/bench/jobs",
        None,
        &json!({"work": "fit"}),
    );
    assert_eq!((again.status, &again.json()["code"]), (409, &json!("busy")));
    running.page("DELETE", &format!("/api/jobs/{job}"), None, &json!({}));
    let events = running.get(&format!("/api/jobs/{job}/events")).text();
    assert!(events.contains("\"state\":\"cancelled\""), "{events}");
    assert_eq!(
        running.get("/api/campaigns/bench/results").json()["outcome"],
        Value::Null
    );

    let done = running.work("bench", &json!({"work": "fit"}));
    assert_eq!(done["state"], "done");
    running.page(
        "POST",
        "/api/campaigns/bench/jobs",
        None,
        &json!({"work": "fit", "intervals": "bootstrap"}),
    );
    std::thread::sleep(Duration::from_millis(200));
    running.kill();
    let status = &fitted(&campaign, &[])["status"];
    assert_eq!(
        (&status["stored"], &status["fitted"]),
        (&json!(40), &json!(0))
    );
}

/// What the page does for somebody who begins with a file and nothing else.
#[test]
fn a_campaign_made_in_the_page_has_what_was_put_in_and_no_examples() {
    let (folder, campaign) = bench("1");
    let recording = std::fs::read(campaign.join("raw/specimen-01-01.csv")).unwrap();
    let running = serve(folder.path(), &[]);
    let made = running.page(
        "POST",
        "/api/campaigns",
        None,
        &json!({"id": "mine", "kind": "pendulum"}),
    );
    assert_eq!(made.status, 201, "{}", made.text());
    let arrived = running.upload("/api/campaigns/mine/raw?file=first.csv", &recording);
    assert_eq!(arrived.status, 201, "{}", arrived.text());
    let channels = json!({
        "channels": [
            {"quantity": "force", "column": "force_V", "unit": "11 mV/N"},
            {"quantity": "phase_a", "column": "phase_a_V", "unit": ""},
            {"quantity": "phase_b", "column": "phase_b_V", "unit": ""},
        ],
        "time": null, "rate": "200 kHz",
    });
    let mapped = running.page("PUT", "/api/campaigns/mine/channels", Some("*"), &channels);
    assert_eq!(mapped.status, 200, "{}", mapped.text());
    // Remarks of the template stay where nothing was changed.
    assert!(
        mapped.json()["text"]
            .as_str()
            .unwrap()
            .contains("# pivot to point of contact")
    );
    let row = json!({"id": "a", "specimen": "apple", "file": "first.csv", "cells": {"level": "2"}});
    let added = running.page(
        "POST",
        "/api/campaigns/mine/impacts",
        Some("*"),
        &json!({"impacts": [row]}),
    );
    assert_eq!(added.status, 200, "{}", added.text());
    assert_eq!(
        added.json()["impacts"]["rows"],
        json!([["a", "apple", "first.csv", "2"]])
    );
    let row = json!({"id": "b", "specimen": "apple", "file": "first.csv"});
    let added = running.page(
        "POST",
        "/api/campaigns/mine/impacts",
        Some("*"),
        &json!({"impacts": [row]}),
    );
    assert_eq!(added.json()["impacts"]["rows"].as_array().unwrap().len(), 2);
    assert_eq!(
        added.json()["specimens"]["rows"].as_array().unwrap().len(),
        1
    );
    // The rig of the template is nobody's until somebody says that it is theirs.
    let rig = json!({"keys": {
        "inertia": "0.01435 kg m^2", "arm": "0.505 m", "mass": "0.11 kg", "centre_of_mass": "0.3 m",
    }});
    let given = running.page("PUT", "/api/campaigns/mine/rig", Some("*"), &rig);
    assert_eq!(given.status, 200, "{}", given.text());
    let mine = fitted(&folder.path().join("mine"), &[]);
    let bench = fitted(&campaign, &[]);
    assert_eq!(mine["failed"], json!([]));
    let k = |outcome: &Value| {
        outcome["impacts"][0]["parameters"]["k"]["value"]
            .as_f64()
            .unwrap()
    };
    assert!(
        (k(&mine) / k(&bench) - 1.0).abs() < 1e-9,
        "{} {}",
        k(&mine),
        k(&bench)
    );
}

/// Curves of a figure, whatever its colours.
fn curves(svg: &str) -> Vec<&str> {
    let parts = svg.split(" points=\"").skip(1);
    parts.filter_map(|part| part.split('"').next()).collect()
}

/// The page shows of drops, taps and compressions what the commands print and draw.
#[test]
fn repeats_figures_and_tables_of_the_command_where_no_impacts_are_fitted() {
    let folder = tempfile::tempdir().unwrap();
    let place = |name: &str| folder.path().join(name);
    let law = "adams-impact(k=\"0.868 N/mm^1.91\", e=1.91, c=\"5.56e-4 N s/mm\", d=\"0.001 mm\")";
    let plate = ["--plate-mass", "0.2 kg", "--plate-stiffness", "645.8 N/mm"];
    let drops = [
        &[
            "drop", "--law", law, "--mass", "4.8 g", "--height", "100 mm", "--drops", "2",
        ][..],
        &plate,
        &["--plate-damping", "0.05247 N s/mm"],
    ]
    .concat();
    let taps = ["tap", "--frequency", "800 Hz", "--quality", "20"];
    let presses = ["compression", "--law", "kuwabara-kono(k=300000, c=20000)"];
    for (name, words, item) in [
        ("drops", &drops[..], "drop-100-2"),
        ("taps", &taps[..], "fruit-2-1"),
        ("presses", &presses[..], "fruit-2-1"),
    ] {
        let (directory, figures) = (place(name), place(&format!("{name}-figures")));
        let directory = directory.to_str().unwrap();
        windfall(&[&["simulate", words[0], directory], &words[1..]].concat()).success();
        let run = windfall(&["fit", directory, "--figures", figures.to_str().unwrap()]).success();
        let printed = String::from_utf8(run.get_output().stdout.clone()).unwrap();
        let running = serve(folder.path(), &[]);
        let get = |query: &str| running.get(&format!("/api/campaigns/{name}/measured{query}"));

        let shown = get(&format!("?item={item}")).json();
        let drawn = std::fs::read_to_string(figures.join(format!("{item}.svg"))).unwrap();
        let svg = shown["figures"][0]["svg"].as_str().unwrap();
        assert!(!curves(svg).is_empty());
        assert_eq!(curves(svg), curves(&drawn));
        assert!(svg.contains("var(--figure-text)"), "{svg}");
        let rows = shown["tables"][0]["rows"].as_array().unwrap();
        assert!(!rows.is_empty());
        for cell in rows.iter().flat_map(|row| row.as_array().unwrap()) {
            let cell = cell.as_str().unwrap();
            assert!(printed.contains(cell), "{cell} is not in\n{printed}");
        }
        assert_eq!(shown["failed"], json!([]));

        let whole = get("").json();
        assert_eq!(whole["figures"], json!([]));
        assert_eq!(get("?item=nobody").status, 422);
    }
    // Impacts have their own views.
    let (other, _) = bench("1");
    let running = serve(other.path(), &[]);
    assert_eq!(running.get("/api/campaigns/bench/measured").status, 422);
}

/// Where no recording can be used any more, the page is told why of each.
#[test]
fn tells_why_every_recording_failed() {
    let (folder, campaign) = bench("2");
    let running = serve(folder.path(), &[]);
    let job = running.work("bench", &json!({"work": "fit"}));
    assert_eq!(job["state"], "done", "{job}");
    for entry in std::fs::read_dir(campaign.join("raw")).unwrap() {
        std::fs::remove_file(entry.unwrap().path()).unwrap();
    }
    let results = running.get("/api/campaigns/bench/results").json();
    assert_eq!(results["pending"], 0, "{results}");
    let failed = results["outcome"]["failed"].as_array().unwrap();
    assert_eq!(failed.len(), 4);
    let message = failed[0]["message"].as_str().unwrap();
    assert!(message.contains("specimen-01-01.csv"), "{message}");
}
