"""The path of the repository, and the command line with which the package is compared."""

import json
import os
import subprocess
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).parents[2]
SCENES = REPOSITORY / "datasets" / "scenes"
ASSEMBLIES = REPOSITORY / "datasets" / "assemblies"


@pytest.fixture(scope="session")
def command_line():
    """Runs the program and returns its JSON output, or its message if it rejected the input."""
    program = os.environ.get("VIBROIMPACT")
    if program is None:
        pytest.skip("VIBROIMPACT does not name the program")

    def run(*arguments):
        words = [program, *map(str, arguments), *([] if arguments[0] == "sweep" else ["--json"])]
        done = subprocess.run(words, capture_output=True, text=True, timeout=120)
        if done.returncode:
            return done.stderr.strip().removeprefix("error: ")
        return json.loads(done.stdout) if arguments[0] != "sweep" else done.stdout

    return run


@pytest.fixture
def scene():
    """A ball on a pinned beam."""
    return json.loads((SCENES / "pinned-beam.json").read_text())
