// Equations that are wider than their column are set smaller.  Boxes that still scroll sideways take part in Tab, and
// mathematics in a line that is wider than its paragraph becomes such a box.
(() => {
  const SMALLEST = 0.72;  // of the size of the text
  const boxes = "div.math, span.math, pre, table.rows, table.docutils, figure.drawn, .cell_output .output";
  const fit = (box) => {
    box.style.fontSize = "";
    const share = 0.97 * box.clientWidth / box.scrollWidth;
    if (box.scrollWidth > box.clientWidth + 1) box.style.fontSize = Math.max(SMALLEST, share).toFixed(3) + "em";
  };
  const mark = () => {
    document.querySelectorAll("div.math").forEach(fit);
    for (const line of document.querySelectorAll("span.math")) {
      line.classList.remove("wide");
      const block = line.closest("p, td, th, li, dd, figcaption, summary, div");
      const set = line.querySelector("mjx-container");
      line.classList.toggle("wide", !!(set && block && set.getBoundingClientRect().width > block.clientWidth + 1 && block.clientWidth > 0));
    }
    for (const box of document.querySelectorAll(boxes)) {
      const moves = box.scrollWidth > box.clientWidth + 1 && ["auto", "scroll"].includes(getComputedStyle(box).overflowX);
      if (moves) box.tabIndex = 0;
      else if (!box.matches("table.rows")) box.removeAttribute("tabindex");
    }
  };
  const start = () => {
    mark();
    let waiting = 0;
    window.addEventListener("resize", () => { clearTimeout(waiting); waiting = setTimeout(mark, 100); });
    document.addEventListener("toggle", mark, true);  // a box inside a folded part has no width before
    document.fonts.addEventListener("loadingdone", mark);  // glyphs have their widths then
  };
  window.addEventListener("load", () => {
    const typeset = window.MathJax && window.MathJax.startup && window.MathJax.startup.promise;
    if (typeset) typeset.then(start);
    else start();
  });
})();
