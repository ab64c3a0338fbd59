#!/usr/bin/env bash
# Runs the solvers outside Rust on the problems of the work-precision report: scipy's DOP853, LSODA, Radau and BDF,
# SUNDIALS CVODE (scikit-sundae) and Octave's ode15s on the impacts, DAQP on the quadratic programs. Creates a Python
# environment under out/peers, and installs Octave if apt-get is permitted. Writes
# benchmarks/work-precision/outside/{outside.csv,versions.txt}, which the next report includes; a run on some of the
# problems writes to out/peers instead.
#
#     benchmarks/peers.sh [--seconds 60] [--minutes 11]
#     benchmarks/peers.sh --problems pinned-hertz,emoc-N8-basic
#
# The options limit the seconds of one solve and the total minutes. The remaining time is shared evenly over the remaining
# solves, and the table lists those that were not run.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
work=out/peers
out=benchmarks/work-precision/outside
for argument in "$@"; do
    case $argument in --problems*) out=$work ;; esac
done
if ! command -v octave-cli > /dev/null && command -v apt-get > /dev/null; then
    root=()
    [ "$(id -u)" = 0 ] || root=(sudo -n)
    "${root[@]}" apt-get update -qq && "${root[@]}" apt-get install --yes -qq octave > /dev/null ||
        echo "Octave could not be installed: its solver is left out" >&2
fi
mkdir -p "$work"
cargo run --release --quiet -p work-precision -- export "$work/problems"
[ -x "$work/python/bin/python" ] || python3 -m venv "$work/python"
"$work/python/bin/pip" install --quiet numpy scipy scikit-sundae daqp
# one thread each, as the solvers in Rust
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
"$work/python/bin/python" benchmarks/work-precision/outside/solve.py "$work/problems" benchmarks/work-precision \
    --out "$out" "$@"
