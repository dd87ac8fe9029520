"""What is generated in the pages: tables and diagrams; `make docs` writes it."""
