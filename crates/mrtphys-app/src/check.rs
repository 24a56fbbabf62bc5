//! check
pub fn check(_scene: &std::ffi::OsStr) -> crate::exit::Outcome { todo!() }
