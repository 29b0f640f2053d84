//! Courses against closed forms and against the contact model, the ideal tile, and the comparison.

mod comparison;
mod courses;
mod ideal_tile;
mod scenes;
