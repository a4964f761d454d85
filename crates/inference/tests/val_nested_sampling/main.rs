//! ln Z of the core against nested sampling.
//!
//! The likelihood and the priors are those that the page on inference states; the likelihood is evaluated by simulation at every point, and
//! no quadratic is used. The tables are shown on that page.
//!
//! Reference: \[Skilling2006\].
#![allow(clippy::unwrap_used, clippy::print_stdout)]

mod cases;
mod closed_form;
mod importance;
mod integrand;
mod known;
mod prior;
mod random;
mod sampler;

use std::f64::consts::TAU;
use std::fmt::Write;

use simgap_effects::{Placed, SiteScale};
use simgap_estimate::{FitOptions, Problem, Start, fit, fit_initial_states};
use simgap_inference::{Budget, CandidateModel, ModelSpace, NoiseModel, Search, add};

use crate::cases::{Case, beyond_a_quadratic, cases, of_many_peaks};
use crate::importance::{Weighted, importance_sampling};
use crate::integrand::{Draws, Integrand};
use crate::sampler::{Found, Settings, nested_sampling};

/// ln Z is known as well as this: a factor of 1.6 on a probability changes no answer.
const CLOSE: f64 = 0.5;
/// With the closed forms of `closed_form` it is known as well as this, where a peak is near a normal one.
const CORRECTED: f64 = 0.1;
/// The statistical error of nested sampling stays below this, so that [`CLOSE`] is three of them.
const MOST_ERROR: f64 = 0.17;
/// Points that live.
const LIVE: usize = 600;
/// The same where each costs much, and where points begin far from the fit.
const FEWER: usize = 300;
const MORE: usize = 1200;
/// Draws of importance sampling.
const DRAWS: usize = 10_000;

/// A case with the core's answer.
struct Solved {
    problem: Problem,
    space: ModelSpace,
    noise: NoiseModel,
    options: FitOptions,
    set: CandidateModel,
}

impl Solved {
    /// As a diagnosis does it: a noise model with the colour of what the set leaves, and a fit of the search.
    fn new(case: &Case) -> Solved {
        Solved::of(case, FitOptions::clone)
    }

    /// The same where all that is left counts as noise.
    fn of_noise(case: &Case) -> Solved {
        Solved::of(case, |options| FitOptions {
            discrepancy: None,
            ..options.clone()
        })
    }

    fn of(case: &Case, counted: impl Fn(&FitOptions) -> FitOptions) -> Solved {
        let mut problem = Problem::new(&case.model, case.runs.clone()).unwrap();
        problem.leaves_out_ends = true;
        let white = FitOptions::white(case.model.outputs.len());
        let nominal = problem.nominal_parameters().into_iter();
        let nominal = nominal.filter(|candidate| case.nominal.contains(&candidate.effect.kind()));
        let states = fit_initial_states(&problem, &[], &white).unwrap();
        let nothing = Start {
            effects: vec![],
            nominal: nominal
                .map(|c| Placed::new(c.effect, c.at, vec![1.0]))
                .collect(),
            initial: states.estimate.initial,
        };
        let baseline = fit(&problem, &nothing, &white).unwrap();
        let noise = NoiseModel::new(&problem, &baseline, &baseline).unwrap();
        let space = ModelSpace::new(&problem, &baseline, &[]).unwrap();
        space.put_priors(&mut problem);
        let budget = Budget {
            progress: &|_| {},
            is_spent: &|| false,
        };
        let effects = case.effects.iter().cloned();
        let start = effects.fold(nothing, |start, effect| add(&start, effect));
        let mut search = Search::new(
            &problem,
            &noise,
            space.clone(),
            &problem.output_std(),
            budget,
        );
        let first = search.fit(&start).unwrap();
        let noise = noise
            .with_colour_of(&first.fit)
            .with_noise(&search.noise_of(&first));
        search.options = counted(&noise.search_options());
        let set = search.fit(&first.fit.estimate).unwrap();
        let options = search.options.clone();
        Solved {
            problem,
            space,
            noise,
            options,
            set,
        }
    }

