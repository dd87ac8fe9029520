"""Linear systems: their forms, realisations and exact discretisation."""
