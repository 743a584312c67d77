//! A recording as CSV → parameters of a law, with their 95 % intervals.
#![allow(clippy::print_stdout)]
use windfall::prelude::*;

fn main() -> Result<(), Error> {
    let file = std::env::args().nth(1).unwrap_or("impact.csv".into());
    let channels = ["force=force_V:11 mV/N", "position=position_V:100 V/m"];
    let recording = RecordingRequest {
        rig: "carriage".into(),
        mass: Some("0.2 kg".into()),
        sampling_rate: Some("20 kHz".into()),
        channels: channels.map(String::from).into(),
        ..RecordingRequest::default()
    };
    let request = FitRequest {
        laws: vec!["kuwabara-kono".into()],
        ..FitRequest::default()
    };
    let outcome = fit_recording(file.as_ref(), &recording, &request, &quiet)?;
    for (name, found) in &outcome.impacts[0].parameters.0 {
        let (low, high) = found.interval().unwrap_or((f64::NAN, f64::NAN));
        println!("{name} = {} {}, {low} to {high}", found.value, found.unit);
    }
    Ok(())
}
