//! What the observations of a fleet say.

use std::collections::{BTreeMap, BTreeSet};

use serde::Serialize;
use simgap_estimate::NORMAL_95;

use crate::course::{Course, course};
use crate::factor::{Division, Explanation, Factor, divisions, factors};
use crate::observe::{Cause, Estimate, Observation, Quantity, is_nominal};
use crate::population::{mean, outlying, population};
use crate::scope::Scope;
use crate::time::days;
use crate::words;

/// Difference of BIC from which a course is told: odds of 20 to 1, and as many more as series are looked at.
const COURSE_GAIN: f64 = 6.0;
/// A cause that is named in so many of the diagnoses that nothing divides is common to all.
const COMMON: f64 = 0.5;
/// A nominal value, or its mean over the fleet, that is off by less than this is no fault of the model file: half of what it states by default.
const LEAST_SHIFT: f64 = 0.01;
/// Standard errors by which the mean over the fleet must be off.
const SHIFTED: f64 = 3.0;
/// A course that so many machines share is the fleet's.
const SHARED: f64 = 0.5;

/// One thing that the fleet says.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Finding {
    /// Whose it is.
    pub scope: Scope,
    /// Catalogue name.
    pub kind: String,
    /// Where it acts, in words.
    pub place: String,
    /// The parameter, where values tell.
    pub parameter: Option<String>,
    /// The levels that it belongs to, by factor: `machine`, `date`, conditions. Several factors where they cannot be told
    /// apart.
    pub levels: BTreeMap<String, Vec<String>>,
    /// Where a value goes over time: the first and the last value.
    pub course: Option<[f64; 2]>,
    /// Dates of steps.
    pub steps: Vec<String>,
    /// One or two sentences.
    pub text: String,
}

/// A value of a machine over time.
#[derive(Debug, Clone)]
pub struct Series {
    /// The machine.
    pub machine: String,
    /// Observations, in the order of their dates.
    pub units: Vec<usize>,
    /// Days, rising.
    pub times: Vec<f64>,
    /// The estimates.
    pub estimates: Vec<Estimate>,
    /// How it goes.
    pub course: Option<Course>,
}

/// Everything that is told.
pub struct Told {
    /// Common first, then machines, conditions, what is undecided.
    pub findings: Vec<Finding>,
    /// Values over time.
    pub series: BTreeMap<Quantity, Vec<Series>>,
    /// Causes that nothing explains, with how often they are named among how many diagnoses.
    pub scattered: Vec<(Cause, [usize; 2])>,
}

/// What the observations say. Failed diagnoses say nothing.
#[must_use]
pub fn told(observations: &[Observation], conditions: &[String]) -> Told {
    let sound = observations.iter().filter(|o| o.failed.is_none());
    let sound: Vec<Observation> = sound.cloned().collect();
    let factors = factors(&sound, conditions);
    let causes: BTreeSet<&Cause> = sound.iter().flat_map(|o| o.named.keys()).collect();
    let mut findings = Vec::new();
    let mut scattered = Vec::new();
    for cause in causes {
        let named: Vec<bool> = sound.iter().map(|o| is_told(o, cause)).collect();
        let (divisions, [rest, count]) = divisions(&named, &factors);
        findings.extend(
            divisions
                .iter()
                .map(|division| of_division(cause, division)),
        );
        let is_most = rest > 0 && count as f64 >= COMMON * rest as f64;
        // Machines of a fleet differ a little, so that a wrong value in most of them need not be one of the model: the mean
        // over the fleet tells.
        if is_most && !is_nominal(&cause.kind) {
            findings.push(common(cause, rest, count));
        } else if count > 0 && !is_most {
            scattered.push((cause.clone(), [rest, count]));
        }
    }
    let series = all_series(&sound);
    let machines: BTreeSet<&str> = sound.iter().map(|o| o.machine.as_str()).collect();
    for (quantity, series) in &series {
        findings.extend(courses(quantity, series, &sound, &factors, machines.len()));
        findings.extend(apart(quantity, series, &factors));
        findings.extend(shifted(quantity, series));
    }
    findings.sort_by_key(|finding| finding.scope as usize);
    Told {
        findings,
        series,
        scattered,
    }
}

