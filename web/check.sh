#!/usr/bin/env bash
# Checks docs/play.html in headless Chromium (Debian's package chromium, or $CHROMIUM) with playwright-core from npm, and compares
# its results with those of the native program.
set -euo pipefail
cd "$(dirname "$0")/.."
cargo build --workspace --locked --bin vibroimpact
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
cp web/check.mjs "$folder"
(cd "$folder" && npm install --silent --no-audit --no-fund playwright-core@1)
(cd "$folder" && node check.mjs "$OLDPWD/docs/play.html" "$OLDPWD/target/debug/vibroimpact" "$@")
