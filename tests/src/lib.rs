//! Tests across the folders.
