"""The same problems by other packages, for `snakemake peers`; those run in an environment of their own."""
