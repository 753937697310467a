"""Configuration of Sphinx for the book; the name of this file and of each variable is Sphinx's."""

from cosserat.thesis.book.edition import edition

project = "cosserat"
author = "The cosserat project"
version = release = edition().version

extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx_copybutton",
    "cosserat.thesis.book.api",
    "cosserat.thesis.book.assets",
    "cosserat.thesis.book.links",
]
default_role = "code"
suppress_warnings = ["mystnb.unknown_mime_type"]

autodoc_typehints_format = "short"
aliases = (
    "Array",
    "Vector",
    "Band",
    "Mask",
    "Fields",
    "Place",
    "Direction",
    "Rows",
    "Track",
    "History",
    "Bytes",
)
autodoc_type_aliases = {name: name for name in aliases}
autodoc_preserve_defaults = True
autodoc_member_order = "bysource"
python_maximum_signature_line_length = 60

nb_execution_mode = "off"
nb_merge_streams = True
nb_render_markdown_format = "myst"
nb_code_prompt_show = "Show the code and its result"
nb_code_prompt_hide = "Hide the code and its result"
myst_enable_extensions = ["amsmath", "dollarmath", "colon_fence"]

html_theme = "sphinx_book_theme"
html_title = "Cosserat curves"
html_static_path = ["_static"]
html_css_files = ["book.css", "links.css"]
html_js_files = [("book.js", {"defer": "defer"}), "equations.js", "equation_preview.js"]
html_copy_source = False
html_show_sourcelink = False
html_use_index = False
html_sidebars: dict[str, list[str]] = {"source/*": []}  # pages of modules are many and small
html_last_updated_fmt = None  # the clock's; the footer has the day of the commit
html_context = {"default_mode": "auto"}
html_theme_options = {
    "use_download_button": False,
    "use_fullscreen_button": False,
    "show_toc_level": 2,
    "navbar_persistent": [],
    "extra_footer": f"<p>{edition().text}</p>",
}
copybutton_prompt_text = r">>> |\.\.\. |\$ "
copybutton_prompt_is_regexp = True

mathjax_path = "mathjax/tex-chtml-full.js"
mathjax3_config = {
    "options": {"enableMenu": False},
    "tex": {"tagSide": "right"},
    "chtml": {"matchFontHeight": False},
}
