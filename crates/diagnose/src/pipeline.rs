//! The path from records to an answer.

use rayon::prelude::*;
use simgap_effects::{Placed, catalogue};
use simgap_estimate::{Fit, Problem, Start, Weights, fit, fit_initial_states};
use simgap_model::{Location, Model};
use simgap_record::{Defect, QualityFinding, Record};

use crate::check::{Check, Checked};
use crate::data::{Data, divide, excerpts};
use crate::diagnosis::{CheckSeries, Diagnosis, PlaceMotion, Where};
use crate::difference::{SEEN, is_told_from_none};
use crate::evidence::{independence, is_nominal};
use crate::final_fit::fit_to_all;
use crate::gap::total;
use crate::hypothesis::{Hypothesis, name, remove, sort};
use crate::locate::Located;
use crate::out_of_sight::{add_rivals_out_of_sight, adjusted};
use crate::outcome::{corrected_model, series};
use crate::refuted::is_refuted;
use crate::remainder::{Remainder, remainder};
use crate::search::Search;
use crate::verdict::{Judged, earned, judge, prune, simplest};
use crate::{DiagnoseError, answer, locate, stretches, unexplained, wander};

/// Prior on nominal parameters while they are re-estimated alone: known to a factor of about two.
const RECALIBRATION_PRIOR: f64 = 0.5;
/// A fit of the search stops when a step gains less than this: rivals are told apart by more.
const SEARCH_CONVERGED: f64 = 0.1;
/// Steps of a fit of the search: it stops in a flat valley, a final fit does not.
const SEARCH_STEPS: usize = 10;
/// Sets that are fitted again once the colour of the residual is known.
const FINALISTS: usize = 6;
/// Single effects that are fitted again.
const SINGLES: usize = 12;
/// Swaps with a better rival before the set is taken as it stands.
const MOST_SWAPS: usize = 3;

/// What is asked.
pub struct Request<'a> {
    /// The nominal model.
    pub model: &'a Model,
    /// Records to learn from.
    pub train: &'a [Record],
    /// Records to judge by; empty to hold back the last part of each training record.
    pub check: &'a [Record],
    /// Kinds to take out of the catalogue.
    pub withheld: &'a [String],
}

/// Told what is being done; called in order from the calling thread's pool.
pub type Progress<'a> = &'a (dyn Fn(&str) + Sync);

/// What comes out.
pub struct Outcome {
    /// The answer.
    pub diagnosis: Diagnosis,
    /// The model with recalibrated parameters and the named effects.
    pub corrected: Model,
    /// Predictions of the check records.
    pub series: Vec<CheckSeries>,
    /// The motion across each member along the check records.
    pub motions: Vec<PlaceMotion>,
}

/// The best set found, as judged in the search, and what it is compared with.
pub(crate) struct Answer {
    pub(crate) set: Hypothesis,
    /// The same set fitted to all training samples.
    pub(crate) estimate: Fit,
    /// What it was fitted with.
    pub(crate) weights: Weights,
    pub(crate) judged: Vec<Judged>,
    /// What the set leaves.
    pub(crate) remainder: Remainder,
    /// Single effects, best first.
    pub(crate) singles: Vec<Hypothesis>,
    /// What the first of them leave of the check records.
    pub(crate) held_back: Vec<f64>,
    /// Without any effect, nominal parameters as given.
    pub(crate) nominal: Fit,
    /// Whether the set leaves nothing but noise of the check records where it starts anew in every stretch.
    pub(crate) follows_anew: bool,
}

impl Answer {
    /// Everything that is put on the nominal model.
    pub(crate) fn placed(&self) -> Vec<Placed> {
        self.estimate.estimate.placed().cloned().collect()
    }

    /// The effects that are named.
    pub(crate) fn named(&self) -> impl Iterator<Item = &Placed> {
        self.judged.iter().map(|judged| &judged.placed)
    }

    pub(crate) fn names_more_than_parameters(&self) -> bool {
        !self.named().all(is_nominal)
    }
}

