#!/usr/bin/env bash
# Runs every code on the problems of impactbench, and writes the results and the page.
# Codes outside Rust are installed: from PyPI into target/impactbench, and, if apt-get is permitted, from Debian (calculix-ccx,
# python3-siconos, libsundials-dev). A code that cannot be installed is omitted, and its results do not change.
# With names of codes only these are run: run.sh siconos cvode
set -euo pipefail
cd "$(dirname "$0")"
root="$(cd ../.. && pwd)"
out="$root/target/impactbench"
mkdir -p "$out"
wanted=" $* "

wants() { [ "$wanted" = "  " ] || [[ $wanted == *" $1 "* ]]; }

debian() { # package
    dpkg -s "$1" > /dev/null 2>&1 && return
    local root=()
    [ "$(id -u)" = 0 ] || root=(sudo -n)
    "${root[@]}" apt-get update -qq && "${root[@]}" apt-get install --yes -qq "$1" > /dev/null
}

program() { # name, Python: runs codes/NAME_code.py
    rm -f "results/$1.csv"
    (cd codes && timeout 600 "$2" "$1_code.py" > /dev/null 2> "$out/$1.log") || echo "$1 stopped: $out/$1.log" >&2
}

python_code() { # name, package
    wants "$1" || return 0
    [ -d "$out/venv" ] || python3 -m venv "$out/venv"
    if "$out/venv/bin/pip" install --quiet --disable-pip-version-check numpy "$2"; then
        program "$1" "$out/venv/bin/python"
    else
        echo "$1 does not install here" >&2
    fi
}

rust_code() { # name, package
    wants "$1" || return 0
    if cargo build --release --quiet --manifest-path "codes/$1/Cargo.toml" --target-dir "$out/$1"; then
        "$out/$1/release/impactbench-$1" > "results/$1.csv"
        version="$(cargo tree --quiet --manifest-path "codes/$1/Cargo.toml" --depth 1 | grep -o "$2 v[0-9.]*")"
        echo "$(date +%F); $(grep -m1 'model name' /proc/cpuinfo | cut -d: -f2- | xargs); $(rustc --version), $version" > "results/$1.txt"
    else
        echo "$1 does not build here" >&2
    fi
}

python_code mujoco "mujoco==4.0.0"
python_code pybullet "pybullet==3.2.7"
python_code exudyn "exudyn==1.13.6"
rust_code rapier rapier2d-f64
rust_code avian avian2d

if wants calculix; then
    if debian calculix-ccx; then program calculix python3; else echo "CalculiX does not install here" >&2; fi
fi
if wants siconos; then
    # Debian's own Python and numpy, for which it is built
    if debian python3-siconos; then
        PYTHONPATH=/usr/lib/python3/dist-packages program siconos /usr/bin/python3
    else
        echo "Siconos does not install here" >&2
    fi
fi
if wants cvode; then
    if debian libsundials-dev; then
        # one process: the libraries are told that there is no MPI, whose headers they would ask for
        mkdir -p "$out/include"
        cp -r /usr/include/{cvode,nvector,sundials,sunlinsol,sunmatrix,sunnonlinsol} "$out/include"
        sed -i 's/#define SUNDIALS_MPI_ENABLED 1/#define SUNDIALS_MPI_ENABLED 0/' "$out/include/sundials/sundials_config.h"
        parts=(/usr/lib/*/libsundials_{cvode,nvecserial,sunnonlinsolfixedpoint,sunlinsoldense,sunmatrixdense,generic}.a)
        cc -O3 -march=x86-64 -I"$out/include" codes/cvode/solve.c "${parts[@]}" -lm -o "$out/cvode"
        export CVODE="$out/cvode"
        export CVODE_VERSION="$(sed -n 's/#define SUNDIALS_VERSION "\(.*\)"/\1/p' "$out/include/sundials/sundials_config.h")"
        program cvode python3
    else
        echo "SUNDIALS does not install here" >&2
    fi
fi

cd "$root"
if wants rust; then cargo xtask impactbench; else cargo xtask impactbench report; fi
