//! Parallel loops whose results do not depend on the number of threads.