/// Whether a diagnosis names a cause that matters: machines of a fleet differ in every nominal value, and a good record sees
/// a tenth of a percent.
fn is_told(observation: &Observation, cause: &Cause) -> bool {
    let mut values = observation.values.iter().filter(|(q, _)| q.cause == *cause);
    observation.named.contains_key(cause)
        && (!is_nominal(&cause.kind) || values.any(|(_, e)| (e.value - 1.0).abs() > LEAST_SHIFT))
}

fn finding(scope: Scope, cause: &Cause, text: String) -> Finding {
    Finding {
        scope,
        kind: cause.kind.clone(),
        place: cause.place.clone(),
        parameter: None,
        levels: BTreeMap::new(),
        course: None,
        steps: vec![],
        text,
    }
}

/// Whose a value is that belongs to a machine, and to levels of other factors where these explain it as well.
fn scope_of(levels: &BTreeMap<String, Vec<String>>) -> Scope {
    match levels.len() {
        1 => Scope::Machine,
        _ => Scope::Undecided,
    }
}

fn common(cause: &Cause, all: usize, count: usize) -> Finding {
    finding(Scope::Common, cause, words::common(cause, all, count))
}

fn of_division(cause: &Cause, division: &Division) -> Finding {
    let all = &division.explanations;
    let levels = all.iter().map(|e| (e.factor.clone(), e.levels.clone()));
    let scope = match &all[..] {
        [Explanation { factor, .. }] if factor == "machine" => Scope::Machine,
        [_] => Scope::Condition,
        // Days and rigs that are alike blame no machine.
        several if several.iter().all(|e| e.factor != "machine") => Scope::Condition,
        _ => Scope::Undecided,
    };
    Finding {
        levels: levels.collect(),
        ..finding(scope, cause, words::division(cause, scope, all))
    }
}

/// The values of each quantity, machine by machine.
fn all_series(observations: &[Observation]) -> BTreeMap<Quantity, Vec<Series>> {
    let dates: Vec<String> = observations.iter().map(|o| o.date.clone()).collect();
    let days = days(&dates);
    let mut found: BTreeMap<Quantity, BTreeMap<&str, Vec<usize>>> = BTreeMap::new();
    for (unit, observation) in observations.iter().enumerate() {
        for quantity in observation.values.keys() {
            let machines = found.entry(quantity.clone()).or_default();
            machines.entry(&observation.machine).or_default().push(unit);
        }
    }
    let count: usize = found.values().map(BTreeMap::len).sum();
    let least_gain = COURSE_GAIN + 2.0 * (count.max(1) as f64).ln();
    let series = found.into_iter().map(|(quantity, machines)| {
        let machines = machines.into_iter().map(|(machine, mut units)| {
            units.sort_by(|a, b| days[*a].total_cmp(&days[*b]).then(a.cmp(b)));
            let times: Vec<f64> = units.iter().map(|&unit| days[unit]).collect();
            let estimates: Vec<Estimate> = units
                .iter()
                .map(|&unit| observations[unit].values[&quantity])
                .collect();
            Series {
                machine: machine.to_owned(),
                course: course(&times, &estimates, least_gain),
                units,
                times,
                estimates,
            }
        });
        (quantity.clone(), machines.collect())
    });
    series.collect()
}

/// Values that change over time: of single machines, or of most of them together.
fn courses(
    quantity: &Quantity,
    series: &[Series],
    observations: &[Observation],
    factors: &[Factor],
    machines: usize,
) -> Vec<Finding> {
    let moving: Vec<&Series> = series.iter().filter(|one| one.course.is_some()).collect();
    if moving.len() > 2 && moving.len() as f64 > SHARED * machines as f64 {
        let all = machines;
        let machines: Vec<String> = moving.iter().map(|one| one.machine.clone()).collect();
        let text = words::shared_course(quantity, machines.len(), all);
        return vec![Finding {
            parameter: Some(quantity.parameter.clone()),
            levels: [("machine".to_owned(), machines)].into(),
            ..finding(Scope::Common, &quantity.cause, text)
        }];
    }
    moving
        .into_iter()
        .filter_map(|one| of_course(quantity, one, observations, factors))
        .collect()
}

