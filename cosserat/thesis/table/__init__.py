"""The results table: read-outs, tolerances, errata, stored references."""
