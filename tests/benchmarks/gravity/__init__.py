"""How fast, how right and how conservative gravity is, beside other codes; figures in README.md beside this."""
