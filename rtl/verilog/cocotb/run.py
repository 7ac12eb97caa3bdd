# SPDX-License-Identifier: MIT OR Apache-2.0
"""Builds the printed core of the small profile with Icarus and runs test_core.py on it: run.py FOLDER."""

import sys
from pathlib import Path

from cocotb_tools.check_results import get_results
from cocotb_tools.runner import get_runner


here = Path(__file__).resolve().parent
folder = Path(sys.argv[1] if len(sys.argv) > 1 else "build").resolve()
runner = get_runner("icarus")
runner.build(sources=sorted((here.parent / "small").glob("*.v")), hdl_toplevel="hapticore", build_dir=folder, always=True, timescale=("1ns", "1ps"))
results = runner.test(
    hdl_toplevel="hapticore",
    test_module="test_core",
    build_dir=folder,
    results_xml=str(folder / "results.xml"),
    # A folder of that name would stand in for the package.
    extra_env={"PYTHONPATH": str(here), "PYTHONDONTWRITEBYTECODE": "1"},
)
tests, failures = get_results(results)
print(f"{tests} tests, {failures} failures")
sys.exit(failures != 0 or tests == 0)
