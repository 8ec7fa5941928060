"""The templates of the report's page."""
