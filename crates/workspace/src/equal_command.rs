//! The command line that does the same as a request.

use windfall_campaign::pipeline::request::FitRequest;
use windfall_files::text::quote::command;

/// The options of a command that fits, as far as the request says them.
pub fn fit_options(request: &FitRequest) -> Vec<String> {
    let mut words = Vec::new();
    let mut add = |option: &str, value: &str| {
        words.extend([option.to_owned(), value.to_owned()]);
    };
    request.laws.iter().for_each(|law| add("--law", law));
    request.free.iter().for_each(|name| add("--free", name));
    if !request.quantities.is_empty() {
        add("--quantities", &request.quantities.join(","));
    }
    let single = [
        ("--weights", &request.weights),
        ("--noise", &request.noise),
        ("--intervals", &request.intervals),
        ("--onset", &request.onset),
        ("--initial-velocity", &request.initial_velocity),
        ("--displacement-offset", &request.displacement_offset),
        ("--end", &request.end),
        ("--group", &request.group),
    ];
    for (option, value) in single {
        if let Some(value) = value {
            add(option, value);
        }
    }
    words
}

/// `windfall WORD … OPTION …`
pub fn command_of_fit(words: &[&str], request: &FitRequest) -> String {
    let options = fit_options(request);
    let options = options.iter().map(String::as_str);
    command(&words.iter().copied().chain(options).collect::<Vec<_>>())
}

/// `windfall population DIR OPTION …`
pub fn command_of_population(shown: &str, request: &FitRequest, covariates: &[String]) -> String {
    let mut words = vec!["population", shown];
    words.extend(covariates.iter().flat_map(|own| ["--covariate", own]));
    command_of_fit(&words, request)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_quotes_what_a_shell_would_take_apart() {
        let request = FitRequest {
            laws: vec!["kuwabara-kono(k=1, c=2)".to_owned()],
            weights: Some("inverse-mean".to_owned()),
            ..FitRequest::default()
        };
        assert_eq!(
            command_of_fit(&["fit", "it's here"], &request),
            r"windfall fit 'it'\''s here' --law 'kuwabara-kono(k=1, c=2)' --weights inverse-mean"
        );
    }
}
