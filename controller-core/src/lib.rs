//! stub
#![no_std]
pub mod plant_model;
