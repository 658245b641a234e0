"""Templates of other fields than crashes: a beam, a stack of parts, a weight, a project, a warranty."""
