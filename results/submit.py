"""Makes an entry of results/ from a program's displacements on a case and your measurements.

Usage: /usr/bin/python3 results/submit.py ANSWER --case CASE --program P --version V --element E
       --precision double --build FLAGS --machine CPU --by NAME [--ns N] [--step S] [--seconds S]
       /usr/bin/python3 results/submit.py --peers peers.json --answers FOLDER --by NAME
The second form makes an entry of every row that `ci/peers CASE --json --answers` measured in static
equilibrium. Exit codes: 0 done, 2 bad usage or input, 3 scoring failed.
"""

import datetime
import re
import sys
from pathlib import Path

if __name__ == "__main__":
    sys.path.insert(1, str(Path(__file__).resolve().parent.parent))

from common.command import command_line, option
from common.errors import InputError
from common.files import new_file, read_json, write_json
from results.entry import FOLDER, displacement_file, hash_of, require_valid, scored

# Motions of different elements differ by less than this share of the imposed displacement.
SOUND = 0.3
REQUIRED = ("case", "program", "version", "element", "build", "machine")
OPTIONAL = ("ns_per_element_step", "time_step", "seconds_to_rest", "how")


def make_entry(answer, folder, given):
    """Scores an answer, stores its displacements and writes its entry; returns the path.

    given: the entry's keys except those computed here. Raises InputError.
    """
    score = scored(given["case"], answer)
    entry = {
        "schema": 1,
        **{key: value for key, value in given.items() if value is not None},
        "case": score.case,
        "mesh_hash": score.mesh_hash,
        "displacement": hash_of(score.displacement),
        "errors": score.errors,
        "date": datetime.date.today().isoformat(),
    }
    words = [entry[key] for key in ("case", "program", "element", "precision")]
    words.append(re.split("[,;]", entry["build"])[0].replace("'", ""))
    name = ".".join(re.sub(r"[^A-Za-z0-9.]+", "-", word).strip("-.").lower() for word in words)
    path = folder / f"{name}.json"
    require_valid(path, entry)
    stored = displacement_file(entry, folder)
    stored.parent.mkdir(exist_ok=True)
    with new_file(stored) as file:
        file.write_bytes(score.displacement)
    write_json(path, entry)
    return path


def of_peers(path, answers):
    """(answer, keys of an entry) of every row that `ci/peers` measured. Raises InputError."""
    found = read_json(path, "ci/peers --json")
    steps = {_key(row): row for row in found["in_motion"] if not row["failure"]}
    programs = {(one["name"], one["build"]): one for one in found["programs"]}
    for row in found["static"]:
        if row["failure"]:
            continue
        about = programs.get((row["program"], row["build"] or ""))
        version, build = _origin(about) if about else (found["sandglass"], found["build"])
        moved = steps.get(_key(row), {})
        yield answers / row["answer"], {
            "program": row["program"],
            "version": version,
            "element": row["element"],
            "precision": row["precision"],
            "build": build,
            "machine": f"{found['processor']}, one thread",
            "case": found["case"],
            "ns_per_element_step": moved.get("ns_per_element_step"),
            "time_step": row["time_step"] or moved.get("time_step"),
            "nearest_motion": moved.get("nearest") if about else None,
            "seconds_to_rest": row["seconds"],
            "how": f"{row['solve']}, {_counted(row)}{_soundness(moved)}; by ci/peers",
        }


def _counted(row):
    """The number of steps or evaluations in words."""
    kinds = ("steps", "load_steps", "evaluations")
    kind = next(kind for kind in kinds if row.get(kind) is not None)
    return f"{row[kind]} {kind.replace('_', ' ')}"


def _soundness(moved):
    """A clause about a motion that differs from all of ours; empty if one is near."""
    nearest = moved.get("nearest")
    if not nearest or nearest["difference"] < SOUND:
        return ""
    return f"; its motion is {100 * nearest['difference']:.0f} % from the nearest of ours"


def _origin(about):
    """(version, build) of a program of `ci/peers`: --about is "REVISION; COMPILER AND FLAGS"."""
    revision, separator, flags = about["about"].partition(";")
    if not separator:
        revision, flags = about["version"], about["about"]
    build = ", ".join(word.strip() for word in (about["build"], flags) if word.strip())
    return revision.strip() or "unknown", build or "unknown"


def _key(row):
    return row["program"], row["build"], row["element"], row["precision"]


def submit(options):
    """Makes the entries. Raises InputError."""
    if options.peers:
        if options.answers is None:
            raise InputError("--peers: needs --answers, the folder that ci/peers wrote")
        pairs = list(of_peers(options.peers, options.answers))
    else:
        given = {key: getattr(options, key) for key in (*REQUIRED, *OPTIONAL, "precision")}
        missing = [f"--{key}" for key in REQUIRED if given[key] is None]
        if options.answer is None or missing:
            raise InputError(f"missing: {', '.join(missing or ['ANSWER'])}")
        pairs = [(options.answer, given)]
    for answer, given in pairs:
        path = make_entry(answer, options.folder, {**given, "submitted_by": options.by})
        print(f"wrote {path}")


main = command_line(
    submit,
    __doc__,
    option("answer", nargs="?", type=Path, metavar="ANSWER", help="what sandglass score reads"),
    *(option(f"--{key}", help="see results/schema.json") for key in REQUIRED),
    option("--precision", choices=("float", "double", "mixed"), default="double"),
    option("--ns", dest="ns_per_element_step", type=float, help="ns per element and step"),
    option("--step", dest="time_step", type=float, help="stable step used, s"),
    option("--seconds", dest="seconds_to_rest", type=float, help="wall time until the answer, s"),
    option("--how", help="how answer and times were found"),
    option("--peers", type=Path, metavar="FILE", help="of ci/peers --json"),
    option("--answers", type=Path, metavar="FOLDER", help="of ci/peers --answers"),
    option("--by", required=True, metavar="NAME", help="who submits"),
    option("--folder", type=Path, default=FOLDER, help="where to write; results/ by default"),
)

if __name__ == "__main__":
    sys.exit(main())
