"""Problems that a case may pose, one kind a file."""
