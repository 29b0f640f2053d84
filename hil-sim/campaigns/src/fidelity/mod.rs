//! How close the skin on the display comes to the skin on the real material: scenarios, laws, and the box of plants that
//! a device may turn out to be.
//!
//! ```text
//! scenario -> cases -> scene text -> device (image or native) -> figures of the run, and the figure that is judged
//!                         ^ law, seed, plant keys: a bound removed, or a draw of the box
//! ```
//!
//! Every run is a scene file: [`Case::text`] writes it, `hil-sim run` repeats it.

mod case;
mod csv;
mod draws;
mod judge;
mod plot;
mod report;
mod row;
mod scenario;
mod table;
mod things;
mod without;

pub use case::{Case, Press};
pub use csv::{box_csv, rows_csv};
pub use draws::{Boxed, Draw, Drawn, LawBox, Percentiles, summarise};
pub use judge::{Judged, Measure};
pub use plot::draw as plot;
pub use report::{HTML, SVG, page};
pub use row::Row;
pub use scenario::Scenario;
pub use table::{box_table, table};
pub use things::Thing;
pub use without::Without;
