#!/usr/bin/env bash
# Runs the solvers outside Rust on the problems of the work-precision report: scipy's DOP853, LSODA, Radau and BDF,
# SUNDIALS CVODE (scikit-sundae) and Octave's ode15s on the impacts, DAQP on the quadratic programs. Makes a Python
# environment by itself under out/peers, and installs Octave where apt-get may. Writes
# benchmarks/work-precision/outside/{outside.csv,versions.txt}, and the next report takes them in; a run on some of the
# problems writes to out/peers instead.
#
#     benchmarks/peers.sh [--seconds 60] [--minutes 11]
#     benchmarks/peers.sh --problems pinned-hertz,emoc-N8-basic
#
# One solve takes at most so many seconds, all of them together so many minutes: what is left of those is shared evenly
# over what is still to be done, and what does not fit is told in the table.
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
