// SPDX-License-Identifier: Apache-2.0
// What axe-core finds in the page that a browser shows: the serious and the critical of its findings.
import { existsSync, readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const source = join(dirname(fileURLToPath(import.meta.url)), "node_modules/axe-core/axe.min.js");

/** Ends the script as not run (exit code 77) where there is no axe-core. */
export function needAxe() {
  if (existsSync(source)) return;
  console.log("not run: axe-core is not installed (.ci/install --tests)");
  process.exit(77);
}

/** ["rule: what is wrong: element, element"], empty for a page that everybody can use. */
export async function findings(browser) {
  if (!(await browser.run("'axe' in window"))) await browser.run(`${readFileSync(source, "utf8")}; undefined`);
  return browser.run(`axe.run(document, { resultTypes: ["violations"] }).then(({ violations }) => violations.filter((v) => ["serious", "critical"].includes(v.impact))
    .map((v) => \`\${v.id}: \${v.help}: \${v.nodes.slice(0, 4).map((n) => n.target.join(" ") + " (" + (n.any[0]?.message ?? n.all[0]?.message ?? n.none[0]?.message ?? "") + ")").join(", ")}\${v.nodes.length > 4 ? ", ..." : ""}\`))`);
}
