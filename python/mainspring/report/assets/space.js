"use strict";
(() => {
  const space = JSON.parse(document.getElementById("space").textContent);
  const $ = (id) => document.getElementById(id);
  const all = (q, within = document) => [...within.querySelectorAll(q)];
  const map = $("map"), stage = document.querySelector(".stage"), machine = stage.querySelector("svg");
  const here = map.querySelector(".here"), near = map.querySelector(".near"), toward = map.querySelector(".toward");
  const free = map.querySelector("defs .cs-free");
  const [X, Y] = space.axes, [left, top, wide, tall] = space.box;
  const marks = all(".touch", machine);
  const minus = (s) => String(s).replace("-", "−");

  // Configurations to pixels of the map and back.
  const across = wide / (X.view[1] - X.view[0]), up = tall / (Y.view[1] - Y.view[0]);
  const pixel = ([a, b]) => [left + (a - X.view[0]) * across, top + (Y.view[1] - b) * up];
  const value = ([x, y]) => [X.view[0] + (x - left) / across, Y.view[1] - (y - top) / up];

  // The same place within the stored tile.
  function wrapped(v, axis) {
    if (!axis.period) return v;
    return v - Math.floor((v - axis.tile[0]) / axis.period) * axis.period;
  }
  const tiles = (v, axis) => axis.period ? Math.floor((v - axis.tile[0]) / axis.period) : 0;
  const inTile = (q) => [wrapped(q[0], X), wrapped(q[1], Y)];

  function isFree(q) {
    if (!free) return false;
    const [x, y] = pixel(inTile(q));
    const point = map.createSVGPoint();
    point.x = x; point.y = y;
    return free.isPointInFill(point);
  }

  // Curves in pixels, once for all.
  const curves = space.curves.map((c) => ({ ...c, px: c.p.map(pixel) }));
  const steps = (axis, scale) => axis.period ? [-axis.period * scale, 0, axis.period * scale] : [0];
  const shiftsX = steps(X, across), shiftsY = steps(Y, -up);

  // The place on a contact curve nearest in the picture.
  function nearest(q) {
    const [x, y] = pixel(inTile(q));
    let best = null, least = Infinity;
    for (const curve of curves) for (let i = 1; i < curve.px.length; i++) {
      const [ax, ay] = curve.px[i - 1], dx = curve.px[i][0] - ax, dy = curve.px[i][1] - ay, l = dx * dx + dy * dy;
      for (const sx of shiftsX) for (const sy of shiftsY) {
        const px = x - ax - sx, py = y - ay - sy;
        const f = l > 0 ? Math.min(1, Math.max(0, (px * dx + py * dy) / l)) : 0;
        const ex = px - f * dx, ey = py - f * dy, d = ex * ex + ey * ey;
        if (d < least) { least = d; best = { curve, off: [-ex, -ey] }; }
      }
    }
    return best;
  }

  // The machine.
  const groups = all("g[data-part],g[data-on]", machine).map((g) => ({
    g, joints: (space.chains[g.dataset.part || g.dataset.on] || []).map((name) => ({ name, m: space.motions[name] })),
  })).filter(({ g, joints }) => joints.length || g.firstElementChild.classList.contains("touch"));
  for (const g of all(".part", machine)) g.classList.toggle("aside", !space.parts.includes(g.dataset.part));
  function turn(m, x) {
    if (m.kind === "turn") return `rotate(${(x * 180 / Math.PI).toFixed(4)} ${m.at[0]} ${m.at[1]})`;
    return `translate(${x * m.at[0]} ${x * m.at[1]})`;
  }
  function position(name, q) {
    const [axis, ratio] = space.moves[name] || [0, 0];
    return ratio ? ratio * q[axis] : space.others[name] || 0;
  }

  // In a copy of the tile another tooth touches: what is lit is turned by as many periods.
  function beyond(g) {
    if (!g.firstElementChild.classList.contains("touch")) return "";
    return space.axes.map((axis, k) => {
      const t = space.tiles[k], n = tiles(q[k], axis);
      return t && n && t.part === g.dataset.part ? ` rotate(${n * t.angle * 180 / Math.PI} ${t.center})` : "";
    }).join("");
  }

  // A turning part comes in again at the other side of the map.
  function seen(p) {
    return space.axes.map((axis, k) => {
      const whole = axis.turns && axis.period, turns = whole ? Math.ceil((p[k] - axis.view[1]) / (2 * Math.PI)) : 0;
      const v = p[k] - 2 * Math.PI * turns;
      return whole && v < axis.view[0] && v + 2 * Math.PI <= axis.view[1] ? v + 2 * Math.PI : v;
    });
  }

  let q = space.start.slice(), held = false;
  const said = (v, axis) => minus(axis.turns ? (v * 180 / Math.PI).toFixed(2) + "°" : v.toPrecision(5));

  function show() {
    const open = isFree(q), hit = nearest(q), [x, y] = pixel(q);
    for (const { g, joints } of groups) {
      g.setAttribute("transform", joints.map(({ name, m }) => turn(m, position(name, q))).join(" ") + beyond(g));
    }
    here.setAttribute("cx", x); here.setAttribute("cy", y);
    const lit = new Set(hit ? hit.curve.m : []);
    marks.forEach((m, i) => { m.style.opacity = lit.has(i) ? 1 : 0; });
    near.style.display = toward.style.display = hit ? "" : "none";
    if (hit) {
      const nx = x + hit.off[0], ny = y + hit.off[1];
      near.setAttribute("cx", nx); near.setAttribute("cy", ny);
      toward.setAttribute("d", `M${x} ${y}L${nx} ${ny}`);
    }
    // Within a pixel's half the picture cannot tell.
    const touches = hit && Math.hypot(...hit.off) < 0.5;
    const word = touches ? "in contact" : open ? "free" : "blocked";
    stage.classList.toggle("blocked", !open && !touches);
    const touching = hit ? ` ${touches ? "Touching" : "Nearest in the map"}: ${hit.curve.t}.` : "";
    $("where").textContent = `${X.name} ${said(q[0], X)}, ${Y.name} ${said(q[1], Y)}: ${word}.${touching}`;
  }
  function clamp(v, axis) { return Math.min(axis.view[1], Math.max(axis.view[0], v)); }
  function go(to) { play(false); q = [clamp(to[0], X), clamp(to[1], Y)]; show(); }
  function toContact() {
    const hit = nearest(q);
    if (!hit) return;
    const [x, y] = pixel(q);
    held = true;
    go(value([x + hit.off[0], y + hit.off[1]]));
  }
  function toStart() { held = true; go(space.start); }

  // The film: the first part pushed, at an even pace along the way in the map.
  const calm = matchMedia("(prefers-reduced-motion: reduce)");
  const film = space.film && space.film.points, SECONDS = 9;
  const trail = map.querySelector(".trail"), way = [0];
  if (film) for (let i = 1; i < film.length; i++) {
    way.push(way[i - 1] + Math.hypot((film[i][0] - film[i - 1][0]) * across, (film[i][1] - film[i - 1][1]) * up));
  }
  let playing = false, before = 0, passed = 0;
  function at(length) {
    let i = 1;
    while (i < way.length - 1 && way[i] < length) i++;
    const f = way[i] > way[i - 1] ? Math.min(1, (length - way[i - 1]) / (way[i] - way[i - 1])) : 1;
    return [i, film[i - 1].map((v, k) => v + f * (film[i][k] - v))];
  }
  function place() {
    const [i, p] = at(passed), line = [...film.slice(0, i), p].map((c) => pixel(seen(c)));
    // A line that leaves the map at one side goes on at the other.
    const joined = (c, b) => Math.abs(c[0] - b[0]) < wide / 2 && Math.abs(c[1] - b[1]) < tall / 2;
    const step = (c, k) => (k && joined(c, line[k - 1]) ? "L" : "M") + c[0].toFixed(1) + " " + c[1].toFixed(1);
    trail.setAttribute("d", line.map(step).join(""));
    q = seen(p);
    show();
  }
  function play(on) {
    if (!film || playing === on) return;
    playing = on;
    if (on) { if (passed >= way[way.length - 1]) passed = 0; before = performance.now(); requestAnimationFrame(frame); }
    $("play").textContent = $("play").textContent.replace(/^\S+/, on ? "❚❚" : "▶");
    $("where").setAttribute("aria-live", on ? "off" : "polite");
  }
  function frame(now) {
    if (!playing) return;
    const end = way[way.length - 1];
    passed += Math.max(0, Math.min(0.1, (now - before) / 1000)) * end / SECONDS;
    before = now;
    if (passed >= end) {
      if (space.film.end !== "arrived") { passed = end; place(); play(false); return; }
      passed = 0;
    }
    place();
    requestAnimationFrame(frame);
  }

  // Pointer and keys.
  function pointed(e) {
    const p = new DOMPoint(e.clientX, e.clientY).matrixTransform(map.getScreenCTM().inverse());
    return value([p.x, p.y]);
  }
  map.addEventListener("pointermove", (e) => {
    if (e.buttons || (e.pointerType === "mouse" && !held && !playing)) go(pointed(e));
  });
  map.addEventListener("pointerdown", (e) => { map.setPointerCapture(e.pointerId); go(pointed(e)); });
  map.addEventListener("click", () => { held = !held; });
  if (film) $("play").onclick = () => play(!playing);
  map.addEventListener("keydown", (e) => {
    if (e.ctrlKey || e.metaKey || e.altKey) return;
    const far = e.shiftKey ? 0.05 : 0.005, sx = far * (X.view[1] - X.view[0]), sy = far * (Y.view[1] - Y.view[0]);
    const step = { ArrowLeft: [-sx, 0], ArrowRight: [sx, 0], ArrowUp: [0, sy], ArrowDown: [0, -sy] }[e.key];
    if (step) { held = true; go([q[0] + step[0], q[1] + step[1]]); }
    else if (e.key === "c" || e.key === "C") toContact();
    else if (e.key === "s" || e.key === "S") toStart();
    else if (e.key === " ") play(!playing);
    else if (e.key === "Escape") held = false;
    else return;
    e.preventDefault();
  });
  $("to-start").onclick = toStart;
  $("to-contact").onclick = toContact;
  if (location.hash.startsWith("#at=")) {
    const asked = location.hash.slice(4).split(",");
    const to = asked.map((v, k) => parseFloat(v) * (k < 2 && space.axes[k].turns ? Math.PI / 180 : 1));
    if (to.length === 2 && to.every(Number.isFinite)) { q = to; held = true; }
  }
  show();
  calm.addEventListener("change", () => { if (calm.matches) play(false); });
  if (!held && !calm.matches) play(true);
})();
