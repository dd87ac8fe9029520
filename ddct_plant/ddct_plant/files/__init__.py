"""Read and write the files of users: bounded, whole or not at all, YAML and JSON."""
