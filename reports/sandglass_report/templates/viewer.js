// The 3D viewer: two bodies side by side, far faces drawn first, with a common camera.
(() => {
  const holder = document.querySelector("#viewer");
  const data = JSON.parse(document.querySelector("#viewer-data").textContent);
  if (!holder || !Object.keys(data.cases).length) return;
  const get = (name) => holder.querySelector(`[name=${name}]`);
  const canvases = [...holder.querySelectorAll("canvas")];
  const captions = [...holder.querySelectorAll(".caption")];
  const camera = { azimuth: 0, elevation: 0, zoom: 1 };

  const bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const places = ({ low, size, xyz }) =>
    Float64Array.from(new Uint16Array(bytes(xyz).buffer), (v, i) => low[i % 3] + (v / 65535) * size);

  // A case with its arrays decoded, cached for switching back.
  const decoded = new Map();
  function open(name) {
    if (!decoded.has(name)) {
      const raw = data.cases[name];
      const numbers = bytes(raw.faces).buffer;
      decoded.set(name, {
        ...raw,
        faces: raw.wide ? new Uint32Array(numbers) : new Uint16Array(numbers),
        rest: places(raw.rest),
        decoded: new Map(),
      });
    }
    return decoded.get(name);
  }
  function answer(body, name) {
    if (name === "undeformed") return { points: body.rest };
    if (!body.decoded.has(name)) {
      const raw = body.answers[name];
      const levels = Object.fromEntries(Object.keys(data.scales).filter((k) => raw[k]).map((k) => [k, bytes(raw[k])]));
      body.decoded.set(name, { points: places(raw.places), levels, largest: raw.largest });
    }
    return body.decoded.get(name);
  }

  // Rows: right, up, towards the viewer, as in sandglass_report/shapes.py.
  function axes(azimuth = camera.azimuth, elevation = camera.elevation) {
    const [a, e] = [azimuth, elevation].map((d) => (d * Math.PI) / 180);
    const [ca, sa, ce, se] = [Math.cos(a), Math.sin(a), Math.cos(e), Math.sin(e)];
    return [[ca, sa, 0], [-sa * se, ca * se, ce], [sa * ce, -ca * ce, se]];
  }
  const turned = (points, rows) => {
    const out = new Float64Array(points.length);
    for (let i = 0; i < points.length; i += 3)
      for (let r = 0; r < 3; r++)
        out[i + r] = rows[r][0] * points[i] + rows[r][1] * points[i + 1] + rows[r][2] * points[i + 2];
    return out;
  };

  // Centre, width and height, in the case's default view, of the bodies that set the scale: the undeformed one and
  // the golden, or the answer shown if there is no golden.
  function bounds(body) {
    const known = [body.rest, answer(body, body.answers.golden ? "golden" : get("left").value).points];
    const spans = (points) => {
      const span = [0, 1, 2].map(() => [Infinity, -Infinity]);
      for (const array of points)
        array.forEach((v, i) => {
          const one = span[i % 3];
          if (v < one[0]) one[0] = v;
          if (v > one[1]) one[1] = v;
        });
      return span;
    };
    const home = axes(...body.view);
    return {
      middle: spans(known).map(([low, high]) => (low + high) / 2),
      reach: spans(known.map((points) => turned(points, home))).map(([low, high]) => high - low),
    };
  }

  const shade = (hex, light) => {
    const at = (i) => Math.round(parseInt(hex.slice(i, i + 2), 16) * light);
    return `rgb(${at(1)},${at(3)},${at(5)})`;
  };

  function paint(canvas, body, shown, key, { middle, reach }) {
    const ratio = window.devicePixelRatio || 1;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    const context = canvas.getContext("2d");
    context.scale(ratio, ratio);
    const rows = axes();
    const flat = turned(shown.points, rows);
    const centre = turned(Float64Array.from(middle), rows);
    const scale = 0.92 * camera.zoom * Math.min(width / reach[0], height / reach[1]);
    const x = (n) => width / 2 + (flat[3 * n] - centre[0]) * scale;
    const y = (n) => height / 2 - (flat[3 * n + 1] - centre[1]) * scale;
    const faces = body.faces;
    const count = faces.length / 4;
    const near = Float64Array.from({ length: count }, (_, f) =>
      [0, 1, 2, 3].reduce((sum, k) => sum + flat[3 * faces[4 * f + k] + 2], 0));
    const order = Uint32Array.from({ length: count }, (_, f) => f).sort((a, b) => near[a] - near[b]);
    const levels = shown.levels?.[key];
    const stops = data.scales[key].map;
    context.lineWidth = 0.5;
    context.lineJoin = "round";
    for (const f of order) {
      const [a, b, c, d] = [0, 1, 2, 3].map((k) => faces[4 * f + k]);
      // The brightness of a face from its slope towards the viewer; both sides are lit.
      const u = [0, 1, 2].map((i) => flat[3 * c + i] - flat[3 * a + i]);
      const v = [0, 1, 2].map((i) => flat[3 * d + i] - flat[3 * b + i]);
      const normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
      const length = Math.hypot(...normal) || 1;
      const light = 0.74 + 0.26 * Math.abs(0.3 * normal[0] / length + 0.35 * normal[1] / length + 0.89 * normal[2] / length);
      const colour = levels ? stops[Math.round((levels[f] / 255) * (stops.length - 1))] : "#b4bec9";
      context.beginPath();
      context.moveTo(x(a), y(a));
      for (const n of [b, c, d]) context.lineTo(x(n), y(n));
      context.closePath();
      context.fillStyle = shade(colour, light);
      context.strokeStyle = shade(colour, light * 0.62);
      context.fill();
      context.stroke();
    }
  }

  const number = (v) => (v === 0 ? "0" : Math.abs(v) < 1e-3 || Math.abs(v) >= 1e4 ? v.toExponential(1) : `${+v.toPrecision(3)}`);

  function scaleBar(body, key) {
    const scale = data.scales[key];
    const bar = holder.querySelector(".bar");
    const limits = body.limits[key];
    bar.hidden = !limits;
    if (!limits) return;
    const shown = key === "error" ? limits.map((v) => 100 * v) : limits;
    bar.querySelector("i").style.background = `linear-gradient(90deg, ${scale.map.join(",")})`;
    // Ratios near 1 need more digits than the others: 0.995 to 1.005 must not end at 1.
    const ratio = (v) => v.toFixed(Math.max(2, 1 - Math.floor(Math.log10(limits[1] - 1))));
    const write = key === "volume" ? ratio : number;
    bar.querySelector(".low").textContent = `${key === "hourglass" ? "" : "≤ "}${write(shown[0])}`;
    bar.querySelector(".high").textContent = `≥ ${write(shown[1])}`;
    bar.querySelector(".words").textContent =
      [scale.words, scale.unit].filter(Boolean).join(", ") + (scale.scale === "log" ? " (logarithmic)" : "");
  }

  function caption(body, name, key) {
    if (name === "undeformed") return name;
    const shown = answer(body, name);
    const largest = shown.largest === null || name === "golden" ? "" : `: up to ${number(100 * shown.largest)}\u00a0% from the golden`;
    const missing = shown.levels[key] ? "" : ` (grey: it has no ${data.scales[key].words})`;
    return (name === "golden" ? "golden, the mixed element" : name) + largest + missing;
  }

  let asked = 0;
  function draw() {
    cancelAnimationFrame(asked);
    asked = requestAnimationFrame(() => {
      const body = open(get("case").value);
      const key = get("colour").value;
      const box = bounds(body);
      ["left", "right"].forEach((side, i) => {
        const name = get(side).value;
        paint(canvases[i], body, answer(body, name), key, box);
        captions[i].textContent = caption(body, name, key);
        canvases[i].setAttribute("aria-label", `${get("case").value}: ${captions[i].textContent}. Arrow keys turn, + and − zoom.`);
      });
      scaleBar(body, key);
      holder.dataset.drawn = get("case").value;
    });
  }

  function choose() {
    const body = open(get("case").value);
    const names = [...Object.keys(body.answers), "undeformed"];
    for (const [side, wish] of [["left", "tl-perturbation"], ["right", "golden"]]) {
      const select = get(side);
      const kept = select.value || wish;
      select.replaceChildren(...names.map((name) => new Option(name)));
      select.value = [kept, wish, names[0]].find((name) => names.includes(name));
    }
    [camera.azimuth, camera.elevation] = body.view;
    camera.zoom = 1;
    draw();
  }

  const turn = (right, up) => {
    camera.azimuth -= right;
    camera.elevation = Math.max(-90, Math.min(90, camera.elevation + up));
    draw();
  };
  const zoom = (factor) => {
    camera.zoom = Math.max(0.4, Math.min(12, camera.zoom * factor));
    draw();
  };
  for (const canvas of canvases) {
    canvas.addEventListener("pointerdown", (event) => canvas.setPointerCapture(event.pointerId));
    canvas.addEventListener("pointermove", (event) => {
      if (canvas.hasPointerCapture(event.pointerId)) turn(event.movementX * 0.5, event.movementY * 0.5);
    });
    canvas.addEventListener("keydown", (event) => {
      const keys = {
        ArrowLeft: () => turn(-6, 0), ArrowRight: () => turn(6, 0), ArrowUp: () => turn(0, -6),
        ArrowDown: () => turn(0, 6), "+": () => zoom(1.2), "=": () => zoom(1.2), "-": () => zoom(1 / 1.2),
      };
      if (!keys[event.key]) return;
      event.preventDefault();
      keys[event.key]();
    });
  }
  holder.querySelectorAll("button[data-zoom]").forEach((b) => b.addEventListener("click", () => zoom(Number(b.dataset.zoom))));
  get("case").addEventListener("change", choose);
  for (const name of ["left", "right", "colour"]) get(name).addEventListener("change", draw);
  new ResizeObserver(draw).observe(holder);
  choose();
})();
