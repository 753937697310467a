/* Plays stored states: moves the parts of <figure data-player> through the states that travel beside them.
   It reads whole numbers (value = offset + step * number) and draws; it computes nothing. */
(function () {
  "use strict";
  const GAP = -32768, JUMP = 12;
  const still = matchMedia("(prefers-reduced-motion: reduce)");

  function unpack(field) {
    const bytes = Uint8Array.from(atob(field.data), (letter) => letter.charCodeAt(0));
    const view = new DataView(bytes.buffer), values = new Float32Array(bytes.length / 2);
    for (let k = 0; k < values.length; k++) {
      const number = view.getInt16(2 * k, true);
      values[k] = number === GAP ? NaN : field.offset + field.step * number;
    }
    return values;
  }

  /* The path of a line in one state; a value that is missing lifts the pen. */
  function outline(part, xs, ys, state) {
    const [x0, along, y0, up] = part.map, n = part.count;
    const i = part.still[0] ? 0 : n * state, j = part.still[1] ? 0 : n * state;
    const base = part.base === undefined ? null : (y0 + up * part.base).toFixed(1);
    let path = "", begin = null, last = null;
    const end = () => {
      if (begin === null) return;
      path += base === null ? (part.closed ? "Z" : "") : "L" + last + " " + base + "L" + begin + " " + base + "Z";
      begin = null;
    };
    for (let k = 0; k < n; k++) {
      const x = xs[i + k], y = ys[j + k];
      if (Number.isNaN(x) || Number.isNaN(y)) { end(); continue; }
      last = (x0 + along * x).toFixed(1);
      path += (begin === null ? "M" : "L") + last + " " + (y0 + up * y).toFixed(1);
      if (begin === null) begin = last;
    }
    end();
    return path;
  }

  function place(node, part, xs, ys, state) {
    const [x0, along, y0, up] = part.map;
    const x = x0 + along * xs[xs.length > 1 ? state : 0], y = y0 + up * ys[ys.length > 1 ? state : 0];
    const missing = Number.isNaN(x) || Number.isNaN(y);
    node.setAttribute("visibility", missing ? "hidden" : "visible");
    if (!missing) node.setAttribute("transform", "translate(" + x.toFixed(1) + " " + y.toFixed(1) + ")");
  }

  function start(figure) {
    const said = JSON.parse(figure.querySelector("script[type='application/json']").textContent);
    const fields = said.fields.map(unpack), last = said.pace.length - 1;
    const nodes = figure.querySelectorAll("[data-part]");
    const controls = figure.querySelector(".controls"), button = controls.querySelector("button");
    const sliders = [...controls.querySelectorAll("input")], clocks = controls.querySelectorAll("output");
    const slider = sliders[0];  /* the one that plays */
    let playing = false, begun = 0;

    function draw() {  /* the state at which the sliders stand; those of the last one follow each other */
      const state = sliders.reduce((whole, one) => whole * (+one.max + 1) + +one.value, 0);
      said.parts.forEach((part, k) => {
        const xs = fields[part.x], ys = fields[part.y];
        if (part.mark) place(nodes[k], part, xs, ys, state);
        else nodes[k].setAttribute("d", outline(part, xs, ys, state));
      });
      sliders.forEach((one, k) => {
        clocks[k].textContent = said.clock[k][+one.value];
        one.setAttribute("aria-valuetext", said.clock[k][+one.value]);
      });
    }
    function show(place) {
      slider.value = place;
      draw();
    }
    function name() {
      button.textContent = still.matches ? "Next" : playing ? "Pause" : "Play";
    }
    function stop() {
      playing = false;
      name();
    }
    function tick(now) {
      if (!playing) return;
      let share = (now - begun) / 1000 / said.seconds;
      if (share >= 1 && said.loop) { begun = now; share = 0; }
      if (share >= 1) { show(last); stop(); return; }
      let state = said.pace.findIndex((reached) => reached > share) - 1;
      show(state < 0 ? 0 : state);
      requestAnimationFrame(tick);
    }
    function toggle() {
      const state = +slider.value;
      if (still.matches) {  /* who wants no motion goes from state to state */
        stop();
        show(state === last ? 0 : Math.min(last, state + Math.max(1, Math.round(last / JUMP))));
        return;
      }
      if (playing) { stop(); return; }
      playing = true;
      begun = performance.now() - 1000 * said.seconds * (state === last ? 0 : said.pace[state]);
      name();
      requestAnimationFrame(tick);
    }
    button.addEventListener("click", toggle);
    for (const one of sliders) {
      one.addEventListener("input", () => { stop(); draw(); });
      one.addEventListener("keydown", (event) => {
        if (event.key === " ") { event.preventDefault(); toggle(); }
      });
    }
    still.addEventListener("change", stop);
    for (const one of sliders) one.value = one.getAttribute("value");  /* not what a reload remembers */
    draw();
    name();
    controls.hidden = false;
    figure.dataset.player = "ready";
  }

  function all() {
    document.querySelectorAll("figure[data-player='']").forEach(start);
  }
  if (document.readyState === "loading") document.addEventListener("DOMContentLoaded", all);
  else all();
})();
