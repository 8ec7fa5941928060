"""Tables, figures, pages and files from records of other packages."""
