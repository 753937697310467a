"""Cases: what is asked for."""
