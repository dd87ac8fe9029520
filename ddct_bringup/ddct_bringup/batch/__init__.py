"""Many runs of linear plants and controllers at once, one column of an array for each run."""
