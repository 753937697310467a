// What a page shows in both themes.  Playwright calls this function in the page; it returns for each theme counts, and
// faults as [check, element, what is wrong].  `view` has the width [px] of the window, and whether it is paper.
(asked) => {
  const audit = (view) => {
    const faults = [], counts = {};
    const article = document.querySelector("article") || document.body;
    const looked = (check, number = 1) => { counts[check] = (counts[check] || 0) + number; };
    const named = (element) => {
      const one = element.closest("[id]");
      const own = element.tagName.toLowerCase() + (element.id ? "#" + element.id : "")
        + [...element.classList].slice(0, 2).map((name) => "." + name).join("");
      const words = (element.textContent || element.getAttribute("alt") || "").trim().replace(/\s+/g, " ").slice(0, 50);
      return own + (one && one !== element ? " in #" + one.id : "") + (words ? ` "${words}"` : "");
    };
    const fault = (check, element, text) => faults.push([check, named(element), text]);
    const kept = (rule) => {  // a rule about an element and its ancestors, each answered once
      const answers = new Map();
      return (element) => {
        if (!answers.has(element)) answers.set(element, rule(element));
        return answers.get(element);
      };
    };
    const visible = kept((element) => element.checkVisibility({ visibilityProperty: true, opacityProperty: true })
      && element.getClientRects().length > 0);
    const unseen = kept((element) => {  // for screen readers alone
      if (!element || element === document.body) return false;
      if (unseen(element.parentElement)) return true;
      if (style(element).overflow === "visible") return false;
      const box = element.getBoundingClientRect();
      return box.width <= 2 && box.height <= 2;
    });
    const style = kept((element) => {
      const { overflow, overflowX, backgroundColor, color, opacity, fill, fillOpacity } = getComputedStyle(element);
      return { overflow, overflowX, backgroundColor, color, opacity, fill, fillOpacity };
    });
    const scrolls = (element) => ["auto", "scroll"].includes(style(element).overflowX);
    const clips = (element) => ["hidden", "clip"].includes(style(element).overflowX);
    const texts = function* (root, without) {
      const walker = document.createTreeWalker(root, NodeFilter.SHOW_TEXT);
      while (walker.nextNode()) {
        const parent = walker.currentNode.parentElement;
        if (walker.currentNode.data.trim() && parent && !parent.closest(without)) yield [walker.currentNode, parent];
      }
    };

    // ---- equations
    const ink = (equation) => {  // left and right ends of its glyphs
      let left = Infinity, right = -Infinity;
      for (const glyph of equation.querySelectorAll("mjx-c, mjx-utext, mjx-line, mjx-mspace, mjx-surd")) {
        const box = glyph.getBoundingClientRect();
        if (box.width > 0) { left = Math.min(left, box.left); right = Math.max(right, box.right); }
      }
      return right > left ? { left, right } : equation.getBoundingClientRect();
    };
    const inner = (element) => {
      const box = element.getBoundingClientRect();
      return { left: box.left + element.clientLeft, right: box.left + element.clientLeft + element.clientWidth };
    };
    for (const equation of document.querySelectorAll("mjx-container")) {
      if (!visible(equation)) continue;
      looked("equations");
      const { left, right } = ink(equation);
      for (let box = equation; box && box !== document.documentElement; box = box.parentElement) {
        if (box.clientWidth === 0) continue;  // inline: it has no box of its own
        const { left: start, right: end } = inner(box);
        const cut = Math.round(Math.max(start - left, right - end));
        if (cut <= 1) continue;
        if (clips(box)) { fault("equations", equation, `cut by ${cut} px`); break; }
        if (!scrolls(box)) continue;
        if (left + box.scrollLeft < start - 1) fault("equations", equation, "its left end cannot be scrolled to");
        else if (view.paper) fault("equations", equation, `cut by ${cut} px on paper`);
        else if (view.width >= 1200) fault("equations", equation, `must be scrolled by ${cut} px`);
        break;
      }
      if (equation.querySelector("mjx-merror, [data-mjx-error]")) fault("mathematics", equation, "an error of MathJax");
      for (const word of equation.querySelectorAll("mjx-mtext"))
        if (style(word).color === "rgb(255, 0, 0)") fault("mathematics", word, "a command that MathJax does not know");
    }

    // ---- columns
    const wide = document.documentElement.scrollWidth - document.documentElement.clientWidth;
    if (wide > 1) fault("columns", document.documentElement, `the page is ${wide} px wider than the window`);
    const column = article.getBoundingClientRect();
    const outside = (box) => Math.round(Math.max(column.left - box.left, box.right - column.right));
    const held = kept((element) => {  // a box around it scrolls or clips; that is looked at itself
      const box = element.parentElement;
      return !!box && box !== article && (scrolls(box) || clips(box) || held(box));
    });
    const reported = new Set();
    for (const element of article.querySelectorAll("*")) {
      if (element.closest("mjx-container, svg") && !["MJX-CONTAINER", "svg"].includes(element.tagName)) continue;
      if (!visible(element) || unseen(element)) continue;
      looked("columns");
      const box = element.getBoundingClientRect();
      if (box.width > 0 && outside(box) > 1 && !held(element) && !reported.has(element.parentElement))
        fault("columns", element, `${outside(box)} px beyond the column`);
      if (outside(box) > 1) reported.add(element);
      const over = element.scrollWidth - element.clientWidth;
      if (over <= 1 || element.clientWidth === 0 || element.matches("input, select, mjx-container, svg, span.math")) continue;
      if (clips(element)) fault("columns", element, `cuts ${over} px of what it holds`);
      else if (scrolls(element) && element.querySelector("mjx-container") && element.matches("div.math")) continue;
      else if (scrolls(element) && (view.paper || view.width >= 1200))
        fault("columns", element, `must be scrolled by ${over} px`);
    }
    for (const [text, parent] of texts(article, "mjx-container, script, style, svg")) {
      if (!visible(parent) || unseen(parent) || held(text.parentElement) || scrolls(parent) || clips(parent)) continue;
      const range = document.createRange();
      range.selectNodeContents(text);
      const box = range.getBoundingClientRect();
      if (box.width > 0 && outside(box) > 1) fault("columns", parent, `its text is ${outside(box)} px beyond the column`);
    }

    // ---- words of tables
    const rows = (range) => new Set([...range.getClientRects()].map((box) => Math.round(box.top))).size;
    for (const cell of article.querySelectorAll("table :is(th, td)")) {
      if (!visible(cell)) continue;
      looked("words");
      for (const [text, parent] of texts(cell, "mjx-container, script, style, svg, code")) {
        const range = document.createRange();
        range.selectNodeContents(text);
        if (!visible(parent) || rows(range) < 2) continue;
        for (const word of text.data.matchAll(/[A-Za-z]{4,}/g)) {
          range.setStart(text, word.index);
          range.setEnd(text, word.index + word[0].length);
          if (rows(range) > 1) fault("words", cell, `breaks "${word[0]}"`);
        }
      }
    }

    // ---- contrast
    const brush = document.createElement("canvas").getContext("2d", { willReadFrequently: true });
    const known = new Map();
    const colour = (text) => {  // red, green, blue, opacity, each from 0 to 1
      if (!known.has(text)) {
        const part = /^rgba?\(([\d.]+), ([\d.]+), ([\d.]+)(?:, ([\d.]+))?\)$/.exec(text);
        if (part) known.set(text, [part[1] / 255, part[2] / 255, part[3] / 255, part[4] === undefined ? 1 : +part[4]]);
        else {
          brush.clearRect(0, 0, 1, 1);
          brush.fillStyle = text;
          brush.fillRect(0, 0, 1, 1);
          known.set(text, [...brush.getImageData(0, 0, 1, 1).data].map((value) => value / 255));
        }
      }
      return known.get(text);
    };
    const over = (top, ground) => [0, 1, 2].map((i) => top[i] * top[3] + ground[i] * (1 - top[3])).concat(1);
    const ground = kept((element) => {  // what is painted behind the text of an element
      if (!element) return [1, 1, 1, 1];
      const own = colour(style(element).backgroundColor);
      return own[3] === 1 ? own : over(own, ground(element.parentElement));
    });
    const opacity = kept((element) => (element ? style(element).opacity * opacity(element.parentElement) : 1));
    const light = ([red, green, blue]) => [red, green, blue]
      .map((value) => (value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4))
      .reduce((sum, value, i) => sum + value * [0.2126, 0.7152, 0.0722][i], 0);
    const shapes = new Map();
    const drawnBehind = (text) => {  // the last shapes before a text of an SVG that cover its middle
      const svg = text.ownerSVGElement;
      if (!shapes.has(svg)) shapes.set(svg, [...svg.querySelectorAll("rect, path, polygon, circle, ellipse")]
        .filter((one) => !one.closest("defs, clipPath, marker, symbol") && style(one).fill !== "none" && visible(one)));
      const box = text.getBoundingClientRect();
      let found = ground(svg);
      for (const shape of shapes.get(svg)) {
        if (!(shape.compareDocumentPosition(text) & Node.DOCUMENT_POSITION_FOLLOWING)) break;
        const screen = shape.getScreenCTM();
        if (!screen) continue;
        const middle = new DOMPoint((box.left + box.right) / 2, (box.top + box.bottom) / 2).matrixTransform(screen.inverse());
        if (!shape.isPointInFill(middle)) continue;
        const fill = colour(style(shape).fill).slice();
        fill[3] *= style(shape).fillOpacity * opacity(shape);
        found = over(fill, found);
      }
      return found;
    };
    const judged = new Map();
    const contrast = (element, shade, behind) => {
      const top = shade.slice();
      top[3] *= opacity(element);
      const pair = [light(over(top, behind)), light(behind)].sort((one, other) => other - one);
      looked("contrast");
      const ratio = (pair[0] + 0.05) / (pair[1] + 0.05);
      if (ratio < 4.495) fault("contrast", element, `contrast ${ratio.toFixed(2)}`);
    };
    for (const [, parent] of texts(document.body, "script, style, noscript, template, mjx-assistive-mml, title, desc")) {
      if (judged.has(parent) || parent.closest("mjx-container")) continue;
      judged.set(parent, true);
      if (!visible(parent) || unseen(parent) || parent.closest(":disabled")) continue;
      if (parent.ownerSVGElement) contrast(parent, colour(style(parent).fill), drawnBehind(parent));
      else contrast(parent, colour(style(parent).color), ground(parent));
    }
    for (const element of document.querySelectorAll("mjx-container, input[placeholder]")) {
      if (!visible(element)) continue;
      const shade = element.placeholder ? getComputedStyle(element, "::placeholder").color : style(element).color;
      contrast(element, colour(shade), ground(element));
    }

    // ---- what does not depend on the window
    if (view.once) {
      for (const [text, parent] of texts(article, "pre, code, .sig, script, style, mjx-container, textarea"))
        if (/\\[a-zA-Z]{2,}|\\[([]|\$[^$]*[\\^_=][^$]*\$|\*\*|(^|[^\w])[a-zA-Z]+_\{/.test(text.data)) fault("mathematics", parent, "raw LaTeX");
      let last = 0;
      for (const heading of article.querySelectorAll("h1, h2, h3, h4, h5, h6")) {
        const level = +heading.tagName[1];
        looked("headings");
        if (level > last + 1) fault("headings", heading, last ? `level ${level} after level ${last}` : "the first is not of level 1");
        if (level === 1 && last) fault("headings", heading, "a second heading of level 1");
        last = level;
      }
      if (!last) fault("headings", article, "the page has none");
      const ids = new Set();
      for (const element of document.querySelectorAll("[id]")) {
        if (ids.has(element.id) && element.id && !element.closest("svg, mjx-container")) fault("anchors", element, `a second '${element.id}'`);
        ids.add(element.id);
      }
      for (const head of article.querySelectorAll("thead th"))
        if (!head.scope && head.closest("table.rows")) fault("tables", head, "a head without a scope");
      looked("tables", article.querySelectorAll("table").length);
    }

    // ---- controls
    const controls = [...document.querySelectorAll(
      "button, input, select, textarea, summary, a[href], video, [tabindex], [role=button], [role=slider], [onclick], [contenteditable]",
    )].filter((one) => visible(one) && !one.disabled && one.type !== "hidden" && one.tabIndex !== undefined
      && !one.closest("[inert], mjx-container, [aria-hidden=true]"));
    const name = (element) => (element.getAttribute("aria-label") || element.title || element.placeholder || element.alt
      || element.textContent.trim() || [...(element.labels || [])].map((one) => one.textContent.trim()).join("")
      || (element.getAttribute("aria-labelledby") || "").split(" ").map((id) => document.getElementById(id)?.textContent || "").join("")
      || element.querySelector("img[alt]")?.alt || element.querySelector("svg title")?.textContent || "").trim();
    if (view.keyboard) {
      const seen = new Set();
      window.auditedControls = [];  // one of each sort, for real presses of Tab
      const looks = (element) => [element, element.parentElement, ...element.querySelectorAll("*")].slice(0, 12).map((one) => {
        const now = getComputedStyle(one);
        return [now.outlineStyle === "none" ? "" : now.outline, now.boxShadow, now.backgroundColor, now.color, now.borderColor,
          now.textDecorationLine, now.textDecorationThickness, now.opacity, now.transform, now.top, now.clipPath].join();
      }).join(";");
      document.activeElement?.blur();
      for (const element of controls) {
        const target = element.matches("[tabindex='-1']:is(section, div, main, article, table, pre, figure, dialog)");
        if (target && !element.matches("[onclick], [role]")) continue;  // a script's target, no control
        looked("controls");
        if (!name(element) && !element.matches("div, pre, table")) fault("controls", element, "has no name");
        if (element.tabIndex > 0) fault("controls", element, "changes the order of Tab");
        const one = element.getAttribute("role") === "radio" || element.type === "radio";
        if (element.tabIndex < 0 && !one) { fault("controls", element, "cannot be reached by Tab"); continue; }
        const sort = element.tagName + "." + element.className;
        if (seen.has(sort)) continue;
        seen.add(sort);
        const before = looks(element);
        element.focus({ preventScroll: true });
        if (document.activeElement !== element) fault("controls", element, "cannot be reached by Tab");
        else if (looks(element) === before) fault("controls", element, "shows no focus");
        element.blur();
        window.auditedControls.push([element, named(element)]);
      }
    }
    for (const element of document.querySelectorAll("main *")) {  // scrolling boxes
      if (!scrolls(element) || element.clientWidth === 0 || element.closest("mjx-container, svg") || !visible(element)) continue;
      if (element.scrollWidth <= element.clientWidth + 1) continue;
      looked("controls");
      if (!view.paper && element.tabIndex < 0 && !element.querySelector("a[href], button, input, summary"))
        fault("controls", element, "scrolls, and Tab does not reach it");
    }

    // ---- figures
    const figures = [];
    if (view.once) {
      for (const picture of article.querySelectorAll("img, svg, canvas, video")) {
        if (picture.parentElement.closest("svg, mjx-container") || picture.closest("[aria-hidden=true], button, summary, a.headerlink")) continue;
        const figure = picture.closest("figure");
        const caption = figure?.querySelector("figcaption");
        const words = (picture.alt || picture.getAttribute("aria-label") || picture.querySelector(":scope > title")?.textContent
          || picture.querySelector(":scope > desc")?.textContent || "").replace(/\s+/g, " ").trim();
        looked("figures");
        if (picture.tagName === "svg" && picture.getAttribute("role") !== "img" && words) fault("figures", picture, "a drawing without role 'img'");
        figures.push([named(picture), words, (caption?.querySelector("b, strong")?.textContent || "").replace(/\.$/, ""),
          (caption?.textContent || "").replace(/\s+/g, " ").trim(), figure?.id || ""]);
      }
    }
    const result = { faults, counts, figures };
    if (view.once) {
      result.ids = [...document.querySelectorAll("[id], a[name]")].map((one) => one.id || one.name);
      result.links = [...document.querySelectorAll("a[href], area[href]")].map((one) => [one.getAttribute("href"), named(one)]);
      result.sources = [...document.querySelectorAll("[src]")].map((one) => [one.getAttribute("src").slice(0, 200), named(one)]);
      result.mathematics = !!document.querySelector("mjx-container");
      result.typesetter = !!document.querySelector('script[src*="mathjax"]');
    }
    return result;
  };

  return ["light", "dark"].map((theme) => {
    Object.assign(document.documentElement.dataset, { theme, mode: theme });
    const light = theme === "light";
    return audit({ ...asked, once: asked.width === 1200 && light, keyboard: !asked.paper && asked.width <= 1200 && light });
  });
}
