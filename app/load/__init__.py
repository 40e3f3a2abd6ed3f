"""How many people a server bears."""
