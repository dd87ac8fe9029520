"""The driveline of a measured car from a log of a drive: fit, verdict, scenario."""
