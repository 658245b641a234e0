"""The engine `numpy`: one step a node, over a block of trials."""
