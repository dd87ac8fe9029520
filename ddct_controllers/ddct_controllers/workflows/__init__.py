"""Program `design`: from specifications to a verified controller, and its robustness."""
