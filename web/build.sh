#!/usr/bin/env bash
# Builds docs/play.html, the interactive page: one file that contains the library as WebAssembly.
# Needs the target: rustup target add wasm32-unknown-unknown. Other arguments are passed to cargo.
set -euo pipefail
cd "$(dirname "$0")"
cargo fetch --locked --target wasm32-unknown-unknown
# messages of panics name source files, but not the folders of the machine that built the page
# (separated by the character that cargo expects, since folders may have spaces)
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
