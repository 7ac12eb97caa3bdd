# SPDX-License-Identifier: MIT OR Apache-2.0
"""Reads Verilog with slang at its default flags and prints what it says of it: slang.py TOP FILE.v…

Exit status: 0 it can be elaborated, 1 it cannot.
"""

import sys

from pyslang.driver import Driver

driver = Driver()
driver.addStandardArgs()
arguments = " ".join(["slang", "--top", *sys.argv[1:]])
read = driver.parseCommandLine(arguments) and driver.processOptions() and driver.parseAllSources()
sys.exit(0 if read and driver.runFullCompilation(True) else 1)
