"""What every program does around its work: errors, tables, files, signals."""
