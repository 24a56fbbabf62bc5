//! Pair routines, one file each.
