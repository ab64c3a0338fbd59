#!/usr/bin/env bash
# Runs the solvers outside Rust on the impacts of the work-precision report: scipy's DOP853, LSODA, Radau and BDF, and
# SUNDIALS CVODE (scikit-sundae), in a Python environment that it makes by itself under out/peers. Writes
# benchmarks/work-precision/outside/{outside.csv,versions.txt}; the next report takes them in.
#
#     benchmarks/peers.sh [seconds a solve may take; 120]
#     ONLY="pinned-hertz stepped-hertz" benchmarks/peers.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
cap=${1:-120}
work=out/peers
mkdir -p "$work"
cargo run --release --quiet -p work-precision -- export "$work/problems"
[ -x "$work/python/bin/python" ] || python3 -m venv "$work/python"
"$work/python/bin/pip" install --quiet numpy scipy scikit-sundae
"$work/python/bin/python" benchmarks/work-precision/outside/solve.py "$work/problems" benchmarks/work-precision "$cap"
