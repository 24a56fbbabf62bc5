//! Arrays that several threads write to, each to places of its own.
#![allow(unsafe_code)]

use std::sync::atomic::AtomicU32;

/// Numbers as atomic ones, for as long as nobody else has them. A relaxed store costs what a plain one does.
pub fn as_atomic(numbers: &mut [u32]) -> &[AtomicU32] {
    const { assert!(align_of::<AtomicU32>() == align_of::<u32>()) };
    // SAFETY: the two have the same representation and, as is asserted, alignment; the borrow is exclusive, so for its time all
    // access is atomic.
    unsafe { &*(std::ptr::from_mut(numbers) as *const [AtomicU32]) }
}
