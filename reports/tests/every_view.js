// Every combination of the controls with these names, chosen as a user does: how many there are, and what fails.
(async (names) => {
  const chart = document.querySelector("#chart"), plot = chart.querySelector(".plot");
  const get = (name) => chart.querySelector(`[name=${name}]`);
  const faults = [];
  const note = (event) => faults.push(String(event.reason ?? event.message));
  for (const event of ["error", "unhandledrejection"]) addEventListener(event, note);
  const product = (lists) => lists.reduce((all, one) => all.flatMap((a) => one.map((b) => [...a, b])), [[]]);
  const values = names.map((name) => (get(name).options ? [...get(name).options].map((o) => o.value) : [false, true]));
  const views = product(values);
  for (const view of views) {
    for (const [i, name] of names.entries()) {
      const control = get(name), kind = control.options ? "value" : "checked";
      if (control[kind] === view[i]) continue;
      if (control.options && [...control.options].find((o) => o.value === view[i]).disabled) continue;
      control[kind] = view[i];
      control.dispatchEvent(new Event("input", { bubbles: true }));
    }
    for (let i = 0; i < 500 && !chart.dataset.drawn; i++) await new Promise((done) => setTimeout(done, 5));
    const shown = names.map((name) => get(name).value).join(" ");
    const [axis, budget] = [plot.layout.xaxis, get("budget")];
    if (!chart.dataset.drawn) faults.push(`${shown}: was not drawn`);
    if (axis.tickvals.length > 60 || !axis.range.every(Number.isFinite)) faults.push(`${shown}: axis ${axis.range}`);
    if (![budget.min, budget.max, budget.value].every((v) => Math.abs(v) < 9)) faults.push(`${shown}: budget ${budget.max}`);
    for (const name of ["reference", "figure", "cost"]) {
      const options = [...get(name).options];
      if (options.some((o) => o.disabled !== Boolean(o.title))) faults.push(`${shown}: ${name} without a reason`);
      if (options.some((o) => !o.disabled) && get(name).selectedOptions[0].disabled) faults.push(`${shown}: ${name} disabled`);
    }
  }
  return { views: views.length, faults: [...new Set(faults)].slice(0, 5) };
})
