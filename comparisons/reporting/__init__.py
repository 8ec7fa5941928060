"""The report that one sends to a colleague: all that is known of some questions, in one folder with one page."""
