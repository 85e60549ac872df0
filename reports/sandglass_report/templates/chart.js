// The main chart: error against cost, with a tolerance and a budget; marks beyond either are grey.
const words = {
  max: "largest over all nodes", profile: "largest on the profile line", rms: "root mean square",
  step: "one step", simulated: "a simulated second", rest: "coming to rest",
};
const LEAST = 1e-5; // errors below are drawn here
const digits = (v) => (v >= 1000 || v === 0 ? String(Math.round(v)) : String(+v.toPrecision(3)));
const percent = (f) => (100 * f < 1e-4 && f > 0 ? `${(100 * f).toExponential(0)} %` : `${digits(100 * f)} %`);
const seconds = (s) =>
  s < 1e-6 ? `${digits(1e9 * s)} ns` : s < 1e-3 ? `${digits(1e6 * s)} µs` : s < 1 ? `${digits(1e3 * s)} ms` : `${digits(s)} s`;
const escaped = (text) => String(text).replace(/[&<>]/g, (c) => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;" })[c]);

function startChart(Plotly) {
  const data = JSON.parse(document.querySelector("#chart-data").textContent);
  const tools = document.querySelector("#chart");
  const plot = tools.querySelector(".plot");
  const get = (name) => tools.querySelector(`[name=${name}]`);
  const hidden = new Set();
  const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const read = () => ({
    case: get("case").value, reference: get("reference").value, figure: get("figure").value, cost: get("cost").value,
    own: get("own").checked, double: get("double").checked, curves: get("curves").checked,
    tolerance: 10 ** get("tolerance").value, budget: 10 ** get("budget").value,
  });
  /** The reference of a case's errors: the golden, a method that stands in for a missing one, or the truth. */
  const standIn = (name) => data.points.find((p) => p.case === name && p.golden_is)?.golden_is;
  const named = (reference, name) => (reference === "truth" ? "the truth" : (standIn(name) ?? "the golden"));
  const errorOf = (p, view) => p[view.reference]?.[view.figure];

  /** Indices of the points that a view shows. */
  const shown = (view) =>
    data.points.flatMap((p, i) =>
      p.case === view.case && errorOf(p, view) !== undefined && p[view.cost] > 0 && !hidden.has(p.method) &&
      !(view.own && p.mesh !== data.own_mesh) && !(view.double && p.precision !== "double") &&
      (view.curves || p.as_it_comes) ? [i] : []);
  const keeps = (p, view) => p.ok && errorOf(p, view) <= view.tolerance && p[view.cost] <= view.budget;

  /** All details of a point, as lines. */
  function describe(p) {
    const errors = (name) =>
      p[name] ? ["max", "profile", "rms"].filter((f) => f in p[name]).map((f) => `${f} ${percent(p[name][f])}`).join(", ") : "unknown";
    const costs = ["step", "simulated", "rest"].filter((c) => p[c]).map((c) => `${words[c]} ${seconds(p[c])}`);
    return [
      `<b>${escaped(p.method)}</b> on ${escaped(p.case)}`,
      [p.kappa !== undefined && `κ ${digits(p.kappa)}${p.as_it_comes ? " (auto)" : ""}`, p.accuracy && `accuracy ${percent(p.accuracy)} requested`,
        p.precision].filter(Boolean).join(", "),
      `${escaped(p.mesh)}${p.elements ? `, ${p.elements} elements` : ""}`,
      `to ${named("golden", p.case)}: ${errors("golden")}`,
      `to ${named("truth", p.case)}: ${errors("truth")}`,
      `cost: ${costs.join(", ") || "unknown"}`,
      `finding: ${escaped(p.finding).replace(/(.{60,90}?) /g, "$1<br>   ")}`,
      `cost measured by ${p.measured_by}`,
    ].join("<br>");
  }

    function pointTrace(positions, view, ink) {
    const points = positions.map((i) => data.points[i]);
    const size = (p) => (!p.as_it_comes ? 5 : p.mesh === data.own_mesh ? 12 : 8);
    return {
      type: "scatter", mode: "markers", showlegend: false, hovertemplate: "%{text}<extra></extra>",
      x: points.map((p) => p[view.cost]), y: points.map((p) => Math.max(errorOf(p, view), LEAST)),
      text: points.map(describe), customdata: positions,
      marker: {
        color: points.map((p) => ink ?? colour(data.methods[p.method].css)), size: points.map(size), opacity: ink ? 0.55 : 1,
        symbol: points.map((p) => data.methods[p.method].symbol + (p.precision === "double" ? "" : "-open")),
        line: {
          width: points.map((p) => (p.fails ? 2 : p.precision === "double" ? 0.8 : 1.6)),
          color: points.map((p) => colour(p.fails ? "--bad" : "--panel")),
        },
      },
    };
  }
  function lineTrace(positions, view, line) {
    const points = positions.map((i) => data.points[i]).filter((p) => errorOf(p, view) !== undefined && p[view.cost] > 0);
    return {
      type: "scatter", mode: "lines", hoverinfo: "skip", showlegend: false, line,
      x: points.map((p) => p[view.cost]), y: points.map((p) => Math.max(errorOf(p, view), LEAST)),
    };
  }

  function ticks(values, write) {
    const [low, high] = [Math.min(...values), Math.max(...values)];
    const steps = high / low > 300 ? [1] : [1, 2, 5];
    const found = [];
    for (let d = Math.floor(Math.log10(low)) - 1; d <= Math.log10(high) + 1; d++) for (const s of steps) found.push(s * 10 ** d);
    return { tickmode: "array", tickvals: found, ticktext: found.map(write) };
  }
  function range(values, room) {
    const ends = [Math.log10(Math.min(...values)), Math.log10(Math.max(...values))];
    return [ends[0] - room, ends[1] + room];
  }

  function layout(view, positions) {
    const points = positions.map((i) => data.points[i]);
    const [ink, muted, grid] = ["--ink", "--muted", "--grid"].map(colour);
    const narrow = plot.clientWidth < 560;
    const times = points.map((p) => p[view.cost]);
    const [fastest, slowest] = [Math.min(...times), Math.max(...times)];
    const costs = [...times, Math.max(fastest / 3, Math.min(view.budget, 3 * slowest))];
    const beyond = view.budget > 3 * slowest;
    const errors = [...points.map((p) => Math.max(errorOf(p, view), LEAST)), view.tolerance];
    const axis = { type: "log", gridcolor: grid, zeroline: false, linecolor: muted, tickfont: { color: muted, size: 12 } };
    const costWords = `wall time of ${words[view.cost]}`;
    const limit = (line) => ({ type: "line", line: { color: ink, width: 1.5, dash: "dash" }, ...line });
    const note = (more) => ({ showarrow: false, font: { color: ink, size: 12 }, bgcolor: colour("--panel"), ...more });
    return {
      margin: { l: narrow ? 58 : 74, r: 14, t: 14, b: 52 }, dragmode: narrow ? false : "zoom",
      paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)", font: { family: "system-ui, sans-serif", color: ink },
      modebar: { bgcolor: "rgba(0,0,0,0)", color: muted, activecolor: ink }, hoverlabel: { bgcolor: colour("--panel"), bordercolor: muted, font: { color: ink, size: narrow ? 10 : 12 }, align: "left" },
      xaxis: { ...axis, ...ticks(costs, seconds), range: range(costs, 0.12), title: { text: costWords, font: { color: muted, size: 13 } } },
      yaxis: {
        ...axis, ...ticks(errors, percent), range: range(errors, 0.18),
        title: { text: `error to ${named(view.reference, view.case)}, ${words[view.figure]}`, font: { color: muted, size: 13 } },
      },
      shapes: [
        limit({ xref: "paper", x0: 0, x1: 1, y0: view.tolerance, y1: view.tolerance }),
        limit({ yref: "paper", y0: 0, y1: 1, x0: view.budget, x1: view.budget }),
      ],
      annotations: [
        note({ xref: "paper", x: 0, xanchor: "left", yanchor: "bottom", y: Math.log10(view.tolerance), text: `tolerance ${percent(view.tolerance)}` }),
        note({ yref: "paper", y: 0.02, yanchor: "bottom", xanchor: "right", textangle: -90,
          ...(beyond ? { xref: "paper", x: 1 } : { x: Math.log10(view.budget) }), text: `budget ${seconds(view.budget)}${beyond ? ", further right" : ""}` }),
      ],
    };
  }

  /** The sentence and the table below the chart: the points within both limits, cheapest first. */
  function tell(view, positions) {
    const enough = positions.filter((i) => keeps(data.points[i], view)).sort((a, b) => data.points[a][view.cost] - data.points[b][view.cost]);
    const best = data.points[enough[0]];
    const mesh = (p) => (p.mesh === data.own_mesh ? p.mesh : `mesh of ${p.elements} elements`);
    const name = (p) => [p.method + (p.accuracy ? ` with accuracy ${percent(p.accuracy)}` : ""), p.precision, mesh(p)].join(", ");
    tools.querySelector(".answer").textContent = best
      ? `Cheapest within ${percent(view.tolerance)} and ${seconds(view.budget)}: ${name(best)}: ${percent(errorOf(best, view))} at ${seconds(best[view.cost])}. ${enough.length} of ${positions.length} are within both.`
      : `None of the ${positions.length} shown is within ${percent(view.tolerance)} and ${seconds(view.budget)}.`;
    const cell = (text, kind) => Object.assign(document.createElement("td"), { textContent: text, className: kind ?? "" });
    tools.querySelector("tbody").replaceChildren(...enough.slice(0, 8).map((i) => {
      const p = data.points[i];
      const row = document.createElement("tr");
      const asked = p.accuracy ? `${p.method} ${percent(p.accuracy)}` : p.method;
      row.append(cell(asked + (p.as_it_comes ? "" : ` κ ${digits(p.kappa)}`)), cell(p.precision), cell(p.mesh),
        cell(percent(errorOf(p, view)), "number"), cell(seconds(p[view.cost]), "number"), cell(p.finding));
      return row;
    }));
    const silent = data.points.filter((p) => p.case === view.case && !p.ok && p.mesh === data.own_mesh && p.as_it_comes);
    tools.querySelector(".silent").textContent = silent.length ? `No answer at rest: ${silent.map((p) => `${p.method} (${p.finding.split(";")[0]})`).join("; ")}.` : "";
  }

  function draw() {
    const view = read();
    const positions = shown(view);
    get("tolerance").nextElementSibling.textContent = percent(view.tolerance);
    get("budget").nextElementSibling.textContent = seconds(view.budget);
    get("reference").options[0].textContent = standIn(view.case) ? `${standIn(view.case)} (no golden)` : "the golden (mixed element, same mesh)";
    tell(view, positions);
    const key = [view.case, view.reference, view.figure, view.cost, view.own ? "own" : "all", view.double ? "double" : "all"].join("|");
    const inView = new Set(positions);
    const lines = data.families.filter((f) => f.every((i) => inView.has(i)));
    const traces = [
      lineTrace(data.fronts[key] ?? [], view, { shape: "hv", color: colour("--ink"), width: 1.2, dash: "dot" }),
      ...lines.map((f) => lineTrace(f, view, { color: colour(data.methods[data.points[f[0]].method].css), width: data.points[f[0]].mesh === data.own_mesh ? 1.8 : 0.8 })),
      pointTrace(positions.filter((i) => !keeps(data.points[i], view)), view, colour("--muted")),
      pointTrace(positions.filter((i) => keeps(data.points[i], view)), view),
    ];
    plot.querySelector(".none")?.remove();
    const options = { displaylogo: false, responsive: true, edits: { shapePosition: true }, modeBarButtonsToRemove: ["select2d", "lasso2d", "autoScale2d"] };
    return Plotly.react(plot, traces, layout(view, positions), options).then(() => (tools.dataset.drawn = key));
  }

  /** Fits the range of the budget's slider to the costs of the case. */
  function newBudget() {
    const view = read();
    const costs = data.points.filter((p) => p.case === view.case && p[view.cost] > 0).map((p) => Math.log10(p[view.cost]));
    const slider = get("budget");
    const usual = view.cost === "step" ? Math.max(...costs) + 0.2 : 0;
    slider.min = Math.floor(10 * Math.min(...costs, usual)) / 10;
    slider.max = Math.ceil(10 * Math.max(...costs, usual)) / 10 + 0.1;
    slider.value = usual;
  }

  tools.addEventListener("input", (event) => {
    if (event.target.name === "case" || event.target.name === "cost") newBudget();
    draw();
  });
  for (const button of tools.querySelectorAll("[data-method]"))
    button.addEventListener("click", () => {
      const on = button.getAttribute("aria-pressed") === "true";
      button.setAttribute("aria-pressed", String(!on));
      hidden[on ? "add" : "delete"](button.dataset.method);
      draw();
    });
  for (const button of tools.querySelectorAll("[data-all]"))
    button.addEventListener("click", () => {
      const on = button.dataset.all === "on";
      for (const one of tools.querySelectorAll("[data-method]")) {
        one.setAttribute("aria-pressed", String(on));
        hidden[on ? "delete" : "add"](one.dataset.method);
      }
      draw();
    });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
  newBudget();
  return draw().then(() =>
    plot.on("plotly_relayout", (change) => {
      const moved = (name) => change[`${name}0`] ?? change[`${name}1`];
      const [tolerance, budget] = [moved("shapes[0].y"), moved("shapes[1].x")];
      if (tolerance > 0) get("tolerance").value = Math.log10(tolerance);
      if (budget > 0) get("budget").value = Math.log10(budget);
      if (tolerance > 0 || budget > 0) draw();
    }));
}

// Unpacks and runs Plotly, which is compressed in the page, and hides the static pictures.
(async () => {
  const packed = document.querySelector("#plotly");
  if (!packed || !window.DecompressionStream) return;
  const bytes = Uint8Array.from(atob(packed.textContent.trim()), (c) => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  const script = document.createElement("script");
  script.textContent = await new Response(stream).text();
  document.head.append(script);
  document.documentElement.classList.add("live");
  await startChart(window.Plotly);
  document.querySelector("details.static").open = false;
})();
