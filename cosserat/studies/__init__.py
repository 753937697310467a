"""Studies: families of cases, solved together as one labelled answer."""
