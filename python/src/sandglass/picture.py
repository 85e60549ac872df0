"""A picture of a deformed body with matplotlib."""

import difflib

import numpy as np

import _sandglass

_UNITS = {
    "displacement": "m",
    "velocity": "m/s",
    "stress": "Pa",
    "hourglass_energy_density": "J/m$^3$",
}
_LIGHT = np.array([0.35, -0.5, 0.8])  # where the light comes from


def von_mises(stress):
    """Von Mises' equivalent stress of Cauchy stresses (m, 3, 3), Pa; (m,)."""
    mean = np.trace(stress, axis1=1, axis2=2)[:, None, None] / 3.0
    return np.sqrt(1.5 * ((stress - mean * np.eye(3)) ** 2).sum(axis=(1, 2)))


def _values(frame, field, faces, owner):
    """A value for each face: the mean of its nodes, or that of its element."""
    fields = [name for name, values in frame.items() if isinstance(values, np.ndarray)]
    if field not in fields:
        near = difflib.get_close_matches(str(field), fields, 1)
        hint = f"did you mean '{near[0]}'?" if near else f"known: {', '.join(fields)}"
        raise _sandglass.InputError(f"field = {field!r} is not known; {hint}")
    values = frame[field]
    if field in ("displacement", "velocity"):
        return np.linalg.norm(values, axis=1)[faces].mean(axis=1)
    return (von_mises(values) if values.ndim == 3 else values)[owner]


def _owners(cells, faces):
    """The element of each face: the one that has all its nodes."""
    touching = {}
    for element, nodes in enumerate(cells.tolist()):
        for node in nodes:
            touching.setdefault(node, set()).add(element)
    return np.array(
        [min(set.intersection(*(touching[n] for n in face))) for face in faces.tolist()]
    )


def draw(points, cells, faces, frame, field, scale, ax):
    """See Solution.plot. faces: (k, 4), on the boundary, counterclockwise seen from outside."""
    import matplotlib.pyplot as plt
    from matplotlib import cm, colors
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection

    values = _values(frame, field, faces, _owners(cells, faces))
    corners = (points + scale * frame["displacement"])[faces]
    normals = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    shade = normals / np.where(lengths > 0, lengths, 1) @ (_LIGHT / np.linalg.norm(_LIGHT))
    norm = colors.Normalize(values.min(), values.max())
    rgba = plt.get_cmap("viridis")(norm(values))
    rgba[:, :3] *= (0.7 + 0.3 * np.clip(shade, 0, 1))[:, None]
    if ax is None:
        ax = plt.figure(figsize=(7, 5), layout="constrained").add_subplot(projection="3d")
    ax.add_collection3d(
        Poly3DCollection(corners, facecolors=rgba, edgecolors=(0, 0, 0, 0.3), linewidths=0.3)
    )
    low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    middle, half = (low + high) / 2, max((high - low).max() / 2, 1e-12)
    for name, center, size in zip("xyz", middle, (high - low) / 2):
        getattr(ax, f"set_{name}lim")(
            center - max(size, 0.1 * half), center + max(size, 0.1 * half)
        )
        getattr(ax, f"set_{name}label")(f"{name} (m)", labelpad=8)
        getattr(ax, f"{name}axis").set_major_locator(plt.MaxNLocator(3))
    ax.set_box_aspect(np.maximum(high - low, 0.2 * half), zoom=0.75)
    name = "von Mises stress" if field == "stress" else field.replace("_", " ")
    unit = f" ({_UNITS[field]})" if field in _UNITS else ""
    figure = ax.get_figure()
    figure.colorbar(cm.ScalarMappable(norm, "viridis"), ax=ax, shrink=0.7, label=name + unit)
    return figure
