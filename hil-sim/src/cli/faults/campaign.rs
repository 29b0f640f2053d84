//! `--campaign` and `--replay`: random campaigns.

use anyhow::Context;
use thermal_campaigns::faults::{CampaignResult, RandomCampaign, campaign_summary};
use thermal_sim::SceneRunner;

use super::{Arguments, Failure, RunsReport, each, output};

/// Runs the campaigns with these numbers; a violation is a failure.
pub fn run(
    arguments: &Arguments,
    device: &dyn SceneRunner,
    numbers: std::ops::Range<u64>,
) -> Result<(), Failure> {
    let campaigns: Vec<_> = numbers
        .map(|number| RandomCampaign::new(arguments.seed, number, device.has_processor()))
        .collect();
    if let (Some(folder), Some(_), [campaign]) =
        (&arguments.out, arguments.replay, campaigns.as_slice())
    {
        let name = format!("campaign-{}.toml", campaign.number);
        output::write(folder, &name, campaign.text()).map_err(Failure::run)?;
    }
    let work = |campaign: &RandomCampaign| {
        let ran = campaign.run(device);
        ran.with_context(|| format!("number {} of seed {}", campaign.number, arguments.seed))
    };
    let ran =
        each(arguments, "campaigns", device.name(), &campaigns, work).map_err(Failure::run)?;
    let ran: Vec<CampaignResult> = ran.into_iter().flatten().collect();
    let failing = ran.iter().filter(|ran| !ran.trial.holds()).count();
    let report = RunsReport {
        engine: Some(device.name()),
        seed: arguments.seed,
        failing,
        key: "campaigns",
        runs: &ran,
    };
    let problem = format!(
        "campaigns do not hold; --replay NUMBER --seed {} --engine {} repeats one",
        arguments.seed,
        device.name()
    );
    report.print(arguments, campaign_summary, problem)
}
