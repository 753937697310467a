// Tables in a box of class "filtered" get a field that filters their rows and headings that sort them.
(function () {
  "use strict";

  function sortable(cell) {
    const text = cell.textContent.trim();
    const number = parseFloat(text.replace("−", "-"));
    return isNaN(number) ? [1, 0, text] : [0, number, text];
  }

  function compare(a, b) {
    return a[0] - b[0] || a[1] - b[1] || a[2].localeCompare(b[2], "en", { numeric: true });
  }

  function sorts(table, heading, column) {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = heading.textContent;
    button.title = "sort by " + heading.textContent;
    heading.replaceChildren(button);
    button.addEventListener("click", function () {
      const down = heading.getAttribute("aria-sort") === "ascending";
      table.querySelectorAll("thead th").forEach(function (other) { other.removeAttribute("aria-sort"); });
      heading.setAttribute("aria-sort", down ? "descending" : "ascending");
      const rows = Array.from(table.tBodies[0].rows);
      rows.sort(function (a, b) {
        return (down ? -1 : 1) * compare(sortable(a.cells[column]), sortable(b.cells[column]));
      });
      table.tBodies[0].append.apply(table.tBodies[0], rows);
    });
  }

  function filters(box, table, what) {
    const rows = Array.from(table.tBodies[0].rows);
    const texts = rows.map(function (row) { return row.textContent.toLowerCase(); });
    const label = document.createElement("label");
    const field = document.createElement("input");
    const count = document.createElement("output");
    field.type = "search";
    label.append("Only " + what + " with ", field);
    function apply() {
      const words = field.value.toLowerCase().split(/\s+/).filter(Boolean);
      let shown = 0;
      rows.forEach(function (row, k) {
        row.hidden = !words.every(function (word) { return texts[k].includes(word); });
        shown += row.hidden ? 0 : 1;
      });
      count.textContent = shown + " of " + rows.length;
    }
    field.addEventListener("input", apply);
    window.addEventListener("hashchange", function () { field.value = ""; apply(); });
    const line = document.createElement("p");
    line.append(label, " ", count);
    box.prepend(line);
    apply();
  }

  document.addEventListener("DOMContentLoaded", function () {
    document.querySelectorAll("div.filtered").forEach(function (box) {
      const table = box.querySelector("table");
      Array.from(table.tHead.rows[0].cells).forEach(function (heading, k) { sorts(table, heading, k); });
      filters(box, table, box.dataset.what);
    });
  });
})();
