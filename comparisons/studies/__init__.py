"""Long studies: measurements in steps, with results as data, sentences and figures."""
