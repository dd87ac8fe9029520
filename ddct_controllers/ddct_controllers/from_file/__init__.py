"""Controllers in a file: one loader for each kind of YAML file, and one for Python."""
