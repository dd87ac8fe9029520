"""The conformance check of a controller: what `check-controller` tries and finds."""
