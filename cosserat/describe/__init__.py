"""The keys of a case: one list from the parameter classes, as text and as schemas."""
