"""The literature that the book names, and how the book itself is cited."""

from __future__ import annotations

import re
import tomllib
from html import escape
from importlib import resources

from IPython.display import HTML
from pydantic import Field

from cosserat.errors import InputError
from cosserat.parameters import Parameters
from cosserat.thesis.book.links import marked
from cosserat.thesis.book.workflow import results


class Reference(Parameters):
    """One work.

    authors : "Family, G. N." each.  place : journal with volume and pages, or publisher.
    doi, url : where it is found; empty if that was not confirmed.  doi : "none" if the work has no DOI.
    names : the words of a text that lead here.
    """

    authors: tuple[str, ...] = Field(min_length=1)
    year: int
    title: str
    place: str = Field(alias="in")
    doi: str = ""
    url: str = ""
    names: tuple[str, ...] = Field(min_length=1)

    @property
    def address(self) -> str:
        """Where the work is found, or nothing."""
        return self.url if self.doi in ("", "none") else f"https://doi.org/{self.doi}"


def literature() -> dict[str, Reference]:
    """The works by their keys, sorted by author and year."""
    text = (resources.files("cosserat.thesis.book") / "references.toml").read_text(encoding="utf-8")
    known = {name: Reference.read(table, name) for name, table in tomllib.loads(text).items()}
    return dict(sorted(known.items(), key=lambda item: (item[1].authors[0].lower(), item[1].year)))


def references() -> HTML:
    """All works as a list, each with an address to which its authors' names lead, and as BibTeX."""
    known = literature()
    items = "".join(_item(name, work) for name, work in known.items())
    folded = _folded("all as BibTeX", "\n\n".join(bibtex(name, work) for name, work in known.items()))
    return HTML(f'<ul class="references no-links">{items}</ul>{folded}')


def _item(name: str, work: Reference) -> str:
    about = f"{work.authors[0].partition(',')[0]} ({work.year}): {work.title}"
    told = f"{', '.join(work.authors)} ({work.year}). <cite>{escape(work.title)}</cite>. {escape(work.place)}."
    return f"<li {marked(f'ref-{name}', about, work.names)}>{told} {_where(work)}</li>"


def _where(work: Reference) -> str:
    """A link to a work, or that it has no DOI; empty if none is known."""
    if work.address:
        return f'<a href="{escape(work.address)}">{escape(work.doi or work.url)}</a>'
    return "It has no DOI." if work.doi == "none" else ""


def bibtex(name: str, work: Reference) -> str:
    """A work as an entry of BibTeX."""
    journal = re.fullmatch(r"(?P<journal>.*?) (?P<volume>\d+), (?P<pages>[\d-]+)", work.place)
    if journal:
        kind, found = "article", {**journal.groupdict(), "pages": journal["pages"].replace("-", "--")}
    elif work.place.startswith("doctoral"):
        kind, found = "phdthesis", {"school": work.place.partition(", ")[2]}
    else:
        kind, found = "misc", {"howpublished": work.place}
    fields = {
        "author": " and ".join(work.authors),
        "title": f"{{{work.title}}}",
        "year": str(work.year),
        **found,
        **({"url": work.url} if work.url else {"doi": work.doi} if work.address else {}),
    }
    lines = ",\n".join(f"  {key} = {{{value}}}" for key, value in fields.items())
    return f"@{kind}{{{name},\n{lines}\n}}"


def how_to_cite() -> HTML:
    """The package, with its version and licence, and the thesis, from CITATION.cff, as text and as BibTeX.

    Raises
    ------
    InputError : there is no CITATION.cff, or it cannot be read.
    """
    import yaml

    path = results().parent / "CITATION.cff"
    try:
        about = yaml.safe_load(path.read_text(encoding="utf-8"))
        authors = [author["name"] for author in about["authors"]]
        thesis = about["references"][0]
        by = [f"{author['family-names']}, {author['given-names']}" for author in thesis["authors"]]
        title, year = about["title"], str(about["date-released"])[:4]
        school = thesis["institution"]["name"]
        told = (
            f"{', '.join(authors)} ({year}). <cite>{escape(title)}</cite>, version {about['version']}. "
            f"Licence: {about['license']}.",
            f"{', '.join(by)} ({thesis['year']}). <cite>{escape(thesis['title'])}</cite>. "
            f"{thesis['thesis-type'].capitalize()}, {school}.",
        )
        entries = (
            f"@software{{cosserat,\n  author = {{{{{authors[0]}}}}},\n  title = {{{{{title}}}}},\n"
            f"  year = {{{year}}},\n  version = {{{about['version']}}}\n}}",
            f"@phdthesis{{hemingway2020,\n  author = {{{by[0]}}},\n  title = {{{{{thesis['title']}}}}},\n"
            f"  school = {{{school}}},\n  year = {{{thesis['year']}}}\n}}",
        )
    except (OSError, yaml.YAMLError, LookupError, TypeError) as error:
        raise InputError(f"cannot read {path} ({error!r}); restore it from the repository") from None
    lines = "".join(f"<li>{line}</li>" for line in told)
    return HTML(
        f'<ul class="references no-links">{lines}</ul>{_folded("as BibTeX", chr(10).join(entries))}'
    )


def _folded(title: str, text: str) -> str:
    return (
        f'<details><summary>{title}</summary><div class="highlight source">'
        f'<pre tabindex="0">{escape(text, quote=False)}</pre></div></details>'
    )
