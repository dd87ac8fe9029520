"""Design and analysis of linear slip-speed controllers: loops, margins, step responses."""
