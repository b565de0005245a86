"""What builds, checks and packages the project; `python3 -m tools --help` lists the commands."""
