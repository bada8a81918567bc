#!/usr/bin/env python3
"""How long the builds and the tests take: writes docs/evidence/build-times.md.

    .ci/build_times.py [--runs N] [--skip-tests]

It clones the last commit to a temporary folder, so that nothing is built before, and runs each command there with the
whole machine to itself. Nothing else should run meanwhile. Two runs take about 40 minutes on two cores.
"""

import argparse
import json
import os
import re
import resource
import shutil
import statistics
import subprocess
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs/evidence/build-times.md"


def timed(command: list[str], folder: Path, rebuilt: Path | None = None) -> tuple[float, float, str]:
    """Wall and processor seconds of a command, and what it prints. `rebuilt` is a file that is touched first."""
    if rebuilt is not None:
        os.utime(folder / rebuilt)
    environment = {name: value for name, value in os.environ.items() if not name.startswith("CARGO_TARGET")}
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    done = subprocess.run(command, cwd=folder, env=environment, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    wall, after = time.monotonic() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(command)} failed:\n{done.stdout[-4000:]}")
    processor = after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime
    return wall, processor, done.stdout


def units(folder: Path) -> dict[str, float]:
    """Seconds that cargo spent on each package, from its report of the last cold build."""
    report = max(folder.glob("target/cargo-timings/cargo-timing-*.html"), key=lambda path: path.stat().st_mtime)
    entries = re.search(r"const UNIT_DATA = (\[.*?\]);\n", report.read_text(), re.DOTALL)
    assert entries is not None, f"{report} has no table of units"
    found: dict[str, float] = {}
    for unit in json.loads(entries.group(1)):
        found[unit["name"]] = found.get(unit["name"], 0.0) + unit["duration"]
    return found


def machine() -> str:
    cores = os.cpu_count()
    model = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")), "unknown")
    compiler = subprocess.run(["rustc", "--version"], text=True, capture_output=True, check=True).stdout.split("(")[0].strip()
    return f"{cores} cores, {model}, {compiler}"


def metadata(folder: Path) -> tuple[int, int]:
    """Test executables of the workspace, and packages of the command."""
    text = subprocess.run(
        ["cargo", "metadata", "--format-version", "1", "--no-deps"], cwd=folder, text=True, capture_output=True, check=True
    ).stdout
    executables = sum(target["test"] for package in json.loads(text)["packages"] for target in package["targets"])
    tree = ["cargo", "tree", "--locked", "-p", "raypencil-cli", "-e", "normal,build", "--prefix", "none"]
    lines = subprocess.run(tree, cwd=folder, text=True, capture_output=True, check=True).stdout.splitlines()
    return executables, len({" ".join(line.split()[:2]) for line in lines if line})


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--runs", type=int, default=2, help="how often each command runs; the median is told")
    options.add_argument("--skip-tests", action="store_true", help="leave out the tests, and print in place of writing the page")
    arguments = options.parse_args()

    run = ["cargo", "run", "--release", "--timings"]
    again = ["cargo", "build", "--release"]
    steps = [
        ("`cargo run --release`, from nothing", run, None),
        ("again, after a change in `referee/src/lib.rs`", again, Path("crates/engines/referee/src/lib.rs")),
        ("again, after a change in `cli/src/lib.rs`", again, Path("crates/doors/cli/src/lib.rs")),
    ]
    if not arguments.skip_tests:
        steps.append(("`cargo test --workspace`, from nothing", ["cargo", "test", "--workspace"], None))
    times: dict[str, list[tuple[float, float]]] = {name: [] for name, _, _ in steps}
    tests = 0
    for _ in range(arguments.runs):
        with tempfile.TemporaryDirectory(prefix="build-times-") as temporary:
            folder = Path(temporary) / "clone"
            subprocess.run(["git", "clone", "--quiet", str(ROOT), str(folder)], check=True)
            subprocess.run(["cargo", "fetch", "--quiet", "--locked"], cwd=folder, check=True)
            for name, command, rebuilt in steps:
                wall, processor, printed = timed(command, folder, rebuilt)
                times[name].append((wall, processor))
                tests = sum(map(int, re.findall(r"^test result: ok\. (\d+) passed", printed, re.MULTILINE))) or tests
                print(f"{name}: {wall:.0f} s, {processor:.0f} s of processor time", flush=True)
            program = folder / "target/release/raypencil"
            stripped = Path(temporary) / "stripped"
            subprocess.run(["strip", "-o", str(stripped), str(program)], check=True)
            sizes = [program.stat().st_size, stripped.stat().st_size]
            seconds = units(folder)
            executables, packages = metadata(folder)
            shutil.rmtree(folder / "target")

    runs = "one run" if arguments.runs == 1 else f"medians of {arguments.runs} runs"

    def median(name: str, part: int) -> str:
        return f"{statistics.median(pair[part] for pair in times[name]):.0f}"

    commit = subprocess.run(
        ["git", "log", "-1", "--format=%h of %cs"], cwd=ROOT, text=True, capture_output=True, check=True
    ).stdout.strip()
    heaviest = sorted(seconds.items(), key=lambda pair: -pair[1])
    ours = sum(value for name, value in seconds.items() if name.startswith("raypencil"))
    rows = "".join(f"| {name} | {median(name, 0)} | {median(name, 1)} |\n" for name in times)
    table = "".join(f"| `{name}` | {value:.1f} |\n" for name, value in heaviest[:20])
    page = f"""# Times of builds and tests

`just build-times` wrote this page at commit {commit}: {machine()}, nothing else running, {runs}.

| what | wall, s | processor, s |
| --- | ---: | ---: |
{rows}
| what | number |
| --- | ---: |
| program, MB | {sizes[0] / 1e6:.1f} |
| program without its symbols, MB | {sizes[1] / 1e6:.1f} |
| packages that the command is built of | {packages} |
| executables of tests | {executables} |
| tests, those of the documentation included | {tests:,} |

The cold build takes {sum(seconds.values()):.0f} unit-seconds: seconds from the start to the end of each compilation, two of which run
at a time. The house's own packages take {ours:.0f} of them. The heaviest packages:

| package | unit-s |
| --- | ---: |
{table}
## Why the levels differ

`Cargo.toml` sets three levels of optimisation. *3*: what each ray, pixel, face or sample passes through, and the libraries under it.
*0*: what reads arguments or short files, once a run; optimising it takes four to six times as long as compiling it. *1*: all else.
The results have the same bits at each level: `.ci/run` compares the committed digest, renderings, a drive, a sweep and a campaign of
a program without any optimisation with those of the released one.
"""
    if arguments.skip_tests:
        print(page)
    else:
        PAGE.write_text(page)
        print(f"wrote {PAGE.relative_to(ROOT)}")


if __name__ == "__main__":
    main()
