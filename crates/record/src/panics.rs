//! Panics of other crates, caught without a word.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::sync::Once;

thread_local! {
    /// Whether a panic of this thread is caught and told in our own words.
    static CAUGHT: Cell<bool> = const { Cell::new(false) };
}

/// Calls code of another crate that may panic on damaged input: `None` where it does, and nothing is printed.
///
/// ```
/// assert_eq!(simgap_record::without_panic(|| 7), Some(7));
/// ```
pub fn without_panic<T>(read: impl FnOnce() -> T) -> Option<T> {
    static HUSHED: Once = Once::new();
    HUSHED.call_once(|| {
        let print = take_hook();
        set_hook(Box::new(move |panic| {
            if !CAUGHT.get() {
                print(panic);
            }
        }));
    });
    let outer = CAUGHT.replace(true);
    let read = catch_unwind(AssertUnwindSafe(read));
    CAUGHT.set(outer);
    read.ok()
}
