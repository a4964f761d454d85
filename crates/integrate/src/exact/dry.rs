//! Dry friction within one step: equation (4) of [`super::march`].

use super::law::ForceLaw;

/// The dry force over a step.
#[derive(Clone, Copy)]
pub(super) struct Dry {
    /// Its mean, which moves the plant.
    pub(super) mean: f64,
    /// Its value at the end of the step.
    pub(super) end: f64,
    /// What a unit of the velocity that it holds against adds to both: 1/G where it holds, nothing where it slides.
    pub(super) stiffness: f64,
}

impl Dry {
    pub(super) const NONE: Dry = Dry {
        mean: 0.0,
        end: 0.0,
        stiffness: 0.0,
    };
}

/// The friction of a law. Not a closure: one that is handed on by reference is not inlined, and eight lanes wait for eight calls.
pub(super) trait Level: Copy {
    /// At a speed, N.
    fn at(self, speed: f64) -> f64;

    /// The same of a law that would push.
    #[inline(always)]
    fn not_below_zero(self, speed: f64) -> f64 {
        self.at(speed).max(0.0)
    }
}

impl Level for &dyn ForceLaw {
    #[inline(always)]
    fn at(self, speed: f64) -> f64 {
        self.dry_level(speed).unwrap_or(0.0)
    }
}

/// A step with dry friction, (4): it starts at the velocity `start` and would end at `free` without the friction, when a unit
/// of its mean changes that by −`compliance`.
///
/// With nearly constant acceleration over the step, a sliding member that comes to rest does so
/// after the share θ of the step and then either stays or slides on:
///
/// ```text
/// v₁ = v* − G F(½ (|v₀| + |v₁|)) sgn v₀                              while it slides one way
/// v_A = v* − G F(½ |v₀|) sgn v₀,   θ = v₀ / (v₀ − v_A)
/// mean = (θ F(½ |v₀|) − (1 − θ) F(½ |v_A|)) sgn v₀  when the other forces exceed the friction at rest, else v* / G
/// ```
///
/// The mean over a step in which the speed changes is that at the mean speed, of second order in the step.
///
/// A motion that is prescribed does not mind the force; where it pauses, the force stays what it was
/// `before`, up to what friction can hold.
pub(super) struct DryStep {
    pub(super) before: f64,
    pub(super) start: f64,
    pub(super) free: f64,
    pub(super) compliance: f64,
}

/// The dry force over a step for a member that slides one way throughout it, if it does.
pub(super) struct Slid {
    pub(super) dry: Dry,
    /// Whether it does, and did before.
    pub(super) is_all_the_way: bool,
    /// Velocity at the end of the step.
    ahead: f64,
    way: f64,
}

impl DryStep {
    /// What slides all the way is asked for alone, as most steps are of that kind.
    #[inline(always)]
    pub(super) fn force(&self, level: impl Level) -> Dry {
        let slid = self.slid(level);
        match slid.is_all_the_way {
            true => slid.dry,
            false => self.force_of_any(level),
        }
    }

    /// Sliding one way: |v₁| = s v* − G F(½ |v₀| + ½ |v₁|), by fixed-point iteration (levels change little in a step).
    #[inline(always)]
    pub(super) fn slid(&self, level: impl Level) -> Slid {
        let DryStep {
            start,
            free,
            compliance,
            ..
        } = *self;
        let rests = start == 0.0;
        let way = sign(choose(rests, free, start));
        let mut speed = way * free;
        for _ in 0..3 {
            let mean = level.not_below_zero(0.5 * (start.abs() + speed.max(0.0)));
            speed = (way * free - compliance * mean).max(0.0);
        }
        let mean = way * level.not_below_zero(0.5 * (start.abs() + speed));
        let end = way * level.not_below_zero(speed);
        let ahead = free - compliance * mean;
        Slid {
            dry: Dry {
                mean,
                end,
                stiffness: 0.0,
            },
            is_all_the_way: (compliance > 0.0) & !rests & (ahead * way >= 0.0),
            ahead,
            way,
        }
    }

    /// In a step of any kind. Every case is computed and one chosen, so that the lanes of [`super::lanes`] can take different ones.
    #[inline(always)]
    pub(super) fn force_of_any(&self, level: impl Level) -> Dry {
        let Slid {
            dry, ahead, way, ..
        } = self.slid(level);
        let DryStep {
            before,
            start,
            free,
            compliance,
        } = *self;
        let at_rest = level.not_below_zero(0.0);
        let most = compliance * at_rest;
        let rests = start == 0.0;
        let stuck = free / compliance;
        // A sliding member that turns: what stopped holds against the other forces, and the mean also
        // brakes what was moving; or it slides on the other way.
        let share = start / (start - ahead);
        let turned_level = level.not_below_zero(0.5 * ahead.abs());
        let turned = share * dry.mean - (1.0 - share) * way * turned_level;
        let turned_end = -way * level.not_below_zero((free - compliance * turned).abs());
        let pauses = before.max(-at_rest).min(at_rest);
        let moved_along = level.not_below_zero(free.abs()) * sign(free);
        let carried = choose(free == 0.0, pauses, moved_along);

        let prescribed = compliance <= 0.0;
        let slides = choose_if(rests, free.abs() > most, ahead * way >= 0.0);
        let stops = rests | ((free - start).abs() <= most);
        let mean = choose(slides, dry.mean, choose(stops, stuck, turned));
        let stopped_end = choose(rests, stuck, (free - start) / compliance);
        let end = choose(slides, dry.end, choose(stops, stopped_end, turned_end));
        let holds = stops & !slides & !prescribed;
        Dry {
            mean: choose(prescribed, carried, mean),
            end: choose(prescribed, carried, end),
            stiffness: choose(holds, 1.0 / compliance, 0.0),
        }
    }
}

#[inline(always)]
fn sign(velocity: f64) -> f64 {
    choose(velocity == 0.0, 0.0, 1.0_f64.copysign(velocity))
}

#[inline(always)]
fn choose(condition: bool, yes: f64, no: f64) -> f64 {
    if condition { yes } else { no }
}

#[inline(always)]
fn choose_if(condition: bool, yes: bool, no: bool) -> bool {
    (condition & yes) | (!condition & no)
}
