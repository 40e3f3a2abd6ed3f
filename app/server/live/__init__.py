"""The robot in a participant's hand: a websocket, sessions, and the worker processes that run the trials."""
