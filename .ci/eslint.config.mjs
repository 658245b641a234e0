// Rules for the scripts of the pages; tsc looks for names that nothing defines, as pages load scripts side by side.
import { createRequire } from "node:module";

const installed = createRequire(new URL("../.venv/validator/package.json", import.meta.url));
const { configs } = installed("@eslint/js");

export default [
  configs.recommended,
  {
    languageOptions: { ecmaVersion: 2023, sourceType: "script" },
    linterOptions: { reportUnusedDisableDirectives: "error" },
    rules: {
      "no-undef": "off",
      "no-unused-vars": ["error", { vars: "local" }],
      "no-var": "error",
      "prefer-const": "error",
      eqeqeq: "error",
      "no-implicit-globals": "off",
      "no-eval": "error",
      "no-implied-eval": "error",
      "no-shadow": "error",
      "consistent-return": "off",
      strict: ["error", "global"],
    },
  },
];
