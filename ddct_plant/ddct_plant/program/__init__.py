"""Common parts of all programs: errors, tables, progress, signals, worker processes."""
