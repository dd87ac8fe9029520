"""The page that `report` writes: what is on it, and how it looks."""
