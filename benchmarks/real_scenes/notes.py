"""What differs in each scene and why, written by hand after looking at the pictures."""

NOTES = {}
