"""What a run found, and further questions."""
