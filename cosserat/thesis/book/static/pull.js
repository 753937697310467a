/* Pull it yourself: moves the tip of the rod in <figure data-pull> by pointer or keyboard and draws what comes of it.
   The module of WebAssembly beside it finds the equilibria; this script computes no mechanics.  If the module does not
   start, the player of stored states inside the figure stays in its place. */
(function () {
  "use strict";
  const OUTCOME = 0, ITERATIONS = 2, FALLS = 4, ENERGY = 5, FORCE_3 = 6, FORCE_2 = 7;
  const KEYS = { ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
  const PIXELS = 640, FINGER = 18, SVG = "http://www.w3.org/2000/svg";

  function bytes(text) {
    return Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  }

  function number(value, digits) {
    return (+value.toFixed(digits) || 0).toFixed(digits).replace("-", "\u2212");  /* no minus before a zero */
  }

  function start(figure, said, made) {
    const { pull, reserve, memory } = made.exports, first = bytes(said.room), n = 4 * said.vertices;
    const size = first.length / 8, address = reserve(first.length);
    const live = figure.querySelector(".live"), stage = live.querySelector(".stage");
    const svg = stage.querySelector("svg"), tell = live.querySelector("output"), note = live.querySelector(".note");
    const scale = PIXELS / (said.view[1] - said.view[0]);
    const parts = [];  /* of the body, one between two vertices */
    let goal = null, waiting = false, hand = null;

    /* The memory moves when it grows, so it is looked up at each use. */
    function room() {
      return new Float64Array(memory.buffer, address, size);
    }
    function reset() {
      new Uint8Array(memory.buffer, address, first.length).set(first);
      pull(address, size, said.vertices, 0, 0);
      goal = null;
      show("At rest.");
    }
    function pixel(x, y) {
      return [(scale * (x - said.view[0])).toFixed(2), (scale * (said.view[3] - y)).toFixed(2)];
    }
    function element(name, look) {
      const made = svg.appendChild(document.createElementNS(SVG, name));
      made.setAttribute("class", look);
      return made;
    }
    function tip() {
      const now = room(), q = said.head + n - 4;
      return [now[q] + now[q + n], now[q + 1] + now[q + n + 1]];
    }

    const ground = element("path", "ground"), inside = element("path", "inside");
    const body = element("g", "body"), edge = element("path", "edge");
    const arrow = element("path", "force"), ring = element("circle", "hand");
    for (let k = 1; k < said.vertices; k++) {
      const part = body.appendChild(document.createElementNS(SVG, "path"));
      parts.push(part);
    }
    {
      const [x, low] = pixel(0, -said.clamp), [, high] = pixel(0, said.clamp);
      ground.setAttribute("d", "M" + x + " " + low + "L" + x + " " + high);
      const from = [said.view[0] + 0.01, said.view[2] + 0.012], ruler = element("path", "ruler"), word = element("text", "");
      const [a, b] = pixel(from[0], from[1]), [c] = pixel(from[0] + said.ruler, from[1]);
      ruler.setAttribute("d", "M" + a + " " + (b - 5) + "V" + b + "H" + c + "V" + (b - 5));
      word.setAttribute("x", a);
      word.setAttribute("y", b - 9);
      word.textContent = number(1e3 * said.ruler, 0) + " mm";
    }

    function show(words) {
      const now = room(), x = [], up = [], low = [], wide = [];
      for (let k = 0; k < said.vertices; k++) {
        const q = said.head + 4 * k, at = [0, 1, 2, 3].map((i) => now[q + i] + now[q + n + i]);
        x.push(pixel(at[0], at[1]));
        up.push(pixel(at[0] + at[2], at[1] + at[3]));
        low.push(pixel(at[0] - said.below * at[2], at[1] - said.below * at[3]));
        wide.push(Math.hypot(at[2], at[3]) / Math.hypot(now[q + n + 2], now[q + n + 3]) - 1);
      }
      parts.forEach((part, k) => {
        const mean = (wide[k] + wide[k + 1]) / 2;
        part.setAttribute("d", "M" + [up[k], up[k + 1], low[k + 1], low[k]].map((at) => at.join(" ")).join("L") + "Z");
        part.setAttribute("class", mean < 0 ? "thin" : "thick");
        part.style.fillOpacity = Math.min(1, Math.abs(mean) / said.strongest).toFixed(3);
      });
      const outline = "M" + up.concat(low.slice().reverse()).map((at) => at.join(" ")).join("L") + "Z";
      edge.setAttribute("d", outline);
      inside.setAttribute("d", outline);
      const [a, b] = x[said.vertices - 1].map(Number), force = [now[FORCE_3], now[FORCE_2]];
      const along = force.map((part) => part * said.arrow), long = Math.hypot(...along);
      const most = Math.min(1, 200 / (long || 1)), end = [a + most * along[0], b - most * along[1]];
      const turn = Math.atan2(b - end[1], end[0] - a);
      const barb = [2.7, -2.7].map((angle) => (end[0] + 10 * Math.cos(turn + angle)).toFixed(1) + " " +
        (end[1] - 10 * Math.sin(turn + angle)).toFixed(1));
      arrow.setAttribute("d", long * most < 4 ? "" : "M" + a + " " + b + "L" + end.join(" ") + "M" + barb[0] + "L" +
        end.join(" ") + "L" + barb[1]);
      ring.setAttribute("r", Math.max(13, FINGER * PIXELS / (svg.clientWidth || PIXELS)));
      ring.setAttribute("cx", a);
      ring.setAttribute("cy", b);
      const place = tip().map((part) => number(1e3 * part, 1));
      tell.textContent = "tip at " + place[0] + ", " + place[1] + " mm; force " + number(force[0], 2) + " N along E3, " +
        number(force[1], 2) + " N along E2; energy " + number(1e3 * now[ENERGY], 1) + " mJ; Newton steps " +
        now[ITERATIONS] + "; stretch of the sections " + number(100 * Math.min(...wide), 1) + " % to " +
        number(100 * Math.max(...wide), 1) + " %";
      note.textContent = words;
    }

    /* The nearest place of the tip [m] within the drawing and no farther from the clamp than the page allows. */
    function within(to) {
      const edge = said.clamp, place = [0, 1].map((k) =>
        Math.max(said.view[2 * k] + edge, Math.min(said.view[2 * k + 1] - edge, to[k])));
      const share = Math.min(1, said.reach / (Math.hypot(place[0], place[1]) || 1));
      return [share * place[0], share * place[1]];
    }
    function move(to) {
      const from = tip(), before = room().slice(), place = within(to);
      try {
        pull(address, size, said.vertices, place[0] - from[0], place[1] - from[1]);
      } catch (error) {
        room().set(before);
        show("The solver stopped (" + error.message + "); the last state is shown.");
        return;
      }
      const outcome = room()[OUTCOME];
      show(outcome === 2 ? "No stable equilibrium was found on the way; the last one is shown." : room()[FALLS] > 0 ?
        "The rod fell: no stable equilibrium was near, and its energy decreased until it came to another one." :
        "In balance.");
    }
    function later(to) {
      goal = to;
      if (waiting) return;
      waiting = true;
      requestAnimationFrame(() => {
        waiting = false;
        if (goal) move(goal);
        goal = null;
      });
    }
    function under(event) {
      const box = svg.getBoundingClientRect(), metre = (said.view[1] - said.view[0]) / box.width;
      return [said.view[0] + metre * (event.clientX - box.left), said.view[3] - metre * (event.clientY - box.top)];
    }
    /* A finger on the ring does not scroll the page; browsers ignore touch-action on parts of a drawing. */
    ring.addEventListener("touchstart", (event) => event.preventDefault(), { passive: false });
    ring.addEventListener("pointerdown", (event) => {
      const at = under(event), now = tip();
      hand = [now[0] - at[0], now[1] - at[1]];
      ring.setPointerCapture(event.pointerId);
      stage.focus({ preventScroll: true });
      event.preventDefault();
    });
    ring.addEventListener("pointermove", (event) => {
      if (!hand) return;
      const at = under(event);
      later([at[0] + hand[0], at[1] + hand[1]]);
    });
    ["pointerup", "pointercancel"].forEach((name) => ring.addEventListener(name, () => { hand = null; }));
    function step(way, times) {
      const from = goal || tip();
      later([from[0] + times * said.step * way[0], from[1] + times * said.step * way[1]]);
    }
    stage.addEventListener("keydown", (event) => {
      if (event.key === "Home") reset();
      else if (event.key in KEYS) step(KEYS[event.key], event.shiftKey ? 5 : 1);
      else return;
      event.preventDefault();
    });
    live.querySelectorAll("button[data-key]").forEach((button) => {
      button.addEventListener("click", () => step(KEYS[button.dataset.key], 5));
    });
    live.querySelector("button.reset").addEventListener("click", reset);
    figure.pulled = () => ({ busy: waiting, room: Array.from(room()) });  /* for who wants to check it */
    live.hidden = false;
    reset();
    figure.dataset.pull = "ready";
  }

  function all() {
    document.querySelectorAll("figure[data-pull='']").forEach((figure) => {
      const said = JSON.parse(figure.querySelector("script.rod").textContent);
      const refuse = (error) => { figure.querySelector(".instead").textContent += " (" + error.message + ")"; };
      try {
        WebAssembly.instantiate(bytes(said.module), {}).then((made) => start(figure, said, made.instance)).catch(refuse);
      } catch (error) {
        refuse(error);
      }
    });
  }
  if (document.readyState === "loading") document.addEventListener("DOMContentLoaded", all);
  else all();
})();
