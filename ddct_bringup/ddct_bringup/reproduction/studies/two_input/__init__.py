"""Studies of the controllers that command the engine too."""
