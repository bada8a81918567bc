"""Arguments have the names that the command's options have."""

from __future__ import annotations

import argparse
import inspect
import keyword
import re
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import pytest

import raypencil
from raypencil import _command, _raypencil

#: The functions by the commands that do the same.
FUNCTIONS: dict[str, list[Callable[..., Any]]] = {
    "campaign": [raypencil.campaign],
    "cast": [raypencil.cast],
    "check": [raypencil.check],
    "diff": [raypencil.diff],
    "drive": [raypencil.drive],
    "pack": [raypencil.pack, raypencil.pack_rays],
    "render": [raypencil.render],
    "sweep": [raypencil.sweep],
    "terrain generate": [raypencil.terrain.generate],
    "validate": [raypencil.validate],
}

#: Commands without a function, and why.
NO_FUNCTION = {
    "completions": "is about the command line",
    "man": "is about the command line",
    "minimise": "writes a scene file, which `load` reads",
    "probe": "prints; `cast` with `margins` has the numbers, and `render` those of sensors",
    "scene": "prints; a `Scene` has the numbers",
    "terrain import": "`load` reads the same files",
    "terrain inspect": "prints and repairs files",
}

#: Functions without a command, and why.
NO_COMMAND = {
    "cast_chunks": "`cast` in pieces; the command writes all of its files at the end",
    "judge": "arrays against arrays; the files of a program are judged by `check`",
    "load": "commands read their files themselves",
    "load_mesh": "commands read their files themselves",
    "read": "commands read their files themselves",
}

SCENES_OWN = "a `Scene` has its settings: `scene.replace`"

#: Options and arguments of a command that its function does not have under this name, and why. `*`: of whatever function.
ONLY_COMMAND = {
    "* --at": SCENES_OWN,
    "* --fan": SCENES_OWN,
    "* --flux": SCENES_OWN,
    "* --heading": SCENES_OWN,
    "* --set": SCENES_OWN,
    "* --thickness": SCENES_OWN,
    "campaign --shard": "a function makes all parts; `shards` is their number",
    "cast --all": "`query`: `all` is a function of Python",
    "cast --allow-empty": "is about the exit code",
    "cast --any": "`query`: `any` is a function of Python",
    "cast --bag": "arrays are returned",
    "cast --bag-dense": "arrays are returned",
    "cast --output": "arrays are returned",
    "cast --pcd": "arrays are returned",
    "cast --ray": "`origins` and `directions`",
    "cast --scale": "vertices are an array: they can be multiplied",
    "cast --scans": "files alone: `cast_chunks` answers more rays than memory holds",
    "cast --up": "vertices are an array: their axes can be exchanged",
    "cast RAYS": "`origins`, `directions` and the ends of rays",
    "check --seed": "is for a check that is made again, which a check from Python names the answer for",
    "check CANDIDATE": "`answers`, which may be arrays",
    "drive --both": "`with_` takes two renderers",
    "generate --output": "a mesh is returned; `save` writes it",
    "generate --window": "the model of `coarse` is a file: the command takes a part of it",
    "pack --blind": "random scenes are the command's alone",
    "pack --fronts-only": "`pack_rays` has it",
    "pack --input": "the input pack is no pack of a scene",
    "pack --rays": "`pack_rays` has it",
    "pack_rays --blind": "`pack` is for scenes",
    "pack_rays --input": "`pack` is for scenes",
    "pack_rays --licence": "packs of rays have no label yet",
    "pack_rays --no-bench": "`pack` is for scenes",
    "pack_rays --pack-version": "packs of rays have no label yet",
    "pack_rays SCENE": "`mesh`, on which the rays are",
    "render --format": "maps are arrays; the files of `output` are EXR",
    "sweep --list": "`runs`: not a file, but its rows",
    "sweep --set": "`settings`, as `Scene` has them: `set` is a type of Python",
    "sweep --shard": "a function makes all parts; `shards` is their number",
    "validate --candidates-must-pass": "`summary` counts wrong candidates apart",
}

