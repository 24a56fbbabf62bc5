//! From candidates to contacts.
