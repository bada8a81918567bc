//! The tests of this crate, one program.

mod candidates;
mod cast;
mod check_escapes;
mod clauses;
mod closed_form;
mod hard_rays;
mod hiding;
mod house;
mod injected_document;
mod injected_faults;
mod injected_files;
mod injected_light;
mod loading;
mod marsyard;
mod minimise;
mod planted_faults;
mod properties;
mod quadrature;
mod radiometry;
mod report_page;
mod reproducers;
mod rulings;
mod single_rays;
mod truth_tables;
mod watertight;