#: Parameters of a function that its command does not have under this name, and why.
ONLY_PYTHON = {
    "* force": "`--force`, which every command has",
    "* progress": "the command shows its stages on every terminal",
    "campaign client": "the cluster of `--dask`, which the package's command alone has",
    "campaign retries": "of `--dask`, which the package's command alone has",
    "campaign shards": "the number of parts, of which `--shard` makes one",
    "cast directions": "the second half of RAYS",
    "cast origins": "the first half of RAYS",
    "cast out": "the command writes files",
    "cast query": "`--any` and `--all`, which are functions of Python",
    "cast t_blind": "a column of RAYS",
    "cast t_max": "a column of RAYS",
    "cast t_min": "a column of RAYS",
    "cast threads": "the command takes all, or as many as RAYON_NUM_THREADS says",
    "cast values": "the command writes a file of each",
    "check answers": "CANDIDATE, or arrays",
    "check name": "arrays have no folder after which they could be called",
    "drive images": "the command keeps none in memory",
    "pack_rays mesh": "SCENE, which is a mesh with `--rays`",
    "sweep client": "the cluster of `--dask`, which the package's command alone has",
    "sweep retries": "of `--dask`, which the package's command alone has",
    "sweep runs": "the rows of the file of `--list`",
    "sweep settings": "the keys of `--set`",
    "sweep shards": "the number of parts, of which `--shard` makes one",
}


class Word(NamedTuple):
    """An option or an argument of a command."""

    #: `--fronts-only`, or `SCENE`.
    word: str
    #: Whether it may be given several times: then one parameter has all of them, in the plural.
    is_repeated: bool = False
    #: As the help has it.
    default: str | None = None

    @property
    def names(self) -> set[str]:
        """The names that a parameter may have. What is a keyword of Python gets an underscore."""
        name = self.word.removeprefix("--").replace("-", "_").lower()
        plural = {name + ("es" if name.endswith("ch") else "s")} if self.is_repeated else set()
        return {f"{name}_" if keyword.iskeyword(name) else name} | plural


Help = Callable[[str], str]


@pytest.fixture
def help_of(capfd: pytest.CaptureFixture[str]) -> Help:
    """The help of a command: `--help` of the command that the package brings."""

    def of(command: str) -> str:
        assert _raypencil.command(["raypencil", *command.split(), "--help"]) == 0
        return capfd.readouterr().out

    return of


def words_of(text: str) -> Iterator[Word]:
    """All options and arguments in the help of a command, without those that every command has."""
    own = text.split("\nOptions of every command:")[0]
    parts = re.split(r"\n(?= {2,6}(?:-\w, )?--[a-z]| {2}[<\[])", own)
    for part in parts[1:]:
        if found := re.match(r" +(?:-\w, )?(--[\w-]+)| +[<\[]([A-Z_]+)[>\]]", part):
            if (word := found[1] or found[2]) != "--help":
                # It may be broken into two lines.
                text = re.sub(r"\s+", " ", part)
                default = re.search(r"\[default: ([^]]*)\]", text)
                yield Word(word, "May be repeated" in text, default and default[1])


def commands_of(text: str) -> list[str]:
    """The commands that a help lists."""
    return [name for name in re.findall(r"^  ([a-z]+)  +[A-Z]", text, re.M) if name != "help"]


def said(default: object) -> str:
    """A default in the words of the command."""
    if isinstance(default, tuple):
        return " ".join(default)
    return f"{default:g}" if isinstance(default, float) else str(default)


def differences(function: Callable[..., Any], words: list[Word], used: set[str]) -> list[str]:
    """Where a function and its command have different names. Exceptions that are needed are added to `used`."""
    name, parameters = function.__name__, inspect.signature(function).parameters
    told = []

    def is_excepted(exceptions: dict[str, str], of: str) -> bool:
        keys = {key for key in (f"{name} {of}", f"* {of}") if key in exceptions}
        # The one for this function first.
        used.update(sorted(keys, reverse=True)[:1])
        return bool(keys)

    for word in words:
        found = word.names & parameters.keys()
        if not found and not is_excepted(ONLY_COMMAND, word.word):
            told.append(f"{name}: {word.word} is no parameter; expected {' or '.join(sorted(word.names))}")
        for of in found:
            default = parameters[of].default
            # What must be given has no default.
            if word.default not in (None, said(default)) and default is not inspect.Parameter.empty:
                told.append(f"{name}: {of} is {default!r} by default; expected {word.default} as of {word.word}")
    every_name = {of for word in words for of in word.names}
    for parameter in parameters:
        if parameter not in every_name and not is_excepted(ONLY_PYTHON, parameter):
            told.append(f"{name}: {parameter} is no option of the command")
    return told


