"""What comes out of a campaign: how often, how badly and from where on engagements fail."""
