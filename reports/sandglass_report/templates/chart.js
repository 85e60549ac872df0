// The main chart: error against cost, with a tolerance and a budget; marks beyond either are grey.
const [LEAST, MOST] = [1e-5, 10]; // errors beyond these are drawn here, with an arrowhead
const HINT = "Point at a mark, or tap it, for its details.";
// Why an option has no data for a case.
const WHY = {
  golden: "none for this case", truth: "none for this case", max: "not known", rms: "not known", profile: "no profile line",
  simulated: "not measured", step: "not measured", equilibrium: "none: a dynamic case",
};
const digits = (v) => (v >= 1000 || v === 0 ? String(Math.round(v)) : String(+v.toPrecision(3)));
const percent = (f) => (100 * f < 1e-4 && f > 0 ? `${(100 * f).toExponential(0)}\u00a0%` : `${digits(100 * f)}\u00a0%`);
const seconds = (s) =>
  s < 1e-6 ? `${digits(1e9 * s)} ns` : s < 1e-3 ? `${digits(1e6 * s)} µs` : s < 1 ? `${digits(1e3 * s)} ms` : `${digits(s)} s`;
const escaped = (text) => String(text).replace(/[&<>]/g, (c) => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;" })[c]);

function startChart(Plotly) {
  const data = JSON.parse(document.querySelector("#chart-data").textContent.replace(/(\d) %/g, "$1\u00a0%"));
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
  const drawnAt = (p, view) => Math.min(Math.max(errorOf(p, view), LEAST), MOST);
  const group = (p) => p.group ?? p.method;
  const leads = (p) => p.as_it_comes && !p.elsewhere; // into the headline and the table

  // The user's choices, kept for cases that have their data; which points have an option's data.
  const wish = { reference: "golden", figure: "max", cost: "simulated" };
  const labels = Object.fromEntries(Object.keys(wish).map((name) => [name, [...get(name).options].map((o) => o.textContent)]));
  const has = {
    reference: (p, value) => p[value] !== undefined,
    figure: (p, value) => p[get("reference").value]?.[value] !== undefined,
    cost: (p, value) => p[value] > 0,
  };
  /** Disables the options for which a case has no data, with the reason; replaces them if they were chosen. */
  function settle() {
    let points = data.points.filter((p) => p.case === get("case").value);
    const stand = standIn(get("case").value);
    for (const name of Object.keys(wish)) {
      const options = [...get(name).options];
      options.forEach((option, i) => {
        option.disabled = !points.some((p) => has[name](p, option.value));
        option.title = option.disabled ? WHY[option.value] : "";
        const label = option.value === "golden" && stand ? `${stand} (no golden)` : labels[name][i];
        option.textContent = option.disabled ? `${labels[name][i]}: ${WHY[option.value]}` : label;
      });
      const free = options.filter((option) => !option.disabled).map((option) => option.value);
      get(name).value = free.includes(wish[name]) ? wish[name] : (free[0] ?? wish[name]);
      points = points.filter((p) => has[name](p, get(name).value));
    }
  }

  /** Indices of the points that a view shows. */
  const shown = (view) =>
    data.points.flatMap((p, i) =>
      p.case === view.case && errorOf(p, view) !== undefined && p[view.cost] > 0 && !hidden.has(group(p)) &&
      !(view.own && p.mesh !== data.own_mesh) && !(view.double && p.precision !== "double") &&
      (view.curves || p.as_it_comes) ? [i] : []);
  const keeps = (p, view) => p.ok && errorOf(p, view) <= view.tolerance && p[view.cost] <= view.budget;

  /** All details of a point, as lines. */
  function describe(p) {
    const errors = (name) =>
      p[name] ? Object.keys(data.figures).filter((f) => f in p[name]).map((f) => `${data.figures[f].head} ${percent(p[name][f])}`).join(", ") : "unknown";
    const costs = Object.keys(data.costs).filter((c) => p[c]).map((c) => `${data.costs[c].head} ${seconds(p[c])}`);
    return [
      `<b>${escaped(p.method)}</b> on ${escaped(p.case)}`,
      [p.kappa !== undefined && `κ ${digits(p.kappa)}${p.as_it_comes ? " (auto)" : ""}`, p.accuracy && `accuracy ${percent(p.accuracy)} requested`,
        p.precision].filter(Boolean).join(", "),
      `${escaped(p.mesh)}${p.elements ? `, ${p.elements} elements` : ""}`,
      `to ${named("golden", p.case)}: ${errors("golden")}`,
      `to ${named("truth", p.case)}: ${errors("truth")}`,
      `time: ${costs.join(", ") || "unknown"}`,
      p.ns && `${digits(p.ns)} ns per element and step${p.checks ? `, checks ${digits((p.checks / p.step) * p.ns)} ns` : p.simulated && p.mean_step ? ", without the checks of a run" : ""}${p.mean_step ? `, mean step ${seconds(p.mean_step)}` : ""}${p.step_remark ? `; ${escaped(p.step_remark)}` : ""}`,
      p.evaluations && `${p.evaluations} evaluations to equilibrium`,
      `finding: ${escaped(p.finding)}`,
      p.measured_by && `measured by ${escaped(p.measured_by)}`,
      p.elsewhere && `<em>timed elsewhere: ${escaped(p.elsewhere)}</em>`,
    ].filter(Boolean).join("<br>");
  }

  function pointTrace(positions, view, ink) {
    const points = positions.map((i) => data.points[i]);
    const size = (p) => (!p.as_it_comes ? 5 : p.mesh === data.own_mesh ? 12 : 8);
    return {
      type: "scatter", mode: "markers", showlegend: false, hovertemplate: "%{text}<extra></extra>",
      x: points.map((p) => p[view.cost]), y: points.map((p) => drawnAt(p, view)),
      text: points.map((p) => escaped(p.method)), customdata: positions,
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
  /** Arrowheads at the marks whose error is beyond the axis. */
  function beyondTrace(positions, view) {
    const points = positions.map((i) => data.points[i]).filter((p) => drawnAt(p, view) !== errorOf(p, view));
    const above = (p) => errorOf(p, view) > MOST;
    return {
      type: "scatter", mode: "text", name: "beyond", hoverinfo: "skip", showlegend: false, cliponaxis: false,
      x: points.map((p) => p[view.cost]), y: points.map((p) => drawnAt(p, view)),
      text: points.map((p) => (above(p) ? "▲<br> <br> " : " <br> <br>▼")), textfont: { size: 9, color: colour("--ink") },
    };
  }
  function lineTrace(positions, view, line) {
    const points = positions.map((i) => data.points[i]).filter((p) => errorOf(p, view) !== undefined && p[view.cost] > 0);
    return {
      type: "scatter", mode: "lines", hoverinfo: "skip", showlegend: false, line,
      x: points.map((p) => p[view.cost]), y: points.map((p) => drawnAt(p, view)),
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
    const empty = points.length === 0;
    const times = empty ? [view.budget] : points.map((p) => p[view.cost]);
    const [fastest, slowest] = [Math.min(...times), Math.max(...times)];
    const costs = [...times, Math.max(fastest / 3, Math.min(view.budget, 3 * slowest))];
    const beyond = view.budget > 3 * slowest;
    const errors = [...points.map((p) => drawnAt(p, view)), view.tolerance];
    const axis = { type: "log", gridcolor: grid, zeroline: false, linecolor: muted, tickfont: { color: muted, size: 12 } };
    const limit = (line) => ({ type: "line", line: { color: ink, width: 1.5, dash: "dash" }, ...line });
    const note = (more) => ({ showarrow: false, font: { color: ink, size: 12 }, bgcolor: colour("--panel"), ...more });
    return {
      margin: { l: narrow ? 58 : 74, r: 14, t: 14, b: 52 }, dragmode: narrow ? false : "zoom",
      paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)", font: { family: "system-ui, sans-serif", color: ink },
      modebar: { bgcolor: "rgba(0,0,0,0)", color: muted, activecolor: ink }, hoverlabel: { bgcolor: colour("--panel"), bordercolor: muted, font: { color: ink, size: narrow ? 10 : 12 }, align: "left" },
      xaxis: { ...axis, ...ticks(costs, seconds), range: range(costs, 0.12), title: { text: data.costs[view.cost].title, font: { color: muted, size: 13 } } },
      yaxis: {
        ...axis, ...ticks(errors, percent), range: range(errors, 0.18),
        title: { text: `${data.figures[view.figure].title}, to ${named(view.reference, view.case)}`, font: { color: muted, size: 13 } },
      },
      shapes: [
        limit({ xref: "paper", x0: 0, x1: 1, y0: view.tolerance, y1: view.tolerance }),
        limit({ yref: "paper", y0: 0, y1: 1, x0: view.budget, x1: view.budget }),
      ],
      annotations: [
        note({ xref: "paper", x: 0, xanchor: "left", yanchor: "bottom", y: Math.log10(view.tolerance), text: `tolerance ${percent(view.tolerance)}` }),
        note({ yref: "paper", y: 0.02, yanchor: "bottom", xanchor: "right", textangle: -90,
          ...(beyond ? { xref: "paper", x: 1 } : { x: Math.log10(view.budget) }), text: `budget ${seconds(view.budget)}${beyond ? ", further right" : ""}` }),
        ...(empty ? [note({ xref: "paper", yref: "paper", x: 0.5, y: 0.5, text: "nothing to show with these options" })] : []),
      ],
    };
  }

  /** The sentence and the table below the chart: the points within both limits, cheapest first. */
  function summarize(view, positions) {
    const ours = positions.filter((i) => leads(data.points[i]));
    const enough = ours.filter((i) => keeps(data.points[i], view)).sort((a, b) => data.points[a][view.cost] - data.points[b][view.cost]);
    const best = data.points[enough[0]];
    const mesh = (p) => (p.mesh === data.own_mesh ? p.mesh : `mesh of ${p.elements} elements`);
    const name = (p) => [p.method + (p.accuracy ? ` with accuracy ${percent(p.accuracy)}` : ""), p.precision, mesh(p)].join(", ");
    tools.querySelector(".answer").textContent = best
      ? `Cheapest within ${percent(view.tolerance)} and ${seconds(view.budget)}: ${name(best)}: ${percent(errorOf(best, view))} at ${seconds(best[view.cost])}. ${enough.length} of ${ours.length} are within both.`
      : ours.length ? `None of the ${ours.length} shown is within ${percent(view.tolerance)} and ${seconds(view.budget)}.`
        : data.points.some((p) => leads(p) && Object.keys(data.costs).some((cost) => p[cost] > 0)) ? "No method of Sandglass with this time is shown."
          : "These methods of Sandglass were not timed; bash ci/verify times them.";
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
    const untimed = data.points.filter((p) => p.case === view.case && errorOf(p, view) !== undefined && !(p[view.cost] > 0));
    tools.querySelector(".silent").textContent = [
      silent.length ? `No answer: ${silent.map((p) => `${p.method} (${p.finding.split(";")[0]})`).join("; ")}.` : "",
      untimed.length ? `${untimed.length} without this time, not drawn: ${[...new Set(untimed.map((p) => p.method))].join(", ")}.` : "",
    ].join(" ").trim();
    tools.querySelector(".meaning").textContent = data.costs[view.cost].definition;
  }

  function draw() {
    const view = read();
    const positions = shown(view);
    delete tools.dataset.drawn;
    get("tolerance").nextElementSibling.textContent = percent(view.tolerance);
    get("budget").nextElementSibling.textContent = seconds(view.budget);
    summarize(view, positions);
    const key = [view.case, view.reference, view.figure, view.cost, view.own ? "own" : "all", view.double ? "double" : "all"].join("|");
    const inView = new Set(positions);
    const lines = data.families.filter((f) => f.every((i) => inView.has(i)));
    const traces = [
      lineTrace(data.fronts[key] ?? [], view, { shape: "hv", color: colour("--ink"), width: 1.2, dash: "dot" }),
      ...lines.map((f) => lineTrace(f, view, { color: colour(data.methods[data.points[f[0]].method].css), width: data.points[f[0]].mesh === data.own_mesh ? 1.8 : 0.8 })),
      pointTrace(positions.filter((i) => !keeps(data.points[i], view)), view, colour("--muted")),
      pointTrace(positions.filter((i) => keeps(data.points[i], view)), view),
      beyondTrace(positions, view),
    ];
    plot.querySelector(".none")?.remove();
    const options = { displaylogo: false, responsive: true, edits: { shapePosition: true }, modeBarButtonsToRemove: ["select2d", "lasso2d", "autoScale2d"] };
    return Plotly.react(plot, traces, layout(view, positions), options).then(() => (tools.dataset.drawn = key));
  }

  /** Fits the range of the budget's slider to the costs of the case. */
  let budgetOf = "";
  function newBudget() {
    const view = read();
    budgetOf = scales();
    const costs = data.points.filter((p) => p.case === view.case && p[view.cost] > 0).map((p) => Math.log10(p[view.cost]));
    const slider = get("budget");
    if (!costs.length) return;
    const usual = view.cost === "step" ? Math.max(...costs) + 0.2 : 0;
    slider.min = Math.floor(10 * Math.min(...costs, usual)) / 10;
    slider.max = Math.ceil(10 * Math.max(...costs, usual)) / 10 + 0.1;
    slider.value = usual;
  }

  const scales = () => [get("case").value, get("cost").value].join("|"); // what the budget depends on
  tools.addEventListener("input", (event) => {
    const { name, value } = event.target;
    if (name in wish) wish[name] = value;
    if (name in wish || name === "case") settle();
    if (name === "case") tools.querySelector(".details").textContent = HINT;
    if (scales() !== budgetOf) newBudget();
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
  settle();
  newBudget();
  return draw().then(() => {
    // The details stand beside the chart: a label with all of them would cover other marks.
    for (const event of ["plotly_hover", "plotly_click"])
      plot.on(event, ({ points: [one] }) => {
        const p = data.points[one.customdata];
        if (p) tools.querySelector(".details").innerHTML = describe(p);
      });
    plot.on("plotly_relayout", (change) => {
      const moved = (name) => change[`${name}0`] ?? change[`${name}1`];
      const [tolerance, budget] = [moved("shapes[0].y"), moved("shapes[1].x")];
      if (tolerance > 0) get("tolerance").value = Math.log10(tolerance);
      if (budget > 0) get("budget").value = Math.log10(budget);
      if (tolerance > 0 || budget > 0) draw();
    });
  });
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
