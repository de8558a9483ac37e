// Fills the manifest in: the version and the tools come from the program itself, the platform and the default place of
// the database from the machine that builds the bundle. Usage: node render.mjs PROGRAM VERSION DATABASE > manifest.json

import { spawn } from "node:child_process";
import { once } from "node:events";
import { readFile } from "node:fs/promises";
import { createInterface } from "node:readline";

// The same places as those of the program without --db.
const DATABASES = {
  darwin: "${HOME}/Library/Application Support/coin/home.db",
  linux: "${HOME}/.local/share/coin/home.db",
  win32: "${HOME}\\AppData\\Roaming\\coin\\data\\home.db",
};

const [program, version, database] = process.argv.slice(2);
const manifest = JSON.parse(await readFile(new URL("manifest.json", import.meta.url), "utf8"));
const tools = await listTools();
manifest.version = version;
manifest.tools = tools.map(({ name, title, description }) => ({ name, description: title ?? description }));
manifest.tools_generated = false;
manifest.compatibility = { platforms: [process.platform] };
manifest.user_config.database.default = DATABASES[process.platform];
if (process.platform === "win32") manifest.server.entry_point += ".exe";
process.stdout.write(JSON.stringify(manifest, null, 2) + "\n");

async function listTools() {
  const server = spawn(program, ["--db", database], { stdio: ["pipe", "pipe", "inherit"] });
  const ended = once(server, "exit");
  const send = (message) => server.stdin.write(JSON.stringify({ jsonrpc: "2.0", ...message }) + "\n");
  const client = { protocolVersion: "2025-11-25", capabilities: {}, clientInfo: { name: "bundle", version } };
  send({ id: 1, method: "initialize", params: client });
  for await (const line of createInterface({ input: server.stdout })) {
    const { id, result, error } = JSON.parse(line);
    if (error) throw new Error(`the program refuses: ${error.message}`);
    if (id === 1) {
      send({ method: "notifications/initialized" });
      send({ id: 2, method: "tools/list", params: {} });
    } else if (id === 2) {
      server.stdin.end();
      await ended;
      return result.tools;
    }
  }
  throw new Error("the program ended before it listed its tools");
}