fn of_course(
    quantity: &Quantity,
    series: &Series,
    observations: &[Observation],
    factors: &[Factor],
) -> Option<Finding> {
    let course = series.course.as_ref()?;
    let date = |place: usize| observations[series.units[place]].date.clone();
    let last = series.units.len() - 1;
    let mut levels: BTreeMap<String, Vec<String>> =
        [("machine".to_owned(), vec![series.machine.clone()])].into();
    let mut steps = vec![];
    if let Course::Steps { at, .. } = course {
        steps = at.iter().map(|&place| date(place)).collect();
        // A condition that changes with every step of the value explains it as well as the machine does.
        for factor in factors
            .iter()
            .filter(|f| !["machine", "date"].contains(&f.name.as_str()))
        {
            let level = |place: usize| factor.of[series.units[place]];
            let changes = |place: usize| {
                let (before, after) = (level(place - 1), level(place));
                before != after
            };
            if at.iter().all(|&place| changes(place)) {
                let after: BTreeSet<&String> =
                    at.iter().map(|&p| &factor.levels[level(p)]).collect();
                levels.insert(factor.name.clone(), after.into_iter().cloned().collect());
            }
        }
    }
    let dates = [date(0), date(last)];
    let scope = scope_of(&levels);
    let text = words::course(quantity, &series.machine, course, &dates, &steps, &levels);
    Some(Finding {
        parameter: Some(quantity.parameter.clone()),
        levels,
        course: Some(course.ends()),
        steps,
        ..finding(scope, &quantity.cause, text)
    })
}

/// Machines whose value lies apart from that of the others, and what else is apart in them.
fn apart(quantity: &Quantity, series: &[Series], factors: &[Factor]) -> Vec<Finding> {
    // A value that moves has been told; what a machine alone has, has no fleet to lie apart from.
    let still: Vec<&Series> = series.iter().filter(|one| one.course.is_none()).collect();
    let means: Vec<(&Series, Estimate)> = still
        .into_iter()
        .filter_map(|one| mean(&one.estimates).map(|mean| (one, mean)))
        .collect();
    let values: Vec<Estimate> = means.iter().map(|(_, mean)| *mean).collect();
    let out = outlying(&values);
    let is_out = |place: &usize| out.contains(place);
    let rest: Vec<usize> = (0..means.len()).filter(|place| !is_out(place)).collect();
    let of_rest: Vec<Estimate> = rest.iter().map(|&place| values[place]).collect();
    let Some(fleet) = mean(&of_rest) else {
        return vec![];
    };
    let found = out.iter().map(|&place| {
        let (one, own) = &means[place];
        let mut levels: BTreeMap<String, Vec<String>> =
            [("machine".to_owned(), vec![one.machine.clone()])].into();
        for factor in factors.iter().filter(|factor| factor.name != "machine") {
            let level = |unit: &usize| factor.of[*unit];
            let own: BTreeSet<usize> = one.units.iter().map(level).collect();
            let others = rest.iter().flat_map(|&place| &means[place].0.units);
            if !others.clone().any(|unit| own.contains(&level(unit))) {
                let names = own.iter().map(|&level| factor.levels[level].clone());
                levels.insert(factor.name.clone(), names.collect());
            }
        }
        let scope = scope_of(&levels);
        let text = words::apart(quantity, &one.machine, *own, fleet, &levels);
        Finding {
            parameter: Some(quantity.parameter.clone()),
            levels,
            ..finding(scope, &quantity.cause, text)
        }
    });
    found.collect()
}

/// A value of the model file that is off in the mean of the fleet.
fn shifted(quantity: &Quantity, series: &[Series]) -> Option<Finding> {
    if !is_of_the_model(quantity) {
        return None;
    }
    let still = series.iter().filter(|one| one.course.is_none());
    let means: Vec<Estimate> = still.filter_map(|one| mean(&one.estimates)).collect();
    let found = population(&means)?;
    let error = found.mean_std;
    let shift = (found.mean - 1.0).abs();
    (shift > LEAST_SHIFT && shift > SHIFTED * error).then(|| Finding {
        parameter: Some(quantity.parameter.clone()),
        ..finding(
            Scope::Common,
            &quantity.cause,
            words::shifted(quantity, &found, NORMAL_95 * error),
        )
    })
}

/// Whether the values of a quantity are those of the model file, of which every diagnosis may have one.
#[must_use]
pub fn is_of_the_model(quantity: &Quantity) -> bool {
    is_nominal(&quantity.cause.kind)
}
