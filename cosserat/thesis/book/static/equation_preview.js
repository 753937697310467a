// A link to an equation shows it while the pointer or the focus is on it. EQUATIONS is written by links.py.
(function () {
  "use strict";
  let box = null;

  function hide() {
    if (box) box.remove();
    box = null;
  }

  function show(link) {
    hide();
    const number = decodeURIComponent(link.hash).replace("#eq-", "");
    const source = EQUATIONS[number];
    if (!source || !window.MathJax || !MathJax.typesetPromise) return;
    box = document.createElement("div");
    box.className = "equation-preview";
    box.setAttribute("role", "tooltip");
    box.textContent = source.replace(/\\tag\{[^}]*\}/, "");
    box.style.visibility = "hidden";
    document.body.append(box);
    const own = box;
    MathJax.typesetPromise([box]).then(function () {
      const place = link.getBoundingClientRect();
      const left = Math.min(place.left, document.documentElement.clientWidth - own.offsetWidth - 8);
      const below = place.bottom + 6 + own.offsetHeight < window.innerHeight;
      own.style.left = Math.max(8, left) + "px";
      own.style.top = (below ? place.bottom + 6 : Math.max(8, place.top - 6 - own.offsetHeight)) + "px";
      own.style.visibility = "visible";
    });
  }

  document.addEventListener("DOMContentLoaded", function () {
    document.querySelectorAll("a.ref.to-eq").forEach(function (link) {
      link.addEventListener("mouseenter", function () { show(link); });
      link.addEventListener("focus", function () { show(link); });
      link.addEventListener("mouseleave", hide);
      link.addEventListener("blur", hide);
    });
    document.addEventListener("keydown", function (event) { if (event.key === "Escape") hide(); });
    document.addEventListener("scroll", hide, { passive: true });
  });
})();
