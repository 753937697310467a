"""What a case may say: one list of keys, read from the parameter classes, and the forms in which it is given."""
