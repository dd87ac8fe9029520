"""Helpers of the tests that cross packages."""
