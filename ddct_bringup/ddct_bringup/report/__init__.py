"""The page that `report` writes: its content and its layout."""
