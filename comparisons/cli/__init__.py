"""The command line: one file per sub-command, and nothing of the mechanics."""
