"""What all Python folders share; see README.md."""
