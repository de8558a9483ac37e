// `get_usage_summary` as a server of the TypeScript SDK v2, on the same file as coin-server: one open connection,
// prepared statements. with_typescript_sdk.mjs DATABASE
import { createRequire } from "node:module";
import { pathToFileURL } from "node:url";
import { DatabaseSync } from "node:sqlite";

// Packages are installed outside the repository, where `import` would not look for them.
const installed = createRequire(`${process.env.COIN_CLIENTS}/package.json`);
const load = (name) => import(pathToFileURL(installed.resolve(name)).href);
const { McpServer } = await load("@modelcontextprotocol/server");
const { StdioServerTransport } = await load("@modelcontextprotocol/server/stdio");
const { z } = await load("zod");

const SESSION_GAP_SECONDS = 1200;
const SECONDS_A_DAY = 86_400;
const ACTIONS = ["use", "take", "place", "transport", "clean", "search", "give", "other"];

const database = new DatabaseSync(process.argv[2]);
database.exec("PRAGMA query_only = ON; PRAGMA cache_size = -4000;");
const begin = database.prepare("BEGIN");
const commit = database.prepare("COMMIT");
const findThing = database.prepare("SELECT object_key, class FROM objects WHERE id = ?");
const findClock = database.prepare("SELECT clock FROM home");
const findEvents = database.prepare(
  `SELECT at, name, action, caption FROM usage_events LEFT JOIN users ON user_key = actor
   WHERE object_key = ? AND at BETWEEN ? AND ? ORDER BY at, caption`,
);

function usageSummary({ object_id, window_days, as_of, max_examples }) {
  let thing, last, events;
  begin.run();
  try {
    thing = findThing.get(object_id);
    if (thing === undefined) throw new Error(`object_id: there is no object "${object_id}"`);
    last = as_of === undefined ? findClock.get().clock : Date.parse(`${as_of}Z`) / 1000;
    events = findEvents.all(thing.object_key, last - window_days * SECONDS_A_DAY, last);
  } finally {
    commit.run();
  }
  const { users, unattributed } = summarised(events, last, max_examples);
  const name = thing.class.split(" ").map((word) => word.charAt(0).toUpperCase() + word.slice(1)).join(" ");
  return {
    object: { id: object_id, name },
    as_of: new Date(last * 1000).toISOString().slice(0, 19),
    window_days,
    user_summary: users,
    unattributed_events: unattributed,
  };
}

/** What each user did, most events first, and how many events are nobody's. */
function summarised(events, now, maxExamples) {
  const users = new Map();
  let unattributed = 0;
  let lastUser = null;
  let lastAt = 0;
  for (const { at, name, action, caption } of events) {
    if (name === null) {
      unattributed += 1;
      continue;
    }
    let user = users.get(name);
    if (user === undefined) {
      user = { name, total: 0, sessions: 0, actions: {}, last: at, captions: [] };
      users.set(name, user);
    }
    user.total += 1;
    if (lastUser !== name || at - lastAt > SESSION_GAP_SECONDS) user.sessions += 1;
    const word = ACTIONS[action];
    user.actions[word] = (user.actions[word] ?? 0) + 1;
    user.last = at;
    user.captions.push(caption);
    lastUser = name;
    lastAt = at;
  }
  const ordered = [...users.values()].sort((one, other) => other.total - one.total || (one.name < other.name ? -1 : 1));
  return {
    unattributed,
    users: ordered.map((user) => ({
      user_id: user.name,
      total_events: user.total,
      sessions: user.sessions,
      actions: user.actions,
      last_used_days_ago: Math.floor((now - user.last + 4320) / 8640) / 10,
      example_events: maxExamples === 0 ? [] : user.captions.slice(-maxExamples),
    })),
  };
}

const server = new McpServer({ name: "usage", version: "1" });
server.registerTool(
  "get_usage_summary",
  {
    description: "Who used a thing, how often, how and how long ago.",
    inputSchema: z.object({
      object_id: z.string(),
      window_days: z.number().int().default(365),
      as_of: z.string().optional(),
      max_examples: z.number().int().default(5),
    }),
    outputSchema: z.object({
      object: z.object({ id: z.string(), name: z.string() }),
      as_of: z.string(),
      window_days: z.number().int(),
      user_summary: z.array(
        z.object({
          user_id: z.string(),
          total_events: z.number().int(),
          sessions: z.number().int(),
          actions: z.record(z.string(), z.number().int()),
          last_used_days_ago: z.number(),
          example_events: z.array(z.string()),
        }),
      ),
      unattributed_events: z.number().int(),
    }),
  },
  async (call) => {
    const summary = usageSummary(call);
    return { content: [{ type: "text", text: JSON.stringify(summary) }], structuredContent: summary };
  },
);
await server.connect(new StdioServerTransport());
