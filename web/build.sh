#!/usr/bin/env bash
# Builds docs/play.html, the interactive page: one file that contains the library as WebAssembly.
# Needs the target: rustup target add wasm32-unknown-unknown. Other arguments are passed to cargo.
set -euo pipefail
cd "$(dirname "$0")"
cargo fetch --locked --target wasm32-unknown-unknown
# The messages of panics name source files. They must not name the folders of the machine that builds the page. Folders may have
# spaces, so the flags are separated by the character that cargo expects between encoded flags.
flags="--remap-path-prefix=$(cd .. && pwd)/="
for sources in "${CARGO_HOME:-$HOME/.cargo}"/registry/src/*/; do
    flags+=$'\x1f'"--remap-path-prefix=$sources="
done
export CARGO_ENCODED_RUSTFLAGS="$flags"
cargo build --release --locked --target wasm32-unknown-unknown "$@"
module="${CARGO_TARGET_DIR:-target}/wasm32-unknown-unknown/release/vibroimpact_web.wasm"
packed="$(gzip -9 -n -c "$module" | base64 -w 0)"
{
    sed -e '/@MODULE@/,$d' page.html
    printf '<script type="application/octet-stream" id="module">%s</script>\n' "$packed"
    sed -e '1,/@MODULE@/d' page.html
} > ../docs/play.html
ls -l ../docs/play.html
