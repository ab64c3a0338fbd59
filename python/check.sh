#!/usr/bin/env bash
# Checks the Python package: builds it (unoptimised linking, for speed) into an environment of its own under target/,
# runs the tests, including those of notebooks and documents, and compares the stubs with the module. Needs Rust and Python 3.10.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
target=${CARGO_TARGET_DIR:-$PWD/target}
export CARGO_TARGET_DIR=$target
venv=$target/python-venv
[ -x "$venv/bin/python" ] || python3 -m venv "$venv"
# shellcheck disable=SC1091
source "$venv/bin/activate"
# pyNastran needs numpy below 2, pandas 3 needs a newer one.
python -m pip install --quiet --disable-pip-version-check 'maturin>=1.7,<2' numpy pytest mypy matplotlib nbclient ipykernel \
  'pandas<3' scipy 'pyNastran>=1.4' pyuff
cargo fmt --check --manifest-path python/Cargo.toml
cargo clippy --quiet --locked --manifest-path python/Cargo.toml -- -D warnings
cargo build --quiet --locked --package vibroimpact
maturin develop --quiet --locked --manifest-path python/Cargo.toml
cd python
VIBROIMPACT=$target/debug/vibroimpact python -m pytest --quiet tests
python -m mypy --strict --cache-dir "$target/mypy" vibroimpact
MYPY_CACHE_DIR=$target/mypy python -m mypy.stubtest vibroimpact --mypy-config-file pyproject.toml
