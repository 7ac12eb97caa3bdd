#!/bin/sh
# SPDX-License-Identifier: MIT OR Apache-2.0
# Makes ulx3s.bit for a ULX3S with an ECP5 85F. Needs yosys, nextpnr-ecp5 and ecppack (Project Trellis) on PATH.
# Then: openFPGALoader -b ulx3s ulx3s.bit
set -eu
cd "$(dirname "$0")"
set -- *.v
yosys -q -p "read_verilog $*; synth_ecp5 -top top -json ulx3s.json"
nextpnr-ecp5 -q --85k --package CABGA381 --speed 6 --freq 100 --seed 1 \
    --json ulx3s.json --lpf ulx3s.lpf --textcfg ulx3s.config --report ulx3s.report.json
ecppack --compress ulx3s.config ulx3s.bit
echo "made ulx3s.bit"