def test_parameters_are_called_as_the_options(help_of: Help) -> None:
    told: list[str] = []
    used: set[str] = set()
    for command, functions in FUNCTIONS.items():
        words = list(words_of(help_of(command)))
        assert len(words) > 4, words
        for function in functions:
            told += differences(function, words, used)
    assert told == []
    # An exception that is not needed any more goes.
    assert {*ONLY_COMMAND, *ONLY_PYTHON} - used == set()


def test_each_command_has_a_function_or_a_reason(help_of: Help) -> None:
    commands = [name for name in commands_of(help_of("")) if name != "terrain"]
    commands += [f"terrain {name}" for name in commands_of(help_of("terrain"))]
    assert sorted(commands) == sorted([*FUNCTIONS, *NO_FUNCTION])
    with_command = {function.__name__ for functions in FUNCTIONS.values() for function in functions} - {"generate"}
    functions = {name for name in raypencil.__all__ if inspect.isfunction(getattr(raypencil, name))}
    assert functions == with_command | NO_COMMAND.keys()


def test_each_exception_has_a_reason() -> None:
    for exceptions in (NO_FUNCTION, NO_COMMAND, ONLY_COMMAND, ONLY_PYTHON):
        assert list(exceptions) == sorted(exceptions)
        assert all(len(reason.split()) > 1 for reason in exceptions.values())


HELP = """Usage

Arguments:
  <MESH>
          A mesh

  [SCENE]
          A scene

Options:
      --fronts-only  Both --sides
      --switch <NAME=VALUE>
          A switch. May be
          repeated

  -o, --output <DIR>
          Folder

      --with[=<NAME>]
          A renderer
          [default: scanline tracer]

  -h, --help
          Print help

Options of every command:
      --json
"""


def test_the_help_is_read() -> None:
    words = list(words_of(HELP))
    assert [word.word for word in words] == ["MESH", "SCENE", "--fronts-only", "--switch", "--output", "--with"]
    names = [{"mesh"}, {"scene"}, {"fronts_only"}, {"switch", "switches"}, {"output"}, {"with_"}]
    assert [word.names for word in words] == names
    assert [word.default for word in words] == [None] * 5 + ["scanline tracer"]


def test_names_that_differ_are_found() -> None:
    def pack_rays(mesh: Any, scene: Any, *, fronts: bool, switch: Any, output: Any, progress: Any) -> None: ...

    used: set[str] = set()
    assert differences(pack_rays, list(words_of(HELP)), used) == [
        "pack_rays: --fronts-only is no parameter; expected fronts_only",
        "pack_rays: --with is no parameter; expected with_",
        "pack_rays: fronts is no option of the command",
    ]
    assert used == {"* progress"}

    def pack(mesh: Any, scene: Any, fronts_only: bool, switches: Any, output: Any, with_: Any = ("scanline", "naive")) -> None: ...

    assert differences(pack, list(words_of(HELP)), used) == [
        "pack: with_ is ('scanline', 'naive') by default; expected scanline tracer as of --with"
    ]


def test_options_of_the_packages_own_command_are_the_commands(help_of: Help) -> None:
    parser = _command._parser()
    (commands,) = (action for action in parser._actions if isinstance(action, argparse._SubParsersAction))
    assert set(commands.choices) == {"campaign", "sweep"}
    for name, command in commands.choices.items():
        options = {option for action in command._actions for option in action.option_strings if option.startswith("--")}
        known = {word.word: word for word in words_of(help_of(name)) if word.word.startswith("--")}
        # On a cluster all parts are made.
        assert options - {"--help", "--json", "--force", "--dask", "--shards"} == known.keys() - {"--shard"}
        for action in command._actions:
            for option in known.keys() & set(action.option_strings):
                assert known[option].default in (None, said(action.default)), option
