"""Controllers that a YAML file describes: one loader for each kind."""
