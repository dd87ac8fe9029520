"""Out of a campaign: how often and how badly engagements fail, where, and what drives it."""
