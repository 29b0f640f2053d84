#![doc = include_str!("../README.md")]
#![no_std]
#![forbid(unsafe_code)]

#[cfg(any(test, feature = "host"))]
extern crate std;

pub mod answer;
mod argument;
mod decimal_number;
mod hex;
#[cfg(feature = "host")]
pub mod host;
pub mod kind;
mod line_buffer;
mod number;
pub mod quantity;
mod read_error;
pub mod request;
pub mod setting;
mod special_arguments;
pub mod telemetry;
mod upload;
pub mod words;

pub use argument::{Argument, PersonData, Switch};
pub use hex::TwoHexDigits;
pub use kind::Kind;
pub use line_buffer::LineBuffer;
pub use number::{Number, Quantity, Whole};
pub use read_error::{QuotedWordExcerpt, ReadError};
pub use request::Request;
pub use special_arguments::{MaterialName, Millimetres, PointOrClear};
pub use upload::UploadLine;
