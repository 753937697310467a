"""The outputs of the reproduction as a whole: their manifest, their check on any machine, and the file to deposit."""
