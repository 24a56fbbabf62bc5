//! Integrators of translation.
