"""Code shared by the Python folders; see README.md."""
