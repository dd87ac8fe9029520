"""Program `design`: from specifications to a verified controller, and what it can bear."""
