"""Links of the book: every number, row, erratum, chapter and path leads to its target; nothing else changes."""

import re

import pytest

from cosserat.thesis.book import links, module_pages
from cosserat.thesis.book.link_text import Linker

EQUATION = '<div class="math notranslate nohighlight">\n\\[a = b \\tag{3.4.11}\\]</div>'
CODE = '<div class="highlight-ipython3 notranslate"><div class="highlight"><pre>'
UNTAGGED = '<div class="math notranslate nohighlight">\n\\[c = d\\]</div>'
PAGES = {
    "ch2_worm.html": f"<article><h1>Chapter 2: a worm</h1>{UNTAGGED}{EQUATION}</article>",
    "ch3_rod.html": f"<article><h1>Chapter 3</h1>{EQUATION}"
    '<figure id="fig_3_8"><img><figcaption><b>Fig. 3.8: equilibria.</b></figcaption></figure></article>',
    "results_table.html": '<article><h1>Rows</h1><table><tr id="row-2.8-stride" data-about="a stride of 61 mm">'
    '</tr><tr id="row-2.8-stride-balanced"></tr></table><div id="table-2.1"></div></article>',
    "errata.html": '<article><h1>Errata</h1><dl><dt id="E2.5">E2.5</dt></dl></article>',
    "left_out.html": '<article><h1>Left out</h1><span id="eq-1.1.5"></span></article>',
    "references.html": '<article><h1>References</h1><p id="ref-q" data-names="Quillin|Perry &amp; Robertson">'
    "</p></article>",
    "source/cosserat.text.html": '<article><h1>cosserat/text.py</h1><div id="module">'
    '<span id="cosserat.text.shown"></span></div></article>',
}


@pytest.fixture
def linker():
    return Linker(links.targets(dict(links.with_equation_anchors(PAGES.items()))))


def linked(linker, html, page="ch3_rod.html"):
    """Pairs of text and address of the links."""
    made = linker.page(page, html)
    assert re.sub(r"</?a\b[^>]*>", "", made) == re.sub(r"</?a\b[^>]*>", "", html)  # nothing else changes
    return [
        (text, address)
        for address, text in re.findall(r'<a class="ref to-\w+" href="([^"]+)".*?>(.*?)</a>', made)
    ]


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("by eq. (3.4.11).", [("(3.4.11)", "ch2_worm.html#eq-3.4.11")]),
        (
            "eqs. (3.4.11)-(1.1.5)",
            [("(3.4.11)", "ch2_worm.html#eq-3.4.11"), ("(1.1.5)", "left_out.html#eq-1.1.5")],
        ),
        (
            "eq. (3.4.11)3 and (1.1.5)_4",
            [("(3.4.11)", "ch2_worm.html#eq-3.4.11"), ("(1.1.5)", "left_out.html#eq-1.1.5")],
        ),
        ("Fig. 3.8(b) shows", [("Fig. 3.8(b)", "#fig_3_8")]),
        ("Figs. 3.8 and 3.8, a", [("Figs. 3.8", "#fig_3_8"), ("3.8", "#fig_3_8")]),
        ("Table 2.1", [("Table 2.1", "results_table.html#table-2.1")]),
        ("see E2.5, of", [("E2.5", "errata.html#E2.5")]),
        ("Chapters 2 and 3.", [("Chapters 2", "ch2_worm.html"), ("3", "ch3_rod.html")]),
        (
            "the row 2.8-stride-balanced is",
            [("2.8-stride-balanced", "results_table.html#row-2.8-stride-balanced")],
        ),
        ("<code>2.8-stride</code>", [("2.8-stride", "results_table.html#row-2.8-stride")]),
        ("<code>cosserat/text.py</code>", [("cosserat/text.py", "source/cosserat.text.html")]),
        (
            "cosserat.text.shown",
            [("cosserat.text.shown", "source/cosserat.text.html#cosserat.text.shown")],
        ),
        (
            "of Quillin, Perry &amp; Robertson",
            [("Quillin", "references.html#ref-q"), ("Perry &amp; Robertson", "references.html#ref-q")],
        ),
        ("in `results/errata.toml`", [("results/errata.toml", "errata.html")]),
        ("<pre>printed (3.4.11)</pre>", [("(3.4.11)", "ch2_worm.html#eq-3.4.11")]),
        (
            f'{CODE}<span class="c1"># eq. (3.4.11)</span></pre></div>',
            [("(3.4.11)", "ch2_worm.html#eq-3.4.11")],
        ),
        (
            f'{CODE}<span class="s2">"3.4.11"</span></pre></div>',
            [('"3.4.11"', "ch2_worm.html#eq-3.4.11")],
        ),
        (
            f'{CODE}<span class="s2">&quot;3.4.11&quot;</span></pre></div>',
            [("3.4.11&quot;", "ch2_worm.html#eq-3.4.11")],
        ),
    ],
)
def test_each_sort_of_place_is_linked(linker, text, found):
    made = linked(linker, f"<p>{text}</p>")
    assert [address for _, address in made] == [address for _, address in found]
    assert not linker.faults


