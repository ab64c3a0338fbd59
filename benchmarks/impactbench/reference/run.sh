#!/usr/bin/env bash
# Makes the references in quadruple precision anew. They are taken in by the next `cargo xtask impactbench problems`.
set -euo pipefail
cd "$(dirname "$0")"
out="$(cd ../../.. && pwd)/target/impactbench"
mkdir -p "$out"
gcc -O2 -o "$out/quad" quad.c -lquadmath -lm
QUAD="$out/quad" python3 quad.py "$@" > "$out/quad.csv"
[ $# -gt 0 ] && cat "$out/quad.csv" || cp "$out/quad.csv" quad.csv
