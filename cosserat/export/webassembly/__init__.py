"""The compiled rod as a module of WebAssembly, which a page runs without the package.

`cosserat.export.webassembly.build` makes it.
"""
