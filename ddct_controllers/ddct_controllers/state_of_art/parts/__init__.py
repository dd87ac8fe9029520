"""What several of these controllers are composed of."""
