"""`python -m tests.browser.paper results/cosserat.pdf` reads the printed book again and says what is wrong with it."""

from __future__ import annotations

import re
import sys
from pathlib import Path

from pypdf import PdfReader

from cosserat.thesis.book.edition import edition

A4 = (595, 842)  # points


def complaints(pdf: PdfReader, chapters: list[str]) -> list[str]:
    """What is wrong: sizes, the outline, the text, numbers of pages, empty pages.

    chapters : titles that the outline must have on its first level, in this order.
    """
    texts = [page.extract_text() for page in pdf.pages]
    titles = [" ".join(one.title.split()) for one in pdf.outline if not isinstance(one, list)]
    found = []
    for number, (page, text) in enumerate(zip(pdf.pages, texts, strict=True), start=1):
        size = (float(page.mediabox.width), float(page.mediabox.height))
        if any(abs(one - other) > 2 for one, other in zip(size, A4, strict=True)):
            found.append(f"page {number} is {size[0]:.0f} by {size[1]:.0f} points")
        if not re.search(rf"\b{number}\s*$|^\s*{number}\b", text):
            found.append(f"page {number} does not have its number")
        if len(text.split()) < 3 and "/XObject" not in page["/Resources"]:
            found.append(f"page {number} is empty")
    squeezed = [re.sub(r"\s", "", title) for title in titles]
    for title in chapters:
        if re.sub(r"\s", "", title) not in squeezed:
            found.append(f"the outline has no '{title}'")
    whole = "\n".join(texts)
    if edition().version not in texts[0]:
        found.append("the first page does not tell its version")
    found += [
        f"raw LaTeX: {raw}" for raw in re.findall(r"\\(?:frac|mathbf|mu|tag|begin)\b.{0,30}", whole)
    ]
    return found


def titles_of(book: Path) -> list[str]:
    """The titles of the pages in the contents of a book."""
    first = (book / "index.html").read_text(encoding="utf-8")
    contents = re.search(r'<ul class="nav bd-sidenav">.*?</nav>', first, flags=re.DOTALL)
    names = (
        re.findall(r'href="[\w.-]+\.html">\s*(.*?)\s*</a>', contents[0], flags=re.DOTALL)
        if contents
        else []
    )
    return [re.sub(r"<[^>]+>", "", name) for name in names]


def main() -> int:
    file = Path(sys.argv[1])
    pdf = PdfReader(file)
    wrong = complaints(pdf, titles_of(file.parent / "book"))
    print(f"{file}: {len(pdf.pages)} pages, {file.stat().st_size / 1e6:.1f} MB, {len(wrong)} complaints")
    print(*wrong[:20], sep="\n", end="\n" if wrong else "")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
