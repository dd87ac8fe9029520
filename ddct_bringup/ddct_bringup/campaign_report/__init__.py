"""Analysis of a campaign: frequency, severity, location and causes of failed engagements."""
