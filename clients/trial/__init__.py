"""COIN's server, tried with clients that the project did not write."""
