// Bundles the scripts for the pages: classic scripts, since browsers load no modules from file://.
import { build } from "esbuild";
import { mkdir, readFile, writeFile } from "node:fs/promises";

const target = "../static";
await mkdir(target, { recursive: true });
await build({
  entryPoints: ["grid.js", "asset.js"],
  bundle: true,
  minify: true,
  format: "iife",
  target: ["chrome100", "firefox113", "safari16.4"],
  legalComments: "none",
  charset: "ascii",
  outdir: target,
});

const names = ["three"];
const texts = await Promise.all(names.map(async (name) => {
  const about = JSON.parse(await readFile(`node_modules/${name}/package.json`, "utf8"));
  const license = await readFile(`node_modules/${name}/LICENSE`, "utf8");
  return `${name} ${about.version} (${about.license})\n\n${license.trim()}\n`;
}));
await writeFile(`${target}/licenses.txt`, `The viewer's script contains:\n\n${texts.join("\n")}`);