@pytest.mark.parametrize(
    "html",
    [
        r'<span class="math notranslate nohighlight">\((3.4.11) + E2.5\)</span>',
        r'<div class="math"><p>(3.4.11)</p></div>',
        '<a href="x.html#(3.4.11)" title="Fig. 3.8">E2.5</a>',
        "<script>f(3.4.11); // (3.4.11)</script>",
        "<svg><text>(3.4.11)</text></svg>",
        '<img alt="Fig. 3.8 by (3.4.11)">',
        "<h2>Chapter 2 and (3.4.11)</h2>",
        "<summary>Misprint E2.5</summary>",
        "<button>Fig. 3.8</button>",
        '<div class="highlight-ipython3"><pre><span class="n">f(3.4.11)</span> x = "E2.5"</pre></div>',
        '<div class="highlight source"><pre>f(3.4.11) "E2.5"</pre></div>',
        "<!-- (3.4.11) -->",
        "<p>version 3.4.11, 1.2.3.4, E2, E2.5.1, Chapter 2.1, x2.8-stride, 2.8-stride-old</p>",
        '<dl><dt class="sig">cosserat.text.shown</dt></dl>',
    ],
)
def test_nothing_is_linked_in_mathematics_addresses_headings_and_code(linker, html):
    assert linker.page("ch3_rod.html", html) == html
    assert not linker.faults


def test_an_element_does_not_lead_to_itself(linker):
    html = '<figure id="fig_3_8"><b>Fig. 3.8: equilibria</b></figure>'
    assert linker.page("ch3_rod.html", html) == html
    assert linked(linker, html, "errata.html") == [("Fig. 3.8", "ch3_rod.html#fig_3_8")]


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("(3.4.12)", "(3.4.12)"),
        ("Fig. 3.9", "Fig. 3.9"),
        ("Figs. 3.8 to 3.14", "3.14"),
        ("Table 3.1", "Table 3.1"),
        ("E2.6", "E2.6"),
        ("Chapter 7", "Chapter 7"),
        ("cosserat/models/rods.py", "cosserat/models/rods.py"),
    ],
)
def test_a_number_without_a_target_is_a_fault(linker, text, fault):
    linker.page("errata.html", f"<p>{text}</p>")
    assert linker.faults == [f"errata.html: {fault} has no target"]


def test_a_file_of_the_package_without_a_page_is_no_fault(linker):
    assert linked(linker, "<p>cosserat/units.py</p>") == []
    assert not linker.faults


def test_links_say_where_they_lead(linker):
    page = linker.page("source/x.html", "<p>(3.4.11), Fig. 3.8, 2.8-stride</p>")
    assert 'href="../ch2_worm.html#eq-3.4.11" title="Eq. (3.4.11); in Chapter 2: a worm"' in page
    assert 'title="Fig. 3.8: equilibria; in Chapter 3"' in page
    assert 'title="a stride of 61 mm"' in page


def test_the_first_display_of_an_equation_has_the_anchor():
    pages = dict(links.with_equation_anchors(PAGES.items()))
    assert pages["ch2_worm.html"].count("eq-3.4.11") == 1
    assert (
        f'{UNTAGGED}<div class="math notranslate nohighlight" id="eq-3.4.11">' in pages["ch2_worm.html"]
    )
    assert "eq-3.4.11" not in pages["ch3_rod.html"]
    assert (
        links.equations_script(pages)
        == 'const EQUATIONS = {\n"3.4.11": "\\\\[a = b \\\\tag{3.4.11}\\\\]"\n};\n'
    )


def test_reading_order_is_that_of_the_table_of_contents():
    assert links.reading_order({"index": ["b", "a"], "b": ["c"]}, "index") == ["index", "b", "c", "a"]


def test_a_module_is_shown_as_it_is():
    text = 'def f(x: int) -> bool:\n    """Of (3.4.11)."""\n    return x < 1  # E2.5\n\n\nclass A:\n    a = "b"\n'
    body = module_pages.body("cosserat/x/y.py", text)
    body = re.sub(r"<p>.*?</p>", "", body)
    assert (
        re.sub(r"<[^>]+>", "", body).replace("&lt;", "<").replace("&gt;", ">")
        == f"cosserat/x/y.py{text.rstrip()}"
    )
    assert '<span id="cosserat.x.y.f"></span><span class="k">def</span> f' in body
    assert '<span id="cosserat.x.y.A">' in body
    assert '<span class="sd">"""Of (3.4.11)."""</span>' in body
    assert '<span class="c1"># E2.5</span>' in body


def test_pages_are_made_of_the_modules_that_are_named():
    made = {
        name: context
        for name, context, _ in module_pages.pages(["in cosserat/text.py, cosserat/none.py"])
    }
    assert list(made) == ["source/cosserat.text"]
    assert made["source/cosserat.text"]["title"] == "cosserat/text.py"


def test_the_name_over_shown_code_leads_to_its_definition(linker):
    code = '<code class="x"><span class="pre">{}</span></code>'
    line = f"<article><p>{code.format('shown')} in {code.format('cosserat/text.py')}</p></article>"
    page = links._linked(linker, "ch3_rod.html", line)
    assert re.findall(r'href="([^"]+)"', page) == [
        "source/cosserat.text.html#cosserat.text.shown",
        "source/cosserat.text.html",
    ]
