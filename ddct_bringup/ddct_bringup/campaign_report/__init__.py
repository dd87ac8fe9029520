"""Out of a campaign: how often and how badly engagements fail, and where failure begins."""
