"""What is computed from a recording, and the tables that show it."""
