"""Runs over one value or two: `sweep`, the short form of a campaign."""
