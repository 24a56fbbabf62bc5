//! Overlaps of inelastic bodies are projected out.