/// Diagnoses the gap between a model and records.
///
/// The result depends on the model, the records and the withheld kinds alone, not on the number
/// of threads of the pool it runs in.
///
/// # Errors
/// [`DiagnoseError`] when the records do not fit the model or the model cannot be simulated.
pub fn diagnose(request: &Request<'_>, progress: Progress<'_>) -> Result<Outcome, DiagnoseError> {
    for kind in request.withheld {
        if catalogue().iter().all(|effect| effect.kind() != kind) {
            return Err(DiagnoseError::UnknownKind {
                found: kind.clone(),
                known: catalogue()
                    .iter()
                    .map(|e| e.kind())
                    .collect::<Vec<_>>()
                    .join(", "),
            });
        }
    }
    let data = divide(request.model, request.train, request.check)?;
    let mut train = Problem::new(request.model, data.train.clone())?;
    let plain = Weights::independent(request.model.outputs.len());

    progress("nominal model");
    let mut nominal = fit_initial_states(&train, &[], &plain)?;
    if let Some(whitening) = wander::whitening(&train, &data.check, &nominal, &plain)? {
        train.whitening = whitening;
        nominal = fit_initial_states(&train, &[], &plain)?;
    }
    let recalibrated = recalibrate(request, &train, &nominal, &plain)?;
    let fits = (&nominal, &recalibrated);
    let mut answer = search(request, &train, fits, Scope::Everything, progress)?;

    progress("check records");
    let check = Check::new(&train, &recalibrated, data.check.clone())?;
    let mut placed = answer.placed();
    let mut checked = check.of(&answer, &placed)?;
    // A law that fails on the check records, or another motion of the same law?
    let fails = is_refuted(&checked.judged)
        || unexplained::leaves_much(&checked.judged)
        || unexplained::is_poor_stand_in(&answer, &checked.judged);
    let anew = match unexplained::has_force(&answer) && fails {
        true => check.followed_anew(&placed),
        false => None,
    };
    answer.follows_anew = anew.is_some();
    if is_refuted(&checked.judged) && answer.names_more_than_parameters() && !answer.follows_anew {
        // On records it was not fitted to, the set is worse than parameters alone.
        let singles = std::mem::take(&mut answer.singles);
        answer = search(request, &train, fits, Scope::Parameters, progress)?;
        answer.singles = singles;
        placed = answer.placed();
        checked = check.of(&answer, &placed)?;
    }
    let (note, known) = (check.note(), &recalibrated.estimate.nominal);
    let Checked {
        predictions,
        gap,
        judged,
    } = checked;
    let [told, by_judgement] = check.held_back(&answer.singles)?;
    answer.held_back = by_judgement;
    let mut verdict = answer::verdict(&train, &answer, &judged);
    let left_unknown = verdict.status == crate::Status::Unknown;
    let (gap, placed, shown) = if left_unknown {
        // Blame nothing: the corrected model is the recalibrated one, or the one as given where that predicts better.
        verdict.effects.clear();
        let shown = usize::from(total(&predictions[1].nrmse) < total(&predictions[0].nrmse));
        let kept = [&vec![], known][shown].clone();
        (check.gap(&kept, &predictions, shown)?, kept, shown)
    } else {
        (gap, placed, 2)
    };
    answer.held_back = told;
    let candidates = answer::candidates(&answer, &verdict);
    let floors: Vec<f64> = gap.channels.iter().map(|c| c.noise_floor).collect();
    let check = &check.problem;
    let located = Located::new(check, &predictions[0], &floors);
    let motions = locate::motions(check, &predictions[0], &locate_places(request.model))?;
    let r#where = Where {
        channels: locate::channels(&located),
        locations: answer::locations(&answer, left_unknown),
        bands: locate::bands(&located),
        times: locate::times(&located),
        states: locate::states(&located, &motions),
        records: locate::records(&located),
    };
    let mut notes = notes(request, &data);
    notes.splice(0..0, note);
    if let Some(anew) = anew.filter(|_| !left_unknown) {
        notes.insert(0, stretches::told(&anew));
    }
    if shown == 0 {
        let worse = "re-estimated parameters predict the check records worse: the corrected model is the model as given";
        notes.insert(0, worse.into());
    }
    if located.is_hidden {
        let hidden = "the gap hardly stands out of the noise: where it lies is where the noise is";
        notes.insert(0, hidden.into());
    }
    Ok(Outcome {
        diagnosis: Diagnosis {
            schema: "simgap-diagnosis/1",
            model: request.model.name.clone(),
            gap,
            r#where,
            next_experiment: answer::next_experiment(&verdict),
            verdict,
            remainder: answer.remainder.told(),
            candidates,
            notes,
        },
        corrected: corrected_model(request.model, &placed),
        series: series(check, &data, &predictions[0], &predictions[shown])?,
        motions,
    })
}

