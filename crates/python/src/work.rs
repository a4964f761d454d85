//! Long work on a thread of its own, while the interpreter stays free and Ctrl-C is heard.

use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::time::Duration;

use pyo3::prelude::*;
use simgap_diagnose::Cancel;

use crate::error::refused;

/// How often Ctrl-C is looked for.
const LOOK: Duration = Duration::from_millis(50);
/// How long cancelled work may take to end before its caller goes on without it; it ends by itself soon after.
const GRACE: Duration = Duration::from_millis(700);

/// What the thread tells.
enum Told<T> {
    /// A step begins.
    Step(String),
    /// The work is done.
    Done(T),
}

/// How work tells its steps and learns that it is to end.
pub(crate) struct Link<T> {
    sender: Sender<Told<T>>,
    /// Set by Ctrl-C.
    pub(crate) cancel: Cancel,
}

impl<T> Link<T> {
    /// Tells that a step begins.
    pub(crate) fn step(&self, step: &str) {
        // Whoever listened may have gone; the work is cancelled then.
        let _ = self.sender.send(Told::Step(step.to_owned()));
    }
}

/// Does work on a thread of its own. `on_step` is called in the calling thread with the name of each step; what it raises, and
/// Ctrl-C, cancel the work.
pub(crate) fn attended<T: Send + 'static>(
    py: Python<'_>,
    on_step: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(&Link<T>) -> T + Send + 'static,
) -> PyResult<T> {
    let (sender, mut told) = channel();
    let cancel = Cancel::default();
    let link = Link {
        sender,
        cancel: cancel.clone(),
    };
    std::thread::Builder::new()
        .name("simgap".to_owned())
        .spawn(move || {
            let done = work(&link);
            let _ = link.sender.send(Told::Done(done));
        })
        .map_err(|error| refused(&format!("the work could not be started ({error})")))?;
    loop {
        let received = py.detach(move || {
            let received = told.recv_timeout(LOOK);
            (received, told)
        });
        told = received.1;
        let heard = match received.0 {
            Ok(Told::Done(done)) => return Ok(done),
            Ok(Told::Step(step)) => on_step.map_or(Ok(()), |call| call.call1((step,)).map(drop)),
            Err(RecvTimeoutError::Timeout) => Ok(()),
            Err(RecvTimeoutError::Disconnected) => {
                return Err(refused(
                    "a defect of simgap ended the work, needed is a report of it with this input",
                ));
            }
        };
        if let Err(raised) = heard.and_then(|()| py.check_signals()) {
            cancel.cancel();
            py.detach(move || ended(&told));
            return Err(raised);
        }
    }
}

/// Waits until the work has ended, for a while.
fn ended<T>(told: &Receiver<Told<T>>) {
    while let Ok(Told::Step(_)) = told.recv_timeout(GRACE) {}
}
