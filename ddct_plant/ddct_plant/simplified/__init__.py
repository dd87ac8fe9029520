"""The simplified plants of Section 1.5.1."""
