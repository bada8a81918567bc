//! Every report of a validation, from its one document.

use raypencil_harness::Validation;

pub fn report_html(validation: &Validation) -> String {
    validation.document_with_pictures().expect("pictures").page().expect("a page")
}

pub fn summary_markdown(validation: &Validation) -> String {
    validation.document().markdown()
}

pub fn junit_xml(validation: &Validation) -> String {
    validation.document().junit().expect("XML")
}

pub fn summary_json(validation: &Validation) -> String {
    validation.document().json()
}
