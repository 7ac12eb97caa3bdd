# SPDX-License-Identifier: MIT OR Apache-2.0
"""Builds the printed core of the small profile and the printed force loop with Icarus, and runs test_core.py and test_loop.py on
them: run.py FOLDER."""

import sys
from pathlib import Path

from cocotb_tools.check_results import get_results
from cocotb_tools.runner import get_runner

# Folder of the Verilog, its top module, the tests.
DESIGNS = [("small", "hapticore_small", "test_core"), ("loop", "hapticore_loop_loop", "test_loop")]


def run(folder, verilog, top, module):
    here = Path(__file__).resolve().parent
    runner = get_runner("icarus")
    sources = sorted((here.parent / verilog).glob("*.v"))
    runner.build(sources=sources, hdl_toplevel=top, build_dir=folder, always=True, timescale=("1ns", "1ps"))
    results = runner.test(
        hdl_toplevel=top,
        test_module=module,
        build_dir=folder,
        results_xml=str(folder / "results.xml"),
        # A folder of that name would stand in for the package.
        extra_env={"PYTHONPATH": str(here), "PYTHONDONTWRITEBYTECODE": "1"},
    )
    return get_results(results)


root = Path(sys.argv[1] if len(sys.argv) > 1 else "build").resolve()
all_results = [run(root / verilog, verilog, top, module) for verilog, top, module in DESIGNS]
tests, failures = (sum(counts) for counts in zip(*all_results))
print(f"{tests} tests, {failures} failures")
sys.exit(failures != 0 or tests != len(DESIGNS))
