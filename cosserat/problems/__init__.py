"""Problems of cases, one kind per file."""
