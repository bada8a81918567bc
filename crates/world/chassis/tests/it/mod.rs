//! The vehicle on ground for which its contacts, its stance and its passage have closed forms, and on random ground.

mod contact;
mod passage;
mod random;
mod rest;
mod shapes;
