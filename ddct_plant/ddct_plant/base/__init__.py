"""What everything else stands on: errors, checks, units and the time base."""
