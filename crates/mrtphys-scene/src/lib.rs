//! Scene text and worlds.
