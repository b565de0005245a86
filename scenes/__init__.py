"""Scripts that build the scenes."""
