"""What a run says of itself: evidence and its weights, digits, directions, errors by cell, result cells."""
