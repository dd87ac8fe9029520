"""Tables and diagrams of the pages, which `make docs` writes."""
