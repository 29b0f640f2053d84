mod data;
mod look;
