//! A simulator of the user's with its last answers: the same is asked again and again.

use std::collections::{HashMap, HashSet};
use std::sync::{Arc, Condvar, Mutex, PoisonError};

use crate::plant::{Key, Plant, PlantError, PlantRun};
use crate::response::{Answer, Response};

/// Numbers of answers that are kept: 64 MiB.
const KEPT_NUMBERS: usize = 8 << 20;
/// Runs whose responses to forces are kept.
const KEPT_RESPONSES: usize = 64;

/// A simulator of the user's with its last answers.
pub struct ExternalPlant {
    plant: Box<dyn Plant>,
    answers: Mutex<Answers>,
    /// Tells those that wait for an answer that one has come.
    answered: Condvar,
    responses: Mutex<Vec<(Key, Arc<Response>)>>,
}

#[derive(Default)]
struct Answers {
    known: HashMap<Key, (u64, Answer)>,
    /// Questions that somebody has asked and that are not answered yet.
    under_way: HashSet<Key>,
    numbers: usize,
    /// Counts the questions.
    clock: u64,
}

impl ExternalPlant {
    /// Wraps a simulator.
    #[must_use]
    pub fn new(plant: impl Plant + 'static) -> Arc<ExternalPlant> {
        Arc::new(ExternalPlant {
            plant: Box::new(plant),
            answers: Mutex::default(),
            answered: Condvar::new(),
            responses: Mutex::default(),
        })
    }

    /// The checked answer, from memory where the same was asked before; where another thread asks it now, its answer.
    pub(crate) fn ask(&self, run: &PlantRun<'_>) -> Result<Answer, PlantError> {
        let key = run.key();
        let mut answers = lock(&self.answers);
        loop {
            if let Some(known) = answers.find(key) {
                return Ok(known);
            }
            if answers.under_way.insert(key) {
                break;
            }
            let woken = self.answered.wait(answers);
            answers = woken.unwrap_or_else(PoisonError::into_inner);
        }
        drop(answers);
        let _turn = Turn { of: self, key };
        let signals = self.plant.simulate(run)?;
        run.check(&signals)?;
        let answer = Arc::new(signals);
        lock(&self.answers).keep(key, &answer);
        Ok(answer)
    }

    /// The response to forces about a run without any, measured once.
    pub(crate) fn response(
        &self,
        run: &PlantRun<'_>,
        ports: &[[usize; 2]],
    ) -> Result<Arc<Response>, PlantError> {
        let key = run.key();
        if let Some((_, known)) = lock(&self.responses).iter().find(|(of, _)| *of == key) {
            return Ok(Arc::clone(known));
        }
        let response = Arc::new(Response::measure(&|run| self.ask(run), run, ports)?);
        let mut responses = lock(&self.responses);
        if responses.len() >= KEPT_RESPONSES {
            responses.remove(0);
        }
        responses.push((key, Arc::clone(&response)));
        Ok(response)
    }
}

/// A question under way, until it is answered or refused.
struct Turn<'a> {
    of: &'a ExternalPlant,
    key: Key,
}

impl Drop for Turn<'_> {
    fn drop(&mut self) {
        lock(&self.of.answers).under_way.remove(&self.key);
        self.of.answered.notify_all();
    }
}

/// A lock that a panic elsewhere does not take away: what is behind it is whole at any time.
pub(crate) fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Answers {
    fn find(&mut self, key: Key) -> Option<Answer> {
        self.clock += 1;
        let (used, answer) = self.known.get_mut(&key)?;
        *used = self.clock;
        Some(Arc::clone(answer))
    }

    /// Keeps an answer; those that were not asked for longest make room.
    fn keep(&mut self, key: Key, answer: &Answer) {
        let size = |answer: &Answer| answer.iter().map(Vec::len).sum::<usize>();
        self.numbers += size(answer);
        if let Some((_, before)) = self.known.insert(key, (self.clock, Arc::clone(answer))) {
            self.numbers -= size(&before);
        }
        while self.numbers > KEPT_NUMBERS {
            let Some(oldest) = self
                .known
                .iter()
                .min_by_key(|(key, (used, _))| (*used, **key))
            else {
                return;
            };
            let oldest = *oldest.0;
            if let Some((_, gone)) = self.known.remove(&oldest) {
                self.numbers -= size(&gone);
            }
        }
    }
}
