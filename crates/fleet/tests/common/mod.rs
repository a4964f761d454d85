//! A generated fleet: tables on a spring under a force, some of which grow old.

use std::path::Path;
use std::sync::Arc;

use simgap_app::input::{Input, model_of};
use simgap_app::simulation::simulate;
use simgap_record::{Channel, Record, write_csv_atomic};

type Fallible<T> = Result<T, Box<dyn std::error::Error>>;

pub(crate) const MODEL: &str = r#"schema = "simgap-model/1"
name = "table"

[[mass]]
name = "table"
value = 2.0

[[spring]]
name = "leaf"
between = ["table", "ground"]
stiffness = 800.0

[[damper]]
name = "guide"
between = ["table", "ground"]
damping = 6.0

[[input]]
channel = "u"
kind = "force"
at = "table"

[[output]]
channel = "y"
kind = "displacement"
at = "table"

[[output]]
channel = "a"
kind = "acceleration"
at = "table"
"#;

/// What is generated.
pub(crate) struct Fleet {
    pub(crate) machines: usize,
    pub(crate) days: usize,
    /// Machines whose friction grows from day to day, N a day.
    pub(crate) growing: Vec<usize>,
    pub(crate) friction_a_day: f64,
    /// The machine whose spring loosens, and how much of it a day.
    pub(crate) loosening: usize,
    pub(crate) loosening_a_day: f64,
    /// The day on which the displacement of all machines is measured with a wrong gain.
    pub(crate) wrong_day: usize,
    /// Samples of a record.
    pub(crate) samples: usize,
}

impl Fleet {
    /// 20 machines over 25 days.
    pub(crate) fn whole() -> Fleet {
        Fleet {
            machines: 20,
            days: 25,
            growing: vec![3, 7, 15],
            friction_a_day: 0.12,
            loosening: 11,
            loosening_a_day: 0.012,
            wrong_day: 12,
            samples: 300,
        }
    }

    pub(crate) fn machine(machine: usize) -> String {
        format!("m{machine:02}")
    }

    /// Days of March 2026.
    pub(crate) fn date(day: usize) -> String {
        format!("2026-03-{:02}", day + 1)
    }

    /// Writes plan, model and one record for each machine and day.
    pub(crate) fn write(&self, folder: &Path) -> Fallible<()> {
        std::fs::create_dir_all(folder)?;
        std::fs::write(folder.join("table.toml"), MODEL)?;
        std::fs::write(folder.join("plan.toml"), PLAN)?;
        for machine in 0..self.machines {
            for day in 0..self.days {
                let (name, date) = (Fleet::machine(machine), Fleet::date(day));
                let at = folder.join(format!("records/machine={name}/date={date}"));
                std::fs::create_dir_all(&at)?;
                self.record(machine, day, &at.join("run.csv"))?;
            }
        }
        Ok(())
    }

    fn record(&self, machine: usize, day: usize, path: &Path) -> Fallible<()> {
        let mut own = Random(1000 + machine as u64);
        let mut chance = Random((1 + machine as u64) * 7919 + day as u64);
        // Machines differ a little, for good.
        let stiffness = 800.0 * (1.0 + 0.002 * own.normal());
        let mass = 2.0 * (1.0 + 0.002 * own.normal());
        let loose = match machine == self.loosening {
            true => self.loosening_a_day * day as f64,
            false => 0.0,
        };
        let mut text = MODEL
            .replace("value = 2.0", &format!("value = {mass}"))
            .replace("800.0", &format!("{}", stiffness * (1.0 - loose)));
        let friction = self.friction_a_day * day as f64;
        if self.growing.contains(&machine) && friction > 0.0 {
            text += &format!(
                "[[effect]]\nkind = \"coulomb_friction\"\nbetween = [\"table\", \"ground\"]\nfriction_force_n = {friction}\n"
            );
        }
        if day == self.wrong_day {
            text += "[[effect]]\nkind = \"sensor_gain\"\nchannel = \"y\"\ngain_factor = 1.2\n";
        }
        let model = model_of(&text, Path::new("true.toml"))?;
        let time: Vec<f64> = (0..self.samples).map(|n| 0.01 * n as f64).collect();
        let tones: Vec<[f64; 3]> = [0.7, 1.7, 2.9, 4.3]
            .into_iter()
            .map(|f| [4.0, f, std::f64::consts::TAU * chance.even()])
            .collect();
        let force = |t: &f64| -> f64 {
            let parts = tones
                .iter()
                .map(|[a, f, p]| a * (std::f64::consts::TAU * f * t + p).sin());
            parts.sum()
        };
        let force: Vec<f64> = time.iter().map(force).collect();
        let channel = Channel::new("u", "N", force.clone());
        let driven = Record::with_time_unit("run", ("t", "s"), time.clone(), vec![channel])?;
        let found = simulate(&model, &Input::made(Arc::new(driven)), true)?;
        let mut noisy = |index: usize, std: f64| -> Vec<f64> {
            let exact = found.columns[index].as_ref() as &[f64];
            exact
                .iter()
                .map(|value| value + std * chance.normal())
                .collect()
        };
        let (y, a) = (noisy(1, 1e-4), noisy(2, 0.05));
        let headers = ["t [s]", "u [N]", "y [m]", "a [m/s^2]"].map(str::to_owned);
        write_csv_atomic(path, &headers, &[&time, &force, &y, &a])?;
        Ok(())
    }
}

const PLAN: &str = r#"schema = "simgap-plan/1"
name = "tables"
records = ["records/machine={machine}/date={date}/{record}.csv"]
model = "table.toml"
"#;

/// Reference: `steele2014`.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Evenly over [0, 1).
    pub(crate) fn even(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Standard normal, by Box and Muller.
    pub(crate) fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.even()).ln()).sqrt();
        radius * (std::f64::consts::TAU * self.even()).cos()
    }
}
