//! How close the skin on the display comes to the skin on the real material: scenarios, laws, and the box of plants that
//! a device may turn out to be.
//!
//! ```text
//! scenario -> cases -> scene text -> device (image or native) -> figures of the run, and the figure that is judged
//!                         ^ law, seed, plant keys: a bound removed, or a draw of the box
//! ```
//!
//! Every run is a scene file: [`FidelityCase::text`] writes it, `hil-sim run` repeats it.

mod case;
mod csv;
mod measure;
mod plant_draws;
mod plot;
mod removed_limit;
mod report;
mod row;
mod scenario;
mod table;
mod touched_object;

pub use case::FidelityCase;
pub use csv::{box_csv, rows_csv};
pub use measure::{JudgedFigure, Measure};
pub use plant_draws::{
    BoxReport, DrawResult, LawStatistics, Percentiles, PlantDraw, statistics_by_law,
};
pub use plot::draw as plot;
pub use removed_limit::RemovedLimit;
pub use report::{HTML, SVG, page};
pub use row::FidelityRow;
pub use scenario::Scenario;
pub use table::{box_table, table};
pub use touched_object::TouchedObject;
