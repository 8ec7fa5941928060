"""The first scene of a user, the schema of scenes for editors, and the installed libraries."""
