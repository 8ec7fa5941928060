"""Libraries of the system that some of Python's need, and the line that installs them on Debian and Ubuntu."""

WHAT_DRAWS = "apt-get install --yes libegl1"
