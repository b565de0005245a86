//! Inputs for the fuzz targets: any bytes become records, programs and scenes, sound ones and broken ones.
#![forbid(unsafe_code)]

pub mod draw;
pub mod programs;
pub mod records;
pub mod scenes;
pub mod shapes;
pub mod sound;
