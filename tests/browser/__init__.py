"""An audit of a built book in a real browser: what is cut, unreadable, unreachable, broken, or asks the network."""
