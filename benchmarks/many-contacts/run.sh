#!/usr/bin/env bash
# Runs the engine, DOP853 and SUNDIALS CVODE on the problems of this folder, one after the other on one core, and prints
# the table of docs/many-contacts.md. CVODE needs the headers and libraries of SUNDIALS 6 (Debian: libsundials-dev; where
# that cannot be installed, SUNDIALS names the folder of its unpacked packages); without them it is left out.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
out=../../out/many-contacts
mkdir -p "$out"
root=${SUNDIALS:-/usr}
libraries=("$root"/lib/x86_64-linux-gnu/libsundials_{cvode,nvecserial,sunnonlinsolfixedpoint,sunlinsoldense,sunmatrixdense,generic}.a)
if [ -d "$root/include/cvode" ]; then
    # one process: the libraries are told that there is no MPI, whose headers they would ask for
    mkdir -p "$out/include"
    cp -r "$root"/include/{cvode,nvector,sundials,sunlinsol,sunmatrix,sunnonlinsol} "$out/include"
    sed -i 's/#define SUNDIALS_MPI_ENABLED 1/#define SUNDIALS_MPI_ENABLED 0/' "$out/include/sundials/sundials_config.h"
    cc -O3 -march=x86-64 -I"$out/include" cvode/solve.c "${libraries[@]}" -lm -o "$out/cvode"
    export CVODE=$out/cvode
fi
cargo run --release --quiet --locked --package many-contacts -- "$out"