/// Re-estimates the nominal parameters, no effect added.
fn recalibrate(
    request: &Request<'_>,
    train: &Problem,
    nominal: &Fit,
    weights: &Weights,
) -> Result<Fit, DiagnoseError> {
    let start = Start {
        effects: vec![],
        nominal: nominal_parameters(request, train),
        initial: nominal.estimate.initial.clone(),
    };
    let loose = Weights {
        nominal_prior: RECALIBRATION_PRIOR,
        ..weights.clone()
    };
    Ok(fit(train, &start, &loose)?)
}

/// Every nominal parameter at its nominal value, but those of withheld kinds.
fn nominal_parameters(request: &Request<'_>, problem: &Problem) -> Vec<Placed> {
    let withheld = |kind: &str| request.withheld.iter().any(|known| known == kind);
    problem
        .nominal_parameters()
        .into_iter()
        .filter(|candidate| !withheld(candidate.effect.kind()))
        .map(|candidate| {
            Placed::new(
                candidate.effect,
                candidate.at,
                vec![1.0; candidate.effect.parameters().len()],
            )
        })
        .collect()
}

/// What is sought.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Scope {
    /// Sets of effects of every kind.
    Everything,
    /// Nominal parameters alone.
    Parameters,
}

fn search(
    request: &Request<'_>,
    train: &Problem,
    (nominal, recalibrated): (&Fit, &Fit),
    scope: Scope,
    progress: Progress<'_>,
) -> Result<Answer, DiagnoseError> {
    let channels = request.model.outputs.len();
    let colour = |fit: &Fit| Weights {
        independence: independence(fit, channels),
        converged: SEARCH_CONVERGED,
        keep_nuisance: true,
        most_steps: SEARCH_STEPS,
        ..Weights::independent(channels)
    };
    let short = train.with_runs(excerpts(&train.runs));
    let plain = Weights::independent(channels);
    let first = Start {
        effects: vec![],
        nominal: nominal_parameters(request, &short),
        initial: fit_initial_states(&short, &[], &plain)?.estimate.initial,
    };
    // The search, with the colour of the discrepancy as known before it.
    let weights = colour(recalibrated);
    let baseline = fit(&short, &first, &weights)?;
    let mut search = Search::new(
        &short,
        weights,
        [nominal, recalibrated, &baseline],
        request.withheld,
    )?;
    let (base, pool) = match scope {
        Scope::Everything => search.run_weighed(&first, colour, progress)?,
        Scope::Parameters => (search.fit(&first)?, vec![]),
    };

    // The finalists, with the colour of the best one's residual.
    progress("finalists");
    // A set shows what its name says under the weights that it was fitted with.
    let shown = pool.iter().filter(|set| search.shows(set));
    let shown: Vec<Hypothesis> = shown.take(FINALISTS).cloned().collect();
    search.reweigh(colour(&pool.first().unwrap_or(&base).fit));
    let again = |sets: &[Hypothesis]| -> Result<Vec<Hypothesis>, DiagnoseError> {
        let mut sets = sets
            .par_iter()
            .map(|set| search.fit(&set.fit.estimate))
            .collect::<Result<Vec<_>, _>>()?;
        sort(&mut sets);
        Ok(sets)
    };
    let finalists = again(&shown)?.into_par_iter();
    let finalists: Vec<Hypothesis> = finalists.filter(|set| search.shows(set)).collect();
    let singles: Vec<Hypothesis> = pool
        .into_iter()
        .filter(|set| set.effects().len() == 1)
        .take(SINGLES)
        .collect();
    let singles = again(&singles)?;

    progress("verdict");
    let best = simplest(&search, finalists, &singles).unwrap_or(base);
    let earned_by =
        |set, is_answer: fn(&Hypothesis) -> bool| earned(&search, set, MOST_SWAPS, is_answer);
    let answer = earned_by(best, |set| !set.effects().is_empty())?;
    let (mut set, mut judged) = if let Some(answer) = answer {
        answer
    } else {
        // Nothing beyond small errors of the nominal parameters: which of them are seen, when the
        // others are held exactly?
        progress("exact parameters");
        let parameters = search.of_parameters();
        let exact = parameters.fit(&Start {
            nominal: vec![],
            ..first.clone()
        })?;
        let best = parameters.run(&exact, &|_| {})?.into_iter().next();
        let seen = prune(&parameters, best.unwrap_or(exact))?;
        judge(&parameters, seen, MOST_SWAPS)?
    };
    let mut start = set.fit.estimate.clone();
    let remainder = if start.nominal.is_empty() {
        // Held exactly while the cause was sought; the answer adjusts them again.
        let nominal = nominal_parameters(request, train);
        let settled = search.fit(&adjusted(&start, &nominal))?;
        start = settled.fit.estimate.clone();
        let mut left = &settled;
        if scope == Scope::Everything {
            let sets = [&set, &settled];
            let better = add_rivals_out_of_sight(&search, sets, &nominal, &mut judged)?;
            let late = better.map(|set| earned_by(set, |set| !set.is_of_parameters()));
            if let Some(answer) = late.transpose()?.flatten() {
                // Found from where the parameters are known, it earns its place after all.
                (set, judged) = answer;
                start = set.fit.estimate.clone();
                left = &set;
            }
        }
        remainder(&search, left)?
    } else {
        remainder(&search, &set)?
    };

    // The answer, on all samples.
    progress("final fit");
    let weights = Weights {
        converged: plain.converged,
        keep_nuisance: false,
        most_steps: plain.most_steps,
        ..search.weights.clone()
    };
    let as_given = &nominal.estimate.initial;
    let mut estimate = fit_to_all(train, &short, &start, as_given, &weights)?;
    // What the search saw on its excerpt, all samples may not tell from nothing.
    while let Some(i) = first_unseen(&estimate, &judged) {
        judged.remove(i);
        set = search.fit(&remove(&set.fit.estimate, i))?;
        estimate = fit(train, &remove(&estimate.estimate, i), &weights)?;
    }
    Ok(Answer {
        set,
        estimate,
        weights,
        judged,
        remainder,
        singles,
        held_back: vec![],
        nominal: nominal.clone(),
        follows_anew: false,
    })
}

