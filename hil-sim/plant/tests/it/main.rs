//! Parts of the plant against golden values.

mod infrared;
