"""What a simulation is: definitions, distributions, draws, the loop over trials, statistics."""
