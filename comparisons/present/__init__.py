"""What a reader sees: tables, figures, pages and files, from records that other packages computed."""
