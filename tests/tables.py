"""Tables and sentences of a comparison, as the program prints them with ``-v``."""

from comparisons.present.case_tables import case_sections


def tables_of(compared):
    """All tables of a comparison, in order."""
    return [table for section in case_sections(compared) for table in section.tables]


def sentences_of(compared):
    """All sentences beside the tables, in order."""
    return [sentence for section in case_sections(compared) for sentence in section.sentences]
