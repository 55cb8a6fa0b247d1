"use strict";
(() => {
  const film = JSON.parse(document.getElementById("film").textContent);
  const $ = (id) => document.getElementById(id);
  const all = (q, within = document) => [...within.querySelectorAll(q)];
  const stage = document.querySelector(".stage"), svg = stage.querySelector("svg"), plots = $("plots");
  const T = film.t, last = T.length - 1, end = T[last];
  const column = new Map(film.parts.map((name, i) => [name, i]));
  const groups = all("g[data-part],g[data-on]", svg)
    .map((g) => ({ g, chain: (film.chains[g.dataset.part || g.dataset.on] || []).filter((name) => column.has(name)) }))
    .filter(({ chain }) => chain.length)
    .map(({ g, chain }) => ({ g, joints: chain.map((name) => ({ i: column.get(name), m: film.motions[name] })) }));
  const springs = film.springs.map((s) => ({ ...s, i: column.get(s.part), path: svg.querySelector(`[data-spring="${s.index}"]`) }));
  const marks = all(".touch", svg), arrows = svg.querySelector(".arrows");
  const panels = all(".panel[data-curve]", plots).map((p) => ({ p, out: p.querySelector(".value"), name: p.dataset.curve }));
  const most = Math.max(...film.k) || 1;
  const strongest = film.touch.flat().reduce((a, c) => Math.max(a, c[5] || 0), 0);
  const calm = matchMedia("(prefers-reduced-motion: reduce)");
  const minus = (s) => String(s).replace("-", "−");

  let t = film.loop ? film.loop[0] : 0, playing = false, before = 0, looping = !!film.loop, clock = 0;

  // Where in the film a moment lies: the sample before it and the share of the way to the next.
  function place(time) {
    let a = 0, b = last;
    while (b - a > 1) { const m = (a + b) >> 1; if (T[m] <= time) a = m; else b = m; }
    if (T[b] <= time) a = b;
    const h = a < last ? T[a + 1] - T[a] : 0;
    return [a, h > 0 ? Math.min(1, Math.max(0, (time - T[a]) / h)) : 0];
  }
  const value = (list, a, f) => f ? list[a] + f * (list[a + 1] - list[a]) : list[a];

  function spiral(s, q) {
    const total = s.w + q, n = Math.max(24, Math.floor(Math.abs(total) * 6)), p = [];
    for (let k = 0; k <= n; k++) {
      const u = k / n, angle = 0.75 * Math.PI + (1 - u) * total, r = s.r[0] + u * (s.r[1] - s.r[0]);
      p.push((s.c[0] + r * Math.cos(angle)).toFixed(3) + " " + (s.c[1] + r * Math.sin(angle)).toFixed(3));
    }
    return "M" + p.join("L");
  }
  function coil(s, q) {
    const span = s.l + q, p = [[0, 0], [0.12, 0]];
    for (let k = 0; k < 14; k++) p.push([0.12 + 0.76 * (k + 0.5) / 14, k % 2 ? -s.b : s.b]);
    p.push([0.88, 0], [1, 0]);
    return "M" + p.map(([a, b]) => {
      const x = a * span - s.l;
      return (s.e[0] + x * s.d[0] - b * s.d[1]).toFixed(4) + " " + (s.e[1] + x * s.d[1] + b * s.d[0]).toFixed(4);
    }).join("L");
  }
  function pose(m, q) {
    if (m.kind === "turn") return `rotate(${(q * 180 / Math.PI).toFixed(4)} ${m.at[0]} ${m.at[1]})`;
    return `translate(${q * m.at[0]} ${q * m.at[1]})`;
  }
  // A spring that unwinds far is drawn with its coils scaled, so that it never turns inside out.
  for (const s of springs) {
    const reach = Math.max(...film.q[s.i].map(Math.abs)), room = Math.max(1, Math.abs(s.w || 0) - 2 * Math.PI);
    s.scale = s.kind === "spiral" && reach > room ? room / reach : 1;
  }

  // Which features touched within the last moments, newest strongest: a blow stays visible while playing.
  function glow(a, span) {
    const lit = new Map();
    for (let k = a; k >= 0 && k > a - 400 && (k === a || T[a] - T[k] < span); k--) {
      const strength = k === a ? 1 : 1 - (T[a] - T[k]) / span;
      for (const c of film.touch[k]) for (const m of c[0]) if (!lit.has(m)) lit.set(m, strength);
    }
    return lit;
  }
  function light(a) {
    const lit = glow(a, playing ? 0.12 * speed() : 0);
    marks.forEach((m, i) => { const o = lit.get(i) || 0; if (m._o !== o) { m.style.opacity = o; m._o = o; } });
    arrows.innerHTML = "";
    if (playing || !strongest) return;
    for (const [, x, y, nx, ny, force] of film.touch[a]) if (force > 0) arrow(x, y, nx, ny, force);
  }
  function arrow(x, y, nx, ny, force) {
    const long = 0.11 * film.size * Math.sqrt(force / strongest), h = 0.016 * film.size;
    const ex = x + nx * long, ey = y + ny * long;
    const wing = (s) => `${ex - h * (nx + s * 0.55 * ny)} ${ey - h * (ny - s * 0.55 * nx)}`;
    const path = document.createElementNS(svg.namespaceURI, "path");
    path.setAttribute("class", "arrow");
    path.setAttribute("d", `M${x} ${y}L${ex} ${ey}M${wing(1)}L${ex} ${ey}L${wing(-1)}`);
    arrows.append(path);
  }
  function read(name, a, f) {
    if (!column.has(name)) return minus((value(film.k, a, f)).toPrecision(3));
    const q = value(film.q[column.get(name)], a, f), m = film.motions[name];
    return minus(m && m.kind === "turn" ? (q * 180 / Math.PI).toFixed(1) + "°" : q.toPrecision(4));
  }
  function show() {
    const [a, f] = place(t);
    for (const { g, joints } of groups) {
      g.setAttribute("transform", joints.map(({ i, m }) => pose(m, value(film.q[i], a, f))).join(" "));
    }
    for (const s of springs) {
      const q = value(film.q[s.i], a, f);
      s.path.setAttribute("d", s.kind === "spiral" ? spiral(s, q * s.scale) : coil(s, q));
    }
    light(f > 0.5 && a < last ? a + 1 : a);
    plots.style.setProperty("--f", end > 0 ? t / end : 0);
    $("scrub").value = t;
    const text = t.toFixed(2) + " s";
    $("clock").textContent = text;
    $("scrub").setAttribute("aria-valuetext", text);
    if (!playing || performance.now() - clock > 90) {
      clock = performance.now();
      for (const { out, name } of panels) out.textContent = read(name, a, f);
    }
  }

  const wanted = film.loop ? film.loop[1] - film.loop[0] : end;
  // Real time where that is watchable; else a pattern in about 8 s, a long run in about a minute.
  const seconds = film.loop ? 8 : Math.max(8, Math.min(60, wanted));
  const base = wanted >= 2 && wanted <= 40 ? 1 : Math.pow(2, Math.round(Math.log2(Math.max(1e-9, wanted / seconds))));
  const rates = [1 / 16, 1 / 8, 1 / 4, 1 / 2, 1, 2, 4, 8, 16].map((r) => r * base);
  const spoken = (r) => (r >= 1 ? String(+r.toPrecision(3)) : "1/" + +(1 / r).toPrecision(3)) + "×";
  $("speed").innerHTML = rates.map((r, i) => `<option value="${r}"${i === 4 ? " selected" : ""}>${spoken(r)}</option>`).join("");
  const speed = () => +$("speed").value;

  function play(on) {
    if (on && !looping && t >= end) t = 0;
    playing = on;
    before = performance.now();
    $("play").textContent = on ? "❚❚" : "▶";
    $("play").setAttribute("aria-label", on ? "pause" : "play");
    show();
    if (on) requestAnimationFrame(frame);
  }
  function frame(now) {
    if (!playing) return;
    t += Math.min(0.25, (now - before) / 1000) * speed();
    before = now;
    if (looping) {
      const [a, b] = film.loop;
      if (t > b || t < a) t = a + ((((t - a) % (b - a)) + (b - a)) % (b - a));
    } else if (t >= end) { t = end; play(false); return; }
    show();
    requestAnimationFrame(frame);
  }
  function seek(time) { t = Math.min(end, Math.max(0, time)); show(); }
  function step(direction, far) {
    play(false);
    if (far) {
      const next = direction > 0 ? film.blows.find((b) => b > t + 1e-6) : film.blows.findLast((b) => b < t - 1e-6);
      seek(next === undefined ? (direction > 0 ? end : 0) : next);
    } else seek(t + direction * speed() / 50);
  }
  function loop(on) { looping = on && !!film.loop; if ($("loop")) $("loop").checked = looping; }

  $("play").onclick = () => play(!playing);
  $("back").onclick = (e) => step(-1, e.shiftKey);
  $("forth").onclick = (e) => step(1, e.shiftKey);
  $("scrub").oninput = (e) => { play(false); seek(+e.target.value); };
  if ($("loop")) $("loop").onchange = (e) => loop(e.target.checked);
  addEventListener("keydown", (e) => {
    if (e.ctrlKey || e.metaKey || e.altKey || e.target.tagName === "SELECT") return;
    const key = e.key;
    if (key === " " && e.target.tagName !== "BUTTON" && e.target.type !== "checkbox") { e.preventDefault(); play(!playing); }
    else if (key === "ArrowLeft" || key === "ArrowRight") { e.preventDefault(); step(key === "ArrowLeft" ? -1 : 1, e.shiftKey); }
    else if (key === "Home") { e.preventDefault(); play(false); seek(0); }
    else if (key === "End") { e.preventDefault(); play(false); seek(end); }
    else if (key === "l" || key === "L") loop(!looping);
    else if (/^[1-9]$/.test(key)) $("speed").selectedIndex = +key - 1;
  });

  // Dragging anywhere on the plots moves the machine; when paused, pointing is enough.
  const area = plots.querySelector(".area");
  const at = (e) => { const r = area.getBoundingClientRect(); return (e.clientX - r.left) / r.width * end; };
  plots.addEventListener("pointerdown", (e) => { plots.setPointerCapture(e.pointerId); play(false); seek(at(e)); });
  plots.addEventListener("pointermove", (e) => {
    if (e.buttons || (!playing && e.pointerType === "mouse")) seek(at(e));
  });

  // Pointing at a part lights its curve, pointing at a curve its part.
  function point(name) {
    for (const box of [stage, plots]) box.classList.toggle("pointing", column.has(name));
    for (const g of all(".part,.spring", svg)) g.classList.toggle("lit", g.dataset.part === name);
    for (const p of panels) p.p.classList.toggle("lit", p.name === name);
  }
  svg.addEventListener("pointerover", (e) => { const g = e.target.closest(".part,.spring"); point(g ? g.dataset.part : null); });
  svg.addEventListener("pointerleave", () => point(null));
  for (const { p, name } of panels) {
    p.querySelector(".label").addEventListener("pointerenter", () => point(name));
    p.querySelector(".label").addEventListener("pointerleave", () => point(null));
  }

  const box = svg.viewBox.baseVal;
  if (box.width > 1.15 * box.height) document.querySelector(".motion").classList.add("wide");
  calm.addEventListener("change", () => { if (calm.matches) play(false); });
  document.addEventListener("visibilitychange", () => { before = performance.now(); });
  if (location.hash.startsWith("#t=")) { t = Math.min(end, Math.max(0, parseFloat(location.hash.slice(3)) || 0)); show(); }
  else play(!calm.matches);
})();