/// The first named effect that is no nominal parameter and whose size cannot be told from none.
fn first_unseen(estimate: &Fit, judged: &[Judged]) -> Option<usize> {
    let mut named = judged.iter().zip(&estimate.intervals);
    named.position(|(judged, intervals)| {
        !is_nominal(&judged.placed)
            && judged.relevance <= SEEN
            && !is_told_from_none(&judged.placed, intervals)
    })
}

fn locate_places(model: &Model) -> Vec<Location> {
    simgap_effects::sites(model, simgap_effects::SiteKind::Member)
}

fn notes(request: &Request<'_>, data: &Data) -> Vec<String> {
    let mut notes = data.notes.clone();
    for record in request.train.iter().chain(request.check) {
        for finding in simgap_record::quality(record)
            .into_iter()
            .filter(worth_a_note)
        {
            notes.push(format!("{}: {finding}", record.name()));
        }
    }
    notes
}

/// A lattice of more steps than this is how numbers are printed, not what a converter does.
const FINE_LATTICE: usize = 4096;

fn worth_a_note(finding: &QualityFinding) -> bool {
    !matches!(finding.defect, Defect::Quantised { levels, .. } if levels > FINE_LATTICE)
}

/// Names of a set, for messages.
pub(crate) fn names(effects: &[Placed]) -> String {
    effects.iter().map(name).collect::<Vec<_>>().join(", ")
}
