"""The command line: a list or help loads click alone, and a command loads libraries at the start of the run."""