    /// What is done with the integrand of the set.
    fn with<T>(&self, draws: Draws, done: impl FnOnce(&Integrand<'_>) -> T) -> T {
        let scale_at = |placed: &Placed| -> SiteScale { self.space.scale_at(&placed.at).unwrap() };
        done(&Integrand::new(
            &self.problem,
            &self.options,
            &self.set,
            &scale_at,
            draws,
        ))
    }

    /// The same set fitted to the end from another start, if ln Z is finite there.
    fn again(&self, start: &Start) -> Option<Solved> {
        let budget = Budget {
            progress: &|_| {},
            is_spent: &|| false,
        };
        let gap = self.problem.output_std();
        let mut search = Search::new(&self.problem, &self.noise, self.space.clone(), &gap, budget);
        search.options = self.noise.final_options();
        let set = search.fit(start).ok()?;
        let mut problem = self.problem.with_runs(self.problem.runs.clone());
        problem.leaves_out_ends = true;
        set.log_marginal_likelihood.is_finite().then(|| Solved {
            problem,
            space: self.space.clone(),
            noise: self.noise.clone(),
            options: self.options.clone(),
            set,
        })
    }

    /// Whether another fit lies within three standard deviations of this one.
    fn is_same_peak(&self, other: &Solved) -> bool {
        let there = other.with(Draws::AboutEstimate, |integrand| integrand.estimates());
        self.with(Draws::AboutEstimate, |integrand| {
            integrand.apart_from(&there) < 9.0
        })
    }

    fn log_z(&self) -> f64 {
        self.set.log_marginal_likelihood
    }
}

fn sampled(integrand: &Integrand<'_>, live: usize) -> Found {
    let mut likelihood = |points: &[Vec<f64>]| integrand.log_likelihood(points);
    let settings = Settings {
        live,
        seed: 1,
        walks: false,
    };
    nested_sampling(integrand.dim(), &mut likelihood, &settings)
}

/// The likelihood that is sampled is that of the fit, and (1) of `closed_form` that of the core.
fn assert_is_that_of_the_core(solved: &Solved, integrand: &Integrand<'_>, name: &str) {
    let (sampled, fitted) = (integrand.at_estimate(), -solved.set.fit.misfit);
    assert!(
        (sampled - fitted).abs() < 1e-6,
        "{name}: {sampled} sampled, {fitted} fitted"
    );
    let closed = closed_form::of_the_core(integrand);
    assert!(
        (closed - solved.log_z()).abs() < 1e-6,
        "{name}: {closed} in closed form"
    );
}

#[test]
fn val_nested_sampling_of_ten_sets() {
    let mut table = String::from(
        "| Set | Dimensions | ln Z, core | nested sampling | error | core − nested | core − weighted draws | effective share of draws |\n\
         |---|---|---|---|---|---|---|---|\n",
    );
    let mut apart = vec![];
    for case in cases() {
        let solved = Solved::new(&case);
        let line = solved.with(Draws::AboutEstimate, |integrand| {
            assert_is_that_of_the_core(&solved, integrand, case.name);
            let found = sampled(integrand, LIVE);
            let weighted = importance_sampling(integrand, DRAWS, 3);
            assert!(
                found.error < MOST_ERROR,
                "{}: error {}",
                case.name,
                found.error
            );
            if case.model.outputs.len() == 1 {
                let corrected = closed_form::corrected(integrand) - weighted.log_z;
                let most = CORRECTED + 3.0 * weighted.error;
                assert!(
                    corrected.abs() < most,
                    "{}: corrected {corrected}",
                    case.name
                );
            }
            let difference = solved.log_z() - found.log_z;
            apart.push((case.name, difference));
            format!(
                "| {} | {} | {:.2} | {:.2} | {:.2} | {difference:+.2} | {} |",
                case.name,
                integrand.dim(),
                solved.log_z(),
                found.log_z,
                found.error,
                shown(&solved, &weighted)
            )
        });
        writeln!(table, "{line}").unwrap();
    }
    for (name, difference) in apart {
        assert!(difference.abs() < CLOSE, "{name}: {difference}\n{table}");
    }
    insta::assert_snapshot!("ten_sets", table);
}

fn shown(solved: &Solved, weighted: &Weighted) -> String {
    let difference = solved.log_z() - weighted.log_z;
    format!(
        "{difference:+.2} ± {:.2} | {:.2}",
        weighted.error, weighted.efficiency
    )
}

/// Where the core is off by more than [`CLOSE`], or by more than in the ten sets, for reasons that a closed form takes into account.
#[test]
fn val_nested_sampling_beyond_a_quadratic() {
    let mut table = String::from(
        "| Set | ln Z, core | nested sampling | error | core − nested | corrected − nested | corrected − weighted draws |\n\
         |---|---|---|---|---|---|---|\n",
    );
    let mut apart = vec![];
    for case in beyond_a_quadratic() {
        let solved = Solved::of_noise(&case);
        let line = solved.with(Draws::AboutEstimate, |integrand| {
            assert_is_that_of_the_core(&solved, integrand, case.name);
            let found = sampled(integrand, LIVE);
            let weighted = importance_sampling(integrand, DRAWS, 3);
            let corrected = closed_form::corrected(integrand);
            apart.push((case.name, corrected - found.log_z));
            format!(
                "| {} | {:.2} | {:.2} | {:.2} | {:+.2} | {:+.2} | {:+.2} ± {:.2} |",
                case.name,
                solved.log_z(),
                found.log_z,
                found.error,
                solved.log_z() - found.log_z,
                corrected - found.log_z,
                corrected - weighted.log_z,
                weighted.error,
            )
        });
        writeln!(table, "{line}").unwrap();
    }
    for (name, difference) in apart {
        assert!(difference.abs() < CLOSE, "{name}: {difference}\n{table}");
    }
    insta::assert_snapshot!("beyond_a_quadratic", table);
}

/// The ten sets with every value but the initial states drawn from its prior: no peak far from the estimate is missed.
#[test]
#[ignore = "takes ten minutes"]
fn val_nested_sampling_of_ten_sets_from_their_priors() {
    let mut apart = vec![];
    for case in cases() {
        let solved = Solved::new(&case);
        let found = solved.with(Draws::FromPrior, |integrand| sampled(integrand, MORE));
        let difference = solved.log_z() - found.log_z;
        println!("{}: {difference:+.2}, error {:.2}", case.name, found.error);
        apart.push((case.name, difference));
    }
    for (name, difference) in apart {
        assert!(difference.abs() < CLOSE, "{name}: {difference}");
    }
}

/// Where a set has many peaks, the core takes the highest.
#[test]
#[ignore = "takes minutes"]
fn val_nested_sampling_of_many_peaks() {
    let mut table = String::from(
        "| Set | peaks found | ln Z, highest peak | sum of the peaks | nested sampling | error |\n|---|---|---|---|---|---|\n",
    );
    for case in of_many_peaks() {
        let peaks = peaks(&case);
        let highest = &peaks[0];
        let sum: f64 = peaks
            .iter()
            .map(|peak| (peak.log_z() - highest.log_z()).exp())
            .sum();
        let sum = highest.log_z() + sum.ln();
        let found = highest.with(Draws::FromPrior, |integrand| sampled(integrand, FEWER));
        let line = format!(
            "| {} | {} | {:.2} | {sum:.2} | {:.2} | {:.2} |",
            case.name,
            peaks.len(),
            highest.log_z(),
            found.log_z,
            found.error
        );
        println!("{line}");
        assert!(highest.log_z() - found.log_z < CLOSE, "{line}");
        writeln!(table, "{line}").unwrap();
    }
    insta::assert_snapshot!("many_peaks", table);
}

/// What fits from the starts of the first effect of a case end at, each peak once, the highest first.
fn peaks(case: &Case) -> Vec<Solved> {
    let first = Solved::new(case);
    let placed = &first.set.effects()[0];
    let scale = first.space.scale_at(&placed.at).unwrap();
    let mut starts = placed.effect.starts(&scale);
    if let Some(clock) = placed.effect.clock() {
        // Every line of the record up to a quarter of the sample rate, from three phases.
        let lines = 1..(0.25 * scale.duration_s / scale.time_step_s) as usize;
        starts.extend(lines.flat_map(|line| {
            (0..3).map(move |third| {
                let mut values = placed.values.clone();
                values[clock.frequency] = line as f64 / scale.duration_s;
                values[clock.phase] = TAU / 3.0 * f64::from(third);
                values
            })
        }));
    }
    let mut found: Vec<Solved> = vec![];
    let starts = starts.into_iter().map(|values| {
        let mut start = first.set.fit.estimate.clone();
        start.effects[0] = Placed::new(placed.effect, placed.at.clone(), values);
        start
    });
    let mut fits: Vec<Solved> = starts.filter_map(|start| first.again(&start)).collect();
    fits.sort_by(|a, b| b.log_z().total_cmp(&a.log_z()));
    for solved in fits {
        if found.iter().all(|known| !known.is_same_peak(&solved)) {
            found.push(solved);
        }
    }
    found
}
