# SPDX-License-Identifier: MIT
"""A suite as tests of pytest, one a case: pytest examples/suite. MIXLOOP names the command where PATH doesn't."""

import json
import os
import pathlib
import subprocess

import pytest

SUITE = pathlib.Path(__file__).parent / "payloads.yaml"


def results():
    command = [os.environ.get("MIXLOOP", "mixloop"), "track", str(SUITE), "--jobs", "2", "--json"]
    done = subprocess.run(command, capture_output=True, text=True)
    return json.loads(done.stdout)["results"]


@pytest.mark.parametrize("result", results(), ids=lambda result: result["experiment"])
def test_case(result):
    assert "error" not in result, result["error"]["message"]
    assert result["verdict"] == "held", "; ".join(result.get("missed", []))
