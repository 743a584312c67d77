//! Who runs a command: a person at a terminal, or a program in whose process it runs.
//!
//! A command says what it finds on the thread that runs it; its other threads only calculate.
//! So what another program hears is kept per thread, and commands may run at once.

use std::cell::RefCell;
use std::ffi::OsString;
use std::ops::ControlFlow;
use std::sync::Arc;
use windfall_files::text::quote::command;

/// Told by any thread how many items of how many are done; its answer says whether the work
/// goes on.
pub type Watch = Arc<dyn Fn(usize, usize) -> ControlFlow<()> + Send + Sync>;

/// What a command has said.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Said {
    /// What would go to standard output.
    pub result: String,
    /// What would go to standard error: a message per line.
    pub messages: String,
}

struct Caller {
    said: Said,
    watch: Watch,
}

thread_local! {
    /// The program that called, if one did.
    static CALLER: RefCell<Option<Caller>> = const { RefCell::new(None) };
}

thread_local! {
    /// The words of the command that runs on this thread, without the name of the program.
    static WORDS: RefCell<Vec<String>> = const { RefCell::new(Vec::new()) };
}

/// From now on, the command on this thread is this one.
///
/// * `words`: the command line, beginning with the name of the program
pub(crate) fn begin(words: &[OsString]) {
    let words = words.iter().skip(1);
    WORDS.set(
        words
            .map(|word| word.to_string_lossy().into_owned())
            .collect(),
    );
}

/// The command on this thread, as it was given.
pub(crate) fn told() -> String {
    WORDS.with_borrow(|words| command(&words.iter().map(String::as_str).collect::<Vec<_>>()))
}

/// Does work for another program.
pub(crate) fn called<T>(watch: Watch, work: impl FnOnce() -> T) -> (T, Said) {
    let caller = Caller {
        said: Said::default(),
        watch,
    };
    let before = CALLER.replace(Some(caller));
    let done = work();
    let caller = CALLER.replace(before);
    (done, caller.map(|own| own.said).unwrap_or_default())
}

/// Takes down what is said, if a program listens.
///
/// * `part`: to which part it belongs
///
/// Returns whether one does.
pub(crate) fn take_down(text: &str, part: impl FnOnce(&mut Said) -> &mut String) -> bool {
    CALLER.with_borrow_mut(|caller| {
        let said = caller.as_mut().map(|own| *part(&mut own.said) += text);
        said.is_some()
    })
}

/// Whether a program called.
pub(crate) fn is_called() -> bool {
    CALLER.with_borrow(Option::is_some)
}

/// Whom a program that called lets watch the work.
pub(crate) fn watch() -> Option<Watch> {
    CALLER.with_borrow(|caller| caller.as_ref().map(|own| Arc::clone(&own.watch)))
}
