//! Fidelity: difference between the skin temperature on the display and on the real material, for scenarios, control laws
//! and random plants.
//!
//! ```text
//! scenario -> cases -> scene text -> device (image or native) -> figures of the run, one of them with a bound
//!                         ^ law, seed, plant parameters: a limit removed, or a random draw
//! ```
//!
//! Every run is a scene file: [`FidelityCase::text`] writes it, and `hil-sim run` can repeat it.

mod case;
mod csv;
mod measure;
mod plant_draws;
mod plot;
mod population;
mod removed_limit;
mod report;
mod row;
mod scenario;
mod table;
mod touched_object;

pub use case::FidelityCase;
pub use csv::{box_csv, populations_csv, rows_csv};
pub use measure::{JudgedFigure, Measure};
pub use plant_draws::{
    BoxReport, DrawResult, LawStatistics, Percentiles, PlantDraw, statistics_by_law,
};
pub use plot::draw as plot;
pub use population::{
    BoundResult, BoundRow, Compared, ImageSample, Population, PopulationCase, PopulationReport,
    PopulationResult, Priors, SVG as POPULATIONS_SVG, Way, WayStatistics, bound_rows,
    chart as population_chart, layer_keys, spread, table as population_table,
};
pub use removed_limit::RemovedLimit;
pub use report::{HTML, SVG, page};
pub use row::FidelityRow;
pub use scenario::Scenario;
pub use table::{box_table, table};
pub use touched_object::TouchedObject;
