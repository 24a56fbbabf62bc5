//! list
pub fn scenes() -> crate::exit::Outcome { todo!() }
pub fn schema() -> crate::exit::Outcome { todo!() }
