"""The proper feedforward that takes the place of Section 1.6.2's."""
