//! Clipping of faces into contact areas.
