"""The programs for which decks are written; a new one is a module here and an entry in PROGRAMS.

A module has NAME, ENDING (of its main file), ELEMENTS (the default first), LAWS and VOLUMES (the
project's names of what it knows), TAKES_HOURGLASS, TAKES_HANGING_NODES, CONTACT (an Expressible),
and deck(problem, element, hourglass), which returns the text of each file by its ending.
"""

from dataclasses import replace

from common.errors import InputError, suggestion
from exchange.decks import calculix, febio, niftysim, openradioss
from exchange.decks.contact import check
from exchange.decks.problem import refuse

PROGRAMS = {
    "calculix": calculix,
    "febio": febio,
    "niftysim": niftysim,
    "openradioss": openradioss,
}


def files(name, problem, output, element="", hourglass=None):
    """{path: text} of a deck for a program by its name in PROGRAMS.

    problem: a Problem. output: the Path of the main file. element: the program's name of an element
    type; empty means its default. hourglass: the program's hourglass coefficient; None means its
    usual one. Raises InputError for anything that the program cannot express.
    """
    if name not in PROGRAMS:
        raise InputError(f"--deck {name}: {suggestion(name, sorted(PROGRAMS))}")
    program = PROGRAMS[name]
    if not output.name.endswith(program.ENDING):
        raise InputError(f"{output}: a deck for {program.NAME} ends in {program.ENDING}")
    element = element or next(iter(program.ELEMENTS))
    if element not in program.ELEMENTS:
        raise InputError(
            f"--element {element}: {program.NAME}: {suggestion(element, list(program.ELEMENTS))}"
        )
    if hourglass is not None and not program.TAKES_HOURGLASS:
        raise InputError(f"--hourglass: decks for {program.NAME} have no hourglass coefficient")
    for material in problem.materials:
        for key, known in (("law", program.LAWS), ("volumetric", program.VOLUMES)):
            value = getattr(material, key)
            if value not in known:
                raise InputError(
                    f"material.{key} = {value!r} is not known to {program.NAME}; "
                    f"{suggestion(value, sorted(known))}"
                )
    if problem.ties and not program.TAKES_HANGING_NODES:
        refuse(problem, program.NAME, "hanging nodes, which refinement and ties make")
    check(problem, program)
    stem = output.name.removesuffix(program.ENDING)
    title = " ".join(problem.title.split()).replace("--", "- -")  # XML comments have no "--"
    texts = program.deck(replace(problem, name=stem, title=title), element, hourglass)
    return {output.with_name(stem + ending): text for ending, text in texts.items()}
