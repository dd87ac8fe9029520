"""Runs over the values of one key or two: `sweep`, the short form of a campaign."""
