//! Tuning rules, each a small type with its source, its validity and its warnings.
