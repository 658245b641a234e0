"""What a run found: in words, on record, and kept in a file."""
