"""Whole steps in a browser: the kernels in WGSL move a box as the program does.

A headless Chromium computes them on a card that this processor imitates.
"""

import base64
import json
import re
import sys

import card
import numpy as np
import pytest
from common.program import ROOT, binary, output_of
from host_card import HostCard

sys.path.insert(0, str(ROOT / "reports/tests"))

from browser import CHROMIUM, Browser  # noqa: E402

pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="chromium is not installed")

# Buffers by name, then dispatches: pipeline, buffers in the order of their bindings, work groups.
# A binding is a buffer, or [buffer, bytes] of its first part. Returns the bytes of `results`.
SCRIPT = """
async (text, buffers, dispatches) => {
  const device = await (await navigator.gpu.requestAdapter()).requestDevice();
  device.pushErrorScope("validation");
  const module = device.createShaderModule({code: text});
  for (const message of (await module.getCompilationInfo()).messages)
    if (message.type == "error") throw new Error(message.lineNum + ": " + message.message);
  const on_device = {};
  for (const [name, [usage, coded]] of Object.entries(buffers)) {
    const bytes = Uint8Array.from(atob(coded), (c) => c.charCodeAt(0));
    on_device[name] = device.createBuffer({
      size: bytes.length,
      usage: GPUBufferUsage[usage] | GPUBufferUsage.COPY_DST | GPUBufferUsage.COPY_SRC});
    device.queue.writeBuffer(on_device[name], 0, bytes);
  }
  const pipelines = {};
  const prepared = dispatches.map(([entry, bindings, groups]) => {
    pipelines[entry] ??= device.createComputePipeline(
      {layout: "auto", compute: {module, entryPoint: entry}});
    const entries = bindings.map((each, n) => {
      const [name, size, binding] = Array.isArray(each) ? each : [each, undefined];
      return {binding: binding ?? n, resource: {buffer: on_device[name], size}};
    });
    const layout = pipelines[entry].getBindGroupLayout(0);
    return [pipelines[entry], device.createBindGroup({layout, entries}), groups];
  });
  const encoder = device.createCommandEncoder();
  for (const [pipeline, group, groups] of prepared) {
    const pass = encoder.beginComputePass();
    pass.setPipeline(pipeline);
    pass.setBindGroup(0, group);
    pass.dispatchWorkgroups(groups);
    pass.end();
  }
  const size = on_device.results.size;
  const back = device.createBuffer(
    {size, usage: GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST});
  encoder.copyBufferToBuffer(on_device.results, 0, back, 0, size);
  device.queue.submit([encoder.finish()]);
  await back.mapAsync(GPUMapMode.READ);
  const error = await device.popErrorScope();
  if (error) throw new Error(error.message);
  let coded = "";
  for (const byte of new Uint8Array(back.getMappedRange())) coded += String.fromCharCode(byte);
  return btoa(coded);
}
"""


def kinds_of(text):
    """The arguments of move_nodes in order, and the array that each is a part of."""
    names = re.findall(r"(\w+): i32", re.search(r"struct move_nodes_input \{([^}]*)\}", text)[1])
    shared = dict((part, whole) for whole, part in re.findall(r"(\w+)\[(\w+)_begin \+", text))
    return {name: shared.get(name) for name in names}


def coded(usage, values):
    return usage, base64.b64encode(values.tobytes()).decode()


def computed(folder, text, buffers, dispatches):
    """The numbers of the buffer `results` afterwards."""
    page = folder / "page.html"
    page.write_text("<html></html>")
    with Browser(webgpu=True) as browser:
        browser.open(page)
        given = ", ".join(map(json.dumps, (text, buffers, dispatches)))
        answer = browser.run(f"({SCRIPT})({given})")
    return np.frombuffer(base64.b64decode(answer), np.float32)


@pytest.fixture(scope="module")
def text(card_folder):
    """The kernels."""
    case = card_folder / "card.toml"
    return output_of(binary(), "kernels", card.METHOD, case, "--dialect", "wgsl", "--step")


def test_a_motion_in_a_browser_is_that_of_the_program(card_folder, text, tmp_path):
    host = HostCard(tmp_path)
    functions = host.functions(card.text_of(card_folder, "float"), card.KERNELS)
    one = card.constants_in(card_folder, "float")
    box = card.Box(host, functions, "float", card.SMALL, one)

    def array(name, kind):
        return np.frombuffer(box.bytes_of(name), kind)

    # Arrays that a kernel shares begin one after another; the forces of elements first, since a
    # buffer is bound from its start. Those that no load reads are left out of the box.
    kinds = kinds_of(text)
    begins = {"count": box.nodes, "elements": box.elements, "columns": 0}
    shared = {"integers": [], "numbers": [array("f", np.float32)], "results": []}
    begins["f"] = 0
    for name, whole in kinds.items():
        if whole is None or name == "f":
            continue
        begins[name] = sum(map(len, shared[whole]))
        kind = np.int32 if whole == "integers" else np.float32
        empty = name in ("load_slots", "load_factors", "g", "load", "load_work")
        shared[whole].append(np.zeros(0, kind) if empty else array(name, kind))
    assert begins["u"] == 0  # for the same reason

    buffers = {name: coded("STORAGE", np.concatenate(parts)) for name, parts in shared.items()}
    buffers["constants"] = coded("STORAGE", array("constants", np.float32))
    buffers["places"] = coded("STORAGE", array("places", np.int32))
    for after, to in ((-1, 0), (13, 13), (13, -1)):
        given = [(begins | {"after": after, "next": to})[name] for name in kinds]
        buffers[f"{after}, {to}"] = coded("UNIFORM", np.array(given, np.int32))
    f_bytes, u_bytes = 4 * 24 * box.elements, 4 * 4 * box.nodes
    bindings = ["places", ["results", u_bytes], "constants", ["numbers", f_bytes]]
    force = card.FORCE, bindings, -(-box.elements // 64)

    def move(after, to):
        return "move_nodes", [f"{after}, {to}", *shared], -(-box.nodes // 64)

    dispatches = [move(-1, 0), *[force, move(13, 13)] * (card.STEPS - 1), force, move(13, -1)]
    results = computed(tmp_path, text, buffers, dispatches)
    u = results[: 4 * box.nodes].reshape(-1, 4)[:, :3].ravel()
    reactions = results[begins["reaction"] :]
    reactions = reactions[: box.constraints]
    assert card.difference(card_folder, "float", u.tolist(), reactions.tolist()) <= 1.0


@pytest.mark.parametrize("worst, ill", [(0.5, 0), (0.0, 1), (-1.0, 1), (np.inf, 1), (np.nan, 1)])
def test_ill_elements_are_found_in_a_browser(text, tmp_path, worst, ill):
    buffers = {
        "results": coded("STORAGE", np.zeros(1, np.float32)),
        "numbers": coded("STORAGE", np.array([9.0, 1.0, worst, 1.0], np.float32)),
        "input": coded("UNIFORM", np.array([3, 1, 0], np.int32)),  # count, and where arrays begin
    }
    bindings = ["input", ["numbers", 16, 2], ["results", 4, 3]]  # it has no integers
    assert computed(tmp_path, text, buffers, [("find_ill", bindings, 1)]) == [ill]
