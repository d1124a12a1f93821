//! The ADRC: three forms of the law, a published implementation, the loop around it.

#[path = "adrc/forms.rs"]
mod forms;
#[path = "adrc/oracle.rs"]
mod oracle;
#[path = "adrc/published.rs"]
mod published;
#[path = "adrc/single.rs"]
mod single;
#[path = "adrc/whole_loop.rs"]
mod whole_loop;
