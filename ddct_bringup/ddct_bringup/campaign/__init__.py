"""Many headless runs: what each is, its row, and the processes that share the work."""
