//! Windows, in a build that has them.

use thermal_window::{SessionView, StopFlag, WindowPeople};

use super::Failure;

/// Runs something with the persons at the windows; returns when the windows are closed and it has ended.
#[cfg(feature = "window")]
pub fn show(
    title: &str,
    session: Option<SessionView>,
    stop: &StopFlag,
    worker: impl FnOnce(&mut WindowPeople) -> Result<(), Failure> + Send,
) -> Result<(), Failure> {
    use thermal_window::{Tones, WindowOptions, run_window};

    let options = WindowOptions {
        title: format!("{title} - thermal-lab"),
        tones: session.is_some().then(Tones::start),
        session,
        stop: stop.clone(),
    };
    let shown = run_window(options, worker).map_err(Failure::input)?;
    let latency = &shown.latency;
    if let (Some(median_ms), Some(late_ms)) = (latency.percentile_ms(50), latency.percentile_ms(99))
    {
        eprintln!(
            "thermal-lab: from an update to the screen: median {median_ms} ms, 99 % {late_ms} ms, longest {} ms, in {} frames",
            latency.longest_ms(),
            latency.frames()
        );
    }
    shown.result
}

/// A build without windows says how to get one.
#[cfg(not(feature = "window"))]
pub fn show(
    _title: &str,
    _session: Option<SessionView>,
    _stop: &StopFlag,
    _worker: impl FnOnce(&mut WindowPeople) -> Result<(), Failure> + Send,
) -> Result<(), Failure> {
    Err(Failure::input(anyhow::anyhow!(
        "this thermal-lab has no windows; give --headless, or build one: cargo build --release -p thermal-lab --features window"
    )))
}
