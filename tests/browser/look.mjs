// SPDX-License-Identifier: Apache-2.0
// Pictures of every screen of a running console, in three sizes and three themes, to be looked at:
//
//   node --experimental-websocket tests/browser/look.mjs "$(mgt console)" docs/console
//
// Also says where an element leaves the page or is cut.
import { mkdirSync } from "node:fs";
import { Browser, until } from "./browser.mjs";

const [url, folder] = process.argv.slice(2);
if (!url || !folder) {
  console.error("usage: node --experimental-websocket tests/browser/look.mjs URL FOLDER");
  process.exit(2);
}
mkdirSync(folder, { recursive: true });
const browser = await Browser.start();
let wrong = 0;
for (const [width, height] of [[1280, 800], [1024, 768], [390, 844]]) {
  await browser.open(url, width, height);
  await until(async () => (await browser.text("link")) === "live", "a live stream");
  await new Promise((resolve) => setTimeout(resolve, 5000));  // the lanes fill
  for (const theme of ["light", "dark", "sun"]) {
    await browser.run(`document.documentElement.dataset.theme = "${theme}"`);
    for (const screen of ["live", "run", "calibrations"]) {
      await browser.click(`tab-${screen}`);
      await new Promise((resolve) => setTimeout(resolve, 1200));
      const beyond = await browser.run("document.documentElement.scrollWidth - innerWidth");
      if (beyond > 0) {
        console.log(`${screen} ${width} ${theme}: ${beyond} px beyond the right edge`);
        ++wrong;
      }
      await browser.picture(`${folder}/${screen}-${width}-${theme}.png`);
    }
  }
}
for (const line of browser.log) console.log(`the browser says: ${line}`);
await browser.close();
process.exit(wrong + browser.log.length > 0 ? 1 : 0);
