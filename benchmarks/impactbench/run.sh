#!/usr/bin/env bash
# Runs every code on the problems of impactbench, and writes the results and the page.
# Codes outside Rust are installed into target/impactbench, from PyPI; one that does not install is left out, and its results
# stay as they are.
set -euo pipefail
cd "$(dirname "$0")"
root="$(cd ../.. && pwd)"
venv="$root/target/impactbench"
[ -d "$venv" ] || python3 -m venv "$venv"

python_code() { # name, package
    if "$venv/bin/pip" install --quiet "$2"; then
        rm -f "results/$1.csv"
        (cd codes && "$venv/bin/python" "$1_code.py" > /dev/null)
    else
        echo "$1 does not install here" >&2
    fi
}

python_code mujoco "mujoco==4.0.0"
python_code pybullet "pybullet==3.2.7"
python_code exudyn "exudyn==1.13.6"

if cargo build --release --quiet --manifest-path codes/rapier/Cargo.toml --target-dir "$venv/rapier"; then
    "$venv/rapier/release/impactbench-rapier" > results/rapier.csv
    version="$(cargo tree --quiet --manifest-path codes/rapier/Cargo.toml --depth 1 | grep -o 'rapier2d-f64 v[0-9.]*')"
    echo "$(date +%F); $(grep -m1 'model name' /proc/cpuinfo | cut -d: -f2- | xargs); $(rustc --version), $version" > results/rapier.txt
fi

cd "$root"
cargo xtask impactbench
