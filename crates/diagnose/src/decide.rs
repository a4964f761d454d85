//! What is answered, from the posterior over sets and from nothing else.

use simgap_effects::Placed;
use simgap_estimate::Start;
use simgap_inference::{
    CandidateModel, EffectPosterior, Gap, LIKELIER_THAN_NOT, ModelPosterior, Other, RELEVANT_SHARE,
    Search, is_nominal, model_posterior, name, other,
};

use crate::prepared::Prepared;
use crate::{DiagnoseError, Status};

/// What the training records say.
pub(crate) struct Decision {
    pub(crate) status: Status,
    /// The sets that hold an effect of any kind, or none.
    pub(crate) posterior: ModelPosterior,
    /// The effects of the best set.
    pub(crate) effects: Vec<EffectPosterior>,
    /// The law that the catalogue may lack.
    pub(crate) other: Other,
    /// Noise in what the best set leaves, mean square of each channel.
    pub(crate) noise: Vec<f64>,
    /// What the model as given leaves above the noise, share of the motion, mean square, summed over the channels.
    to_explain: f64,
    /// Where the final fit starts.
    start: Start,
}

impl Decision {
    /// Where the final fit starts: the best set; for `unknown` the free law where that leaves less than re-estimated parameters.
    pub(crate) fn start(&self) -> &Start {
        &self.start
    }

    /// Nothing is named; a free law may stand for the cause, or else the set without effects.
    fn say_unknown(&mut self, base: &CandidateModel) {
        self.status = Status::Unknown;
        let law = self.other.law.as_ref();
        self.start = law.map_or(&base.fit, |law| &law.fit).estimate.clone();
    }

    /// The places of the effects as they are told: what the model lacks comes before parameters of it that are off besides, unless it
    /// closes no share of the gap that counts; then what explains most.
    pub(crate) fn order(&self) -> Vec<usize> {
        let least = RELEVANT_SHARE.powi(2) * self.to_explain;
        let rank = |effect: &EffectPosterior| {
            let is_besides = is_nominal(&effect.placed);
            (!is_besides && effect.explains < least, is_besides)
        };
        let mut order: Vec<usize> = (0..self.effects.len()).collect();
        order.sort_by(|&i, &j| {
            let [one, other] = [i, j].map(|k| &self.effects[k]);
            let by_rank = rank(one).cmp(&rank(other));
            by_rank.then(other.explains.total_cmp(&one.explains))
        });
        order
    }
}

/// Decides between the sets of a pool. `first` holds no effect and every nominal parameter at its value.
pub(crate) fn decide(
    search: &Search<'_>,
    pool: Vec<CandidateModel>,
    first: &Start,
    prepared: &Prepared,
) -> Result<Decision, DiagnoseError> {
    let problem = search.problem;
    let std = problem.output_std();
    let given = &prepared.nominal.variance;
    let base = match pool.iter().find(|set| set.effects().is_empty()) {
        Some(base) => base.clone(),
        None => search.fit(first)?,
    };
    let posterior = model_posterior(search, pool)?;
    let best = posterior.best().unwrap_or(&base).clone();
    let noise = search.noise_of(&best);
    let gap = Gap::of(given, &best.fit.variance, &noise, &std);
    let other = other(search, &base, &best, &gap)?;
    let mut decision = Decision {
        status: Status::None,
        effects: posterior.effects.clone(),
        posterior,
        start: best.fit.estimate.clone(),
        noise,
        to_explain: gap.to_explain(),
        other,
    };
    if decision.other.probability > LIKELIER_THAN_NOT {
        decision.say_unknown(&base);
    } else if best.effects().is_empty() {
        small_errors(search, first, &mut decision)?;
        // A gap of which parameters within what the model states leave a share that counts is no noise.
        if decision.status == Status::None && decision.other.left > RELEVANT_SHARE {
            decision.say_unknown(&base);
        }
    } else if are_parameters(best.effects().iter()) {
        decision.status = Status::Parameters;
    } else {
        decision.status = Status::Effect;
    }
    Ok(decision)
}

/// Where nothing is wrong: which nominal parameters are seen to be off within what the model states of them.
fn small_errors(
    search: &Search<'_>,
    first: &Start,
    decision: &mut Decision,
) -> Result<(), DiagnoseError> {
    let stated: Vec<f64> = first
        .nominal
        .iter()
        .map(|p| search.problem.stated_std(p))
        .collect();
    let widest = stated.iter().copied().fold(0.0, f64::max);
    let mut parameters = search.of_stated_parameters(widest);
    let exact = parameters.fit(&Start {
        nominal: vec![],
        ..first.clone()
    })?;
    let mut pool = parameters.run(&exact)?;
    parameters.refine(&mut pool)?;
    let posterior = model_posterior(&parameters, pool)?;
    let Some(best) = posterior.best().filter(|best| !best.effects().is_empty()) else {
        return Ok(());
    };
    decision.status = Status::Parameters;
    decision.effects = posterior.effects.clone();
    decision.start = best.fit.estimate.clone();
    // The others are adjusted again.
    let named: Vec<String> = best.effects().iter().map(name).collect();
    let others = first.nominal.iter().filter(|p| !named.contains(&name(p)));
    decision.start.nominal = others.cloned().collect::<Vec<Placed>>();
    Ok(())
}

/// Whether all of some effects are wrong nominal parameters.
fn are_parameters<'a>(mut effects: impl Iterator<Item = &'a Placed>) -> bool {
    effects.all(is_nominal)
}
