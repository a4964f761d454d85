//! Starts a process for each case and waits for its answer.

use std::fs::File;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use super::files::{Places, answer};
use super::plan::Planned;
use super::worker::{Reply, read};

/// A worker that takes longer has failed.
const LIMIT: Duration = Duration::from_secs(600);
/// How often a worker is looked after.
const PAUSE: Duration = Duration::from_millis(20);

/// What became of one case.
pub(super) enum Answered {
    /// Its answer.
    Reply(Box<Reply>),
    /// Why there is none.
    Failed(String),
}

/// Has one case diagnosed.
pub(super) fn ask(places: &Places, case: &Planned, tell: &(dyn Fn(&str) + Sync)) -> Answered {
    let name = case.name();
    let answered = match started(places, case) {
        Ok(child) => waited(child, LIMIT).and_then(|status| {
            if status.success() {
                read(&places.of_answer(&name, "json"))
            } else {
                let said = std::fs::read_to_string(places.of_answer(&name, "txt"));
                let said = said.unwrap_or_default();
                Err(format!("{status}: {}", said.trim()))
            }
        }),
        Err(error) => Err(format!("cannot be started: {error}")),
    };
    match answered {
        Ok(reply) => {
            tell(&format!("{name}: diagnosed in {:.1} s", reply.seconds));
            Answered::Reply(Box::new(reply))
        }
        Err(why) => {
            tell(&format!("{name}: failed: {why}"));
            Answered::Failed(why)
        }
    }
}

/// The answer that an earlier run kept in a folder.
pub(super) fn kept(folder: &Path, case: &Planned) -> Answered {
    match read(&answer(folder, &case.name(), "json")) {
        Ok(reply) => Answered::Reply(Box::new(reply)),
        Err(why) => Answered::Failed(why),
    }
}

/// The worker stands in the folder of its case; its arguments name no case, its environment is
/// empty.
pub(super) fn command(program: &Path, folder: &Path, withheld: Option<&String>) -> Command {
    let mut command = Command::new(program);
    command.args(["blind-worker", "."]);
    if let Some(kind) = withheld {
        command.args(["--withhold", kind]);
    }
    command.current_dir(folder).env_clear().stdin(Stdio::null());
    command
}

fn started(places: &Places, case: &Planned) -> std::io::Result<Child> {
    let name = case.name();
    let answer = File::create(places.of_answer(&name, "json"))?;
    let errors = File::create(places.of_answer(&name, "txt"))?;
    let folder = places.of_case(&name);
    command(&places.program, &folder, case.withheld.as_ref())
        .stdout(answer)
        .stderr(errors)
        .spawn()
}

/// Waits for the end of a process, which is killed when it takes too long.
fn waited(mut child: Child, limit: Duration) -> Result<ExitStatus, String> {
    let begun = Instant::now();
    loop {
        match child.try_wait() {
            Ok(Some(status)) => return Ok(status),
            Ok(None) if begun.elapsed() < limit => std::thread::sleep(PAUSE),
            ended => {
                // Whether it can be killed or has just ended: there is no answer in time.
                let _ = child.kill();
                let _ = child.wait();
                return Err(match ended {
                    Err(error) => error.to_string(),
                    Ok(_) => format!("no answer within {} s", limit.as_secs_f64()),
                });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_a_worker_is_told_nothing_but_its_folder() {
        let folder = Path::new("/cases/case-0003");
        let plain = command(Path::new("/worker"), folder, None);
        let args: Vec<_> = plain.get_args().collect();
        assert_eq!(args, ["blind-worker", "."]);
        assert_eq!(plain.get_current_dir(), Some(folder));
        assert_eq!(plain.get_envs().count(), 0);
        let kind = "clipping".to_string();
        let withheld = command(Path::new("/worker"), folder, Some(&kind));
        let args: Vec<_> = withheld.get_args().collect();
        assert_eq!(args, ["blind-worker", ".", "--withhold", "clipping"]);
    }

    #[cfg(unix)]
    #[test]
    fn verify_a_worker_that_takes_too_long_has_failed() -> std::io::Result<()> {
        let child = Command::new("sleep").arg("60").spawn()?;
        let begun = Instant::now();
        let ended = waited(child, Duration::from_millis(60));
        assert_eq!(ended, Err("no answer within 0.06 s".to_string()));
        assert!(begun.elapsed() < Duration::from_secs(20));
        Ok(())
    }
}
